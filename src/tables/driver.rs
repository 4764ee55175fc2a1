//! The one loop over texels: threads, progress and cancelling live here and nowhere else.
//!
//! Runs of texels are computed in parallel and collected in order; each texel depends only on its coordinates, so the bytes do
//! not depend on the number of threads.

use super::{Bound, TexelError};
use crate::cancel::{Cancel, Cancelled};
use crate::grid::Table;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What to do with a texel whose error estimate stays above the tolerance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OnMiss {
    /// It is an error.
    #[default]
    Fail,
    /// It is counted and reported in the file.
    Report,
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

/// The results of one task: a run of texels.
struct Row {
    values: Vec<f64>,
    errors: Vec<f64>,
    evaluations: Vec<u32>,
}

/// Bakes a table on the current rayon pool.
///
/// # Errors
/// [`BakeError`]; the first texel in order is named, whatever the number of threads.
pub fn bake(bound: &Bound, options: Options<'_>) -> Result<Table, BakeError> {
    let grid = &bound.spec.grid;
    let len = grid.len();
    // small enough that a one-row table keeps every thread busy, large enough that a task is worth its keeping
    let width = (len / 32).clamp(1, CHUNK);
    let rows = len.div_ceil(width);
    let done = AtomicUsize::new(0);
    let results: Vec<Result<Row, BakeError>> = (0..rows)
        .into_par_iter()
        .map(|y| {
            let texels = y * width..len.min((y + 1) * width);
            let count = texels.len();
            let row = bake_row(bound, texels, options)?;
            (options.progress)(done.fetch_add(count, Ordering::Relaxed) + count);
            Ok(row)
        })
        .collect();
    let mut table = Table {
        grid: grid.clone(),
        channels: bound.spec.channels(),
        values: Vec::new(),
        errors: Vec::new(),
        evaluations: Vec::new(),
    };
    for row in results {
        let row = row?;
        table.values.extend(row.values);
        table.errors.extend(row.errors);
        table.evaluations.extend(row.evaluations);
    }
    if options.on_miss == OnMiss::Fail {
        check_tolerance(&table, options.tolerance)?;
    }
    Ok(table)
}

fn bake_row(bound: &Bound, texels: std::ops::Range<usize>, options: Options<'_>) -> Result<Row, BakeError> {
    let channels = bound.spec.layout.channels.len();
    let grid = &bound.spec.grid;
    let mut row = Row { values: Vec::new(), errors: Vec::new(), evaluations: Vec::new() };
    for texel in texels {
        options.cancel.check()?;
        let e = bound.baker.texel(grid.texel(texel).values(), options.tolerance).map_err(|error| {
            BakeError::Texel {
                texel,
                place: super::place(grid, texel),
                channels: bound.spec.layout.ids().map(str::to_owned).collect(),
                error,
            }
        })?;
        row.values.extend_from_slice(&e.value[..channels]);
        row.errors.extend_from_slice(&e.error[..channels]);
        row.evaluations.push(e.evaluations);
    }
    Ok(row)
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
