//! Is a reader between the texels as near to fresh integrals as the file says?

use super::stored::Stored;
use super::{Asked, Kind, Recheck};
use crate::grid::layout::MAX_AXES;
use crate::grid::provenance::LawResult;
use crate::grid::table::{named, place};
use crate::grid::{Provenance, lookup};
use crate::integrate::MAX_CHANNELS;
use crate::math::figures::short;
use crate::verify::reconstruction::in_practical_domain;
use crate::verify::seeds::Seeds;
use rayon::prelude::*;

/// Points for each four texels that are looked at.
const SHARE: usize = 4;

/// Stated errors are measured in the middles of cells and on a grid of quarters of the worst ones. The error of linear reading is a
/// parabola over a cell; the nearest such place is at most an eighth of a cell off its peak, where 15 / 16 of it are left.
const BETWEEN: f64 = 16.0 / 15.0;

struct Read {
    error: f64,
    practical: bool,
    words: String,
}

pub(super) fn check(stored: &Stored, p: &Provenance, asked: Asked<'_>, r: &mut Recheck) {
    let Some(told) = &p.reconstruction else {
        return r.note("reading", LawResult::NotChecked, "the file states no error of reading".to_owned());
    };
    let grid = &stored.bound.spec.grid;
    let mut seeds = Seeds::new(asked.seed ^ 0xbe7e);
    let points: Vec<[f64; MAX_AXES]> =
        (0..asked.samples.div_ceil(SHARE)).map(|_| [(); MAX_AXES].map(|()| seeds.unit())).collect();
    let read: Vec<Read> =
        points.par_iter().filter_map(|x| read_at(stored, &x[..grid.axes().len()], asked)).collect();
    let largest = |inside: bool| {
        read.iter().filter(|r| r.practical || !inside).max_by(|a, b| a.error.total_cmp(&b.error))
    };
    let limit = |stated: f64| BETWEEN * stated + stored.tolerance;
    let parts = [(Some(&told.whole), false, "whole"), (told.practical.as_ref(), true, "practical")];
    let mut broken = false;
    for (spread, inside, words) in parts {
        let (Some(spread), Some(found)) = (spread, largest(inside)) else { continue };
        let stated = spread.largest.value;
        if found.error > limit(stated) {
            broken = true;
            let error = short(found.error);
            r.blame(
                Kind::Reading,
                format!(
                    "{error} at {}, the file states {} over the {words} domain",
                    found.words,
                    short(stated)
                ),
            );
        }
    }
    let result = if broken { LawResult::Broken } else { LawResult::Held };
    let found = largest(false).map_or(0.0, |r| r.error);
    let told = format!(
        "{} at most at {} points, {} stated",
        short(found),
        read.len(),
        short(told.whole.largest.value)
    );
    r.note("reading", result, told);
}

fn read_at(stored: &Stored, x: &[f64], asked: Asked<'_>) -> Option<Read> {
    asked.cancel.check().ok()?;
    let (grid, baker) = (&stored.bound.spec.grid, &stored.bound.baker);
    let point = grid.at_coordinates(x);
    let mut fresh = baker.texel(point.values(), stored.tolerance).ok()?.value;
    baker.decode(point.values(), &mut fresh);
    let mut read = [0.0; MAX_CHANNELS];
    let n = stored.table.channels.len();
    lookup::read(grid, &stored.table.values, &point, &mut read[..n]);
    baker.decode(point.values(), &mut read);
    let n = baker.decoded().map_or(n, <[_]>::len);
    let error = read[..n].iter().zip(&fresh).map(|(r, f)| (r - f).abs()).fold(0.0, f64::max);
    Some(Read { error, practical: in_practical_domain(grid, &point), words: place(&named(grid, &point)) })
}
