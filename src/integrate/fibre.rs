//! The fibre chart: wi in polar coordinates (beta, gamma) round the tangent +x.
//!
//! For functions of beta alone, as fibres along the tangent reflect: `sin^p(beta)`, which peaks across the fibre, and
//! `max(0, cos(beta - pi + beta_o))^q`, which peaks on the cone where a mirror-like fibre reflects. With
//! `dwi = sin(beta) dbeta dgamma` and `mu_i = sin(beta) sin(gamma)` the integrand over gamma in (0, pi) is a sine.
//!
//! beta is split at both peaks, graded towards them on the scales `1 / sqrt(p)` and `1 / sqrt(q)`, and split 90 degrees
//! off the cone, where the clamp begins.
//!
//! Measured over 3000 draws of p in [1, 1e3] and q in [1, 1e6]: 1e-6 takes 2000 evaluations in the mean, 5100 at most.

use super::gauss;
use super::graded::{Graded, Order, share_scales};
use super::nodes::{BATCH, Nodes};
use super::view::View;
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

const ORDER: Order = Order(1.5, 0.35);

/// Calls `visit` with batches of nodes; `across` and `cone` are the exponents p and q.
pub fn visit(view: View, across: f64, cone: f64, level: f64, visit: &mut dyn FnMut(&Nodes)) {
    let mut nodes = Nodes::new(view);
    let wo = nodes.wo();
    let around = gauss::rule(order(level + 2.0));
    let beta = PI - libm::atan2((wo.y * wo.y + wo.z * wo.z).sqrt(), wo.x);
    let clamp = if beta < FRAC_PI_2 { beta + FRAC_PI_2 } else { beta - FRAC_PI_2 };
    let flat = 1e3;
    let peak = |n: f64| 1.0 / (n + 1.0).sqrt();
    let mut ends = [(0.0, flat), (beta, peak(cone)), (clamp, flat), (FRAC_PI_2, peak(across)), (PI, flat)];
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    share_scales(&mut ends);
    for (i, pair) in ends.windows(2).enumerate() {
        let middle = 0.5 * (pair[0].0 + pair[1].0);
        for (j, &(from, scale)) in pair.iter().enumerate() {
            nodes.panel = 2 * i + j;
            let length = middle - from;
            if length.abs() <= 0.0 {
                continue;
            }
            let rule = Graded::new(scale / length.abs(), ORDER, level);
            for k in 0..rule.node.len() {
                let beta = from + length * rule.node[k];
                circle(&mut nodes, beta, length.abs() * rule.weight[k], around);
                visit(&nodes);
            }
        }
    }
}

/// Nodes of one cone round the fibre.
fn circle(nodes: &mut Nodes, beta: f64, width: f64, around: &gauss::Rule) {
    let (sin, cos) = libm::sincos(beta);
    let sin = sin.max(0.0);
    nodes.len = around.nodes.len();
    for (j, (&t, &w)) in around.nodes.iter().zip(&around.weights).enumerate() {
        let (sin_g, cos_g) = libm::sincos(PI * t);
        nodes.set(j, DVec3::new(cos, sin * cos_g, sin * sin_g), width * PI * w * sin);
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [2, BATCH] first")]
fn order(wanted: f64) -> usize {
    wanted.round().clamp(2.0, BATCH as f64) as usize
}
