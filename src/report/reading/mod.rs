//! Bytes and operations against the error that a shader reads: tables of falling size by axes, texel fit and storage; formulas, fitted
//! and published; a small neural network.

mod network;
mod published;

use super::analytic;
use super::chart::{Chart, Curve};
use crate::cancel::{Cancel, Cancelled, untold};
use crate::encode::{Storage, quantise_table_until, texel_size};
use crate::grid::fit::{self, Objective};
use crate::grid::layout::Point;
use crate::grid::{Axis, Grid, Texel, Warp, lookup};
use crate::integrate::Sums;
use crate::tables::driver::{self, OnMiss, Options, at_points};
use crate::tables::spec::{Bound, Request};
use crate::verify::converge::split_of_ggx;
use crate::verify::reconstruction::{Probe, in_practical_domain};
use crate::verify::seeds::Seeds;
use network::Network;
use published::PUBLISHED;
use serde::Serialize;

/// Lengths of the axes.
const LENGTHS: [usize; 4] = [8, 16, 32, 64];
/// Storages.
const STORAGES: [Storage; 4] = [Storage::Half, Storage::Unorm8, Storage::Unorm16, Storage::Float];
/// Those of the chart; the table has all.
const DRAWN: [Storage; 2] = [Storage::Half, Storage::Unorm8];
/// Degrees of formulas.
const DEGREES: [usize; 3] = [2, 3, 4];
/// Tolerance of texels and of what they are compared with.
const TOLERANCE: f64 = 1e-6;
/// Points that a table is compared at.
const POINTS: usize = 4096;
/// Points of the root mean squares: half of them even in the values of the axes, half in their coordinates. The first half decides the
/// mean, both the largest of what has no texels.
const SAMPLES: usize = 8192;

/// Intervals of a cell, along each axis, whose ends texels are fitted to; in all at most so many.
const PER_CELL: [usize; 2] = [4, 2];
const PLACES: usize = 1 << 15;
/// The form whose texels are fitted, too.
const OWN: &str = "own axes";

/// What a shader can read, and what it costs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reading {
    /// Axes and texels, or the formula.
    pub form: String,
    /// Storage id; empty for a formula.
    pub storage: &'static str,
    /// Texels along each axis; 0 for a formula.
    pub length: usize,
    /// Bytes of the texels or weights; 0 for a formula, whose numbers are in its code.
    pub bytes: usize,
    /// Operations: of a formula, of a network, or of the texture coordinates of a table, which is then fetched once.
    pub operations: usize,
    /// Largest error over the whole domain.
    pub whole: f64,
    /// Root of the mean square over the values of the axes.
    pub rms: f64,
    /// Largest error over mu >= 0.05, roughness >= 0.09.
    pub practical: Option<f64>,
    /// The root of the mean square there.
    pub practical_rms: Option<f64>,
}

/// Tables, formulas and networks of what `bound` holds.
///
/// # Errors
/// [`Cancelled`].
pub fn readings(bound: &Bound, cancel: &Cancel) -> Result<Vec<Reading>, Cancelled> {
    let mut all = Vec::new();
    let samples = Samples::new(bound, cancel)?;
    let own: Vec<Axis> = bound.spec.grid.axes().to_vec();
    let linear = |texel: Texel| -> Vec<Axis> {
        own.iter().map(|a| Axis { warp: Warp::Linear, texel, ..a.clone() }).collect()
    };
    let forms = [
        (OWN, own.clone()),
        ("linear, centres", linear(Texel::Center)),
        ("linear, ends", linear(Texel::Endpoint)),
    ];
    for (form, axes) in forms {
        for length in LENGTHS {
            let axes = axes.iter().map(|a| Axis { len: length, ..a.clone() }).collect();
            let Ok(bound) = (Request { axes: Some(axes), ..bound.spec.request() }).bind() else { continue };
            table(&bound, form, length, &samples, cancel, &mut all)?;
        }
    }
    for degree in DEGREES.into_iter().filter(|_| analytic::splits(bound)) {
        cancel.check()?;
        if let Ok(fit) = analytic::split_sum_until(cancel, bound, degree) {
            all.push(samples.formula(
                format!("formula of degree {degree}"),
                fit.operations(),
                Some((fit.whole.largest, fit.practical.as_ref().map(|p| p.largest))),
                &|v| split_at(bound, &fit, v),
            ));
        }
    }
    if let Some([mu, alpha]) = split_of_ggx(bound) {
        for p in PUBLISHED {
            let at = |v: &[f64]| Some((p.at)(v[mu], v[alpha].sqrt()).to_vec());
            all.push(samples.formula(p.name.to_owned(), p.operations, None, &at));
        }
        if let Some(network) = Network::new() {
            let at = |v: &[f64]| network.at(v[mu], v[alpha]).map(|v| v.to_vec());
            let read = samples.formula("network 3 x 32".to_owned(), network.operations(), None, &at);
            all.push(Reading { storage: Storage::Float.id(), bytes: network.bytes(), ..read });
        }
    }
    cancel.check()?;
    Ok(all)
}

/// Points of the domain with what a reader should get there.
struct Samples {
    points: Vec<(Point, Sums)>,
    /// How many of the first are even in the values of the axes.
    even: usize,
    practical: Vec<bool>,
    channels: usize,
    cuts: bool,
}

/// Largest, and root of the mean square.
#[derive(Default, Clone, Copy)]
struct Spread {
    largest: f64,
    squares: f64,
    count: f64,
}

impl Spread {
    fn rms(&self) -> f64 {
        (self.squares / self.count.max(1.0)).sqrt()
    }
}

impl Samples {
    fn new(bound: &Bound, cancel: &Cancel) -> Result<Samples, Cancelled> {
        let grid = &bound.spec.grid;
        let mut seeds = Seeds::new(1);
        let mut drawn = |even: bool| {
            let values: Vec<f64> = grid.axes().iter().map(|a| place(a, seeds.unit(), even)).collect();
            let base = |(axis, v): (&Axis, &f64)| axis.quantity.to_base(*v);
            if even {
                return grid.point(&grid.axes().iter().zip(&values).map(base).collect::<Vec<_>>());
            }
            Some(grid.at_coordinates(&values))
        };
        let points: Vec<Point> = (0..SAMPLES).filter_map(|i| drawn(i < SAMPLES / 2)).collect();
        let truth = at_points(bound, &points, TOLERANCE, cancel, &untold);
        cancel.check()?;
        let even = truth.iter().take(SAMPLES / 2).flatten().count();
        let points: Vec<(Point, Sums)> =
            points.into_iter().zip(truth).filter_map(|(p, t)| Some((p, t?))).collect();
        let practical = points.iter().map(|(p, _)| in_practical_domain(grid, p)).collect();
        let cuts = crate::verify::reconstruction::has_practical(grid);
        Ok(Samples { points, even, practical, channels: bound.spec.layout.channels.len(), cuts })
    }

    /// What is off over the whole and the practical domain: the largest of all points, the mean over those that are even in values.
    fn off(&self, read: &dyn Fn(&Point, &mut [f64]) -> bool) -> [Spread; 2] {
        let mut spreads = [Spread::default(); 2];
        let mut got = vec![0.0; self.channels];
        for (i, (point, truth)) in self.points.iter().enumerate() {
            if !read(point, &mut got) {
                continue;
            }
            for (g, t) in got.iter().zip(truth) {
                let off = (g - t).abs();
                for spread in &mut spreads[..1 + usize::from(self.practical[i])] {
                    spread.largest = spread.largest.max(off);
                    if i < self.even {
                        spread.squares += off * off;
                        spread.count += 1.0;
                    }
                }
            }
        }
        spreads
    }

    /// A formula, whose largest errors may be known from a search.
    fn formula(
        &self,
        form: String,
        operations: usize,
        found: Option<(f64, Option<f64>)>,
        at: &dyn Fn(&[f64]) -> Option<Vec<f64>>,
    ) -> Reading {
        let [whole, practical] = self.off(&|point, got| {
            let Some(values) = at(point.values()) else { return false };
            got.iter_mut().zip(values).for_each(|(g, v)| *g = v);
            true
        });
        let (found, found_practical) = found.map_or((0.0, None), |f| f);
        Reading {
            form,
            storage: "",
            length: 0,
            bytes: 0,
            operations,
            whole: whole.largest.max(found),
            rms: whole.rms(),
            practical: self.cuts.then_some(practical.largest.max(found_practical.unwrap_or(0.0))),
            practical_rms: self.cuts.then_some(practical.rms()),
        }
    }
}

/// The channels of a table by the formula of its split sum.
#[allow(clippy::cast_possible_truncation, reason = "the code computes in f32")]
fn split_at(bound: &Bound, fit: &analytic::FittedFormula, at: &[f64]) -> Option<Vec<f64>> {
    let spec = &bound.spec;
    let [mu, alpha] = [at[spec.axis("mu")?], at[spec.axis("alpha")?]];
    let [scale, bias, e] = fit.evaluate(&[mu as f32, alpha as f32])[..] else { return None };
    let [scale, bias, e] = [scale, bias, e].map(f64::from);
    let grazing = (1.0 - mu) * (1.0 - mu) * (1.0 - mu) * (1.0 - mu) * (1.0 - mu);
    let channel = |id: &str| {
        Some(match id {
            "dfg.scale" => scale,
            "dfg.bias" | "dfg.fc" => bias,
            "dfg.total" => e,
            "dfg.loss" => 1.0 - e,
            "dfg.rest" => bias - e * grazing,
            _ => return None,
        })
    };
    spec.layout.ids().map(channel).collect()
}

/// A value of an axis, even in its values, or a coordinate.
fn place(axis: &Axis, u: f64, even: bool) -> f64 {
    let [lo, hi] = axis.domain;
    if even { lo + u * (hi - lo) } else { u }
}

/// Operations of the texture coordinates of some axes.
fn of_coordinates(axes: &[Axis]) -> usize {
    axes.iter().map(Axis::operations).sum()
}

fn table(
    bound: &Bound,
    form: &str,
    length: usize,
    samples: &Samples,
    cancel: &Cancel,
    all: &mut Vec<Reading>,
) -> Result<(), Cancelled> {
    let options = Options { tolerance: TOLERANCE, on_miss: OnMiss::Report, cancel, progress: &|_| {} };
    let baked = driver::bake(bound, options);
    cancel.check()?;
    let Ok(table) = baked else { return Ok(()) };
    let probe = Probe::until(cancel, bound, TOLERANCE, POINTS);
    let mut forms = vec![(form.to_owned(), table.clone())];
    if form == OWN {
        for objective in [Objective::LeastSquares, Objective::Minimax] {
            let values = fitted(bound, &table.values, objective, cancel)?;
            let table = crate::grid::Table { values, ..table.clone() };
            forms.push((format!("{form}, {}", objective.id()), table));
        }
    }
    for (form, table) in &forms {
        for storage in STORAGES {
            let stored = quantise_table_until(cancel, table, storage);
            cancel.check()?;
            // numbers that the storage does not hold are no choice
            let Ok(stored) = stored else { continue };
            let read = probe.measure(&stored.values);
            let grid: &Grid = &table.grid;
            let [whole, practical] = samples.off(&|point, got| {
                lookup::read(grid, &stored.values, point, got);
                true
            });
            all.push(Reading {
                form: form.clone(),
                storage: storage.id(),
                length,
                bytes: grid.len() * texel_size(storage, table.channels.len()),
                operations: of_coordinates(grid.axes()),
                whole: read.whole.largest.value,
                rms: whole.rms(),
                practical: read.practical.map(|p| p.largest.value),
                practical_rms: samples.cuts.then_some(practical.rms()),
            });
        }
    }
    cancel.check()
}

/// Values for all channels that read, interpolated, with the least errors.
fn fitted(
    bound: &Bound,
    exact: &[f64],
    objective: Objective,
    cancel: &Cancel,
) -> Result<Vec<f64>, Cancelled> {
    let grid = &bound.spec.grid;
    let n = bound.spec.layout.channels.len();
    let [fine, coarse] = PER_CELL;
    let places = fit::places(grid, if fit::places_count(grid, fine) <= PLACES { fine } else { coarse });
    let points: Vec<Point> = places.iter().map(|(x, _)| grid.at_coordinates(x)).collect();
    let truth = at_points(bound, &points, TOLERANCE, cancel, &untold);
    cancel.check()?;
    let known = || truth.iter().enumerate().filter_map(|(i, t)| t.as_ref().map(|t| (i, t)));
    let samples = fit::Samples::new(grid, known().map(|(i, _)| (&points[i], places[i].1)));
    let mut out = exact.to_vec();
    for (c, info) in bound.spec.layout.channels.iter().enumerate() {
        let want: Vec<f64> = known().map(|(_, t)| t[c]).collect();
        let start: Vec<f64> = exact.iter().skip(c).step_by(n).copied().collect();
        let values = match objective {
            Objective::Minimax => samples.minimax(&want, &start, info.range, cancel),
            _ => samples.least_squares(&want, &start, info.range, cancel),
        };
        cancel.check()?;
        out.iter_mut().skip(c).step_by(n).zip(values).for_each(|(o, v)| *o = v);
    }
    Ok(out)
}

/// One row for each table, formula and network.
#[must_use]
pub fn csv(readings: &[Reading]) -> String {
    let mut lines = vec!["form,storage,length,bytes,operations,whole,rms,practical,practical_rms".to_owned()];
    for r in readings {
        let known = |v: Option<f64>| v.map_or_else(String::new, |v| format!("{v:e}"));
        let (practical, practical_rms) = (known(r.practical), known(r.practical_rms));
        let Reading { form, storage, length, bytes, operations, whole, rms, .. } = r;
        lines.push(format!(
            "\"{form}\",{storage},{length},{bytes},{operations},{whole:e},{rms:e},{practical},{practical_rms}"
        ));
    }
    lines.join("\n") + "\n"
}

/// Error of reading over bytes, one curve for axes, texels and storage (of storages half floats and bytes); formulas are levels, a
/// network is a point.
#[must_use]
pub fn chart(subject: &str, readings: &[Reading]) -> Chart {
    let error = |r: &Reading| r.practical.unwrap_or(r.whole);
    let mut curves: Vec<Curve> = Vec::new();
    let drawn = |r: &&Reading| r.bytes > 0 && (r.length == 0 || DRAWN.iter().any(|s| s.id() == r.storage));
    for r in readings.iter().filter(drawn) {
        let name = match r.length {
            0 => format!("{}, {} op.", r.form, r.operations),
            _ => format!("{}, {}", r.form.replace("own axes, ", "own, "), r.storage),
        };
        let point = [r.bytes as f64, error(r)];
        match curves.iter_mut().find(|c| c.name == name) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve { name, points: vec![point] }),
        }
    }
    let level = |r: &Reading| (error(r), format!("{}, {} op.", r.form, r.operations));
    let practical = readings.iter().any(|r| r.practical.is_some());
    let where_ = if practical { " (mu >= 0.05, roughness >= 0.09)" } else { "" };
    let mut levels: Vec<(f64, String)> = readings.iter().filter(|r| r.bytes == 0).map(level).collect();
    levels.sort_by(|a, b| b.0.total_cmp(&a.0));
    Chart {
        title: subject.to_owned(),
        axes: [
            "bytes of the texels or weights; op.: operations".to_owned(),
            format!("largest error as read{where_}"),
        ],
        curves,
        levels,
    }
}
