//! Error against evaluations, for the adaptive rule and for the samplers that others use, at seeded texels of one table.
//!
//! Each texel keeps its sums as points come in, so that every budget is a beginning of the longest run; Hammersley's set has to be
//! made anew for each. Errors are those of the channels against the adaptive rule at [`REFERENCE`]; points nearer to it than ten times its
//! own estimate are left out.

mod estimators;

use super::seeds::Seeds;
use crate::cancel::{Cancel, Cancelled};
use crate::tables::spec::Bound;
use crate::tables::{TexelError, place};
pub(crate) use estimators::split_of_ggx;
use estimators::{Estimators, Run};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Tolerance of the reference.
pub const REFERENCE: f64 = 1e-13;
/// How many times the error of the reference the smallest error is that is shown.
pub const ABOVE: f64 = 10.0;
/// Tolerances for which it is told when they are reached: a permille, half a step of half floats at 1, a hundred-thousandth.
pub const REACHED: [f64; 3] = [1e-3, 2.44140625e-4, 1e-5];
/// Budgets in evaluations of a texel: from 2^4 up to 2 to the power that is asked for.
pub const LEAST_POWER: u32 = 4;
/// Largest power of a budget.
pub const MOST_POWER: u32 = 20;

/// How a table is looked at.
#[derive(Debug, Clone, Copy)]
pub struct Asked<'a> {
    /// Which texels, and which points.
    pub seed: u64,
    /// How many texels.
    pub texels: usize,
    /// The largest budget is 2 to this power.
    pub power: u32,
    /// Set from outside to stop.
    pub cancel: &'a Cancel,
}

/// Errors of every method at every budget. No clock: equal on every machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Chart {
    /// The table in words.
    pub subject: String,
    /// The rule of its baker.
    pub rule: String,
    /// The seed.
    pub seed: u64,
    /// How many texels.
    pub texels: usize,
    /// Channel ids.
    pub channels: Vec<String>,
    /// Largest error estimate of the reference.
    pub reference: f64,
    /// The methods.
    pub series: Vec<Series>,
}

/// One method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Series {
    /// Id.
    pub method: String,
    /// In words.
    pub title: String,
    /// Budgets in order.
    pub points: Vec<Point>,
    /// Power of evaluations that the RMS error falls with.
    pub order: Option<f64>,
    /// Evaluations of a texel from which on the largest error is within each of [`REACHED`].
    pub reached: Vec<Option<f64>>,
}

/// Errors at one budget.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// Evaluations of a texel, mean.
    pub evaluations: f64,
    /// Largest error of a channel.
    pub largest: f64,
    /// Root of the mean square.
    pub rms: f64,
    /// The error that one value in a hundred exceeds.
    pub p99: f64,
    /// Largest error in steps of half floats at the value.
    pub half_ulps: f64,
    /// Where the largest is.
    pub at: String,
}

/// Seconds of a texel at the points of a [`Series`]: of this machine, now.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Times {
    /// Id of the method.
    pub method: String,
    /// Seconds of a texel on one thread, at each point: the median of the texels.
    pub seconds: Vec<f64>,
    /// Seconds of a texel that reach each of [`REACHED`].
    pub reached: Vec<Option<f64>>,
}

/// Why there is no chart.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConvergeError {
    /// A table whose channels are no integrals of a lobe.
    #[error(
        "{kind}: channel `{channel}` is no integral of reflected light; tables of kind dfg and albedo are (models are looked at as albedo)"
    )]
    NoIntegral {
        /// Kind.
        kind: &'static str,
        /// Channel.
        channel: &'static str,
    },
    /// A texel that has no reference.
    #[error("{at}: {error}")]
    Texel {
        /// Where.
        at: String,
        /// Why.
        error: TexelError,
    },
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Errors and times of every method.
///
/// # Errors
/// [`ConvergeError`].
pub fn converge(bound: &Bound, asked: Asked<'_>) -> Result<(Chart, Vec<Times>), ConvergeError> {
    let spec = &bound.spec;
    let estimators = Estimators::new(bound, &chosen(bound, asked), asked)?;
    let texels = estimators.numbers();
    let reference = reference(bound, &texels, asked)?;
    let names: Vec<String> = texels.iter().map(|t| place(&spec.grid, *t)).collect();
    let mut chart = Chart {
        subject: super::finding::subject(spec),
        rule: bound.baker.rule(),
        seed: asked.seed,
        texels: texels.len(),
        channels: spec.layout.ids().map(str::to_owned).collect(),
        reference: reference.error,
        series: Vec::new(),
    };
    let mut times = Vec::new();
    for method in estimators.methods() {
        asked.cancel.check()?;
        let runs = estimators.run(method, bound)?;
        let (series, time) = summary(method.id(), method.title(), &runs, &reference, &names);
        chart.series.push(series);
        times.push(time);
    }
    Ok((chart, times))
}

/// Seeded texels, each once; all of a table that has no more.
fn chosen(bound: &Bound, asked: Asked<'_>) -> Vec<usize> {
    let len = bound.spec.grid.len();
    let mut all: Vec<usize> = (0..len).collect();
    let mut seeds = Seeds::new(asked.seed);
    let count = asked.texels.min(len);
    for i in 0..count {
        let j = i + seeds.index(len - i);
        all.swap(i, j);
    }
    all.truncate(count);
    all.sort_unstable();
    all
}

struct Reference {
    /// `[texel][channel]`.
    values: Vec<Vec<f64>>,
    error: f64,
}

fn reference(bound: &Bound, texels: &[usize], asked: Asked<'_>) -> Result<Reference, ConvergeError> {
    let n = bound.spec.layout.channels.len();
    let one = |texel: &usize| {
        asked.cancel.check()?;
        let point = bound.spec.grid.texel(*texel);
        let e = bound
            .baker
            .texel(point.values(), REFERENCE)
            .map_err(|error| ConvergeError::Texel { at: place(&bound.spec.grid, *texel), error })?;
        Ok((e.value[..n].to_vec(), e.error[..n].iter().copied().fold(0.0, f64::max)))
    };
    let all: Vec<(Vec<f64>, f64)> = texels.par_iter().map(one).collect::<Result<_, ConvergeError>>()?;
    let error = all.iter().map(|(_, e)| *e).fold(0.0, f64::max);
    Ok(Reference { values: all.into_iter().map(|(v, _)| v).collect(), error })
}

fn summary(id: &str, title: &str, runs: &[Run], reference: &Reference, names: &[String]) -> (Series, Times) {
    let budgets = runs.first().map_or(0, |r| r.values.len());
    let (mut points, mut seconds) = (Vec::new(), Vec::new());
    for b in 0..budgets {
        let point = point(runs, b, reference, names);
        // nearer to the reference than it is to the truth: nothing is known
        if point.largest <= ABOVE * reference.error {
            continue;
        }
        seconds.push(median(runs.iter().map(|r| r.seconds[b]).collect()));
        points.push(point);
    }
    let first = |of: &dyn Fn(usize) -> f64| -> Vec<Option<f64>> {
        REACHED
            .iter()
            .map(|t| {
                let last_above = points.iter().rposition(|p| p.largest > *t);
                let i = last_above.map_or(0, |i| i + 1);
                (i < points.len()).then(|| of(i))
            })
            .collect()
    };
    let reached = first(&|i| points[i].evaluations);
    let in_time = first(&|i| seconds[i]);
    let order = order(&points);
    let times = Times { method: id.to_owned(), seconds: seconds.clone(), reached: in_time };
    (Series { method: id.to_owned(), title: title.to_owned(), order, reached, points }, times)
}

/// The middle one: a machine that does other things now and then slows some texels.
fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds.get(seconds.len() / 2).copied().unwrap_or(0.0)
}

fn point(runs: &[Run], b: usize, reference: &Reference, names: &[String]) -> Point {
    let mut errors = Vec::new();
    let mut p =
        Point { evaluations: 0.0, largest: 0.0, rms: 0.0, p99: 0.0, half_ulps: 0.0, at: String::new() };
    for ((run, truth), name) in runs.iter().zip(&reference.values).zip(names) {
        p.evaluations += run.evaluations[b] / runs.len() as f64;
        for (v, t) in run.values[b].iter().zip(truth) {
            let off = (v - t).abs();
            errors.push(off);
            p.half_ulps = p.half_ulps.max(off / half_ulp(*t));
            if off > p.largest || p.at.is_empty() {
                p.largest = off;
                p.at.clone_from(name);
            }
        }
    }
    let n = errors.len().max(1) as f64;
    p.rms = (errors.iter().map(|e| e * e).sum::<f64>() / n).sqrt();
    errors.sort_by(f64::total_cmp);
    // the least error that 99 of 100 do not exceed
    let rank = (errors.len() * 99).div_ceil(100).max(1) - 1;
    p.p99 = errors.get(rank).copied().unwrap_or(0.0);
    p
}

/// Distance of neighbouring half floats at a value.
fn half_ulp(v: f64) -> f64 {
    let exponent = if v.abs() > 0.0 { libm::ilogb(v).max(-14) } else { -14 };
    libm::ldexp(1.0, exponent - 10)
}

/// Minus the slope of log RMS over log evaluations, by least squares.
fn order(points: &[Point]) -> Option<f64> {
    let rows: Vec<(f64, f64)> = points
        .iter()
        .filter(|p| p.rms > 0.0 && p.evaluations > 0.0)
        .map(|p| (libm::log(p.evaluations), libm::log(p.rms)))
        .collect();
    if rows.len() < 2 {
        return None;
    }
    let n = rows.len() as f64;
    let (mx, my) = (rows.iter().map(|r| r.0).sum::<f64>() / n, rows.iter().map(|r| r.1).sum::<f64>() / n);
    let up: f64 = rows.iter().map(|r| (r.0 - mx) * (r.1 - my)).sum();
    let down: f64 = rows.iter().map(|r| (r.0 - mx) * (r.0 - mx)).sum();
    (down > 0.0).then(|| -up / down)
}
