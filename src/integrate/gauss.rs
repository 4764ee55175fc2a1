//! Gauss-Legendre rules on (0, 1), computed once to full f64 accuracy.

use std::f64::consts::PI;
use std::sync::OnceLock;

/// Highest order served.
pub const MAX_ORDER: usize = 256;

/// A rule: `sum weights[i] f(nodes[i])` approximates the integral of f over (0, 1); exact to degree 2 n - 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Nodes, increasing.
    pub nodes: Vec<f64>,
    /// Weights; they sum to 1.
    pub weights: Vec<f64>,
}

/// The rule of `order` (clamped to 1 ..= [`MAX_ORDER`]).
#[must_use]
pub fn rule(order: usize) -> &'static Rule {
    static RULES: [OnceLock<Rule>; MAX_ORDER] = [const { OnceLock::new() }; MAX_ORDER];
    let order = order.clamp(1, MAX_ORDER);
    RULES[order - 1].get_or_init(|| build(order))
}

/// Newton on P_n in t = cos(theta) from Tricomi's start.
fn build(n: usize) -> Rule {
    let mut nodes = vec![0.0; n];
    let mut weights = vec![0.0; n];
    let nf = n as f64;
    for i in 0..n.div_ceil(2) {
        let mut z = libm::cos(PI * (i as f64 + 0.75) / (nf + 0.5));
        let mut derivative = 1.0;
        for _ in 0..16 {
            let (p, d) = legendre(n, z);
            derivative = d;
            let step = p / d;
            z -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        if n % 2 == 1 && i == n / 2 {
            z = 0.0;
            derivative = legendre(n, z).1;
        }
        let w = 1.0 / ((1.0 - z) * (1.0 + z) * derivative * derivative);
        nodes[i] = 0.5 * (1.0 - z);
        nodes[n - 1 - i] = 0.5 * (1.0 + z);
        weights[i] = w;
        weights[n - 1 - i] = w;
    }
    Rule { nodes, weights }
}

/// `P_n(z)` and its derivative by the three-term recurrence.
fn legendre(n: usize, z: f64) -> (f64, f64) {
    let (mut p0, mut p1) = (1.0, z);
    for k in 2..=n {
        let k = k as f64;
        let p2 = ((2.0 * k - 1.0) * z * p1 - (k - 1.0) * p0) / k;
        p0 = p1;
        p1 = p2;
    }
    (p1, n as f64 * (z * p1 - p0) / (z * z - 1.0))
}
