//! The plain chart: wi in polar coordinates round the normal. For diffuse lobes, whose integrand is smooth there.

use super::gauss;
use super::nodes::{BATCH, Nodes};
use std::f64::consts::PI;

/// Calls `visit` with batches of nodes: `mu_i` split at `mu_o` (where max(mu_i, mu_o) has its kink), azimuth in (0, pi).
pub fn visit(mu_o: f64, level: f64, visit: &mut dyn FnMut(&Nodes)) {
    let mut nodes = Nodes::new(mu_o);
    let order = order(level);
    let azimuth = gauss::rule(order);
    let polar = gauss::rule(order);
    for (panel, lo, hi) in [(0, 0.0, mu_o), (1, mu_o, 1.0)] {
        nodes.panel = panel;
        if hi - lo <= 0.0 {
            continue;
        }
        for (&x, &w) in polar.nodes.iter().zip(&polar.weights) {
            let mu_i = lo + (hi - lo) * x;
            let sin_i = ((1.0 - mu_i) * (1.0 + mu_i)).sqrt();
            nodes.len = order;
            for (j, (&y, &wy)) in azimuth.nodes.iter().zip(&azimuth.weights).enumerate() {
                let cos_phi_i = libm::cos(PI * y);
                let dot = nodes.sin_o * sin_i * cos_phi_i + mu_o * mu_i;
                let v = (0.5 * (1.0 + dot)).max(0.0).sqrt();
                let cos_h = ((mu_i + mu_o) / (2.0 * v)).min(1.0);
                let sin_h = ((1.0 - cos_h) * (1.0 + cos_h)).max(0.0).sqrt();
                nodes.mu_i[j] = mu_i;
                nodes.cos_d[j] = v;
                nodes.cos_h[j] = cos_h;
                nodes.sin_h[j] = sin_h;
                let x_h = (sin_i * cos_phi_i + nodes.sin_o) / (2.0 * v);
                nodes.cos_phi[j] = if sin_h > 0.0 { (x_h / sin_h).clamp(-1.0, 1.0) } else { 1.0 };
                nodes.weight[j] = 2.0 * PI * wy * (hi - lo) * w;
            }
            visit(&nodes);
        }
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [4, BATCH] first")]
fn order(level: f64) -> usize {
    (2.0 * level).ceil().clamp(4.0, BATCH as f64) as usize
}
