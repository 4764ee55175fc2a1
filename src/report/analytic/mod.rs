//! Tables as formulas: polynomials and rational functions, fitted to fresh integrals, written as shader code with their errors.
//!
//! * [`split_sum`]: scale, bias and E of a model whose Fresnel factor splits off, in few operations (`split.rs`).
//! * [`table`]: every channel of any table of one or two axes, in the coordinates of its axes (`table.rs`).
//!
//! The fits are of least largest error ([`math::rational`](crate::math::rational)), where errors over mu 0.05, roughness
//! 0.09 and above ("practical") count four times. Errors are then measured in f32, operation by operation as the code computes,
//! at the points of the fit, and between them along either variable and both, the borders of the domain among them. Results are clamped to
//! the range of their channel, or of the values where these leave it: a model need not be passive.
//!
//! The numbers of a linearly transformed cosine are judged by its lobe (`lobes.rs`).

mod formula;
mod lobes;
mod split;
mod table;

pub use formula::Lang;
pub use lobes::{Error, Lobes};
pub use split::{DEGREES, split_sum, split_sum_until, splits};
pub use table::{Form, table, table_until};

use crate::cancel::Cancelled;
use crate::encode::EncodeError;
use crate::tables::TexelError;
use formula::Formula;

/// How much more an error counts in the practical domain.
const PRACTICAL_WEIGHT: f64 = 4.0;
/// Lines of points along each variable.
const LINES: usize = 65;
/// Steps of a fit.
const STEPS: usize = 150;
/// Shifts of the points between those of a fit, in parts of their distance.
const BETWEEN: [[f64; 2]; 3] = [[0.5, 0.5], [0.5, 0.0], [0.0, 0.5]];
/// Integration error of the truth.
const TOLERANCE: f64 = 1e-6;

/// Largest and mean error, and where the largest lies.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Off {
    /// The largest, over points and results.
    pub largest: f64,
    /// Mean over points and results.
    pub mean: f64,
    /// Which result, by number.
    pub result: usize,
    /// Arguments at the largest.
    pub at: Vec<f64>,
}

/// A formula with its errors.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedFormula {
    /// What it is of, in words.
    pub title: String,
    /// Which form and degree, in words.
    pub form: String,
    /// Id of each result.
    pub results: Vec<String>,
    /// Range that each result is clamped to.
    pub ranges: Vec<[f64; 2]>,
    /// Over the whole domain.
    pub whole: Off,
    /// Over mu >= 0.05, roughness >= 0.09, if there is an axis that this cuts.
    pub practical: Option<Off>,
    /// Of parameters of a lobe: how far the lobes are from the model, over the whole and the practical domain.
    pub lobes: Option<[Lobes; 2]>,
    /// Least denominator, as 1 + ..., over the points at which errors are measured; positive.
    pub least_denominator: f64,
    formula: Formula,
}

/// Why there is no fit.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// Not a table that can be fitted.
    #[error("{got} is not fitted: {why}")]
    Table {
        /// Kind and channels.
        got: String,
        /// What it would have to be.
        why: &'static str,
    },
    /// No denominator stays positive.
    #[error("degree {degree}: no denominator stays positive; take another degree or the form polynomial")]
    Pole {
        /// Degree.
        degree: usize,
    },
    /// A value to be met could not be integrated.
    #[error("at {at}: {}", .error.of(.channels.iter().map(String::as_str)))]
    Texel {
        /// The point.
        at: String,
        /// Ids of the channels of the table.
        channels: Vec<String>,
        /// Why.
        error: TexelError,
    },
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// An axis that code cannot compute.
    #[error(transparent)]
    Axis(#[from] EncodeError),
}

/// A point at which errors are measured.
struct Sample {
    arguments: Vec<f64>,
    want: Vec<f64>,
    practical: bool,
}

impl FittedFormula {
    /// The results in f32, operation by operation as the code computes them.
    #[must_use]
    pub fn evaluate(&self, arguments: &[f32]) -> Vec<f32> {
        self.formula.evaluate(arguments).0
    }

    /// The denominators' least value there, 1 if there are none.
    #[must_use]
    pub fn denominator(&self, arguments: &[f32]) -> f64 {
        self.formula.evaluate(arguments).1
    }

    /// Multiplications, additions, divisions, roots and powers; minima and maxima, and so clamps, are not counted.
    #[must_use]
    pub fn operations(&self) -> usize {
        self.formula.operations()
    }

    /// Names of the arguments, in order.
    #[must_use]
    pub fn arguments(&self) -> &[&'static str] {
        &self.formula.arguments
    }

    /// Error that a bound is compared with: practical if that is asked for and there is one, else whole; of parameters of a lobe what
    /// they add to the L3 error of the nearest lobes.
    #[must_use]
    pub fn largest(&self, practical: bool) -> f64 {
        if let Some([whole, inside]) = &self.lobes {
            return if practical && self.practical.is_some() { inside.added() } else { whole.added() };
        }
        self.practical.as_ref().filter(|_| practical).map_or(self.whole.largest, |p| p.largest)
    }

    /// Measures a formula; none if a denominator is not positive somewhere.
    fn measured(
        formula: Formula,
        [title, form]: [String; 2],
        (results, ranges): (Vec<String>, Vec<[f64; 2]>),
        samples: &[Sample],
    ) -> Option<FittedFormula> {
        let formula = formula.simplified();
        let mut fit = FittedFormula {
            title,
            form,
            results,
            ranges,
            whole: Off::default(),
            practical: None,
            lobes: None,
            least_denominator: 1.0,
            formula,
        };
        let values: Vec<(Vec<f32>, f64)> =
            samples.iter().map(|s| fit.formula.evaluate(&single(&s.arguments))).collect();
        let least = values.iter().map(|v| v.1).fold(f64::INFINITY, f64::min);
        if !values.iter().all(|v| v.1 > 0.0 && v.0.iter().all(|r| r.is_finite())) {
            return None;
        }
        fit.least_denominator = least;
        fit.whole = off(samples, &values, |_| true).unwrap_or_default();
        fit.practical = off(samples, &values, |s| s.practical);
        Some(fit)
    }

    /// A function of the arguments, below what it is and how far off, as comments.
    #[must_use]
    pub fn code(&self, lang: Lang) -> String {
        format!("{}{}", self.comment(lang.syntax().comment()), self.formula.code(lang))
    }

    fn comment(&self, mark: &str) -> String {
        let results: Vec<String> = (self.results.iter().zip(&self.ranges))
            .map(|(id, [lo, hi])| format!("{id} in [{lo}, {hi}]"))
            .collect();
        let line = |what: &str, o: &Off| {
            let at: Vec<String> =
                self.formula.arguments.iter().zip(&o.at).map(|(a, v)| format!("{a} = {v:.4}")).collect();
            let result = self.results.get(o.result).map_or("", String::as_str);
            format!(
                "{mark} {what}: largest {:.2e} ({result} at {}), mean {:.2e}\n",
                o.largest,
                at.join(", "),
                o.mean
            )
        };
        let domain = "mu >= 0.05, roughness >= 0.09";
        let practical = self.practical.as_ref().map_or_else(String::new, |o| line(domain, o));
        let lobes = self.lobes.as_ref().map_or_else(String::new, |[whole, inside]| {
            let inside = if practical.is_empty() { String::new() } else { inside.line(mark, domain) };
            whole.line(mark, "whole domain") + &inside
        });
        format!(
            "{mark} {}: {}.\n{mark} {}; {} operations. Errors in f32, against integrals:\n{lobes}{}{practical}",
            self.title,
            results.join(", "),
            self.form,
            self.operations(),
            line("whole domain", &self.whole),
        )
    }
}

#[allow(clippy::cast_possible_truncation, reason = "the code computes in f32")]
fn single(v: &[f64]) -> Vec<f32> {
    v.iter().map(|x| *x as f32).collect()
}

/// A range, widened to the values that leave it.
fn reached(range: [f64; 2], values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold(range, |[lo, hi], v| [lo.min(v), hi.max(v)])
}

/// None if there is no such sample.
fn off(samples: &[Sample], values: &[(Vec<f32>, f64)], inside: impl Fn(&Sample) -> bool) -> Option<Off> {
    let mut off = Off::default();
    let mut n = 0.0;
    for (s, (got, _)) in samples.iter().zip(values).filter(|(s, _)| inside(s)) {
        for (result, (got, want)) in got.iter().zip(&s.want).enumerate() {
            let error = (f64::from(*got) - want).abs();
            off.mean += error;
            n += 1.0;
            if error > off.largest || off.at.is_empty() {
                off = Off { largest: error, result, at: s.arguments.clone(), ..off };
            }
        }
    }
    off.mean /= f64::max(n, 1.0);
    (n > 0.0).then_some(off)
}
