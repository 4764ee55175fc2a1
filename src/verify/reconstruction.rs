//! What the shader will read: the error of bilinear reading at the stored precision, against fresh integrals taken
//! between the texels, over the whole domain and over its practical part.
//!
//! Points: the middles of all cells, and for centre axes the edges of the domain (where a reader clamps). Where
//! that is more than a limit, every n-th one. Then the cells of the largest errors are searched on a finer
//! grid of 5 x 5 points each, and the neighbourhoods of the largest errors among those on finer grids again, so that neither a corner
//! nor the ridge of grazing views slips through.

use crate::cancel::{Cancel, Tell, untold};
use crate::grid::axis::count;
use crate::grid::layout::{MAX_AXES, Point, combination};
use crate::grid::provenance::{Reconstruction, Spread};
use crate::grid::table::{Extreme, named};
use crate::grid::{Grid, Texel, lookup};
use crate::integrate::{MAX_CHANNELS, Sums};
use crate::tables::driver::at_points;
use crate::tables::{Bound, ChannelInfo};
use rayon::prelude::*;

/// Least view cosine of the practical domain.
pub const PRACTICAL_MU: f64 = 0.05;
/// Least alpha of the practical domain: roughness 0.09.
pub const PRACTICAL_ALPHA: f64 = 0.09 * 0.09;

/// Cells that are searched more finely, of the whole and of the practical domain each.
const SEARCHED: usize = 8;

/// Sizes of the neighbourhoods that are searched then, in cells, and of how many points of the whole and of the practical domain each.
const ZOOMS: [f64; 2] = [0.25, 0.06];
const ZOOMED: usize = 2;

/// Points between the texels with fresh integrals, made once and compared with every stored form of a table.
#[derive(Debug)]
pub struct Probe<'a> {
    cancel: &'a Cancel,
    bound: &'a Bound,
    tolerance: f64,
    points: Vec<Fresh>,
}

#[derive(Debug, Clone)]
struct Fresh {
    x: [f64; MAX_AXES],
    point: Point,
    value: Sums,
}

struct Compared<'a> {
    fresh: &'a Fresh,
    /// Largest error of the channels, its channel, and the sum over channels.
    largest: f64,
    channel: usize,
    sum: f64,
}

impl<'a> Probe<'a> {
    /// Integrates at the middles of the cells, at most about `limit` of them.
    ///
    /// Points where the integral itself fails are left out; the laws report those.
    #[must_use]
    pub fn new(bound: &'a Bound, tolerance: f64, limit: usize) -> Probe<'a> {
        static NEVER: Cancel = Cancel::new();
        Probe::until(&NEVER, bound, tolerance, limit)
    }

    /// [`Probe::new`] that leaves out what is not integrated when it is stopped, then and in every measure; who stops it
    /// throws the figures away.
    #[must_use]
    pub fn until(cancel: &'a Cancel, bound: &'a Bound, tolerance: f64, limit: usize) -> Probe<'a> {
        Probe::telling(cancel, bound, tolerance, limit, &untold)
    }

    /// [`Probe::until`], telling of the points that are integrated.
    #[must_use]
    pub fn telling(
        cancel: &'a Cancel,
        bound: &'a Bound,
        tolerance: f64,
        limit: usize,
        tell: &Tell<'_>,
    ) -> Probe<'a> {
        let grid = &bound.spec.grid;
        let between: Vec<Vec<f64>> = (0..grid.axes().len()).map(|i| grid.between(i)).collect();
        let total: usize = between.iter().map(Vec::len).product();
        let step = total.div_ceil(limit.max(1));
        let chosen: Vec<[f64; MAX_AXES]> =
            (0..total).step_by(step).map(|n| combination(&between, n)).collect();
        let mut probe = Probe { cancel, bound, tolerance, points: Vec::new() };
        probe.points = probe.integrate(&chosen, tell);
        probe
    }

    /// Compares `stored` (quantised values of the table's grid), read by the reference reader, with the integrals.
    #[must_use]
    pub fn measure(&self, stored: &[f64]) -> Reconstruction {
        self.measure_on(&self.bound.spec.grid, stored)
    }

    /// The same for a reader that knows nothing of the offsets of the axes; none if there are none.
    #[must_use]
    pub fn measure_without_offset(&self, stored: &[f64]) -> Option<Reconstruction> {
        let grid = self.bound.spec.grid.without_offset()?;
        Some(self.measure_on(&grid, stored))
    }

    fn measure_on(&self, reader: &Grid, stored: &[f64]) -> Reconstruction {
        let grid = &self.bound.spec.grid;
        let regular = self.compare_all(reader, stored, &self.points);
        let mut worst: Vec<&Compared<'_>> = regular.iter().collect();
        // the sort is stable, so equal errors keep the order of the grid
        worst.sort_by(|a, b| b.largest.total_cmp(&a.largest));
        // a cell counts if a part of it is inside
        let inside = |x: &[f64; MAX_AXES]| in_practical_domain(grid, &grid.at_coordinates(x));
        let cell = |c: &&&Compared<'_>| around(grid, &c.fresh.x, 1.0).iter().any(inside);
        let practical = worst.iter().filter(cell).take(SEARCHED);
        let near = |c: &&Compared<'_>| around(grid, &c.fresh.x, 1.0);
        let cells: Vec<[f64; MAX_AXES]> =
            worst.iter().take(SEARCHED).chain(practical).flat_map(near).collect();
        let mut fine = self.integrate(&cells, &untold);
        for size in ZOOMS {
            let next = self.worst_of(reader, stored, &fine, size);
            fine.extend(self.integrate(&next, &untold));
        }
        let searched = self.compare_all(reader, stored, &fine);
        let whole = self.spread(&regular, &searched, |_| true);
        Reconstruction {
            filter: filter(grid).to_owned(),
            points: (regular.len() + searched.len()) as u64,
            whole: whole.unwrap_or_else(nothing),
            practical: has_practical(grid)
                .then(|| self.spread(&regular, &searched, |p| in_practical_domain(grid, p)))
                .flatten(),
        }
    }

    /// Points round the largest errors, of the whole and of the practical domain.
    fn worst_of(&self, reader: &Grid, stored: &[f64], fine: &[Fresh], size: f64) -> Vec<[f64; MAX_AXES]> {
        let grid = &self.bound.spec.grid;
        let mut worst = self.compare_all(reader, stored, fine);
        worst.sort_by(|a, b| b.largest.total_cmp(&a.largest));
        let practical = worst.iter().filter(|c| in_practical_domain(grid, &c.fresh.point)).take(ZOOMED);
        let chosen = worst.iter().take(ZOOMED).chain(practical);
        chosen.flat_map(|c| around(grid, &c.fresh.x, size)).collect()
    }

    /// What the errors are measured on.
    fn channels(&self) -> &[ChannelInfo] {
        self.bound.baker.decoded().unwrap_or(&self.bound.spec.layout.channels)
    }

    fn integrate(&self, points: &[[f64; MAX_AXES]], tell: &Tell<'_>) -> Vec<Fresh> {
        let grid = &self.bound.spec.grid;
        let places: Vec<Point> = points.iter().map(|x| grid.at_coordinates(x)).collect();
        let values = at_points(self.bound, &places, self.tolerance, self.cancel, tell);
        let fresh = |((x, point), value): ((&[f64; MAX_AXES], Point), Option<Sums>)| {
            let mut value = value?;
            self.bound.baker.decode(point.values(), &mut value);
            Some(Fresh { x: *x, point, value })
        };
        points.iter().zip(places).zip(values).filter_map(fresh).collect()
    }

    fn compare_all<'f>(&self, reader: &Grid, stored: &[f64], points: &'f [Fresh]) -> Vec<Compared<'f>> {
        points.par_iter().map(|fresh| self.compare(reader, stored, fresh)).collect()
    }

    fn compare<'f>(&self, reader: &Grid, stored: &[f64], fresh: &'f Fresh) -> Compared<'f> {
        let channels = self.bound.spec.layout.channels.len();
        let mut read = [0.0; MAX_CHANNELS];
        lookup::read(reader, stored, &fresh.point, &mut read[..channels]);
        self.bound.baker.decode(fresh.point.values(), &mut read);
        let channels = self.channels().len();
        let mut result = Compared { fresh, largest: 0.0, channel: 0, sum: 0.0 };
        for (c, (r, f)) in read[..channels].iter().zip(&fresh.value).enumerate() {
            let error = (r - f).abs();
            result.sum += error;
            if error > result.largest {
                result.largest = error;
                result.channel = c;
            }
        }
        result
    }

    /// The largest error of all points inside; the mean is over the regular ones only.
    fn spread(
        &self,
        regular: &[Compared<'_>],
        searched: &[Compared<'_>],
        inside: impl Fn(&Point) -> bool,
    ) -> Option<Spread> {
        let channels = self.channels();
        let (mut sum, mut n) = (0.0, 0.0);
        for c in regular.iter().filter(|c| inside(&c.fresh.point)) {
            sum += c.sum;
            n += count(channels.len());
        }
        let mut largest: Option<&Compared<'_>> = None;
        for c in regular.iter().chain(searched).filter(|c| inside(&c.fresh.point)) {
            if largest.is_none_or(|l| c.largest > l.largest) {
                largest = Some(c);
            }
        }
        let largest = largest?;
        Some(Spread {
            largest: Extreme {
                value: largest.largest,
                channel: channels[largest.channel].id.to_owned(),
                at: named(&self.bound.spec.grid, &largest.fresh.point),
            },
            mean: if n > 0.0 { sum / n } else { 0.0 },
        })
    }
}

fn nothing() -> Spread {
    Spread { largest: Extreme { value: 0.0, channel: String::new(), at: Vec::new() }, mean: 0.0 }
}

fn filter(grid: &Grid) -> &'static str {
    match grid.axes().len() {
        1 => "linear, clamped",
        2 => "bilinear, clamped",
        _ => "multilinear, clamped",
    }
}

/// A 5 x 5 grid (5^n) over a neighbourhood of `x`, its size in cells.
fn around(grid: &Grid, x: &[f64; MAX_AXES], size: f64) -> Vec<[f64; MAX_AXES]> {
    let n = grid.axes().len();
    let mut points = Vec::new();
    for mut code in 0..5usize.pow(u32::try_from(n).unwrap_or(0)) {
        let mut p = *x;
        for (p, axis) in p.iter_mut().zip(grid.axes()) {
            let cells = if axis.texel == Texel::Center { axis.len } else { axis.len - 1 };
            let t = count(code % 5) / 4.0 - 0.5;
            *p = (*p + 0.96 * size * t / count(cells)).clamp(0.0, 1.0);
            code /= 5;
        }
        points.push(p);
    }
    points
}

/// Is there an axis that the practical domain cuts?
#[must_use]
pub fn has_practical(grid: &Grid) -> bool {
    grid.axes().iter().any(|a| ["mu", "alpha"].contains(&a.quantity.base_id()))
}

/// Is a point in the practical domain?
#[must_use]
pub fn in_practical_domain(grid: &Grid, point: &Point) -> bool {
    grid.axes().iter().zip(point.values()).all(|(axis, &v)| match axis.quantity.base_id() {
        "mu" => v >= PRACTICAL_MU,
        "alpha" => v >= PRACTICAL_ALPHA,
        _ => true,
    })
}
