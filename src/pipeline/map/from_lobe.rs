//! Codes that tell of lobes of another kind, as widths of GGX.

use super::MapError;
use crate::models::ParamError;
use crate::plan::map::FromLobe;
use crate::terms::half_vectors::{self, Lobe};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

/// What the codes became.
pub(super) struct Lobes {
    /// √ of the smaller width.
    pub(super) roughness: Vec<f32>,
    /// √ of the larger width, and its direction.
    pub(super) stretch: Option<Vec<[f32; 2]>>,
    /// D, difference of E, what E gains.
    pub(super) costs: Vec<[f32; 3]>,
    /// What reading between converted pairs costs of D at most.
    pub(super) between: f64,
}

/// Codes of one number that are converted one by one: those of 8 bits are; of more, as many evenly spaced ones.
const CODES: usize = 257;

/// Side of the grid of pairs of numbers, and pairs that are converted one by one.
const SIDE: usize = 17;
const PAIRS: usize = SIDE * SIDE;

/// ln α_x, ln α_y, D, difference of E, what E gains.
type Row = [f64; 5];

impl FromLobe {
    fn convert(&self, codes: [f64; 2]) -> Result<Row, ParamError> {
        let (found, gap) = self.conversion.certified(codes.map(|c| self.number(c)), self.by)?;
        let held = found.alphas.map(|a| a.min(1.0));
        // no map holds a wider lobe than alpha = 1: D is that of what is written
        let distance = if found.alphas.iter().all(|a| *a <= 1.0) {
            found.distance
        } else {
            let lobe = (self.conversion.lobe)(codes.map(|c| self.number(c)));
            half_vectors::distance(&lobe, &Lobe::Ggx(held))
        };
        let [x, y] = held.map(libm::log);
        Ok([x, y, distance, gap.largest, gap.gained])
    }

    /// The pairs that occur, in order, with what each becomes: converted one by one up to `most` of them, else read between a grid; and
    /// what reading costs.
    fn table(
        &self,
        pairs: impl Iterator<Item = Key>,
        most: usize,
        sides: [usize; 2],
    ) -> Result<Table, MapError> {
        let mut keys: Vec<Key> = pairs.collect();
        keys.sort_unstable();
        keys.dedup();
        let codes = |(a, b): &Key| [a, b].map(|k| f64::from(f32::from_bits(*k)));
        if keys.len() <= most {
            let rows: Result<Vec<Row>, ParamError> =
                keys.par_iter().map(|k| self.convert(codes(k))).collect();
            return Ok(Table { keys, rows: rows?, between: 0.0 });
        }
        let grid = Grid::new(self, sides)?;
        let rows = keys.iter().map(|k| grid.read(codes(k))).collect();
        Ok(Table { keys, rows, between: grid.between })
    }

    /// Lobes of one number.
    pub(super) fn single(&self, codes: &[f32]) -> Result<Lobes, MapError> {
        let key = |c: &f32| (c.to_bits(), c.to_bits());
        let table = self.table(codes.iter().map(key), CODES, [CODES, 1])?;
        let found: Vec<(f32, [f32; 2], [f32; 3])> =
            codes.par_iter().map(|c| placed(&table.row(key(c)), 0.0)).collect();
        Ok(Lobes {
            roughness: found.iter().map(|f| f.0).collect(),
            stretch: None,
            costs: found.iter().map(|f| f.2).collect(),
            between: table.between,
        })
    }

    /// Lobes of two numbers.
    pub(super) fn pairs(
        &self,
        first: &[f32],
        second: &[f32],
        angle: Option<&[f32]>,
    ) -> Result<Lobes, MapError> {
        let key = |i: usize| (first[i].to_bits(), second[i].to_bits());
        let table = self.table((0..first.len()).map(key), PAIRS, [SIDE; 2])?;
        let mut out =
            Lobes { roughness: Vec::new(), stretch: None, costs: Vec::new(), between: table.between };
        let mut stretch = Vec::with_capacity(first.len());
        for i in 0..first.len() {
            let turn = angle.map_or(0.0, |a| f64::from(a[i]) * PI);
            let (roughness, wide, cost) = placed(&table.row(key(i)), turn);
            out.roughness.push(roughness);
            stretch.push(wide);
            out.costs.push(cost);
        }
        out.stretch = Some(stretch);
        Ok(out)
    }
}

/// Two codes by their bits; one number is there twice.
type Key = (u32, u32);

/// What the pairs of a map become.
struct Table {
    keys: Vec<Key>,
    rows: Vec<Row>,
    between: f64,
}

impl Table {
    fn row(&self, key: Key) -> Row {
        self.keys.binary_search(&key).map_or([0.0; 5], |i| self.rows[i])
    }
}

/// √ of the smaller width; √ of the larger one with its direction in (−π/2, π/2]; the costs.
#[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
fn placed(row: &Row, turn: f64) -> (f32, [f32; 2], [f32; 3]) {
    let [x, y] = [row[0], row[1]].map(|l| libm::exp(0.5 * l));
    let along = if x >= y { turn } else { turn + FRAC_PI_2 };
    let along = along - PI * libm::ceil(along / PI - 0.5);
    let (small, large) = (x.min(y) as f32, x.max(y) as f32);
    let angle = if large > small { along as f32 } else { 0.0 };
    (small, [large, angle], [row[2], row[3], row[4]].map(|v| v as f32))
}

/// Codes on a grid, read between: pairs, or one number with a second side of 1.
struct Grid {
    sides: [usize; 2],
    rows: Vec<Row>,
    between: f64,
}

impl Grid {
    fn new(from: &FromLobe, sides: [usize; 2]) -> Result<Grid, ParamError> {
        let last = sides.map(|s| s.saturating_sub(1).max(1) as f64);
        let codes = |i: usize, by: f64| {
            let place = |k: usize, c: usize| (k as f64 + if sides[c] > 1 { by } else { 0.0 }) / last[c];
            let (x, y) = (place(i % sides[0], 0), place(i / sides[0], 1));
            if sides[1] > 1 { [x, y] } else { [x; 2] }
        };
        let rows: Result<Vec<Row>, ParamError> =
            (0..sides[0] * sides[1]).into_par_iter().map(|i| from.convert(codes(i, 0.0))).collect();
        let mut grid = Grid { sides, rows: rows?, between: 0.0 };
        // in every third cell of every third row, half way: D of what is read against D that is told
        let sparse = |k: usize, c: usize| sides[c] == 1 || (k % 3 == 1 && k + 1 < sides[c]);
        let cells: Vec<usize> =
            (0..sides[0] * sides[1]).filter(|i| sparse(i % sides[0], 0) && sparse(i / sides[0], 1)).collect();
        let lost = |i: &usize| {
            let codes = codes(*i, 0.5);
            let read = grid.read(codes);
            let lobe = (from.conversion.lobe)(codes.map(|c| from.number(c)));
            let alphas = [libm::exp(read[0]), libm::exp(read[1])];
            (half_vectors::distance(&lobe, &Lobe::Ggx(alphas)) - read[2]).abs()
        };
        let lost: Vec<f64> = cells.par_iter().map(lost).collect();
        grid.between = lost.into_iter().fold(0.0, f64::max);
        Ok(grid)
    }

    fn read(&self, codes: [f64; 2]) -> Row {
        let cell = |c: f64, side: usize| {
            let place = c.clamp(0.0, 1.0) * (side - 1) as f64;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the grid")]
            let k = (place as usize).min(side.saturating_sub(2));
            (k, place - k as f64)
        };
        let ((x, tx), (y, ty)) = (cell(codes[0], self.sides[0]), cell(codes[1], self.sides[1]));
        let at = |x: usize, y: usize| &self.rows[y.min(self.sides[1] - 1) * self.sides[0] + x];
        std::array::from_fn(|c| {
            let along = |y: usize| at(x, y)[c] + (at(x + 1, y)[c] - at(x, y)[c]) * tx;
            along(y) + (along(y + 1) - along(y)) * ty
        })
    }
}
