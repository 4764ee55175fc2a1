//! The lobe chart: wi in polar coordinates (a, psi) round the axis of a cosine lobe `max(0, v . wi)^n`, v = C wo.
//!
//! `cos a = exp(-x^2 / 2)` turns the lobe into a Gaussian, `cos^n(a) sin(a) da = x exp(-(n + 1) x^2 / 2) dx`, for every
//! n >= 0. psi is measured from the direction of the normal, and the horizon is the curve `cos psi = -cot(a) cot(theta_v)`:
//!
//! * up to `a = pi/2 - theta_v` the whole circle lies above it (midpoints in psi, exact for trigonometric polynomials);
//! * beyond, psi ends at the horizon; that end has a square root at the start, so `x - x_c = w^2`, graded on the
//!   distance of the mirror singularity at `a = -(pi/2 - theta_v)`;
//! * an axis below the horizon has the second panel only.
//!
//! No lobe is visited where its value is below 1e-17 of its peak.
//!
//! Measured over 2000 draws of n in [0.1, 1e5] and views down to mu = 1e-5: 6e-14 at the median and 5e-7 for 99 % at
//! level 8 with 280 evaluations, 3e-13 for 99 % at level 15 with 910.

use super::gauss;
use super::graded::{Graded, Order};
use super::nodes::{BATCH, Nodes};
use super::view::View;
use glam::DVec3;
use std::f64::consts::PI;

/// `(n + 1) x^2 / 2` where the lobe ends.
const END: f64 = 39.0;

/// Calls `visit` with batches of nodes. `c` is the diagonal of C, `n` the exponent.
pub fn visit(view: View, c: [f64; 3], n: f64, level: f64, visit: &mut dyn FnMut(&Nodes)) {
    let mut nodes = Nodes::new(view);
    let wo = nodes.wo();
    let v = DVec3::new(c[0] * wo.x, c[1] * wo.y, c[2] * wo.z);
    let length = v.length();
    if length <= 0.0 {
        return;
    }
    let lobe = Lobe::new(v / length, wo, n, level);
    let last = (2.0 * END / (n + 1.0)).sqrt();
    let begin = lobe.horizon();
    if lobe.cos > 0.0 {
        lobe.circles(begin.min(last), &mut nodes, visit);
        if begin < last {
            lobe.arcs(begin, last, &mut nodes, visit);
        }
    } else if begin.is_finite() {
        // an axis straight down has no direction above the horizon within 90 degrees
        lobe.arcs(begin, (begin * begin + last * last).sqrt(), &mut nodes, visit);
    }
}

struct Lobe {
    axis: DVec3,
    /// Across the axis: towards the normal, and sideways.
    up: DVec3,
    side: DVec3,
    /// Of the angle between axis and normal.
    sin: f64,
    cos: f64,
    /// Signs of psi to visit: one, taken twice, if wo lies in the plane of axis and normal.
    signs: &'static [f64],
    n: f64,
    level: f64,
}

impl Lobe {
    fn new(axis: DVec3, wo: DVec3, n: f64, level: f64) -> Lobe {
        let sin = (axis.x * axis.x + axis.y * axis.y).sqrt();
        let (x, y) = if sin > 0.0 { (axis.x / sin, axis.y / sin) } else { (1.0, 0.0) };
        let coplanar = (x * wo.y - y * wo.x).abs() < 1e-15;
        Lobe {
            axis,
            up: DVec3::new(-axis.z * x, -axis.z * y, sin),
            side: DVec3::new(-y, x, 0.0),
            sin,
            cos: axis.z,
            signs: if coplanar { &[1.0] } else { &[1.0, -1.0] },
            n,
            level,
        }
    }

    /// x where the circle touches the horizon: cos a = sin(theta_v).
    fn horizon(&self) -> f64 {
        let cos2 = self.cos * self.cos;
        let log = if cos2 < 0.5 { -libm::log1p(-cos2) } else { -2.0 * libm::log(self.sin) };
        log.max(0.0).sqrt()
    }

    /// Order of a rule over `length` in x: longer ones see more of the Gaussian.
    fn order(&self, length: f64) -> Order {
        Order(1.2 + 0.15 * length * (self.n + 1.0).sqrt(), 0.3)
    }

    /// Circles that lie above the horizon, up to `end`.
    fn circles(&self, end: f64, nodes: &mut Nodes, visit: &mut dyn FnMut(&Nodes)) {
        let rule = Graded::new(1e3, self.order(end), self.level);
        let count = order(self.level + 1.0);
        let step = PI / count as f64;
        for i in 0..rule.node.len() {
            let x = end * rule.node[i];
            let (cos, sin, jacobian) = polar(x);
            let weight = end * rule.weight[i] * jacobian * step;
            for (panel, &sign) in self.signs.iter().enumerate() {
                nodes.panel = panel;
                nodes.len = count;
                for j in 0..count {
                    let (sin_psi, cos_psi) = libm::sincos((j as f64 + 0.5) * step);
                    let z = cos * self.cos + sin * self.sin * cos_psi;
                    self.set(nodes, j, [cos, sin, cos_psi, sign * sin_psi], z, weight);
                }
                visit(nodes);
            }
        }
    }

    /// Arcs that end at the horizon, from x = `begin` to `end`.
    fn arcs(&self, begin: f64, end: f64, nodes: &mut Nodes, visit: &mut dyn FnMut(&Nodes)) {
        let length = end - begin;
        let near = 2.0 * begin / length;
        let scale = if near < 1e-8 { 1e3 } else { near.sqrt().min(1e3) };
        let rule = Graded::new(scale, self.order(length), self.level);
        let arc = gauss::rule(order(self.level + 2.0));
        for i in 0..rule.node.len() {
            let w = rule.node[i];
            let (cos, sin, jacobian) = polar(begin + length * w * w);
            let psi_end = libm::acos((-self.cos * cos / (self.sin * sin)).clamp(-1.0, 1.0));
            let weight = 2.0 * w * length * rule.weight[i] * jacobian * psi_end;
            for (panel, &sign) in self.signs.iter().enumerate() {
                nodes.panel = 2 + panel;
                nodes.len = arc.nodes.len();
                for (j, (&t, &wt)) in arc.nodes.iter().zip(&arc.weights).enumerate() {
                    let psi = psi_end * t;
                    // sin a sin theta (cos psi - cos psi_end), as a product
                    let half = libm::sin(0.5 * (psi_end + psi)) * libm::sin(0.5 * (psi_end - psi));
                    let z = 2.0 * sin * self.sin * half;
                    let (sin_psi, cos_psi) = libm::sincos(psi);
                    self.set(nodes, j, [cos, sin, cos_psi, sign * sin_psi], z, weight * wt);
                }
                visit(nodes);
            }
        }
    }

    fn set(&self, nodes: &mut Nodes, j: usize, [cos, sin, cos_psi, sin_psi]: [f64; 4], z: f64, weight: f64) {
        let wi = cos * self.axis + sin * (cos_psi * self.up + sin_psi * self.side);
        let twice = if self.signs.len() == 1 { 2.0 } else { 1.0 };
        nodes.set(j, DVec3::new(wi.x, wi.y, z.max(0.0)), twice * weight);
    }
}

/// cos a, sin a and `sin(a) da/dx` at x.
fn polar(x: f64) -> (f64, f64, f64) {
    let cos = libm::exp(-0.5 * x * x);
    (cos, (-libm::expm1(-x * x)).max(0.0).sqrt(), x * cos)
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [2, BATCH] first")]
fn order(wanted: f64) -> usize {
    wanted.round().clamp(2.0, BATCH as f64) as usize
}
