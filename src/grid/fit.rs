//! Texels fitted to the reader: the values whose multilinear reading is closest to the truth, instead of samples of it.
//!
//! A sample of the truth at a point reads a few texels with the weights of [`lookup::corners`], so a table is close to
//! the truth where `A v` is close to `f`: a sparse linear system, overdetermined.
//!
//! * Least squares: the v that minimises `sum w (A v - f)^2`. The weights are those of Simpson's rule in axis
//!   coordinates (`i / (len - 1)` or `(i + 1/2) / len`, so the measure of the texture, not of mu), with panels that end
//!   where the reading has its kinks: products of the reader's weights are integrated exactly.
//!   Beyond the outermost texel centres a reader clamps, one texel serves a strip and no fit can mend it: those samples count for a
//!   tenth ([`MARGIN`]), so that they do not bend the cells beside them.
//! * Minimax: the v that minimises the largest `r = |A v - f| / s`, by least `sum w r^p` for p rising from 3 to 64, each
//!   by Newton steps, which are least squares with the weights `w r^(p - 2)`. Of all that it passes the best is kept,
//!   so its largest error at the samples is never above that of the exact values. With s = 1 everything would serve the
//!   one worst cell (a split sum would read twice as wrong in the practical domain as before); s, from the errors of the
//!   exact values, is the geometric mean of the largest and the largest nearby.
//!
//! Both stay inside the range of the channel: texels that leave it are held at its end, and the others solved again.
//! Sums run in fixed order on one thread: the result does not depend on the number of threads.

use super::layout::{Grid, MAX_AXES, Point, combination};
use super::{Texel, axis::count, lookup};
use crate::cancel::Cancel;

/// What the texels of a table hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Objective {
    /// The value at the texel.
    #[default]
    Exact,
    /// The values that read with the least mean square error.
    LeastSquares,
    /// The values that read with the least largest error.
    Minimax,
}

impl Objective {
    /// All of them, in the order of reports.
    pub const ALL: [Objective; 3] = [Objective::Exact, Objective::LeastSquares, Objective::Minimax];

    /// Id in recipes and metadata.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Objective::Exact => "exact",
            Objective::LeastSquares => "least-squares",
            Objective::Minimax => "minimax",
        }
    }

    /// What it means for who uses the numbers.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Objective::Exact => "each texel holds the value at its place",
            Objective::LeastSquares => {
                "texels are not samples: together they read, interpolated, with the least mean square error"
            }
            Objective::Minimax => {
                "texels are not samples: together they read, interpolated, with the least largest error"
            }
        }
    }
}

/// What a recipe asks of its texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Texels {
    /// This, for every channel.
    Held(Objective),
    /// For each channel what reads best, if it reads better than the exact values by every measure: largest and mean error, over
    /// the whole and over the practical domain. Else the exact values.
    Better,
}

impl Default for Texels {
    fn default() -> Texels {
        Texels::Held(Objective::Exact)
    }
}

impl Texels {
    /// All of them, in the order of messages.
    pub const ALL: [Texels; 4] = [
        Texels::Held(Objective::Exact),
        Texels::Held(Objective::LeastSquares),
        Texels::Held(Objective::Minimax),
        Texels::Better,
    ];

    /// Id in recipes and metadata.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Texels::Held(objective) => objective.id(),
            Texels::Better => "auto",
        }
    }

    /// True if no fit is needed.
    #[must_use]
    pub const fn are_exact(self) -> bool {
        matches!(self, Texels::Held(Objective::Exact))
    }
}

/// Weight in least squares of what lies beyond the outermost texel centres.
pub const MARGIN: f64 = 0.1;

/// Most steps of a linear solution; the matrix is close to diagonal and needs about 30.
const STEPS: usize = 200;
/// Residual, relative to the first one, at which a solution is done.
const RESIDUAL: f64 = 1e-11;
/// The same for the steps of the minimax, each of which begins where the one before ended.
const RESIDUAL_OF_STEP: f64 = 1e-3;
/// Rounds in which texels outside the range are held.
const ROUNDS: usize = 4;
/// Powers of the minimax.
const POWERS: [f64; 14] = [3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0, 24.0, 32.0, 40.0, 48.0, 64.0];
/// Newton steps for each power.
const NEWTON: usize = 2;
/// Least weight of a sample in the minimax, relative to the largest: where errors are far below the largest, plain least
/// squares are left.
const FLOOR: f64 = 1e-6;
/// Least scale of an error in the minimax, relative to the largest error: a part of the domain that reads this well is left to
/// least squares.
const LEAST_SCALE: f64 = 1e-3;

/// Points in axis coordinates and the part of the domain that each stands for; axis 0 runs fastest.
///
/// `per_cell`, an even number, is the number of intervals into which a cell is divided along each axis. The points
/// include the texels, the edges of the domain, and the edges of the strips in which a reader clamps.
#[must_use]
pub fn places(grid: &Grid, per_cell: usize) -> Vec<([f64; MAX_AXES], f64)> {
    let lines: Vec<Vec<(f64, f64)>> = grid
        .axes()
        .iter()
        .map(|a| if a.texel == Texel::Center { a.len } else { a.len - 1 })
        .map(|cells| simpson(cells * per_cell))
        .collect();
    let total: usize = lines.iter().map(Vec::len).product();
    (0..total)
        .map(|n| {
            let chosen = combination(&lines, n);
            let area = chosen[..lines.len()].iter().map(|(_, weight)| weight).product();
            (chosen.map(|(place, _)| place), area)
        })
        .collect()
}

/// Number of [`places`].
#[must_use]
pub fn places_count(grid: &Grid, per_cell: usize) -> usize {
    let cells = grid.axes().iter().map(|a| if a.texel == Texel::Center { a.len } else { a.len - 1 });
    cells.fold(1, |n: usize, cells| n.saturating_mul(2 * (panels(cells * per_cell).len() - 1) + 1))
}

/// Parts of the first panel of an axis at which it is cut: at grazing views reflectances turn within a part of the first texel.
const CUTS: [f64; 2] = [1.0 / 16.0, 1.0 / 4.0];

/// Where panels of two intervals each end, in [0, 1].
fn panels(intervals: usize) -> Vec<f64> {
    let width = 2.0 / count(intervals);
    let cuts = CUTS.map(|cut| cut * width);
    let even = (1..=intervals / 2).map(|k| count(2 * k) / count(intervals));
    [0.0].into_iter().chain(cuts).chain(even).collect()
}

/// Simpson's rule on [0, 1] with an even number of intervals, the first two cut further: places and weights.
fn simpson(intervals: usize) -> Vec<(f64, f64)> {
    let mut line = vec![(0.0, 0.0)];
    for ends in panels(intervals).windows(2) {
        let sixth = (ends[1] - ends[0]) / 6.0;
        if let Some(last) = line.last_mut() {
            last.1 += sixth;
        }
        line.extend([(0.5 * (ends[0] + ends[1]), 4.0 * sixth), (ends[1], sixth)]);
    }
    line
}

/// The reader at many points: which texels each reads, with which weights.
#[derive(Debug)]
pub struct Samples {
    corners: usize,
    /// `[sample][corner]`.
    reads: Vec<(u32, f64)>,
    area: Vec<f64>,
    /// The area, less where the reader clamps.
    weight: Vec<f64>,
    texels: usize,
}

impl Samples {
    /// Points and the part of the domain that each stands for.
    pub fn new<'a>(grid: &Grid, points: impl Iterator<Item = (&'a Point, f64)>) -> Samples {
        let corners = 1 << grid.axes().len();
        let (reads, area, weight) = (Vec::new(), Vec::new(), Vec::new());
        let mut samples = Samples { corners, reads, area, weight, texels: grid.len() };
        for (point, area) in points {
            let (all, n) = lookup::corners(grid, point);
            samples.weight.push(if lookup::is_clamped(grid, point) { MARGIN * area } else { area });
            // a grid has at most 2^26 texels
            samples.reads.extend(all[..n].iter().map(|(t, w)| (u32::try_from(*t).unwrap_or(u32::MAX), *w)));
            samples.area.push(area);
        }
        samples
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.area.len()
    }

    /// The part of the domain that each point stands for.
    #[must_use]
    pub fn areas(&self) -> &[f64] {
        &self.area
    }

    /// Are there none?
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.area.is_empty()
    }

    /// What a reader gets from `values`, one a texel, at every point.
    #[must_use]
    pub fn read(&self, values: &[f64]) -> Vec<f64> {
        let one = |reads: &[(u32, f64)]| reads.iter().map(|(t, w)| w * values[*t as usize]).sum();
        self.reads.chunks_exact(self.corners).map(one).collect()
    }

    /// Largest `|A v - f|`.
    #[must_use]
    pub fn largest(&self, values: &[f64], truth: &[f64]) -> f64 {
        self.read(values).iter().zip(truth).map(|(r, f)| (r - f).abs()).fold(0.0, f64::max)
    }

    /// `A' y`: what the samples say to each texel.
    fn gather(&self, y: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.texels];
        for (reads, y) in self.reads.chunks_exact(self.corners).zip(y) {
            for (t, w) in reads {
                out[*t as usize] += w * y;
            }
        }
        out
    }

    /// Diagonal of `A' W A`.
    fn diagonal(&self, weights: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; self.texels];
        for (reads, y) in self.reads.chunks_exact(self.corners).zip(weights) {
            for (t, w) in reads {
                out[*t as usize] += w * w * y;
            }
        }
        out
    }

    /// The values in `range` that minimise the mean square error, from `start`.
    ///
    /// A texel that no sample reads keeps its value. Stopped, it is what the steps until then came to. Accuracy: relative 1e-11 of the residual of the normal equations;
    /// where the range binds, the texels that are held are those that left it in up to four rounds, which is nearly,
    /// not always, the best set.
    #[must_use]
    pub fn least_squares(&self, truth: &[f64], start: &[f64], range: [f64; 2], cancel: &Cancel) -> Vec<f64> {
        self.weighted(&self.weight, truth, start, (range, RESIDUAL), cancel)
    }

    /// The values in `range` that minimise the largest of `|A v - f| / s`, as far as powers up to 64 go; from `start`. s is
    /// a scale of the errors of `start`, so that where the table
    /// reads well does not pay in full for where it does not. At the samples the largest error is at most that of `start`.
    #[must_use]
    pub fn minimax(&self, truth: &[f64], start: &[f64], range: [f64; 2], cancel: &Cancel) -> Vec<f64> {
        let errors = |values: &[f64]| -> Vec<f64> {
            self.read(values).iter().zip(truth).map(|(r, f)| (r - f).abs()).collect()
        };
        let Some(scale) = self.scale(&errors(start)) else { return start.to_vec() };
        let relative = |values: &[f64]| -> (Vec<f64>, f64) {
            let all: Vec<f64> = errors(values).iter().zip(&scale).map(|(e, s)| e / s).collect();
            let largest = all.iter().copied().fold(0.0, f64::max);
            (all, largest)
        };
        let mut best = (relative(start).1, start.to_vec());
        let mut values = self.least_squares(truth, start, range, cancel);
        for p in POWERS.iter().flat_map(|p| [*p; NEWTON]) {
            let (errors, largest) = relative(&values);
            if largest < best.0 {
                best = (largest, values.clone());
            }
            if largest <= 0.0 || cancel.is_set() {
                break;
            }
            let weight =
                |((e, s), a): ((&f64, &f64), &f64)| a / (s * s) * libm::pow(e / largest, p - 2.0).max(FLOOR);
            let weights: Vec<f64> = errors.iter().zip(&scale).zip(&self.area).map(weight).collect();
            let next = self.weighted(&weights, truth, &values, (range, RESIDUAL_OF_STEP), cancel);
            values.iter_mut().zip(next).for_each(|(v, n)| *v += (n - *v) / (p - 1.0));
        }
        if relative(&values).1 < best.0 { values } else { best.1 }
    }

    /// For each sample the geometric mean of two of `errors`: the largest round the texels that it reads (not below
    /// `LEAST_SCALE` of the largest), and the largest of all. None if all are 0.
    fn scale(&self, errors: &[f64]) -> Option<Vec<f64>> {
        let mut round = vec![0.0_f64; self.texels];
        let read = |(_, w): &&(u32, f64)| *w > 0.0;
        for (reads, e) in self.reads.chunks_exact(self.corners).zip(errors) {
            for (t, _) in reads.iter().filter(read) {
                round[*t as usize] = round[*t as usize].max(*e);
            }
        }
        let largest = errors.iter().copied().fold(0.0, f64::max);
        let one = |reads: &[(u32, f64)]| {
            let local = reads.iter().filter(read).map(|(t, _)| round[*t as usize]).fold(0.0, f64::max);
            (local.max(LEAST_SCALE * largest) * largest).sqrt()
        };
        (largest > 0.0).then(|| self.reads.chunks_exact(self.corners).map(one).collect())
    }

    /// Least squares with any weights, inside a range.
    fn weighted(
        &self,
        weights: &[f64],
        truth: &[f64],
        start: &[f64],
        ([lo, hi], residual): ([f64; 2], f64),
        cancel: &Cancel,
    ) -> Vec<f64> {
        let diagonal = self.diagonal(weights);
        let mut free: Vec<bool> = diagonal.iter().map(|d| *d > 0.0).collect();
        let mut values = start.to_vec();
        for _ in 0..ROUNDS {
            self.solve((weights, truth), (&diagonal, &free), residual, &mut values, cancel);
            let mut held = false;
            for (v, free) in values.iter_mut().zip(&mut free).filter(|(v, _)| !(lo..=hi).contains(*v)) {
                (*v, *free, held) = (v.clamp(lo, hi), false, true);
            }
            if !held {
                break;
            }
        }
        values
    }

    /// Conjugate gradients on the normal equations of the free texels, scaled by their diagonal.
    fn solve(
        &self,
        (weights, truth): (&[f64], &[f64]),
        (diagonal, free): (&[f64], &[bool]),
        residual: f64,
        values: &mut [f64],
        cancel: &Cancel,
    ) {
        let apply = |v: &[f64]| {
            let mut read = self.read(v);
            read.iter_mut().zip(weights).for_each(|(r, w)| *r *= w);
            let mut out = self.gather(&read);
            out.iter_mut().zip(free).for_each(|(o, f)| *o = if *f { *o } else { 0.0 });
            out
        };
        let misfit: Vec<f64> =
            self.read(values).iter().zip(truth).zip(weights).map(|((r, f), w)| w * (f - r)).collect();
        let mut rest = self.gather(&misfit);
        rest.iter_mut().zip(free).for_each(|(r, f)| *r = if *f { *r } else { 0.0 });
        let scaled = |rest: &[f64]| -> Vec<f64> {
            rest.iter().zip(diagonal).map(|(r, d)| if *d > 0.0 { r / d } else { 0.0 }).collect()
        };
        let mut z = scaled(&rest);
        let mut rho = dot(&rest, &z);
        let target = residual * residual * rho;
        let mut direction = z.clone();
        for _ in 0..STEPS {
            if rho <= target || rho <= 0.0 || cancel.is_set() {
                break;
            }
            let image = apply(&direction);
            let curvature = dot(&direction, &image);
            if curvature <= 0.0 {
                break;
            }
            let step = rho / curvature;
            values.iter_mut().zip(&direction).for_each(|(v, d)| *v += step * d);
            rest.iter_mut().zip(&image).for_each(|(r, i)| *r -= step * i);
            z = scaled(&rest);
            let next = dot(&rest, &z);
            let along = next / rho;
            direction.iter_mut().zip(&z).for_each(|(d, z)| *d = z + along * *d);
            rho = next;
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
