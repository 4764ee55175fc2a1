//! Texels fitted to the reader: the truth at a fine grid of points, and the values that read closest to it.

use super::PipelineError;
use crate::grid::Table;
use crate::grid::fit::{Objective, Samples, places, places_count};
use crate::grid::layout::Point;
use crate::integrate::Sums;
use crate::recipe::PlannedTable;
use crate::tables::driver::BakeError;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// Intervals into which a cell is divided along each axis, with the most points for which they are taken; the first that
/// fits is. Small tables can have a ridge within a cell, which four intervals miss.
const PER_CELL: [(usize, usize); 3] = [(8, 1 << 17), (4, LIMIT), (2, LIMIT)];
/// Most points of the truth.
const LIMIT: usize = 1 << 22;

/// The values of a table for every objective.
pub(super) struct Fitted {
    /// Points of the truth.
    pub(super) samples: u64,
    least_squares: Vec<f64>,
    minimax: Vec<f64>,
}

impl Fitted {
    /// `[texel][channel]`; `exact` are the integrals.
    pub(super) fn values<'a>(&'a self, objective: Objective, exact: &'a [f64]) -> &'a [f64] {
        match objective {
            Objective::Exact => exact,
            Objective::LeastSquares => &self.least_squares,
            Objective::Minimax => &self.minimax,
        }
    }
}

/// Fits every channel by itself. A point where the integral fails is left out; the laws report those.
pub(super) fn fit(
    planned: &PlannedTable,
    table: &Table,
    cancel: &AtomicBool,
) -> Result<Fitted, PipelineError> {
    let grid = &table.grid;
    let per_cell = PER_CELL.into_iter().find(|(k, most)| places_count(grid, *k) <= *most);
    let (per_cell, _) = per_cell.ok_or_else(|| PipelineError::Fit {
        table: planned.name.clone(),
        points: places_count(grid, 2),
        limit: LIMIT,
    })?;
    let truth = |(x, area): &([f64; crate::grid::layout::MAX_AXES], f64)| {
        if cancel.load(Ordering::Relaxed) {
            return None;
        }
        let point = grid.at_coordinates(x);
        let value = planned.bound.baker.texel(point.values(), planned.tolerance).ok()?.value;
        Some((point, *area, value))
    };
    let truth: Vec<(Point, f64, Sums)> = places(grid, per_cell).par_iter().filter_map(truth).collect();
    if cancel.load(Ordering::Relaxed) {
        return Err(PipelineError::Bake { table: planned.name.clone(), error: BakeError::Cancelled });
    }
    let samples = Samples::new(grid, truth.iter().map(|(p, area, _)| (p, *area)));
    let n = table.channels.len();
    let channel = |c: usize| {
        let exact: Vec<f64> = table.values.iter().skip(c).step_by(n).copied().collect();
        let f: Vec<f64> = truth.iter().map(|t| t.2[c]).collect();
        let range = feasible(table.channels[c].range, &exact);
        (samples.least_squares(&f, &exact, range), samples.minimax(&f, &exact, range))
    };
    let (least_squares, minimax): (Vec<_>, Vec<_>) = (0..n).into_par_iter().map(channel).unzip();
    let interleave = |channels: &[Vec<f64>]| -> Vec<f64> {
        (0..grid.len()).flat_map(|t| channels.iter().map(move |values| values[t])).collect()
    };
    Ok(Fitted {
        samples: samples.len() as u64,
        least_squares: interleave(&least_squares),
        minimax: interleave(&minimax),
    })
}

/// The range of the channel, with the values that are outside by their own error.
fn feasible([lo, hi]: [f64; 2], exact: &[f64]) -> [f64; 2] {
    [exact.iter().copied().fold(lo, f64::min), exact.iter().copied().fold(hi, f64::max)]
}
