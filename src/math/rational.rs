//! Rational functions of one or two variables with the least largest error.
//!
//! Fitted is `base + factor (P / Q)^power`, P and Q polynomials, Q with the constant term 1. A start by linearised least
//! squares, reweighted by 1 / Q of the step before ([Sanathanan and Koerner](crate::cite::SANATHANAN_KOERNER_1963)); then
//! damped steps on the error itself ([Marquardt](crate::cite::MARQUARDT_1963)), of which those are refused that bring Q near
//! zero, while weights that grow with the error at each point (Lawson's, as in
//! [Nakatsukasa and Trefethen](crate::cite::NAKATSUKASA_TREFETHEN_2020)) turn the sum of squares into the largest error. The
//! best of all steps is kept. Everything is summed in the order of the points.

use crate::cancel::Cancel;
use crate::math::least_squares::{least_squares, positive};

/// Least value of a denominator at a point.
const LEAST_Q: f64 = 1e-3;
/// Steps of the linearised start.
const STARTS: usize = 12;
/// Steps before Lawson's weights set in.
const SETTLING: usize = 6;
/// Trials of one step, each damped ten times as much as the one before.
const TRIALS: usize = 8;

/// Exponents of x and y.
pub type Term = [usize; 2];

/// Which terms P and Q have; the constant term of Q is 1 and not among them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Terms {
    /// Terms of P.
    pub above: Vec<Term>,
    /// Terms of Q, without the constant.
    pub below: Vec<Term>,
}

/// A value to be met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// The variables.
    pub at: [f64; 2],
    /// What is added to the power of P / Q.
    pub base: f64,
    /// What it is multiplied with.
    pub factor: f64,
    /// The value.
    pub want: f64,
    /// What an error here counts.
    pub weight: f64,
    /// Part of the error that no choice of P and Q removes; not negative.
    pub slack: f64,
}

/// Coefficients, in the order of the terms.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// Of P.
    pub above: Vec<f64>,
    /// Of Q, without the constant.
    pub below: Vec<f64>,
    /// The largest weighted error over the points, slack included.
    pub largest: f64,
}

impl Fitted {
    /// P / Q.
    #[must_use]
    pub fn ratio(&self, terms: &Terms, at: [f64; 2]) -> f64 {
        let sum =
            |terms: &[Term], c: &[f64]| terms.iter().zip(c).map(|(t, c)| c * monomial(at, *t)).sum::<f64>();
        sum(&terms.above, &self.above) / (1.0 + sum(&terms.below, &self.below))
    }
}

/// Coefficients of the terms, after `steps` steps; none if no denominator stays positive at the points, or
/// if there are fewer points than coefficients. Stopped, it is the best of the steps until then.
#[must_use]
pub fn fit(points: &[Point], terms: &Terms, power: usize, steps: usize, cancel: &Cancel) -> Option<Fitted> {
    if points.len() < terms.above.len() + terms.below.len() {
        return None;
    }
    let problem = Problem::new(points, terms, power);
    let mut c = problem.start()?;
    let mut now = problem.values(&c)?;
    let mut lawson = vec![1.0; points.len()];
    let mut damping = 1e-6;
    let mut best = (f64::INFINITY, c.clone());
    for step in (0..steps).take_while(|_| !cancel.is_set()) {
        let weights: Vec<f64> =
            points.iter().zip(&lawson).map(|(p, l): (&Point, &f64)| p.weight * l.sqrt()).collect();
        if let Some((next, values)) = problem.step(&c, &now, &weights, &mut damping) {
            (c, now) = (next, values);
        }
        let errors = problem.errors(&now);
        let largest = errors.iter().copied().fold(0.0, f64::max);
        if largest < best.0 {
            best = (largest, c.clone());
        }
        if step >= SETTLING && largest > 0.0 {
            lawson.iter_mut().zip(&errors).for_each(|(l, e)| *l *= e / largest + 0.01);
            let mean = lawson.iter().sum::<f64>() / points.len() as f64;
            lawson.iter_mut().for_each(|l| *l = (*l / mean).max(1e-4));
        }
    }
    let (largest, mut c) = best;
    let below = c.split_off(terms.above.len());
    largest.is_finite().then_some(Fitted { above: c, below, largest })
}

struct Problem<'a> {
    points: &'a [Point],
    power: usize,
    /// Terms of P, and of P and Q together.
    above: usize,
    all: usize,
    /// Their values, point after point.
    table: Vec<f64>,
}

/// P / Q and Q at each point.
type Values = Vec<[f64; 2]>;

impl Problem<'_> {
    fn new<'a>(points: &'a [Point], terms: &Terms, power: usize) -> Problem<'a> {
        let list = || terms.above.iter().chain(&terms.below);
        let table = points.iter().flat_map(|p| list().map(|t| monomial(p.at, *t))).collect();
        Problem { points, power, above: terms.above.len(), all: list().count(), table }
    }

    /// Terms of P and of Q at each point.
    fn rows(&self) -> impl Iterator<Item = (&[f64], &[f64])> {
        self.table.chunks_exact(self.all.max(1)).map(|row| row.split_at(self.above))
    }

    /// None if a denominator is too near zero.
    fn values(&self, c: &[f64]) -> Option<Values> {
        let (above, below) = c.split_at(self.above);
        let value = |(p, q): (&[f64], &[f64])| {
            let under = 1.0 + dot(q, below);
            (under > LEAST_Q).then(|| [dot(p, above) / under, under])
        };
        self.rows().map(value).collect()
    }

    fn difference(&self, point: &Point, ratio: f64) -> f64 {
        point.base + point.factor * raised(ratio, self.power) - point.want
    }

    fn errors(&self, values: &Values) -> Vec<f64> {
        let error = |(p, v): (&Point, &[f64; 2])| p.weight * (self.difference(p, v[0]).abs() + p.slack);
        self.points.iter().zip(values).map(error).collect()
    }

    /// Linearised: P - t (Q - 1) = t, weighted by 1 / Q of the step before, with a pull of Q towards 1 while it has a zero.
    fn start(&self) -> Option<Vec<f64>> {
        let (n, all) = (self.above, self.all);
        let targets: Vec<f64> = self.points.iter().map(|p| self.target(p)).collect();
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for ((p, q), t) in self.rows().zip(&targets) {
            rows.push(p.iter().copied().chain(q.iter().map(|q| -t * q)).collect());
        }
        let mut right = targets.clone();
        for j in n..all {
            rows.push((0..all).map(|k| f64::from(u8::from(k == j))).collect());
            right.push(0.0);
        }
        let slope = |(p, t): (&Point, &f64)| {
            p.weight * (p.factor * self.power as f64 * raised(t.max(1e-3), self.power - 1)).abs()
        };
        let slopes: Vec<f64> = self.points.iter().zip(&targets).map(slope).collect();
        let mut under = vec![1.0; self.points.len()];
        let mut pull = 0.0_f64;
        let mut best: Option<(f64, Vec<f64>)> = None;
        for _ in 0..STARTS {
            let mut weights: Vec<f64> = slopes.iter().zip(&under).map(|(s, q)| s / q).collect();
            weights.resize(rows.len(), pull);
            let c = least_squares(&rows, &right, &weights)?;
            let Some(values) = self.values(&c) else {
                pull = (4.0 * pull).max(1e-4 * (self.points.len() as f64).sqrt());
                under.fill(1.0);
                continue;
            };
            under = values.iter().map(|v| v[1]).collect();
            let square: f64 = self.errors(&values).iter().map(|e| e * e).sum();
            if best.as_ref().is_none_or(|b| square < b.0) {
                best = Some((square, c));
            }
        }
        best.map(|b| b.1)
    }

    /// P / Q that meets a point; 0 where it does not matter.
    fn target(&self, p: &Point) -> f64 {
        let r = (p.want - p.base) / p.factor;
        match self.power {
            _ if p.factor.abs() < 1e-9 => 0.0,
            1 => r,
            n => libm::pow(r.max(0.0), 1.0 / n as f64),
        }
    }

    /// A step that does not raise the weighted sum of squares, if there is one.
    fn step(
        &self,
        c: &[f64],
        now: &Values,
        weights: &[f64],
        damping: &mut f64,
    ) -> Option<(Vec<f64>, Values)> {
        let n = c.len();
        let (gram, slope, square) = self.normal(now, weights);
        let scale: Vec<f64> = (0..n).map(|j| 1.0 / (gram[j][j].sqrt() + 1e-30)).collect();
        for _ in 0..TRIALS {
            let damped: Vec<Vec<f64>> = (0..n)
                .map(|j| {
                    (0..n)
                        .map(|k| {
                            gram[j.max(k)][j.min(k)] * scale[j] * scale[k]
                                + if j == k { *damping } else { 0.0 }
                        })
                        .collect()
                })
                .collect();
            let right: Vec<f64> = slope.iter().zip(&scale).map(|(s, f)| s * f).collect();
            if let Some(d) = positive(&damped, &right) {
                let next: Vec<f64> = (0..n).map(|j| c[j] + d[j] * scale[j]).collect();
                if let Some(values) = self.values(&next) {
                    let sum: f64 = (self.points.iter().zip(&values).zip(weights))
                        .map(|((p, v), w)| raised(w * self.difference(p, v[0]), 2))
                        .sum();
                    if sum <= square {
                        *damping = (*damping / 5.0).max(1e-12);
                        return Some((next, values));
                    }
                }
            }
            *damping *= 10.0;
        }
        *damping = 1e-4;
        None
    }

    /// Lower half of the normal matrix of the derivatives by the coefficients, their product with the errors, and the square of those.
    fn normal(&self, now: &Values, weights: &[f64]) -> (Vec<Vec<f64>>, Vec<f64>, f64) {
        let mut gram: Vec<Vec<f64>> = (0..self.all).map(|j| vec![0.0; j + 1]).collect();
        let mut slope = vec![0.0; self.all];
        let mut square = 0.0;
        let mut row = vec![0.0; self.all];
        for (((point, weight), [ratio, under]), (p, q)) in
            self.points.iter().zip(weights).zip(now).zip(self.rows())
        {
            let outer = weight * point.factor * self.power as f64 * raised(*ratio, self.power - 1) / under;
            let (above, below) = row.split_at_mut(self.above);
            above.iter_mut().zip(p).for_each(|(r, p)| *r = outer * p);
            below.iter_mut().zip(q).for_each(|(r, q)| *r = -outer * ratio * q);
            let error = weight * self.difference(point, *ratio);
            square += error * error;
            for ((line, slope), r) in gram.iter_mut().zip(&mut slope).zip(&row) {
                *slope -= r * error;
                line.iter_mut().zip(&row).for_each(|(g, s)| *g += r * s);
            }
        }
        (gram, slope, square)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `x^i y^j`.
#[must_use]
pub fn monomial([x, y]: [f64; 2], [i, j]: Term) -> f64 {
    raised(x, i) * raised(y, j)
}

fn raised(x: f64, n: usize) -> f64 {
    (0..n).fold(1.0, |product, _| product * x)
}

impl Terms {
    /// All terms of total degree up to `degree`, in one or two variables; with or without a denominator.
    #[must_use]
    pub fn of_degree(degree: usize, variables: usize, rational: bool) -> Terms {
        let last = |i: usize| if variables > 1 { degree - i } else { 0 };
        let above: Vec<Term> = (0..=degree).flat_map(|i| (0..=last(i)).map(move |j| [i, j])).collect();
        let below = if rational { above[1..].to_vec() } else { Vec::new() };
        Terms { above, below }
    }
}
