//! Graded one-dimensional rules: Gauss-Legendre under `t = eps sinh(L x)`, `L = asinh(1 / eps)`, on (0, 1).
//!
//! A function whose nearest singularities lie at `t = +- i eps` is analytic in x up to a distance pi / (2 L), so the
//! order that a given accuracy needs grows with L, that is with the logarithm of 1 / eps, and no faster.

use super::gauss;
use super::nodes::BATCH;
use crate::math::exp::exp;
use std::f64::consts::FRAC_PI_2;
use std::sync::OnceLock;

/// Order of a panel at `level`: `level (c0 + c1 L)` rounded, at least 2.
///
/// With `c0 >= 1` and levels that grow by 1.4 from 2 on, every order grows from level to level: a panel that did not
/// grow would hide its error from the ladder. For the same reason no order is too high: above that of the highest Gauss rule the panel
/// is cut into equal parts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Order(pub f64, pub f64);

impl Order {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped first")]
    fn at(self, level: f64, l: f64) -> usize {
        (level * (self.0 + self.1 * l)).round().clamp(2.0, 4096.0) as usize
    }
}

/// Nodes and weights of so many points on (0, 1): one Gauss rule, or equal parts of one each.
fn points(order: usize) -> impl Iterator<Item = (f64, f64)> {
    let parts = order.div_ceil(gauss::MAX_ORDER);
    let rule = gauss::rule(order.div_ceil(parts));
    let (count, share) = (parts as f64, 1.0 / parts as f64);
    let of_part = move |k: usize| {
        let at = move |(x, w): (&f64, &f64)| ((k as f64 + x) / count, w * share);
        rule.nodes.iter().zip(&rule.weights).map(at)
    };
    (0..parts).flat_map(of_part)
}

/// Nodes in (0, 1) graded towards 0 on the scale `eps`, and their weights.
#[derive(Debug, Clone, Default)]
pub struct Graded {
    /// Nodes, increasing.
    pub node: Vec<f64>,
    /// Weights; they sum to 1.
    pub weight: Vec<f64>,
}

/// Some nodes of a rule and their weights, at most [`BATCH`].
#[derive(Debug, Clone, Copy)]
pub struct Part<'a> {
    /// Nodes, increasing.
    pub node: &'a [f64],
    /// Weights.
    pub weight: &'a [f64],
}

/// Scales of shared rules are powers of the eighth root of 2: the exponents of the finest and of the coarsest one, beyond which a rule
/// is Gauss's own to the last bit but one.
const EIGHTHS: [i32; 2] = [-560, 88];
/// Orders of shared rules.
const SHARED_ORDERS: usize = 1024;
/// Scales of shared rules.
const SCALES: usize = (EIGHTHS[1] - EIGHTHS[0] + 1).unsigned_abs() as usize;

/// A rule that is made once a process; see [`shared`].
#[derive(Debug)]
pub struct Shared {
    /// Nodes and weights.
    pub rule: Graded,
    /// sin(pi/2 x) at each node x.
    pub quarter_sine: Vec<f64>,
}

impl Shared {
    fn new(eps: f64, order: usize) -> Shared {
        let mut rule = Graded::default();
        rule.fill(eps, order, [0.0, 1.0]);
        let quarter_sine = rule.node.iter().map(|x| libm::sin(FRAC_PI_2 * x)).collect();
        Shared { rule, quarter_sine }
    }
}

/// The eighth of an octave at or below a scale: never coarser than what was asked for.
fn eighth(eps: f64) -> i32 {
    /// Powers of the eighth root of 2.
    const ROOTS: [f64; 7] = [
        1.090_507_732_665_257_659_2,
        1.189_207_115_002_721_066_7,
        1.296_839_554_651_009_666_0,
        std::f64::consts::SQRT_2,
        1.542_210_825_407_940_823_6,
        1.681_792_830_507_429_086_1,
        1.834_008_086_409_342_463_5,
    ];
    let bits = eps.to_bits();
    #[allow(clippy::cast_possible_truncation, reason = "eleven bits")]
    let octave = (bits >> 52) as i32 - 1023;
    let mantissa = f64::from_bits((bits & ((1 << 52) - 1)) | 1.0f64.to_bits());
    let above: i32 = ROOTS.iter().map(|root| i32::from(mantissa >= *root)).sum();
    (8 * octave + above).clamp(EIGHTHS[0], EIGHTHS[1])
}

/// The rule of a panel of length 1 for a scale of at most `eps > 0`, and less than a tenth below it; made once a process.
///
/// Charts ask for rules at every view: with scales on a ladder the same few serve all of them.
#[must_use]
pub fn shared(eps: f64, order: Order, level: f64) -> &'static Shared {
    static RULES: [OnceLock<OfScale>; SCALES] = [const { OnceLock::new() }; SCALES];
    let eighth = eighth(eps);
    let of_scale = RULES[(eighth - EIGHTHS[0]).unsigned_abs() as usize].get_or_init(|| OfScale::new(eighth));
    let count = order.at(level, of_scale.stretch).min(SHARED_ORDERS);
    of_scale.rules[count - 1].get_or_init(|| Box::new(Shared::new(of_scale.eps, count)))
}

/// The rules of one scale, by order.
struct OfScale {
    eps: f64,
    /// `asinh(1 / eps)`.
    stretch: f64,
    rules: Box<[OnceLock<Box<Shared>>]>,
}

impl OfScale {
    fn new(eighth: i32) -> OfScale {
        let eps = libm::exp2(0.125 * f64::from(eighth));
        let rules = (0..SHARED_ORDERS).map(|_| OnceLock::new()).collect();
        OfScale { eps, stretch: libm::asinh(1.0 / eps), rules }
    }
}

impl Graded {
    /// The rule of a panel of length 1 for the scale `eps > 0`.
    #[must_use]
    pub fn new(eps: f64, order: Order, level: f64) -> Graded {
        let mut rule = Graded::default();
        rule.set(eps, order, level);
        rule
    }

    /// The rule in parts that fit a batch.
    pub fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        self.node.chunks(BATCH).zip(self.weight.chunks(BATCH)).map(|(node, weight)| Part { node, weight })
    }

    /// Makes this the rule of another scale, order and level, in place.
    pub fn set(&mut self, eps: f64, order: Order, level: f64) {
        self.set_between(eps, order, level, [0.0, 1.0]);
    }

    /// A rule of (lo, hi) within (0, 1), graded towards 0 as [`Graded::new`]; its weights sum to hi - lo.
    ///
    /// Two of them that meet at a kink are as good as one rule without it.
    #[must_use]
    pub fn between(eps: f64, order: Order, level: f64, span: [f64; 2]) -> Graded {
        let mut rule = Graded::default();
        rule.set_between(eps, order, level, span);
        rule
    }

    /// As [`Graded::between`], in place.
    fn set_between(&mut self, eps: f64, order: Order, level: f64, span: [f64; 2]) {
        let (_, l) = stretch(eps, span);
        self.fill(eps, order.at(level, l), span);
    }

    /// The rule of so many points.
    fn fill(&mut self, eps: f64, order: usize, span: [f64; 2]) {
        let ratio = 1.0 / eps.max(1e-300);
        let (start, l) = stretch(eps, span);
        let scale = 1.0 / ratio;
        self.node.clear();
        self.weight.clear();
        // sinh y = (e^y - e^-y) / 2 would cancel near 0
        let small = start + l < 1.0;
        for (x, w) in points(order) {
            let y = start + l * x;
            let (node, weight) = if small {
                let (sinh, cosh) = near_zero(y);
                (sinh * scale, cosh * (l * scale * w))
            } else {
                let e = exp(y);
                let inverse = 1.0 / e;
                (0.5 * (e - inverse) * scale, 0.5 * (e + inverse) * (l * scale * w))
            };
            self.node.push(node);
            self.weight.push(weight);
        }
    }

    /// A rule from `span[0]`, where the integrand has a square root of the distance, to `span[1]`, on either side of it.
    ///
    /// The distance is `length * w^2`, w graded towards 0 on the scale `eps`: 1e3 for a true square root, the root of its
    /// blur over the length for a blurred one.
    #[must_use]
    pub fn root_at(span: [f64; 2], eps: f64, order: Order, level: f64) -> Graded {
        let mut rule = Graded::new(eps, order, level);
        let length = span[1] - span[0];
        for (x, w) in rule.node.iter_mut().zip(&mut rule.weight) {
            *w *= 2.0 * *x * length.abs();
            *x = span[0] + length * (*x * *x);
        }
        rule
    }

    /// The rule of a panel whose integrand holds the square root of the variable: `t = x^2`.
    #[must_use]
    pub fn root(order: Order, level: f64) -> Graded {
        let (node, weight): (Vec<f64>, Vec<f64>) =
            points(order.at(level, 0.0)).map(|(x, w)| (x * x, 2.0 * x * w)).unzip();
        Graded { node, weight }
    }
}

/// Where a span begins in the stretched variable, and its length there.
fn stretch(eps: f64, [lo, hi]: [f64; 2]) -> (f64, f64) {
    let ratio = 1.0 / eps.max(1e-300);
    let start = if lo > 0.0 { libm::asinh(ratio * lo) } else { 0.0 };
    (start, libm::asinh(ratio * hi) - start)
}

/// sinh and cosh for |y| <= 1 by their series to y^17 (remainder below 1e-17).
fn near_zero(y: f64) -> (f64, f64) {
    let q = y * y;
    let (mut sinh, mut cosh) = (1.0, 1.0);
    for k in (1..=8u32).rev() {
        let k = 2.0 * f64::from(k);
        sinh = 1.0 + sinh * (q / (k * (k + 1.0)));
        cosh = 1.0 + cosh * (q / (k * (k - 1.0)));
    }
    (y * sinh, cosh)
}

/// Lowers the scales of panel ends `(position, scale)` to what their neighbours need: a peak that is wider than its
/// distance to the next end reaches over it.
pub fn share_scales(ends: &mut [(f64, f64)]) {
    for i in 0..ends.len() {
        let needed = ends.iter().map(|end| end.1 + (end.0 - ends[i].0).abs());
        ends[i].1 = needed.fold(ends[i].1, f64::min);
    }
}

#[cfg(test)]
mod tests {
    use super::{Order, eighth, shared};

    #[test]
    fn shared_rules_are_never_coarser_than_asked_for() {
        for i in -4000..800 {
            let eps = libm::exp2(0.01 * f64::from(i));
            let taken = libm::exp2(0.125 * f64::from(eighth(eps)));
            assert!(taken <= eps * (1.0 + 1e-15) && taken > 0.917 * eps, "{eps:e}: {taken:e}");
            let sum: f64 = shared(eps, Order(1.0, 0.35), 15.0).rule.weight.iter().sum();
            assert!((sum - 1.0).abs() < 1e-13, "{eps:e}: {sum}");
        }
    }
}
