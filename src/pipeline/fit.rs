//! Texels fitted to the reader: the truth at a fine grid of points, and the values that read closest to it.

use super::PipelineError;
use crate::cancel::{Cancel, Tell};
use crate::grid::fit::{Objective, Samples, places, places_count};
use crate::grid::layout::Point;
use crate::grid::{Grid, Table};
use crate::integrate::{MAX_CHANNELS, Sums};
use crate::plan::PlannedTable;
use crate::tables::Bound;
use crate::tables::driver::at_points;
use crate::verify::reconstruction::in_practical_domain;
use rayon::prelude::*;

/// Intervals into which a cell is divided along each axis, with the most points for which they are taken; the first that
/// fits is. Small tables can have a ridge within a cell, which four intervals miss.
const PER_CELL: [(usize, usize); 3] = [(8, 1 << 17), (4, 1 << 19), (2, LIMIT)];
/// The same for a trial, which only has to tell whether a table is worth the full fit.
const PER_CELL_QUICK: [(usize, usize); 2] = [(4, 1 << 14), (2, LIMIT)];
/// Most points of the truth: two intervals a cell of 1024 x 1024 texels, both ends included.
const LIMIT: usize = (2 * 1024 + 5) * (2 * 1024 + 5);

/// The values of a table for every objective, and the truth that they were fitted to.
pub(super) struct Fitted {
    samples: Samples,
    truth: Vec<(Point, Sums)>,
    /// Is a point of the truth in the practical domain?
    practical: Vec<bool>,
    least_squares: Vec<f64>,
    minimax: Vec<f64>,
}

/// Eighths of the exact, the least-squares and the minimax values, in the order of [`Objective::ALL`]; they add up to eight.
///
/// Reading is linear in the texels, so that a blend of two is at most as far off as the farther one, and often nearer than both.
pub(super) type Blend = [u8; 3];

/// The whole of a blend.
pub(super) const WHOLE: u8 = 8;

/// All of one.
pub(super) fn pure(objective: Objective) -> Blend {
    Objective::ALL.map(|o| if o == objective { WHOLE } else { 0 })
}

/// Weights of a blend.
pub(super) fn weights(blend: Blend) -> [f64; 3] {
    blend.map(|part| f64::from(part) / f64::from(WHOLE))
}

/// How a channel reads over a part of the domain.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Figures {
    pub(super) largest: f64,
    /// Number of the point of the largest.
    pub(super) at: usize,
    /// By area in axis coordinates.
    pub(super) mean: f64,
}

impl Figures {
    fn see(&mut self, at: usize, area: f64, error: f64) {
        self.mean += area * error;
        if error > self.largest {
            (self.largest, self.at) = (error, at);
        }
    }
}

/// Sums over areas become means.
fn over(figures: &mut [Figures; 2], areas: [f64; 2]) {
    figures.iter_mut().zip(areas).filter(|(_, area)| *area > 0.0).for_each(|(f, area)| f.mean /= area);
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

    /// Number of points of the truth.
    pub(super) fn points(&self) -> u64 {
        self.samples.len() as u64
    }

    /// A point of the truth.
    pub(super) fn point(&self, i: usize) -> &Point {
        &self.truth[i].0
    }

    /// The texels of a channel as a blend, `[texel]`.
    pub(super) fn blended(&self, blend: Blend, channel: usize, channels: usize, exact: &[f64]) -> Vec<f64> {
        let of = |values: &[f64], i: usize| values[i * channels + channel];
        let one = |i: usize| {
            let parts = Objective::ALL.iter().zip(weights(blend)).filter(|(_, part)| *part > 0.0);
            parts.map(|(o, part)| part * of(self.values(*o, exact), i)).sum()
        };
        (0..exact.len() / channels).map(one).collect()
    }

    /// How blends of a channel read at these points before they are stored, where the shader takes the channel as it is.
    pub(super) fn figures_of_blends(
        &self,
        (channel, channels): (usize, usize),
        exact: &[f64],
        blends: &[Blend],
    ) -> Vec<[Figures; 2]> {
        let errors = Objective::ALL.map(|o| {
            let mut read = self.samples.read(&self.blended(pure(o), channel, channels, exact));
            read.iter_mut().zip(&self.truth).for_each(|(r, t)| *r -= t.1[channel]);
            read
        });
        let of = |blend: &Blend| {
            let blend = weights(*blend);
            let (mut figures, mut areas) = ([Figures::default(); 2], [0.0; 2]);
            for (i, area) in self.samples.areas().iter().enumerate() {
                let error = errors.iter().zip(blend).map(|(e, part)| part * e[i]).sum::<f64>().abs();
                for part in 0..=usize::from(self.practical[i]) {
                    areas[part] += area;
                    figures[part].see(i, *area, error);
                }
            }
            over(&mut figures, areas);
            figures
        };
        blends.par_iter().map(of).collect()
    }

    /// How stored values read at these points: for each channel as measured, over the whole and the practical domain.
    pub(super) fn figures(&self, bound: &Bound, stored: &[f64]) -> Vec<[Figures; 2]> {
        let n = bound.spec.layout.channels.len();
        let reads: Vec<Vec<f64>> = (0..n)
            .map(|c| self.samples.read(&stored.iter().skip(c).step_by(n).copied().collect::<Vec<f64>>()))
            .collect();
        let measured = bound.baker.decoded().map_or(n, <[_]>::len);
        let mut figures = vec![[Figures::default(); 2]; measured];
        let mut areas = [0.0; 2];
        for (i, ((point, value), area)) in self.truth.iter().zip(self.samples.areas()).enumerate() {
            let (mut read, mut value) = ([0.0; MAX_CHANNELS], *value);
            read.iter_mut().zip(&reads).for_each(|(r, channel)| *r = channel[i]);
            bound.baker.decode(point.values(), &mut read);
            bound.baker.decode(point.values(), &mut value);
            for part in 0..=usize::from(self.practical[i]) {
                areas[part] += area;
                for (c, f) in figures.iter_mut().enumerate() {
                    f[part].see(i, *area, (read[c] - value[c]).abs());
                }
            }
        }
        figures.iter_mut().for_each(|f| over(f, areas));
        figures
    }
}

/// Most points that a fit on a grid takes.
pub(super) fn points(grid: &Grid) -> usize {
    let count = |(k, most): &(usize, usize)| Some(places_count(grid, *k)).filter(|n| n <= most);
    PER_CELL.iter().chain(&PER_CELL_QUICK).filter_map(count).max().unwrap_or(0)
}

/// Fits every channel of a table by itself; `bound` is what bakes it, a `quick` fit has fewer points. A point where the integral fails is left out; the laws report those.
pub(super) fn fit(
    planned: &PlannedTable,
    bound: &Bound,
    table: &Table,
    tolerance: f64,
    quick: bool,
    cancel: &Cancel,
    tell: &Tell<'_>,
) -> Result<Fitted, PipelineError> {
    let grid = &table.grid;
    let choices: &[(usize, usize)] = if quick { &PER_CELL_QUICK } else { &PER_CELL };
    let per_cell = choices.iter().find(|(k, most)| places_count(grid, *k) <= *most);
    let (per_cell, _) = *per_cell.ok_or_else(|| PipelineError::Fit {
        table: planned.name().to_owned(),
        points: places_count(grid, 2),
        limit: LIMIT,
    })?;
    let places = places(grid, per_cell);
    let points: Vec<Point> = places.iter().map(|(x, _)| grid.at_coordinates(x)).collect();
    let values = at_points(bound, &points, tolerance, cancel, tell);
    let truth: Vec<(Point, f64, Sums)> = points
        .into_iter()
        .zip(&places)
        .zip(values)
        .filter_map(|((point, (_, area)), value)| Some((point, *area, value?)))
        .collect();
    cancel.check()?;
    let samples = Samples::new(grid, truth.iter().map(|(p, area, _)| (p, *area)));
    let n = table.channels.len();
    let channel = |c: usize| {
        let exact: Vec<f64> = table.values.iter().skip(c).step_by(n).copied().collect();
        let f: Vec<f64> = truth.iter().map(|t| t.2[c]).collect();
        let errors: Vec<f64> = table.errors.iter().skip(c).step_by(n).copied().collect();
        let (exact, range) = feasible(table.channels[c].range, &exact, &errors);
        (samples.least_squares(&f, &exact, range, cancel), samples.minimax(&f, &exact, range, cancel))
    };
    let (least_squares, minimax): (Vec<_>, Vec<_>) = (0..n).into_par_iter().map(channel).unzip();
    cancel.check()?;
    let interleave = |channels: &[Vec<f64>]| -> Vec<f64> {
        (0..grid.len()).flat_map(|t| channels.iter().map(move |values| values[t])).collect()
    };
    let (least_squares, minimax) = (interleave(&least_squares), interleave(&minimax));
    let practical = truth.iter().map(|(point, ..)| in_practical_domain(grid, point)).collect();
    let truth = truth.into_iter().map(|(point, _, value)| (point, value)).collect();
    Ok(Fitted { samples, truth, practical, least_squares, minimax })
}

/// Values to start from, and the range that fitted ones keep: that of the channel, whose ends stand for values beyond them by no
/// more than their own error; wider only where a value is further out, which is a finding that somebody let through.
fn feasible([lo, hi]: [f64; 2], exact: &[f64], errors: &[f64]) -> (Vec<f64>, [f64; 2]) {
    let kept = |(v, error): (&f64, &f64)| {
        let end = v.clamp(lo, hi);
        if (v - end).abs() <= *error { end } else { *v }
    };
    let kept: Vec<f64> = exact.iter().zip(errors).map(kept).collect();
    let range = [kept.iter().copied().fold(lo, f64::min), kept.iter().copied().fold(hi, f64::max)];
    (kept, range)
}
