//! The smallest table that reads to within an error: `size = "auto"`.
//!
//! The error of multilinear reading is nearly the sum of what each axis alone leaves. So the error of each axis is
//! measured on its own first, at rising lengths, with the other axes on [`ROWS`] lines where reading is exact. Combinations
//! of lengths are then tried in full, from the fewest texels on, until one holds: baked, rounded as the outputs round it,
//! and compared with fresh integrals between its texels, worst cells searched more finely ([`Probe`]). Where the recipe has its
//! texels fitted, each trial is fitted too.
//!
//! Other warps, where the recipe allows them, are ranked by two lengths of each axis; the best few are searched in full.

use super::reached::Reached;
use super::texels::Source;
use super::{PipelineError, fit};
use crate::cancel::{Cancel, untold};
use crate::encode::Storage;
use crate::grid::layout::{Point, combination};
use crate::grid::provenance::SizeRecord;
use crate::grid::{Axis, Grid, Table, Texel, Warp, lookup};
use crate::integrate::{MAX_CHANNELS, Sums};
use crate::plan::{PlannedTable, Sizing};
use crate::tables::Bound;
use crate::verify::reconstruction::{Probe, in_practical_domain};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Lengths that are tried.
const LENGTHS: [usize; 20] =
    [4, 6, 8, 12, 16, 20, 24, 32, 40, 48, 64, 80, 96, 128, 192, 256, 384, 512, 1024, 2048];

/// Lines of the other axes on which the error of one is measured.
const ROWS: usize = 17;

/// Lengths by which warps are ranked.
const RANKED: [usize; 2] = [16, 32];

/// Sets of warps that are searched in full.
const FINALISTS: usize = 3;

/// Full trials of one set of warps.
const TRIALS: usize = 40;

/// How many times smaller than that of exact texels the largest error of fitted ones can be: twice where a parabola bends.
const FITTED: f64 = 2.0;

/// Most points of a trial that are compared with fresh integrals.
const COMPARED: usize = 1 << 14;

/// Part of the asked error that integration may have during the search.
const SHARE: f64 = 0.02;

/// A table of the size that was found, and how it was found.
pub(super) fn resolve(
    planned: &PlannedTable,
    sizing: &Sizing,
    cancel: &Cancel,
) -> Result<PlannedTable, PipelineError> {
    let search = Search::new(planned, sizing, cancel)?;
    let mut sets = vec![search.axes().to_vec()];
    if sizing.warps {
        sets = search.best_warps()?;
    }
    let mut best: Option<FoundSize> = None;
    for set in sets {
        let limit = best.as_ref().map_or(usize::MAX, |b| b.grid.len());
        if let Some(found) = search.smallest(&set, limit)? {
            best = Some(found);
        }
    }
    let trials = search.trials.load(Ordering::Relaxed);
    let found = best.ok_or_else(|| PipelineError::Size {
        table: planned.name().to_owned(),
        asked: sizing.error,
        longest: sizing.longest,
        reached: *search.least(),
        searched: sizing.warps,
        longer: LENGTHS.iter().any(|l| *l > sizing.longest),
    })?;
    let record = SizeRecord {
        error: sizing.error,
        domain: if sizing.practical { "practical" } else { "whole" }.to_owned(),
        warps_searched: sizing.warps,
        longest: sizing.longest,
        trials,
        reached: found.error,
    };
    search.bind(found.grid).map(|bound| planned.sized(bound, record))
}

struct FoundSize {
    grid: Grid,
    error: f64,
}

struct Search<'a> {
    planned: &'a PlannedTable,
    sizing: &'a Sizing,
    storages: Vec<Storage>,
    tolerance: f64,
    cancel: &'a Cancel,
    trials: AtomicUsize,
    /// What came nearest.
    least: Mutex<Reached>,
}

impl<'a> Search<'a> {
    fn new(
        planned: &'a PlannedTable,
        sizing: &'a Sizing,
        cancel: &'a Cancel,
    ) -> Result<Search<'a>, PipelineError> {
        let storages = planned.outputs.iter().map(|o| o.storage).collect();
        Ok(Search {
            planned,
            sizing,
            storages,
            tolerance: (SHARE * sizing.error).max(1e-12),
            cancel,
            trials: 0.into(),
            least: Mutex::default(),
        })
    }

    fn least(&self) -> MutexGuard<'_, Reached> {
        self.least.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn axes(&self) -> &[Axis] {
        self.planned.bound.spec.grid.axes()
    }

    fn bound(&self) -> &Bound {
        &self.planned.bound
    }

    fn bind(&self, grid: Grid) -> Result<Bound, PipelineError> {
        let mut spec = self.bound().spec.clone();
        spec.grid = grid;
        let baker = (spec.kind.bind)(&spec).map_err(|e| self.fault(&e))?;
        Ok(Bound { spec, baker })
    }

    fn grid(&self, axes: Vec<Axis>) -> Result<Grid, PipelineError> {
        Grid::new(axes).map_err(|e| self.fault(&e))
    }

    fn fault(&self, error: &dyn std::fmt::Display) -> PipelineError {
        PipelineError::SizeGrid { table: self.planned.name().to_owned(), message: error.to_string() }
    }

    fn cancelled(&self) -> Result<(), PipelineError> {
        Ok(self.cancel.check()?)
    }

    /// Values of a grid; NaN where the integral fails (the laws report those in the end).
    fn values(&self, grid: &Grid) -> Vec<f64> {
        let channels = self.bound().spec.layout.channels.len();
        let texels: Vec<Sums> = (0..grid.len()).into_par_iter().map(|i| self.at(&grid.texel(i))).collect();
        texels.iter().flat_map(|v| v[..channels].iter().copied()).collect()
    }

    fn at(&self, point: &Point) -> Sums {
        let nothing = [f64::NAN; MAX_CHANNELS];
        if self.cancel.is_set() {
            return nothing;
        }
        let texel = self.bound().baker.texel(point.values(), self.tolerance);
        texel.map_or(nothing, |e| e.value)
    }

    /// The error of exact texels from which what is asked for may still be reached.
    fn hope(&self) -> f64 {
        let fitted = if self.planned.asked.texels.are_exact() { 1.0 } else { FITTED };
        fitted * self.sizing.error
    }

    /// What axis `i` alone leaves at a length: the other axes on lines where reading is exact.
    fn axis_error(&self, set: &[Axis], i: usize, len: usize) -> Result<f64, PipelineError> {
        self.cancelled()?;
        let axes: Vec<Axis> = set
            .iter()
            .enumerate()
            .map(|(j, axis)| {
                let mut axis = axis.clone();
                if i == j {
                    axis.len = len;
                } else {
                    (axis.len, axis.texel, axis.offset) = (ROWS, Texel::Endpoint, 0.0);
                }
                axis
            })
            .collect();
        let grid = self.grid(axes)?;
        let stored = self.values(&grid);
        let lines: Vec<Vec<f64>> = (0..set.len())
            .map(|j| {
                if i == j {
                    grid.between(j)
                } else {
                    (0..ROWS).map(|k| k as f64 / (ROWS - 1) as f64).collect()
                }
            })
            .collect();
        let total: usize = lines.iter().map(Vec::len).product();
        let errors: Vec<f64> = (0..total)
            .into_par_iter()
            .map(|n| self.error_at(&grid, &stored, &grid.at_coordinates(&combination(&lines, n))))
            .collect();
        Ok(errors.into_iter().fold(0.0, f64::max))
    }

    /// The error of reading at a point; 0 outside the domain that is asked for.
    fn error_at(&self, grid: &Grid, stored: &[f64], point: &Point) -> f64 {
        if self.sizing.practical && !in_practical_domain(grid, point) {
            return 0.0;
        }
        let baker = &self.bound().baker;
        let channels = self.bound().spec.layout.channels.len();
        let (mut read, mut fresh) = ([0.0; MAX_CHANNELS], self.at(point));
        lookup::read(grid, stored, point, &mut read[..channels]);
        baker.decode(point.values(), &mut read);
        baker.decode(point.values(), &mut fresh);
        let channels = baker.decoded().map_or(channels, <[_]>::len);
        // NaN counts as no error: the laws find what is not finite
        read[..channels].iter().zip(&fresh).map(|(r, f)| (r - f).abs()).fold(0.0, f64::max)
    }

    /// The full trial: error of every output as it is stored; fitted texels may be fitted to fewer points.
    fn trial(&self, grid: Grid, quick: bool) -> Result<f64, PipelineError> {
        self.cancelled()?;
        self.trials.fetch_add(1, Ordering::Relaxed);
        let bound = self.bind(grid)?;
        let n = bound.spec.channels().len();
        let values = self.values(&bound.spec.grid);
        let table = Table {
            grid: bound.spec.grid.clone(),
            channels: bound.spec.channels(),
            errors: vec![0.0; values.len()],
            evaluations: vec![0; values.len() / n.max(1)],
            values,
        };
        let texels = self.planned.asked.texels;
        let fitted = match texels.are_exact() {
            true => None,
            false => {
                Some(fit::fit(self.planned, &bound, &table, self.tolerance, quick, self.cancel, &untold)?)
            }
        };
        let probe = Probe::until(self.cancel, &bound, self.tolerance, COMPARED);
        let source = Source {
            bound: &bound,
            table: &table,
            fitted: fitted.as_ref(),
            probe: Some(&probe),
            cancel: self.cancel,
        };
        let mut worst = 0.0_f64;
        for storage in &self.storages {
            // what cannot be stored is reported by the bake itself
            let Ok(chosen) = source.choose(texels, *storage) else { continue };
            let Some(measured) = chosen.reconstruction else { continue };
            let spread = if self.sizing.practical { measured.practical.as_ref() } else { None };
            worst = worst.max(spread.unwrap_or(&measured.whole).largest.value);
        }
        self.cancelled()?;
        self.least().trial(worst);
        Ok(worst)
    }

    /// The smallest grid of a set of axes that holds, with fewer than `limit` texels.
    fn smallest(&self, set: &[Axis], limit: usize) -> Result<Option<FoundSize>, PipelineError> {
        // for each axis the lengths with the error that they leave alone, from the first that may do
        let mut choices: Vec<Vec<(usize, f64)>> = Vec::new();
        for (i, axis) in set.iter().enumerate() {
            if !self.sizing.axes.contains(&i) {
                choices.push(vec![(axis.len, 0.0)]);
                continue;
            }
            let mut list = Vec::new();
            let mut best: Option<(f64, usize)> = None;
            for len in LENGTHS.into_iter().filter(|l| *l <= self.sizing.longest) {
                let error = self.axis_error(set, i, len)?;
                if best.is_none_or(|(least, _)| error < least) {
                    best = Some((error, len));
                }
                if error <= self.hope() {
                    list.push((len, error));
                }
                if error <= 0.2 * self.sizing.error {
                    break;
                }
            }
            if let Some((error, len)) = best.filter(|_| list.is_empty()) {
                self.least().only(axis.quantity.id, len, error);
                return Ok(None);
            }
            choices.push(list);
        }
        for lens in combinations(&choices, self.sizing.error).into_iter().take(TRIALS) {
            if lens.iter().product::<usize>() >= limit {
                break;
            }
            let mut axes = set.to_vec();
            axes.iter_mut().zip(&lens).for_each(|(axis, len)| axis.len = *len);
            let grid = self.grid(axes)?;
            let mut error = self.trial(grid.clone(), true)?;
            if error <= self.sizing.error && !self.planned.asked.texels.are_exact() {
                error = self.trial(grid.clone(), false)?;
            }
            if error <= self.sizing.error {
                return Ok(Some(FoundSize { grid, error }));
            }
        }
        Ok(None)
    }

    /// Sets of axes with other warps, the most promising first.
    fn best_warps(&self) -> Result<Vec<Vec<Axis>>, PipelineError> {
        let mut sets = vec![self.axes().to_vec()];
        for i in self.sizing.axes.iter().copied() {
            let mut wider = Vec::new();
            for set in &sets {
                for warp in warps(&set[i], self.axes()) {
                    let mut other = set.clone();
                    other[i].warp = warp;
                    wider.push(other);
                }
            }
            sets = wider;
        }
        let mut ranked = Vec::new();
        for set in sets {
            let mut texels = 1.0;
            for &i in &self.sizing.axes {
                let [coarse, fine] =
                    [self.axis_error(&set, i, RANKED[0])?, self.axis_error(&set, i, RANKED[1])?];
                texels *= needed(coarse, fine, 0.5 * self.sizing.error);
            }
            ranked.push((texels, set));
        }
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        Ok(ranked.into_iter().take(FINALISTS).map(|(_, set)| set).collect())
    }
}

/// The length at which an axis would leave `error`, from what it leaves at the two ranked lengths.
fn needed(coarse: f64, fine: f64, error: f64) -> f64 {
    if fine <= 0.0 {
        return RANKED[0] as f64;
    }
    let order = libm::log2((coarse / fine).max(1.2)).min(2.0);
    RANKED[1] as f64 * libm::pow(fine / error, 1.0 / order)
}

/// Combinations of lengths whose errors can add up to what is asked, fewest texels first.
fn combinations(choices: &[Vec<(usize, f64)>], error: f64) -> Vec<Vec<usize>> {
    let mut all: Vec<(usize, f64, Vec<usize>)> = vec![(1, 0.0, Vec::new())];
    for list in choices {
        let mut wider = Vec::new();
        for (texels, sum, lens) in &all {
            for (len, e) in list {
                let lens = lens.iter().copied().chain([*len]).collect();
                wider.push((texels * len, sum + e, lens));
            }
        }
        all = wider;
    }
    // errors of two axes often cancel in part, so sums above are worth a trial
    all.retain(|(_, sum, _)| *sum <= 1.8 * error);
    all.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    all.into_iter().map(|(_, _, lens)| lens).collect()
}

/// Warps to try on an axis: its own first, then those that a shader decodes cheaply.
fn warps(axis: &Axis, all: &[Axis]) -> Vec<Warp> {
    let mut list =
        vec![axis.warp.clone(), Warp::Linear, Warp::Power(0.5), Warp::Power(0.65), Warp::OneMinusPower(0.5)];
    if axis.quantity.base_id() == "mu" && all.iter().any(|a| a.quantity.base_id() == "alpha") {
        let coupled =
            |power, scale, exponent| Warp::Coupled { to: "alpha".to_owned(), power, scale, exponent };
        list.extend([
            coupled(2.0, 1.0, 1.0),
            coupled(2.5, 2.0, 1.0),
            coupled(3.0, 3.0, 1.0),
            coupled(4.0, 16.0, 0.5),
        ]);
    }
    let mut kept: Vec<Warp> = Vec::new();
    for warp in list {
        if !kept.contains(&warp) {
            kept.push(warp);
        }
    }
    kept
}
