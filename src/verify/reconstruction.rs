//! What the shader will read: the error of bilinear reading at the stored precision, against fresh integrals taken
//! between the texels, over the whole domain and over its practical part.
//!
//! Points: the middles of all cells, and for centre axes the edges of the domain (where a reader clamps). Where
//! that is more than `limit` points, every n-th one. Then the cells of the largest errors are searched on a finer
//! grid of 5 x 5 points each, so that a corner does not slip through between two middles.

use crate::grid::axis::count;
use crate::grid::layout::{MAX_AXES, Point};
use crate::grid::provenance::{Reconstruction, Spread};
use crate::grid::table::{Extreme, named};
use crate::grid::{Grid, Texel, lookup};
use crate::tables::Bound;
use rayon::prelude::*;

/// Least view cosine of the practical domain.
pub const PRACTICAL_MU: f64 = 0.05;
/// Least alpha of the practical domain: roughness 0.09.
pub const PRACTICAL_ALPHA: f64 = 0.09 * 0.09;

/// Cells that are searched more finely.
const SEARCHED: usize = 12;

struct Compared {
    x: [f64; MAX_AXES],
    point: Point,
    /// Largest error of the channels, its channel, and the sum over channels.
    largest: f64,
    channel: usize,
    sum: f64,
}

/// Measures the reconstruction of `stored` (quantised values of the table's grid).
///
/// Points where the integral itself fails are left out; the laws report those.
#[must_use]
pub fn measure(bound: &Bound, stored: &[f64], tolerance: f64, limit: usize) -> Reconstruction {
    let grid = &bound.spec.grid;
    let between: Vec<Vec<f64>> = (0..grid.axes().len()).map(|i| grid.between(i)).collect();
    let total: usize = between.iter().map(Vec::len).product();
    let step = total.div_ceil(limit.max(1));
    let coordinates = |mut n: usize| {
        let mut x = [0.0; MAX_AXES];
        for (x, list) in x.iter_mut().zip(&between) {
            *x = list[n % list.len()];
            n /= list.len();
        }
        x
    };
    let points: Vec<[f64; MAX_AXES]> = (0..total).step_by(step).map(coordinates).collect();
    let mut compared = compare_all(bound, stored, tolerance, &points);
    let coarse = compared.len();
    let mut worst: Vec<usize> = (0..coarse).collect();
    worst.sort_by(|&a, &b| compared[b].largest.total_cmp(&compared[a].largest).then(a.cmp(&b)));
    let fine: Vec<[f64; MAX_AXES]> =
        worst.iter().take(SEARCHED).flat_map(|&i| around(grid, &compared[i].x)).collect();
    let searched = compare_all(bound, stored, tolerance, &fine);
    // the mean is over the regular points only
    let whole = spread(bound, &compared, &searched, |_| true);
    let practical = spread(bound, &compared, &searched, |p| is_practical(grid, p));
    let points = (compared.len() + searched.len()) as u64;
    compared.clear();
    Reconstruction {
        filter: filter(grid).to_owned(),
        points,
        whole: whole.unwrap_or_else(nothing),
        practical,
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

fn compare_all(bound: &Bound, stored: &[f64], tolerance: f64, points: &[[f64; MAX_AXES]]) -> Vec<Compared> {
    points.par_iter().filter_map(|x| compare(bound, stored, tolerance, *x)).collect()
}

fn compare(bound: &Bound, stored: &[f64], tolerance: f64, x: [f64; MAX_AXES]) -> Option<Compared> {
    let grid = &bound.spec.grid;
    let channels = bound.spec.layout.channels.len();
    let point = grid.at_coordinates(&x);
    let fresh = bound.baker.texel(point.values(), tolerance).ok()?;
    let mut read = [0.0; crate::integrate::MAX_CHANNELS];
    lookup::read(grid, stored, &point, &mut read[..channels]);
    let mut result = Compared { x, point, largest: 0.0, channel: 0, sum: 0.0 };
    for (c, (r, f)) in read[..channels].iter().zip(&fresh.value).enumerate() {
        let error = (r - f).abs();
        result.sum += error;
        if error > result.largest {
            result.largest = error;
            result.channel = c;
        }
    }
    Some(result)
}

/// A 5 x 5 grid (5^n) over the cell round `x`.
fn around(grid: &Grid, x: &[f64; MAX_AXES]) -> Vec<[f64; MAX_AXES]> {
    let n = grid.axes().len();
    let mut points = Vec::new();
    for mut code in 0..5usize.pow(u32::try_from(n).unwrap_or(0)) {
        let mut p = *x;
        for (p, axis) in p.iter_mut().zip(grid.axes()) {
            let cells = if axis.texel == Texel::Center { axis.len } else { axis.len - 1 };
            let t = count(code % 5) / 4.0 - 0.5;
            *p = (*p + 0.96 * t / count(cells)).clamp(0.0, 1.0);
            code /= 5;
        }
        points.push(p);
    }
    points
}

fn is_practical(grid: &Grid, point: &Point) -> bool {
    grid.axes().iter().zip(point.values()).all(|(axis, &v)| match axis.quantity.base_id() {
        "mu" => v >= PRACTICAL_MU,
        "alpha" => v >= PRACTICAL_ALPHA,
        _ => true,
    })
}

fn spread(
    bound: &Bound,
    regular: &[Compared],
    searched: &[Compared],
    inside: impl Fn(&Point) -> bool,
) -> Option<Spread> {
    let channels = bound.spec.layout.channels;
    let (mut sum, mut n) = (0.0, 0.0);
    let mut largest: Option<&Compared> = None;
    for (i, c) in regular.iter().chain(searched).enumerate() {
        if !inside(&c.point) {
            continue;
        }
        if i < regular.len() {
            sum += c.sum;
            n += count(channels.len());
        }
        if largest.is_none_or(|l| c.largest > l.largest) {
            largest = Some(c);
        }
    }
    let largest = largest?;
    Some(Spread {
        largest: Extreme {
            value: largest.largest,
            channel: channels[largest.channel].id.to_owned(),
            at: named(&bound.spec.grid, &largest.point),
        },
        mean: if n > 0.0 { sum / n } else { 0.0 },
    })
}
