//! Nodes for the part of a transformed cosine that lies below the horizon, where the target is 0.
//!
//! In the space of the cosine that part lies between two planes through the y axis, `v.z = 0` and `(M v).z = 0`. With
//! `v = (cos t sin p, sin t, cos t cos p)` the cube of the density is a trigonometric polynomial times a smooth factor in both
//! angles, so a product Gauss-Legendre rule has its integral to 1e-9.

use super::target::Node;
use crate::integrate::gauss;
use crate::terms::ltc::Inverse;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// Orders in p and t.
const ORDERS: [usize; 2] = [12, 8];

/// Fills `out` with nodes of weight in sr; half of them, doubled, as the lobe is even in y.
pub(super) fn nodes(inverse: &Inverse, out: &mut Vec<Node>) {
    out.clear();
    // (M v).z ~ m11 cos p - m31 sin p < 0
    let (m11, m31) = (inverse.m11, inverse.m31);
    let edge = if m31.abs() > 0.0 { libm::atan(m11 / m31) } else { -FRAC_PI_2 };
    let (from, to) = match (m31 > 0.0, m31 < 0.0) {
        (true, _) => (edge, FRAC_PI_2),
        (_, true) => (-FRAC_PI_2, edge),
        _ if m11 < 0.0 => (-FRAC_PI_2, FRAC_PI_2),
        _ => return,
    };
    let (p_rule, t_rule) = (gauss::rule(ORDERS[0]), gauss::rule(ORDERS[1]));
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
