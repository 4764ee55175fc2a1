//! The split sum in few operations.
//!
//! As functions of mu and alpha, E has a corner where both vanish, and the bias falls as (1 - mu)^5 on smooth surfaces. Both
//! are gone after a change of variable and of what is fitted:
//!
//! * `E = 1 - v (1 - v) P(v, alpha) / Q(v, alpha)`, `v = mu / (mu + alpha)`: 1 - E vanishes where v does and falls off as
//!   alpha / mu far from the corner. Models whose loss does not vanish there take `E = P / Q`, whichever is nearer.
//! * `bias = E k^n`, n = 4 or 6, `k = P(mu, alpha) / Q(mu, alpha)`: the mean Schlick factor of the visible facets, bias / E, is nearly a
//!   power of a number that falls from 1 to 0 almost linearly in mu, at every alpha, and has no corner.
//! * `scale = E - bias`. With E in [0, 1] and k^n held to at most 1, all three are in [0, 1].
//!
//! E is fitted first. Half of what it is off is then given to the bias, the other half to the scale, which is the best that can be
//! done, and k is fitted to that. The terms of each degree are what was left of all terms of total degree 3 after those were
//! dropped, one by one, without which GGX was fitted best.

use super::formula::{Formula, name, number, ratio};
use super::{BETWEEN, FitError, FittedFormula, LINES, PRACTICAL_WEIGHT, STEPS, Sample, TOLERANCE, reached};
use crate::cancel::Cancel;
use crate::grid::Axis;
use crate::grid::expression::Expression;
use crate::grid::scalar::Scalar;
use crate::math::figures::short;
use crate::math::rational::{self, Fitted, Point, Term, Terms};
use crate::tables::Bound;
use crate::tables::default_axes::LEAST_ROUGHNESS;
use crate::verify::reconstruction::{PRACTICAL_ALPHA, PRACTICAL_MU};
use rayon::prelude::*;

/// Degrees of [`split_sum`].
pub const DEGREES: [usize; 2] = [1, LADDER.len()];

/// Exponents of the first variable, and how many powers of the second go with each: `[3, 2, 1]` is all of total degree 2.
type Rows = &'static [usize];

/// A degree: P and Q of E, P and Q of k, and the power of k.
struct Degree {
    e: [Rows; 2],
    k: [Rows; 2],
    power: usize,
}

const LADDER: [Degree; 5] = [
    Degree { e: [&[3], &[2, 2, 2]], k: [&[2, 1, 1], &[2, 1]], power: 4 },
    Degree { e: [&[3], &[2, 2, 2, 1]], k: [&[3, 3, 1], &[3, 1]], power: 6 },
    Degree { e: [&[3, 1, 1], &[3, 2, 2, 1]], k: [&[3, 3, 1], &[4, 1]], power: 6 },
    Degree { e: [&[4, 2, 2, 2, 1], &[3, 3, 2, 1]], k: [&[4, 3, 1, 1], &[4, 2, 2, 1]], power: 6 },
    Degree { e: [&[5, 3, 2, 2, 1], &[3, 3, 2, 2]], k: [&[4, 3, 2, 1], &[4, 3, 2, 1]], power: 6 },
];

/// E and bias from the channels of a layout, and mu.
type Decode = fn(&[f64], f64) -> [f64; 2];

/// Is this a table from whose channels scale, bias and E follow, over mu and alpha?
#[must_use]
pub fn splits(bound: &Bound) -> bool {
    decode(bound).is_some()
}

fn decode(bound: &Bound) -> Option<([usize; 2], Decode)> {
    let spec = &bound.spec;
    let (mu, alpha) = spec.axis("mu").zip(spec.axis("alpha"))?;
    let ids: Vec<&str> = spec.layout.ids().collect();
    let decode: Decode = match ids.as_slice() {
        ["dfg.scale", "dfg.bias"] => |v, _| [v[0] + v[1], v[1]],
        ["dfg.fc", "dfg.total"] => |v, _| [v[1], v[0]],
        ["dfg.loss", "dfg.rest"] => |v, mu| [1.0 - v[0], (1.0 - v[0]) * fifth(1.0 - mu) + v[1]],
        _ => return None,
    };
    (spec.grid.axes().len() == 2).then_some(([mu, alpha], decode))
}

fn fifth(x: f64) -> f64 {
    x * x * x * x * x
}

/// A value to be met.
struct Node {
    mu: f64,
    alpha: f64,
    e: f64,
    bias: f64,
    practical: bool,
}

/// Scale, bias and E of a table of `dfg` over mu and alpha, by a degree of [`DEGREES`]: a function `split_sum(mu, alpha)`.
///
/// # Errors
/// [`FitError`].
pub fn split_sum(bound: &Bound, degree: usize) -> Result<FittedFormula, FitError> {
    split_sum_until(&Cancel::new(), bound, degree)
}

/// [`split_sum`], until it is stopped.
///
/// # Errors
/// [`FitError`], [`FitError::Cancelled`] among them.
pub fn split_sum_until(cancel: &Cancel, bound: &Bound, degree: usize) -> Result<FittedFormula, FitError> {
    let spec = &bound.spec;
    let got = || format!("{} with {}", spec.kind.id, spec.layout.ids().collect::<Vec<_>>().join(", "));
    let (axes, decode) = decode(bound).ok_or_else(|| FitError::Table {
        got: got(),
        why: "a split sum is a table `dfg` of scale and bias, Fc and total, or loss and rest, on two axes, mu and alpha or roughness",
    })?;
    let parts = degree.checked_sub(1).and_then(|i| LADDER.get(i)).ok_or_else(|| FitError::Table {
        got: format!("degree {degree}"),
        why: "there are degrees 1 to 5",
    })?;
    let nodes = nodes(cancel, bound, axes, decode, [0.0; 2])?;
    let pole = || FitError::Pole { degree };
    // every other node: errors are measured at all of them
    let fitted: Vec<&Node> = nodes.iter().step_by(2).collect();
    let top = reached([0.0, 1.0], nodes.iter().map(|n| n.e))[1];
    let albedo = Albedo::new(cancel, &fitted, terms(parts.e), top);
    cancel.check()?;
    let albedo = albedo.ok_or_else(pole)?;
    let factor = albedo.factor(cancel, &fitted, terms(parts.k), parts.power);
    cancel.check()?;
    let (k_terms, k) = factor.ok_or_else(pole)?;
    let model = spec.model.as_ref().map_or("", |(info, _)| info.id);
    let [lo, hi] = roughness(&spec.grid.axes()[axes[1]]).map(|r| r * r);
    let titles = [
        format!("Split sum of {model}, mu = n.v in [0, 1], alpha = roughness^2 in [{lo}, {hi}]"),
        format!("Rational, degree {degree}"),
    ];
    let results = ["scale", "bias", "E = scale + bias"].map(str::to_owned).to_vec();
    let mut samples: Vec<Sample> = nodes.iter().map(Node::sample).collect();
    for offset in BETWEEN {
        samples.extend(self::nodes(cancel, bound, axes, decode, offset)?.iter().map(Node::sample));
    }
    let formula = albedo.formula(&k_terms, &k, parts.power);
    FittedFormula::measured(formula, titles, (results, vec![[0.0, top]; 3]), &samples).ok_or_else(pole)
}

/// The constant term of Q is always 1.
fn terms([above, below]: [Rows; 2]) -> Terms {
    let list = |rows: Rows| -> Vec<Term> {
        rows.iter().enumerate().flat_map(|(i, n)| (0..*n).map(move |j| [i, j])).collect()
    };
    Terms { above: list(above), below: list(below)[1..].to_vec() }
}

/// On lines of `sqrt(mu (1 + alpha) / (mu + alpha))` and of roughness, and of mu and roughness, shifted by a part of their
/// distance: the former are dense where mu is near alpha, the latter where it is not.
fn nodes(
    cancel: &Cancel,
    bound: &Bound,
    [mu_axis, alpha_axis]: [usize; 2],
    decode: Decode,
    offset: [f64; 2],
) -> Result<Vec<Node>, FitError> {
    let lines = offset.map(|shift| LINES - usize::from(shift > 0.0));
    let area = lines[0] * lines[1];
    let place = |i: usize, shift: f64| (i as f64 + shift) / (LINES - 1) as f64;
    let axes = bound.spec.grid.axes();
    let [lo, hi] = roughness(&axes[alpha_axis]);
    let one = |n: usize| {
        cancel.check()?;
        let x = place(n % lines[0], offset[0]);
        let roughness = lo + (hi - lo) * place(n / lines[0] % lines[1], offset[1]);
        let alpha = roughness * roughness;
        let mu = if n < area && alpha > 0.0 { x * x * alpha / (1.0 + alpha - x * x) } else { x };
        // mu = alpha = 0 is not one value
        if mu + alpha <= 0.0 {
            return Ok(None);
        }
        let mut at = [0.0; 2];
        (at[mu_axis], at[alpha_axis]) = (mu, alpha);
        let texel = bound.baker.texel(&at, TOLERANCE);
        let fault = |error| FitError::Texel {
            at: format!("mu = {}, alpha = {}", short(mu), short(alpha)),
            channels: bound.spec.layout.ids().map(str::to_owned).collect(),
            error,
        };
        let value = texel.map_err(fault)?.value;
        let [e, bias] = decode(&value, mu);
        Ok(Some(Node { mu, alpha, e, bias, practical: mu >= PRACTICAL_MU && alpha >= PRACTICAL_ALPHA }))
    };
    let all: Result<Vec<Option<Node>>, FitError> = (0..2 * area).into_par_iter().map(one).collect();
    Ok(all?.into_iter().flatten().collect())
}

/// Roughness where the fit is to hold; an axis that begins where the surface is a mirror to the eye stands for the mirror too.
fn roughness(axis: &Axis) -> [f64; 2] {
    let [lo, hi] = axis.domain.map(|v| axis.quantity.to_base(v).sqrt());
    [if lo <= LEAST_ROUGHNESS { 0.0 } else { lo }, hi]
}

impl Node {
    fn v(&self) -> f64 {
        self.mu / (self.mu + self.alpha)
    }

    fn weight(&self) -> f64 {
        if self.practical { PRACTICAL_WEIGHT } else { 1.0 }
    }

    fn sample(&self) -> Sample {
        Sample {
            arguments: vec![self.mu, self.alpha],
            want: vec![self.e - self.bias, self.bias, self.e],
            practical: self.practical,
        }
    }
}

/// E, fitted.
struct Albedo {
    terms: Terms,
    fitted: Fitted,
    /// True for `1 - v (1 - v) P / Q`, false for `P / Q`.
    loss: bool,
    /// What E is held to at most: 1, or more of a model that is not passive.
    top: f64,
}

impl Albedo {
    fn new(cancel: &Cancel, nodes: &[&Node], terms: Terms, top: f64) -> Option<Albedo> {
        let fit = |loss: bool| {
            let point = |n: &Node| {
                let (base, factor) = if loss { (1.0, -n.v() * (1.0 - n.v())) } else { (0.0, 1.0) };
                Point { at: [n.v(), n.alpha], base, factor, want: n.e, weight: n.weight(), slack: 0.0 }
            };
            let points: Vec<Point> = nodes.iter().copied().map(point).collect();
            let fitted = rational::fit(&points, &terms, 1, STEPS, cancel)?;
            Some(Albedo { terms: terms.clone(), fitted, loss, top })
        };
        let both = [true, false].into_iter().filter_map(fit);
        both.min_by(|a, b| a.fitted.largest.total_cmp(&b.fitted.largest))
    }

    /// k of the bias.
    fn factor(
        &self,
        cancel: &Cancel,
        nodes: &[&Node],
        terms: Terms,
        power: usize,
    ) -> Option<(Terms, Fitted)> {
        let point = |n: &Node| {
            let at = [n.v(), n.alpha];
            let ratio = self.fitted.ratio(&self.terms, at);
            let e = if self.loss { 1.0 - at[0] * (1.0 - at[0]) * ratio } else { ratio }.clamp(0.0, self.top);
            let half = 0.5 * (e - n.e);
            Point {
                at: [n.mu, n.alpha],
                base: 0.0,
                factor: e,
                want: n.bias + half,
                weight: n.weight(),
                slack: half.abs(),
            }
        };
        let points: Vec<Point> = nodes.iter().copied().map(point).collect();
        let fitted = rational::fit(&points, &terms, power, STEPS, cancel)?;
        Some((terms, fitted))
    }

    fn formula(&self, k_terms: &Terms, k: &Fitted, power: usize) -> Formula {
        let e_ratio = ratio(&self.terms, &self.fitted, "v", "alpha");
        let k_ratio = ratio(k_terms, k, "mu", "alpha");
        let (v, one) = (|| name("v"), || number(1.0));
        let quotient = |above: Expression, below: &str| above.over(name(below));
        let e = if self.loss {
            one().minus(quotient(v().times(one().minus(v())).times(name("e_p")), "e_q"))
        } else {
            quotient(name("e_p"), "e_q")
        };
        let steps = [
            ("v", name("mu").over(name("mu").plus(name("alpha")).at_least(1e-30))),
            ("e_p", e_ratio.above),
            ("e_q", e_ratio.below),
            ("e", e.at_least(0.0).at_most(self.top)),
            ("k_p", k_ratio.above),
            ("k_q", k_ratio.below),
            ("k", quotient(name("k_p"), "k_q")),
            ("k2", name("k").times(name("k"))),
            ("bias", name("e").times((1..power / 2).fold(name("k2"), |p, _| p.times(name("k2"))).min(one()))),
        ];
        Formula {
            name: "split_sum".to_owned(),
            arguments: vec!["mu", "alpha"],
            steps: steps.into_iter().map(|(name, e)| (name.to_owned(), e)).collect(),
            results: vec![name("e").minus(name("bias")), name("bias"), name("e")],
            denominators: vec![("e_q".to_owned(), e_ratio.unit), ("k_q".to_owned(), k_ratio.unit)],
        }
    }
}
