//! Nodes where a transformed cosine is, on both sides of the horizon.
//!
//! In the space of the cosine, with `v = (cos t sin p, sin t, cos t cos p)`, the horizon is a line p = const. On each side of it
//! the cube of the density is a trigonometric polynomial times a smooth factor, so a product Gauss-Legendre rule of
//! modest order has its integral to all digits.

use super::target::Node;
use crate::integrate::gauss;
use crate::terms::ltc::Inverse;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// Orders in p and t below the horizon, where the target is 0.
const BELOW: [usize; 2] = [12, 8];

/// Nodes with weights in sr, above and below the horizon; half of them, doubled, as the lobe is even in y.
pub(super) fn nodes(inverse: &Inverse, level: f64, above: &mut Vec<Node>, below: &mut Vec<Node>) {
    above.clear();
    below.clear();
    let fine = [order(2.0 * level), order(1.2 * level)];
    // (M v).z ~ m11 cos p - m31 sin p
    let (m11, m31) = (inverse.m11, inverse.m31);
    let ends = [-FRAC_PI_2, FRAC_PI_2];
    if m31.abs() > 0.0 {
        let edge = libm::atan(m11 / m31);
        let (low, high) = ([ends[0], edge], [edge, ends[1]]);
        let (up, down) = if m31 > 0.0 { (low, high) } else { (high, low) };
        rule(inverse, up, fine, above);
        rule(inverse, down, BELOW, below);
    } else if m11 > 0.0 {
        rule(inverse, ends, fine, above);
    } else {
        rule(inverse, ends, BELOW, below);
    }
}

fn rule(inverse: &Inverse, [from, to]: [f64; 2], orders: [usize; 2], out: &mut Vec<Node>) {
    let (p_rule, t_rule) = (gauss::rule(orders[0]), gauss::rule(orders[1]));
    let det = inverse.minor() * inverse.minor() / inverse.m22;
    for (&x, &wp) in p_rule.nodes.iter().zip(&p_rule.weights) {
        let (sin_p, cos_p) = libm::sincos(from + (to - from) * x);
        for (&y, &wt) in t_rule.nodes.iter().zip(&t_rule.weights) {
            let (sin_t, cos_t) = libm::sincos(FRAC_PI_2 * y);
            let v = inverse.undo(DVec3::new(cos_t * sin_p, sin_t, cos_t * cos_p));
            let length = v.length();
            // dw = |det M| / |M v|^3 dv
            let jacobian = det / (length * length * length);
            let weight = 2.0 * (to - from) * wp * FRAC_PI_2 * wt * cos_t * jacobian;
            out.push(Node { w: v / length, lobe: 0.0, weight });
        }
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped first")]
fn order(wanted: f64) -> usize {
    wanted.round().clamp(4.0, gauss::MAX_ORDER as f64) as usize
}
