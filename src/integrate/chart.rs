//! The charts that a model can declare.

use super::nodes::Nodes;
use super::{broad, half_vector, hemisphere};

/// Coordinates of the hemisphere of incident directions in which a model is smooth.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Chart {
    /// Polar round the normal in half-vector space, graded at `alpha`; see [`half_vector`].
    HalfVector {
        /// Width of the peak of D.
        alpha: f64,
        /// D vanishes beyond `tan(theta) = reach * alpha`; infinite for a power-law tail.
        reach: f64,
        /// True if the model has kinks inside the panels (V-cavity masking): convergence is then algebraic, and the
        /// difference of two levels says less.
        kinks: bool,
    },
    /// Polar round the normal in `wi`; see [`hemisphere`].
    Hemisphere,
    /// Polar round the normal in `wi`, graded without bound at horizon and normal; see [`broad`].
    Broad {
        /// As in [`Chart::HalfVector`].
        kinks: bool,
    },
}

impl Chart {
    /// Calls `visit` with batches of nodes at a refinement level (2 is coarse, 16 is full f64 accuracy).
    pub fn visit(&self, mu_o: f64, level: f64, visit: &mut dyn FnMut(&Nodes)) {
        match *self {
            Chart::HalfVector { alpha, reach, .. } => half_vector::visit(mu_o, alpha, reach, level, visit),
            Chart::Hemisphere => hemisphere::visit(mu_o, level, visit),
            Chart::Broad { .. } => broad::visit(mu_o, level, visit),
        }
    }

    /// How much smaller than the difference of two successive levels the error of the finer one is taken to be, for
    /// the step to ladder level `j`.
    ///
    /// Measured over 6000 pairs of mu and alpha in [1e-5, 1] (`cargo long`, `tests/quadrature.rs`): with these gains
    /// the error is below its estimate for 99.9 % of GGX and 99 % of Beckmann pairs at every level. A Gaussian peak
    /// converges later and then faster than a power law, so its first levels get a gain below 1.
    #[must_use]
    pub fn gain(&self, j: usize) -> f64 {
        let table = match self {
            Chart::HalfVector { kinks: true, .. } | Chart::Broad { kinks: true } => [0.2; 4],
            Chart::HalfVector { reach, .. } if reach.is_finite() => [0.3, 0.3, 0.3, 2.0],
            Chart::HalfVector { .. } => [0.3, 0.8, 0.9, 2.0],
            Chart::Hemisphere | Chart::Broad { .. } => [1.0; 4],
        };
        table[j.clamp(1, table.len()) - 1]
    }

    /// The rule in words, for metadata.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Chart::HalfVector { .. } => {
                "product Gauss-Legendre, graded half-vector chart, level raised until two levels agree"
            }
            Chart::Hemisphere => "product Gauss-Legendre, polar chart, level raised until two levels agree",
            Chart::Broad { .. } => {
                "double exponential by Gauss-Legendre, polar chart, level raised until two levels agree"
            }
        }
    }
}
