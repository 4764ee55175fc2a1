//! Lobes that no transformed cosine can be fitted to, because the integral of their cube is infinite.
//!
//! Seen from the horizon, `f mu_i` of facets in V-shaped grooves goes as `1 / (wo.wh)`, which near the direction opposite to the view is
//! the inverse of the distance e from it. That has an integral, and `int e^-3 e de` has none. What is fitted there is the pole alone, by a
//! lobe without width.

use crate::math::special::circle;
use crate::models::Brdf;
use glam::DVec3;

/// Distances from the direction opposite to the view, rad.
const NEAR: [f64; 3] = [1e-4, 1e-6, 1e-8];

/// Directions in which it is left, turns from the normal.
const TURNS: [f64; 5] = [0.0, 0.08, 0.16, 0.22, 0.248];

/// A view in the horizon: above it by what no sum of cosines sees, for models say 0 of what is not above.
const GRAZING: DVec3 = DVec3::new(1.0, 0.0, 1e-300);

/// Exponent of 1/e from which on the integral of the cube is infinite, less what a pole that has not come into its own yet lacks.
const STEEP: f64 = 2.0 / 3.0 - 0.02;

/// Is the integral of `(f mu_i)^3` infinite for a view in the horizon?
///
/// Along five great circles from the direction opposite to the view; values that are not finite are no pole but a model without an
/// albedo there.
#[must_use]
pub fn has_pole(model: &dyn Brdf) -> bool {
    let value = |turn: f64, e: f64| {
        let ((up, side), (sin, cos)) = (circle(turn), libm::sincos(e));
        let wi = DVec3::new(-cos, sin * side, sin * up);
        model.eval(GRAZING, wi) * wi.z
    };
    TURNS.iter().any(|&turn| {
        let [far, near, nearest] = NEAR.map(|e| value(turn, e));
        let exponent = |a: f64, b: f64, from: f64, to: f64| libm::log(b / a) / libm::log(from / to);
        let [first, last] =
            [exponent(far, near, NEAR[0], NEAR[1]), exponent(near, nearest, NEAR[1], NEAR[2])];
        first.is_finite() && last.is_finite() && first >= STEEP && last >= STEEP
    })
}
