//! The charts that a model can declare.

use super::crease::Crease;
use super::ellipse::{self, Edge, FacetLobe};
use super::hemisphere::{self, Folds};
use super::nodes::Nodes;
use super::stop::Trust;
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
        /// True if the model has kinks inside the panels (V-cavity masking), or a D without bound at the horizon: convergence is then
        /// slow, and the difference of two levels says less.
        kinks: bool,
        /// Width in `wo . wm` over which the Fresnel factor changes at grazing incidence; infinite if it is smooth there.
        slope: f64,
        /// Width of the layer at the horizon in `mu_i`; three alpha for Smith's masking.
        layer: f64,
    },
    /// The same for two widths, for lobes with other edges than masking has, and where F is not smooth; see [`ellipse`].
    Ellipse(FacetLobe),
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
        /// Cosines below this count as this: another kink; 0 for none.
        floor: f64,
    },
    /// The same with panels that end at `mu_i = mu_o` and at azimuth pi/2 from wo.
    Folded,
    /// The same graded towards the horizon, for lobes with a power of `mu_i`.
    Horizon,
}

/// Angle from the horizon down to which [`Chart::Horizon`] is graded.
const HORIZON_SCALE: f64 = 1e-9;

impl Chart {
    /// The cosine below which a lobe is flat; 0 where it has none.
    #[must_use]
    pub fn floor(&self) -> f64 {
        if let Chart::Broad { floor, .. } = self { *floor } else { 0.0 }
    }

    /// The half-vector chart that facets need: the simple one where it is enough.
    #[must_use]
    pub fn facets(facets: FacetLobe) -> Chart {
        let FacetLobe { alpha: [x, y], reach, edge, layer, fold, crease, slope, steep } = facets;
        let smith = (layer - 3.0 * x).abs() <= 0.0;
        if (x - y).abs() <= 0.0 && smith && edge == Edge::Layer && !fold && crease.is_none() {
            return Chart::HalfVector { alpha: x, reach, kinks: steep, slope, layer };
        }
        Chart::Ellipse(facets)
    }

    /// The chart for the lobe times a factor of `wo . wm` with a crease; the chart itself where it does not know the facets.
    #[must_use]
    pub fn creased(self, crease: Option<Crease>) -> Chart {
        match self {
            Chart::HalfVector { alpha, reach, slope, layer, kinks } if crease.is_some() => {
                let facets = FacetLobe::smith([alpha; 2], reach);
                Chart::Ellipse(FacetLobe { crease, slope, layer, steep: kinks, ..facets })
            }
            Chart::Ellipse(facets) => {
                Chart::Ellipse(FacetLobe { crease: crease.or(facets.crease), ..facets })
            }
            other => other,
        }
    }

    /// Calls `visit` with batches of nodes at a refinement level (2 is coarse, 16 is full f64 accuracy).
    pub fn visit(&self, view: View, level: f64, visit: &mut dyn FnMut(&Nodes)) {
        match *self {
            Chart::HalfVector { alpha, reach, slope, layer, .. } => {
                half_vector::visit(view.mu, [alpha, slope, layer], reach, level, visit);
            }
            Chart::Ellipse(facets) => ellipse::visit(view, &facets, level, visit),
            Chart::Lobe { c, exponent } => lobe::visit(view, c, exponent, level, visit),
            Chart::Fibre { across, cone } => fibre::visit(view, across, cone, level, visit),
            Chart::Hemisphere => hemisphere::visit(view, Folds::None, level, visit),
            Chart::Folded => hemisphere::visit(view, Folds::Cross, level, visit),
            Chart::Horizon => hemisphere::visit(view, Folds::Horizon(HORIZON_SCALE), level, visit),
            Chart::Broad { floor, .. } => broad::visit(view.mu, floor, level, visit),
        }
    }

    /// How far the differences of its levels are to be trusted; see [`Trust`].
    #[must_use]
    pub fn trust(&self) -> Trust {
        let (gain, memory): (&[f64], &[f64]) = match self {
            Chart::Ellipse(facets) => return facets.trust(),
            Chart::HalfVector { kinks: true, .. } | Chart::Broad { kinks: true, .. } => (&[0.2], &[0.2]),
            Chart::HalfVector { reach, .. } if reach.is_finite() => {
                (&[1.1, 1.1, 4.0, 2.0, 2.0, 1.2], &[0.2, 0.2, 0.03, 0.005, 0.005])
            }
            Chart::HalfVector { .. } => {
                // what has not converged by the sixth level has a tail that converges slowly
                (&[1.0, 1.0, 3.2, 6.0, 3.0, 2.0], &[0.05, 0.05, 0.03, 0.003, 0.003, 0.01])
            }
            Chart::Lobe { .. } => (&[1.4, 1.4, 3.0, 6.0, 2.5], &[0.2, 0.2, 0.03, 0.02, 0.003]),
            Chart::Fibre { .. } => (&[0.7, 0.7, 0.55], &[0.02]),
            Chart::Broad { .. } => (&[1.5, 1.5, 3.0, 2.5, 0.7, 1.0, 0.6], &[0.03, 0.03, 0.1, 0.1, 0.01]),
            Chart::Hemisphere | Chart::Folded | Chart::Horizon => (&[1.0], &[0.05, 0.05, 0.01, 0.002]),
        };
        Trust { gain, memory }
    }

    /// The rule in words, for metadata.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Chart::HalfVector { .. } => {
                "product Gauss-Legendre, graded half-vector chart, level raised until three levels agree"
            }
            Chart::Ellipse(_) => {
                "product Gauss-Legendre, elliptical half-vector chart, level raised until three levels agree"
            }
            Chart::Lobe { .. } => {
                "product Gauss-Legendre, polar chart round the lobe, level raised until three levels agree"
            }
            Chart::Fibre { .. } => {
                "product Gauss-Legendre, polar chart round the tangent, level raised until three levels agree"
            }
            Chart::Hemisphere => {
                "Gauss-Legendre by midpoints, polar chart, level raised until three levels agree"
            }
            Chart::Folded | Chart::Horizon => {
                "product Gauss-Legendre, polar chart, level raised until three levels agree"
            }
            Chart::Broad { .. } => {
                "double exponential by Gauss-Legendre, polar chart, level raised until three levels agree"
            }
        }
    }
}
