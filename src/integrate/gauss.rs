//! Gauss-Legendre rules on [0, 1], every order from 1 to 256, made once a process to the last bit.

use crate::math::double::Double;
use crate::math::sum::Sum;
use std::f64::consts::PI;
use std::sync::OnceLock;

/// The highest order that [`rule`] makes.
pub const MAX_ORDER: usize = 256;

/// Nodes and weights of one order on [0, 1].
///
/// Symmetric to the bit: `nodes[n−1−i] = 1 − nodes[i]` (rounded once) and `weights[n−1−i] = weights[i]`. The lower half
/// of the nodes has full *relative* accuracy, so graded maps may put their singular end at 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// In (0, 1), rising.
    pub nodes: Vec<f64>,
    /// Positive; their sum is 1.
    pub weights: Vec<f64>,
}

impl Rule {
    /// `∫ f` over [a, b], summed with compensation in the order of the nodes.
    ///
    /// Exact for polynomials up to degree 2n − 1.
    pub fn integrate(&self, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        let terms = self.nodes.iter().zip(&self.weights).map(|(x, w)| w * f(a + (b - a) * x));
        (b - a) * terms.collect::<Sum>().total()
    }
}

/// The Gauss-Legendre rule of `order` points on [0, 1].
///
/// Nodes y: zeros of `P_n(1 − 2y)`. Weights: `4 y (1 − y)/(n P_{n−1}(1 − 2y))²`.
/// Source: [DLMF](crate::cite::DLMF) §3.5(v); the recurrence is Eq. 18.9.1, written for the differences of
/// neighbouring degrees and for y, the distance from the end: neither loses digits near the end.
/// Domain: order in 1..=256. Guard: an order outside counts as the nearest one inside.
/// Accuracy: half an ulp or the next f64 to it, nodes (relative, lower half) and weights (`tests/quadrature.rs`):
/// Newton's method from the asymptotic zeros, then one step with 106 bits. Made on first use (a quarter of a millisecond at order 64),
/// then shared; safe to call from many threads.
///
/// ```
/// use brdfbake::integrate::gauss;
/// let cubic = gauss::rule(2).integrate(0.0, 1.0, |x| x * x * x);
/// assert!((cubic - 0.25).abs() < 1e-15);
/// ```
#[must_use]
pub fn rule(order: usize) -> &'static Rule {
    static RULES: [OnceLock<Rule>; MAX_ORDER] = [const { OnceLock::new() }; MAX_ORDER];
    let order = order.clamp(1, MAX_ORDER);
    RULES[order - 1].get_or_init(|| make(order))
}

fn make(order: usize) -> Rule {
    let (mut nodes, mut weights) = (vec![0.5; order], vec![0.0; order]);
    for i in 0..order.div_ceil(2) {
        let mirrored = order - 1 - i;
        let (node, weight) = zero(order, i);
        (weights[i], weights[mirrored]) = (weight, weight);
        // The middle node of an odd order is 1/2 and stays.
        if i != mirrored {
            (nodes[i], nodes[mirrored]) = (node, 1.0 - node);
        }
    }
    Rule { nodes, weights }
}

/// The i-th zero of `P_n(1 − 2y)` from y = 0, for y ≤ 1/2, and its weight.
fn zero(order: usize, i: usize) -> (f64, f64) {
    let n = exact(order);
    let half_angle = 0.5 * PI * (exact(i) + 0.75) / (n + 0.5);
    let start = libm::sin(half_angle);
    let mut y = start * start;
    // Quadratic convergence from an error of 1e-2 of the spacing: 3 steps reach 1e-16, more only jitter.
    for _ in 0..4 {
        y -= near_step(order, y);
    }
    let y = Double::from(y) - newton_step(order, Double::from(y));
    let (_, below) = legendre(order, y);
    let scaled = below * Double::from(n);
    let weight = y * (Double::from(1.0) - y) * Double::from(4.0) * (scaled * scaled).reciprocal();
    (y.to_f64(), weight.to_f64())
}

/// [`newton_step`] with 53 bits: enough up to the last step.
fn near_step(order: usize, y: f64) -> f64 {
    let (mut p, mut below, mut delta) = (1.0, 0.0, 0.0);
    for k in 0..order {
        let k = exact(k);
        delta = (delta * k - y * p * (2.0 * (2.0 * k + 1.0))) / (k + 1.0);
        (p, below) = (p + delta, p);
    }
    let x = (1.0 - y) - y;
    p * y * (1.0 - y) / ((below - x * p) * (-0.5 * exact(order)))
}

/// `P_n/(dP_n/dy)` with `dP_n/dy = −2 n (P_{n−1} − x P_n)/(1 − x²)`, x = 1 − 2y.
fn newton_step(order: usize, y: Double) -> Double {
    let (p, below) = legendre(order, y);
    let one_minus_y = Double::from(1.0) - y;
    let x = one_minus_y - y;
    let slope = (below - x * p) * Double::from(-0.5 * exact(order));
    p * y * one_minus_y * slope.reciprocal()
}

/// `P_n` and `P_{n−1}` at 1 − 2y, through `Δ_{k+1} = (k Δ_k − 2 (2k + 1) y P_k)/(k + 1)`, `Δ_{k+1} = P_{k+1} − P_k`.
fn legendre(order: usize, y: Double) -> (Double, Double) {
    let (mut p, mut below) = (Double::from(1.0), Double::from(0.0));
    let mut delta = Double::from(0.0);
    for k in 0..order {
        let k = exact(k);
        delta = (delta * Double::from(k) - y * p * Double::from(2.0 * (2.0 * k + 1.0))).over(k + 1.0);
        (p, below) = (p + delta, p);
    }
    (p, below)
}

/// A small count as f64, exactly.
fn exact(count: usize) -> f64 {
    u32::try_from(count).map_or(f64::INFINITY, f64::from)
}
