//! The chart of broad lobes with hard corners: cloth, whose fitted masking has powers like `mu^0.17` at the horizon and
//! at the normal, and a joint at `mu_i = 1/2`.
//!
//! Polar round the normal in `wi`. The cosine runs over panels between 0, a floor, 1/2, `mu_o` and 1, each under
//! `s = 1 / (1 + exp(-pi sinh t))` (Takahasi and Mori's double exponential), which integrates any power at the ends of a
//! panel as if it were smooth. The azimuth is graded towards the far side, where the half vector of two grazing
//! directions swings up to the normal within an angle of `mu_o`.

use super::graded::{Graded, Order, Part};
use super::nodes::Nodes;
use std::f64::consts::PI;
use std::sync::OnceLock;

const AZIMUTH: Order = Order(1.0, 0.4);

/// Beyond |t| = 3.2 the weight is below 1e-16.
const END: f64 = 3.2;

/// Calls `visit` with batches of nodes that cover the hemisphere for one view cosine.
pub fn visit(mu_o: f64, floor: f64, level: f64, visit: &mut dyn FnMut(&Nodes)) {
    let mut nodes = Nodes::new(mu_o.into());
    let scale = (mu_o / (nodes.sin_o.max(1e-9) * PI)).clamp(1e-9, 1e3);
    let azimuth = Graded::new(scale, AZIMUTH, level);
    let mut ends = [0.0, floor, mu_o.max(0.0), 0.5, 1.0];
    ends.sort_by(f64::total_cmp);
    for (panel, pair) in ends.windows(2).enumerate() {
        let (lo, hi) = (pair[0], pair[1]);
        if hi - lo <= 0.0 {
            continue;
        }
        nodes.panel = panel;
        for &[s, rest, weight] in rule(level) {
            // both distances are exact at their own end
            let mu_i = lo + (hi - lo) * s;
            let from_normal = (1.0 - hi) + (hi - lo) * rest;
            let sin_i = (from_normal * (1.0 + mu_i)).sqrt();
            for part in azimuth.parts() {
                row(&mut nodes, part, mu_i, sin_i, (hi - lo) * weight);
                visit(&nodes);
            }
        }
    }
}

/// Most steps on either side.
const MOST: usize = 200;

/// Nodes in (0, 1) as `(s, 1 - s, weight)`, about 4 a level. They depend on the level alone, so each rule is made once a process.
fn rule(level: f64) -> &'static [[f64; 3]] {
    static RULES: [OnceLock<Vec<[f64; 3]>>; MOST + 1] = [const { OnceLock::new() }; MOST + 1];
    let half = half_count(level);
    RULES[half].get_or_init(|| make(half))
}

fn make(half: usize) -> Vec<[f64; 3]> {
    let step = END / half as f64;
    let mut nodes = Vec::with_capacity(2 * half + 1);
    for i in 0..=2 * half {
        let t = step * (i as f64 - half as f64);
        let e = libm::exp(-PI * libm::sinh(t.abs()));
        let (near, far) = (e / (1.0 + e), 1.0 / (1.0 + e));
        let (s, rest) = if t < 0.0 { (near, far) } else { (far, near) };
        let weight = step * PI * libm::cosh(t) * near * far;
        if weight > 0.0 && near > 0.0 {
            nodes.push([s, rest, weight]);
        }
    }
    nodes
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [4, 200] first")]
fn half_count(level: f64) -> usize {
    (2.0 * level).ceil().clamp(4.0, MOST as f64) as usize
}

/// One cosine: the azimuth from the far side (pi) to the near one.
fn row(nodes: &mut Nodes, azimuth: Part<'_>, mu_i: f64, sin_i: f64, width: f64) {
    let (mu_o, sin_o) = (nodes.mu_o, nodes.sin_o);
    nodes.len = azimuth.node.len();
    for j in 0..nodes.len {
        // pi - phi
        let from_far = PI * azimuth.node[j];
        let half = libm::sin(0.5 * from_far);
        let cos_phi_i = 2.0 * half * half - 1.0;
        // |wo + wi|^2 = (sin_o - sin_i)^2 + 4 sin_o sin_i sin^2(from_far / 2) + (mu_o + mu_i)^2
        let flat = (sin_o - sin_i) * (sin_o - sin_i) + 4.0 * sin_o * sin_i * half * half;
        let up = mu_o + mu_i;
        let length = (flat + up * up).sqrt();
        nodes.mu_i[j] = mu_i;
        nodes.cos_d[j] = (0.5 * length).min(1.0);
        nodes.cos_h[j] = (up / length).min(1.0);
        nodes.sin_h[j] = (flat.sqrt() / length).min(1.0);
        let x = sin_o + sin_i * cos_phi_i;
        nodes.cos_phi[j] = if flat > 0.0 { (x / flat.sqrt()).clamp(-1.0, 1.0) } else { 1.0 };
        let c = nodes.cos_phi[j];
        nodes.sin_phi[j] = ((1.0 - c) * (1.0 + c)).max(0.0).sqrt();
        nodes.weight[j] = 2.0 * PI * azimuth.weight[j] * width;
    }
}
