//! Plain charts for diffuse lobes: wi in polar coordinates round the normal.
//!
//! The polar angle itself is the variable, not its cosine: a diffuse lobe holds sines, and `sqrt(1 - mu^2)` has an
//! infinite slope at the normal. Where the lobe is smooth all round, the azimuth is summed at equally spaced
//! midpoints, which is exact for trigonometric polynomials; where it has folds, they are edges of panels:
//! * `mu_i = mu_o`, where `max(mu_i, mu_o)` changes its branch;
//! * azimuth pi/2 from wo, where `max(0, cos phi)` does.
//!
//! The heights above that of wo are graded towards it, since `tan((theta_i + theta_o) / 2)` changes on its scale.
//!
//! Measured over 2000 views down to mu = 1e-5: without folds (Burley) 2e-12 at level 5.6 with 66 evaluations, with folds
//! (Oren-Nayar, Fujii) at most 4e-10 at level 5.6 with 340, and rounding at level 8 with 630.

use super::gauss;
use super::graded::{Graded, Order};
use super::nodes::{BATCH, Nodes};
use super::view::View;
use std::f64::consts::{FRAC_PI_2, PI};

/// Where a diffuse lobe is not smooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Folds {
    /// Nowhere.
    None,
    /// At `mu_i = mu_o` and at azimuth pi/2 from wo.
    Cross,
    /// At the horizon: a power of `mu_i`, graded down to this angle in rad.
    Horizon(f64),
}

/// No arc is graded further down than this.
const LEAST_SCALE: f64 = 1e-9;

/// Nodes of one variable with their weights: sine, cosine, weight.
type Arc = Vec<[f64; 3]>;

/// Calls `visit` with batches of nodes that cover the hemisphere; the azimuth is measured from that of the view.
pub fn visit(view: View, folds: Folds, level: f64, visit: &mut dyn FnMut(&Nodes)) {
    let mut nodes = Nodes::new(view.in_plane());
    let azimuths = match folds {
        Folds::Cross => vec![azimuth_panel(0.0, level), azimuth_panel(FRAC_PI_2, level)],
        _ => vec![azimuth_midpoints(level)],
    };
    for (p, polar) in polar_panels(view, folds, level).iter().enumerate() {
        for &[mu_i, sin_i, w] in polar {
            for (a, azimuth) in azimuths.iter().enumerate() {
                nodes.panel = 2 * p + a;
                nodes.len = azimuth.len();
                for (j, &[sin, cos, wa]) in azimuth.iter().enumerate() {
                    let wi = glam::DVec3::new(sin_i * cos, sin_i * sin, mu_i);
                    nodes.set(j, wi, 2.0 * wa * w * sin_i);
                }
                visit(&nodes);
            }
        }
    }
}

/// Height above the horizon, as sine (mu_i) and cosine (sin_i); the weight is that of the angle.
fn polar_panels(view: View, folds: Folds, level: f64) -> Vec<Arc> {
    let arc = |from: f64, length: f64| {
        let rule = gauss::rule(order(2.0 * level));
        let at = |(&x, &w): (&f64, &f64)| {
            let (sin, cos) = libm::sincos(from + length * x);
            [sin, cos, length * w]
        };
        rule.nodes.iter().zip(&rule.weights).map(at).collect::<Arc>()
    };
    match folds {
        Folds::None => vec![arc(0.0, FRAC_PI_2)],
        Folds::Cross => {
            let height = libm::atan2(view.mu, view.sine());
            let mut panels = Vec::new();
            if height > 0.0 {
                panels.push(arc(0.0, height));
            }
            if height < FRAC_PI_2 {
                panels.push(graded_arc(height, height, level));
            }
            panels
        }
        Folds::Horizon(scale) => vec![graded_arc(0.0, scale, level)],
    }
}

/// Heights from `from` to the normal, graded towards `from` on the scale `scale`.
fn graded_arc(from: f64, scale: f64, level: f64) -> Arc {
    let length = FRAC_PI_2 - from;
    let rule = Graded::new(scale.max(LEAST_SCALE) / length, Order(1.6, 0.25), level);
    let at = |i: usize| {
        let (sin, cos) = libm::sincos(from + length * rule.node[i]);
        [sin, cos, length * rule.weight[i]]
    };
    (0..rule.node.len()).map(at).collect()
}

/// A quarter of the azimuth, by Gauss-Legendre.
fn azimuth_panel(from: f64, level: f64) -> Arc {
    let rule = gauss::rule(order(level + 1.0));
    let at = |(&x, &w): (&f64, &f64)| {
        let (sin, cos) = libm::sincos(from + FRAC_PI_2 * x);
        [sin, cos, FRAC_PI_2 * w]
    };
    rule.nodes.iter().zip(&rule.weights).map(at).collect()
}

/// Half the azimuth, at the midpoints of equal parts.
fn azimuth_midpoints(level: f64) -> Arc {
    let n = order(level);
    let step = PI / n as f64;
    let at = |j: usize| {
        let (sin, cos) = libm::sincos((j as f64 + 0.5) * step);
        [sin, cos, step]
    };
    (0..n).map(at).collect()
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [2, BATCH] first")]
fn order(wanted: f64) -> usize {
    wanted.round().clamp(2.0, BATCH as f64) as usize
}
