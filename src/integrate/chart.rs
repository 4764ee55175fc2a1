//! The charts that a model can declare.

use super::ellipse::{self, Edge};
use super::hemisphere::{self, Folds};
use super::nodes::Nodes;
use super::view::View;
use super::{broad, fibre, half_vector, lobe};

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
    /// The same for two widths, or for lobes with other edges than masking has; see [`ellipse`].
    Ellipse {
        /// Widths of the peak of D along the tangents.
        alpha: [f64; 2],
        /// As in [`Chart::HalfVector`], in units of the width along each azimuth.
        reach: f64,
        /// What the lobe does at the horizon.
        edge: Edge,
    },
    /// Polar round the axis `C wo` of a lobe `max(0, wi . C wo)^exponent`; see [`lobe`].
    Lobe {
        /// Diagonal of C.
        c: [f64; 3],
        /// Exponent.
        exponent: f64,
    },
    /// Polar round the tangent, for fibres; see [`fibre`].
    Fibre {
        /// Exponent of the lobe across the fibre.
        across: f64,
        /// Exponent of the lobe on the cone of reflection.
        cone: f64,
    },
    /// Polar round the normal in `wi`, for lobes that are smooth all over; see [`hemisphere`].
    Hemisphere,
    /// Polar round the normal in `wi`, graded without bound at horizon and normal; see [`broad`].
    Broad {
        /// As in [`Chart::HalfVector`].
        kinks: bool,
    },
    /// The same with panels that end at `mu_i = mu_o` and at azimuth pi/2 from wo.
    Folded,
    /// The same graded towards the horizon, for lobes with a power of `mu_i`.
    Horizon,
}

/// Angle from the horizon down to which [`Chart::Horizon`] is graded.
const HORIZON_SCALE: f64 = 1e-9;

impl Chart {
    /// Calls `visit` with batches of nodes at a refinement level (2 is coarse, 16 is full f64 accuracy).
    pub fn visit(&self, view: View, level: f64, visit: &mut dyn FnMut(&Nodes)) {
        match *self {
            Chart::HalfVector { alpha, reach, .. } => half_vector::visit(view.mu, alpha, reach, level, visit),
            Chart::Ellipse { alpha, reach, edge } => ellipse::visit(view, alpha, reach, edge, level, visit),
            Chart::Lobe { c, exponent } => lobe::visit(view, c, exponent, level, visit),
            Chart::Fibre { across, cone } => fibre::visit(view, across, cone, level, visit),
            Chart::Hemisphere => hemisphere::visit(view, Folds::None, level, visit),
            Chart::Folded => hemisphere::visit(view, Folds::Cross, level, visit),
            Chart::Horizon => hemisphere::visit(view, Folds::Horizon(HORIZON_SCALE), level, visit),
            Chart::Broad { .. } => broad::visit(view.mu, level, visit),
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
        let table: &[f64] = match self {
            Chart::HalfVector { kinks: true, .. } | Chart::Broad { kinks: true } => &[0.2],
            Chart::HalfVector { reach, .. } if reach.is_finite() => &[0.3, 0.3, 0.3, 2.0],
            Chart::HalfVector { .. } => &[0.3, 0.8, 0.9, 2.0],
            Chart::Ellipse { reach, .. } if reach.is_finite() => &[1.0, 0.5, 0.6, 3.0, 1.2],
            Chart::Ellipse { .. } => &[4.0, 3.0, 2.0, 1.0, 0.7],
            Chart::Lobe { .. } => &[0.2, 0.7, 4.0],
            Chart::Fibre { .. } => &[0.4, 1.0],
            Chart::Hemisphere | Chart::Folded | Chart::Horizon | Chart::Broad { .. } => &[1.0],
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
            Chart::Ellipse { .. } => {
                "product Gauss-Legendre, elliptical half-vector chart, level raised until two levels agree"
            }
            Chart::Lobe { .. } => {
                "product Gauss-Legendre, polar chart round the lobe, level raised until two levels agree"
            }
            Chart::Fibre { .. } => {
                "product Gauss-Legendre, polar chart round the tangent, level raised until two levels agree"
            }
            Chart::Hemisphere => {
                "Gauss-Legendre by midpoints, polar chart, level raised until two levels agree"
            }
            Chart::Folded | Chart::Horizon => {
                "product Gauss-Legendre, polar chart, level raised until two levels agree"
            }
            Chart::Broad { .. } => {
                "double exponential by Gauss-Legendre, polar chart, level raised until two levels agree"
            }
        }
    }
}
