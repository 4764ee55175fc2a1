//! The charts that a model can declare.

use super::nodes::Nodes;
use super::{half_vector, hemisphere};

/// Coordinates of the hemisphere of incident directions in which a model is smooth.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Chart {
    /// Polar round the normal in half-vector space, graded at `alpha`; see [`half_vector`].
    HalfVector {
        /// Width of the peak of D.
        alpha: f64,
    },
    /// Polar round the normal in `wi`; see [`hemisphere`].
    Hemisphere,
}

impl Chart {
    /// Calls `visit` with batches of nodes at a refinement level (2 is coarse, 16 is full f64 accuracy).
    pub fn visit(&self, mu_o: f64, level: f64, visit: &mut dyn FnMut(&Nodes)) {
        match *self {
            Chart::HalfVector { alpha } => half_vector::visit(mu_o, alpha, level, visit),
            Chart::Hemisphere => hemisphere::visit(mu_o, level, visit),
        }
    }

    /// How much smaller than the difference of two successive levels the error of the finer one is taken to be.
    ///
    /// In the half-vector chart the error falls by at least 12 from one level of the ladder to the next (measured,
    /// `tests/quadrature.rs`); a third of that gain is claimed.
    #[must_use]
    pub fn gain(&self) -> f64 {
        match self {
            Chart::HalfVector { .. } => 1.0,
            Chart::Hemisphere => 1.0,
        }
    }

    /// The rule in words, for metadata.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Chart::HalfVector { .. } => {
                "product Gauss-Legendre, graded half-vector chart, level raised until two levels agree"
            }
            Chart::Hemisphere => "product Gauss-Legendre, polar chart, level raised until two levels agree",
        }
    }
}
