//! The one loop over texels: threads, progress and cancelling live here and nowhere else.
//!
//! Runs of texels are computed in parallel and collected in order; a texel depends only on the coordinates of its group
//! ([`Baker::group`](super::Baker::group)), and groups are counted from the first texel of the table, so that the bytes do not depend on
//! the number of threads.

use super::{Bound, TexelError};
use crate::cancel::{Cancel, Cancelled, Steps, Tell};
use crate::grid::Table;
use crate::grid::layout::Point;
use crate::integrate::{Estimate, Sums};
use rayon::prelude::*;
use serde::Serialize;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What to do with a texel whose error estimate stays above the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum OnMiss {
    /// It is an error.
    #[default]
    Fail,
    /// It is counted and reported in the file.
    Report,
}

impl OnMiss {
    /// All of them, in the order of messages.
    pub const ALL: [OnMiss; 2] = [OnMiss::Fail, OnMiss::Report];

    /// Id in recipes.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            OnMiss::Fail => "fail",
            OnMiss::Report => "report",
        }
    }
}

/// How to bake.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// Absolute tolerance of each channel.
    pub tolerance: f64,
    /// What to do with a texel that misses it.
    pub on_miss: OnMiss,
    /// Set from outside to stop.
    pub cancel: &'a Cancel,
    /// Called with the number of finished texels.
    pub progress: &'a (dyn Fn(usize) + Sync),
}

impl std::fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Options").field("tolerance", &self.tolerance).field("on_miss", &self.on_miss).finish()
    }
}

/// Why a table could not be baked.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BakeError {
    /// A texel has no value.
    #[error("texel {texel} ({place}): {}", .error.of(.channels.iter().map(String::as_str)))]
    Texel {
        /// Texel number.
        texel: usize,
        /// Its coordinates.
        place: String,
        /// Ids of the channels of the table.
        channels: Vec<String>,
        /// Why.
        error: TexelError,
    },
    /// Texels that miss the tolerance.
    #[error(
        "{count} texels miss the tolerance {tolerance:e}; the worst is texel {texel} ({place}) with an estimated error of {estimate:e}. \
         Ask for a larger tolerance, move the axis off the stiff corner, or set `on-miss = \"report\"`"
    )]
    Missed {
        /// How many.
        count: usize,
        /// The tolerance.
        tolerance: f64,
        /// The worst texel.
        texel: usize,
        /// Its coordinates.
        place: String,
        /// Its estimate.
        estimate: f64,
    },
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Most texels in one task.
const CHUNK: usize = 128;

/// Where the results of one task go: a run of texels.
struct Row<'a> {
    values: &'a mut [f64],
    errors: &'a mut [f64],
    evaluations: &'a mut [u32],
}

/// Bakes a table on the current rayon pool.
///
/// # Errors
/// [`BakeError`]; the first texel in order is named, whatever the number of threads.
pub fn bake(bound: &Bound, options: Options<'_>) -> Result<Table, BakeError> {
    let grid = &bound.spec.grid;
    let len = grid.len();
    // small enough that a one-row table keeps every thread busy, large enough that a task is worth its keeping
    let width = (len / 32).clamp(1, CHUNK).next_multiple_of(bound.baker.group());
    let n = bound.spec.layout.channels.len();
    let mut table = Table {
        grid: grid.clone(),
        channels: bound.spec.channels(),
        values: vec![0.0; len * n],
        errors: vec![0.0; len * n],
        evaluations: vec![0; len],
    };
    let done = AtomicUsize::new(0);
    // into the table at once: it is all the memory that a bake needs
    let parts = table.values.par_chunks_mut(width * n).zip(table.errors.par_chunks_mut(width * n));
    let rows: Vec<Result<(), BakeError>> = parts
        .zip(table.evaluations.par_chunks_mut(width))
        .enumerate()
        .map(|(y, ((values, errors), evaluations))| {
            let count = evaluations.len();
            bake_row(bound, y * width, Row { values, errors, evaluations }, options)?;
            (options.progress)(done.fetch_add(count, Ordering::Relaxed) + count);
            Ok(())
        })
        .collect();
    rows.into_iter().collect::<Result<(), BakeError>>()?;
    if options.on_miss == OnMiss::Fail {
        check_tolerance(&table, options.tolerance)?;
    }
    Ok(table)
}

/// Bakes the texels from `first` on that a row has room for.
fn bake_row(bound: &Bound, first: usize, row: Row<'_>, options: Options<'_>) -> Result<(), BakeError> {
    let n = bound.spec.layout.channels.len();
    let grid = &bound.spec.grid;
    let texels: Vec<_> = (first..first + row.evaluations.len()).map(|texel| grid.texel(texel)).collect();
    let mut slots = row.values.chunks_exact_mut(n).zip(row.errors.chunks_exact_mut(n)).zip(row.evaluations);
    let group = bound.baker.group();
    for (part, start) in texels.chunks(group).zip((first..).step_by(group)) {
        options.cancel.check()?;
        let results = made(bound, part, options.tolerance);
        for (result, texel) in results.into_iter().zip(start..) {
            let e = result.map_err(|error| BakeError::Texel {
                texel,
                place: super::place(grid, texel),
                channels: bound.spec.layout.ids().map(str::to_owned).collect(),
                error,
            })?;
            let Some(((values, errors), evaluations)) = slots.next() else { break };
            values.copy_from_slice(&e.value[..n]);
            errors.copy_from_slice(&e.error[..n]);
            *evaluations = e.evaluations;
        }
    }
    Ok(())
}

/// One texel of a table as [`bake`] makes it: with the others of its group.
///
/// # Errors
/// Those of the texel.
pub fn bake_again(bound: &Bound, texel: usize, tolerance: f64) -> Result<Estimate, TexelError> {
    let (grid, group) = (&bound.spec.grid, bound.baker.group());
    let first = texel - texel % group;
    let points: Vec<Point> = (first..grid.len().min(first + group)).map(|t| grid.texel(t)).collect();
    made(bound, &points, tolerance).swap_remove(texel - first)
}

/// The values at points that are no texels, in groups as texels are, without their estimates: none where an integral fails, and after a
/// stop.
pub(crate) fn at_points(
    bound: &Bound,
    points: &[Point],
    tolerance: f64,
    cancel: &Cancel,
    tell: &Tell<'_>,
) -> Vec<Option<Sums>> {
    let steps = Steps::new(points.len(), tell);
    let group = |part: &[Point]| {
        if cancel.is_set() {
            return vec![None; part.len()];
        }
        let results = made(bound, part, tolerance);
        part.iter().for_each(|_| steps.step());
        results.into_iter().map(|e| e.ok().map(|e| e.value)).collect()
    };
    points.par_chunks(bound.baker.group()).flat_map_iter(group).collect()
}

/// What the baker makes of a group.
fn made(bound: &Bound, group: &[Point], tolerance: f64) -> Vec<Result<Estimate, TexelError>> {
    let at: Vec<&[f64]> = group.iter().map(Point::values).collect();
    bound.baker.texels(&at, tolerance)
}

/// Number of texels of which some channel's estimate is above the tolerance.
#[must_use]
pub fn missed(table: &Table, tolerance: f64) -> usize {
    table.errors.chunks(table.channels.len()).filter(|e| e.iter().any(|e| !within(*e, tolerance))).count()
}

/// NaN is never within.
fn within(error: f64, tolerance: f64) -> bool {
    error <= tolerance
}

fn check_tolerance(table: &Table, tolerance: f64) -> Result<(), BakeError> {
    let count = missed(table, tolerance);
    if count == 0 {
        return Ok(());
    }
    let mut worst = 0;
    for (i, e) in table.errors.iter().enumerate() {
        if *e > table.errors[worst] {
            worst = i;
        }
    }
    let texel = worst / table.channels.len();
    let place = super::place(&table.grid, texel);
    Err(BakeError::Missed { count, tolerance, texel, place, estimate: table.errors[worst] })
}
