//! The fallback for models that declare no chart: adaptive subdivision of the hemisphere.
//!
//! Cells of (theta, phi), phi from the azimuth of wo, are summed by the rules of degree 7 and 5 of Genz and Malik (17
//! common points). The cell with the largest difference of the two is halved along the axis with the larger fourth
//! difference, until the sum of the differences meets the tolerance or [`MAX_CELLS`] are used up.
//!
//! Honesty: the rule of degree 7 is the value, twice its difference to degree 5 the error. Where the halves of a cell
//! disagree with the whole by more than their own errors say, the rules did not see what is in there, and the errors
//! of the halves are raised by that factor. The first cells are fine around the mirror direction and wo, where lobes
//! peak; a lobe narrower than 1e-3 elsewhere may be missed, and along an edge of infinite slope the error may be ten
//! times its estimate: such models should declare a chart.
//!
//! Measured (`tests/quadrature_charts.rs`): 1e-5 takes 2000 to 13 000 evaluations for lobes wider than 0.05, and the
//! error stays below its estimate, mostly by a factor of ten and more; an integrand with a step needs 450 000 for 1e-4.
//!
//! Source: [Genz and Malik 1980](crate::cite::GENZ_MALIK_1980); the subdivision is that of `DCUHRE`.

use super::nodes::Nodes;
use super::stop::{Estimate, MAX_CHANNELS, ROUNDING, Sums};
use super::view::View;
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::f64::consts::{FRAC_PI_2, PI};

/// Most cells; 17 evaluations each.
pub const MAX_CELLS: usize = 40_000;

/// The rule in words, for metadata.
pub const NAME: &str = "adaptive subdivision, Genz-Malik rules of degree 7 and 5";

/// How many times the difference of the two rules counts as error: peaks between few cells need it.
const MARGIN: f64 = 2.0;

/// Distances from the peaks at which the first cells end, rad.
const NEAR: [f64; 3] = [0.02, 0.1, 0.4];

/// Groups of points that share their weights: centre, two distances along x and y, two kinds of corners.
const GROUPS: usize = 7;

/// Weights of a group in degree 7 and degree 5, for the mean over the cell.
const WEIGHTS: [[f64; 2]; GROUPS] = [
    [(12_824.0 - 18_240.0 + 1_600.0) / 19_683.0, (729.0 - 1_900.0 + 200.0) / 729.0],
    [980.0 / 6_561.0, 245.0 / 486.0],
    [980.0 / 6_561.0, 245.0 / 486.0],
    [1_020.0 / 19_683.0, 65.0 / 1_458.0],
    [1_020.0 / 19_683.0, 65.0 / 1_458.0],
    [200.0 / 19_683.0, 25.0 / 729.0],
    [6_859.0 / 78_732.0, 0.0],
];

struct Cell {
    /// Lower ends and lengths in theta and phi.
    from: [f64; 2],
    length: [f64; 2],
    value: Sums,
    error: Sums,
    /// Largest error of the channels: the key of the heap.
    worst: f64,
    /// Axis along which it should be halved.
    axis: usize,
    /// Number of creation, so that ties have an order.
    number: usize,
}

impl PartialEq for Cell {
    fn eq(&self, other: &Cell) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Cell {}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Cell) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Cell {
    fn cmp(&self, other: &Cell) -> Ordering {
        self.worst.total_cmp(&other.worst).then(other.number.cmp(&self.number))
    }
}

/// Integrates `channels` channels over the hemisphere, as [`ladder::integrate`](super::ladder::integrate) does.
pub fn integrate(
    view: View,
    channels: usize,
    tolerance: f64,
    add: &mut dyn FnMut(&Nodes, &mut Sums),
) -> Estimate {
    let mut work = Work { nodes: Nodes::new(view), view, channels, cells: 0, add };
    let mut heap = BinaryHeap::new();
    for theta in breaks_theta(view).windows(2) {
        for phi in breaks_phi().windows(2) {
            heap.push(work.cell([theta[0], phi[0]], [theta[1] - theta[0], phi[1] - phi[0]]));
        }
    }
    let mut error = total(&heap, |c| c.error);
    // sums of errors are kept up to date by differences, and made anew when they say that the work is done
    while work.cells < MAX_CELLS {
        if !exceeds(&error, channels, tolerance) {
            error = total(&heap, |c| c.error);
            if !exceeds(&error, channels, tolerance) {
                break;
            }
        }
        let Some(cell) = heap.pop() else { break };
        let halves = work.halve(&cell);
        for (c, e) in error.iter_mut().enumerate().take(channels) {
            *e += halves[0].error[c] + halves[1].error[c] - cell.error[c];
        }
        heap.extend(halves);
    }
    let value = total(&heap, |c| c.value);
    let magnitude = total(&heap, |c| c.value.map(f64::abs));
    let mut error = total(&heap, |c| c.error);
    for (e, m) in error.iter_mut().zip(&magnitude).take(channels) {
        *e += m * ROUNDING;
    }
    Estimate { value, error, evaluations: u32::try_from(17 * work.cells).unwrap_or(u32::MAX) }
}

/// NaN counts as done: it does not get better by subdivision.
fn exceeds(error: &Sums, channels: usize, tolerance: f64) -> bool {
    error[..channels].iter().any(|e| *e > tolerance) && !error[..channels].iter().any(|e| e.is_nan())
}

/// The sum over the cells, in the order of their creation.
fn total(heap: &BinaryHeap<Cell>, part: impl Fn(&Cell) -> Sums) -> Sums {
    let mut cells: Vec<&Cell> = heap.iter().collect();
    cells.sort_unstable_by_key(|c| c.number);
    let mut sums = [0.0; MAX_CHANNELS];
    for cell in cells {
        for (s, p) in sums.iter_mut().zip(part(cell)) {
            *s += p;
        }
    }
    sums
}

fn breaks_theta(view: View) -> Vec<f64> {
    let theta = libm::atan2(view.sine(), view.mu);
    let mut breaks = vec![0.0, FRAC_PI_2];
    for near in NEAR.into_iter().flat_map(|n| [theta - n, theta + n]).chain([theta]) {
        if near > 1e-9 && near < FRAC_PI_2 - 1e-9 {
            breaks.push(near);
        }
    }
    breaks.sort_by(f64::total_cmp);
    breaks
}

/// From wo (0) over the mirror direction (pi) and back.
fn breaks_phi() -> Vec<f64> {
    let mut breaks = vec![0.0, FRAC_PI_2, PI, 3.0 * FRAC_PI_2, 2.0 * PI];
    for near in NEAR {
        breaks.extend([near, PI - near, PI + near, 2.0 * PI - near]);
    }
    breaks.sort_by(f64::total_cmp);
    breaks
}

struct Work<'a> {
    nodes: Nodes,
    view: View,
    channels: usize,
    cells: usize,
    add: &'a mut dyn FnMut(&Nodes, &mut Sums),
}

impl Work<'_> {
    fn cell(&mut self, from: [f64; 2], length: [f64; 2]) -> Cell {
        let inner = (9.0f64 / 70.0).sqrt();
        let outer = (9.0f64 / 10.0).sqrt();
        let corner = (9.0f64 / 19.0).sqrt();
        let corners = |x: f64| [[x, x], [x, -x], [-x, x], [-x, -x]];
        let mut sums = [[0.0; MAX_CHANNELS]; GROUPS];
        self.points(from, length, &[[0.0, 0.0]], &mut sums[0]);
        self.points(from, length, &[[inner, 0.0], [-inner, 0.0]], &mut sums[1]);
        self.points(from, length, &[[0.0, inner], [0.0, -inner]], &mut sums[2]);
        self.points(from, length, &[[outer, 0.0], [-outer, 0.0]], &mut sums[3]);
        self.points(from, length, &[[0.0, outer], [0.0, -outer]], &mut sums[4]);
        self.points(from, length, &corners(outer), &mut sums[5]);
        self.points(from, length, &corners(corner), &mut sums[6]);
        self.cells += 1;
        self.judge(from, length, &sums)
    }

    /// Adds the integrand times the area of the cell at points given in (-1, 1)^2.
    fn points(&mut self, from: [f64; 2], length: [f64; 2], points: &[[f64; 2]], sums: &mut Sums) {
        let area = length[0] * length[1];
        self.nodes.len = points.len();
        for (i, point) in points.iter().enumerate() {
            let at = |k: usize| from[k] + 0.5 * length[k] * (1.0 + point[k]);
            let (sin_phi, cos_phi) = libm::sincos(self.view.phi + at(1));
            let (sin, cos) = libm::sincos(at(0));
            let wi = DVec3::new(sin * cos_phi, sin * sin_phi, cos);
            self.nodes.set(i, wi, area * sin);
        }
        (self.add)(&self.nodes, sums);
    }

    fn judge(&self, from: [f64; 2], length: [f64; 2], sums: &[Sums; GROUPS]) -> Cell {
        let (mut value, mut error) = ([0.0; MAX_CHANNELS], [0.0; MAX_CHANNELS]);
        let (mut worst, mut fourth) = (0.0f64, [0.0f64; 2]);
        for c in 0..self.channels {
            let rule =
                |degree: usize| -> f64 { WEIGHTS.iter().zip(sums).map(|(w, s)| w[degree] * s[c]).sum() };
            value[c] = rule(0);
            error[c] = MARGIN * (value[c] - rule(1)).abs();
            // NaN must come up first, not hide at the bottom of the heap
            worst = if error[c].is_nan() { f64::INFINITY } else { worst.max(error[c]) };
            for (k, f) in fourth.iter_mut().enumerate() {
                let bend = |s: f64| s - 2.0 * sums[0][c];
                *f = f.max((bend(sums[1 + k][c]) - bend(sums[3 + k][c]) / 7.0).abs());
            }
        }
        // equal differences: the longer side
        let even = (fourth[0] - fourth[1]).abs() <= 1e-10 * fourth[0].max(fourth[1]);
        let axis = usize::from(if even { length[1] > length[0] } else { fourth[1] > fourth[0] });
        Cell { from, length, value, error, worst, axis, number: self.cells }
    }

    fn halve(&mut self, cell: &Cell) -> [Cell; 2] {
        let mut length = cell.length;
        length[cell.axis] *= 0.5;
        let mut second = cell.from;
        second[cell.axis] += length[cell.axis];
        let mut halves = [self.cell(cell.from, length), self.cell(second, length)];
        let mut raise = 1.0f64;
        for c in 0..self.channels {
            let apart = (halves[0].value[c] + halves[1].value[c] - cell.value[c]).abs();
            let errors = halves[0].error[c] + halves[1].error[c];
            // below the rounding of the whole nothing is to be learnt
            if apart > errors && apart > 1e-13 * cell.value[c].abs() {
                raise = raise.max((apart / errors.max(f64::MIN_POSITIVE)).min(1e3));
            }
        }
        for half in &mut halves {
            half.error.iter_mut().for_each(|e| *e *= raise);
            half.worst *= raise;
        }
        halves
    }
}
