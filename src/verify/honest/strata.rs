//! Which texels are looked at: seeded, every row and every column at least once, and enough that what is wrong with one texel in
//! twenty is met with a probability above 0.999.

use crate::grid::Grid;
use crate::verify::seeds::Seeds;

/// Least number of texels: `0.95^135 < 0.001`.
pub const LEAST: usize = 135;

/// Texels of one row, in the order in which they are tried: the first is looked at, the next ones stand in for it where it cannot
/// be judged.
pub type Row = Vec<usize>;

/// How many stand in for a texel that cannot be judged.
const SPARE: usize = 3;

/// Numbers of at least `least` texels, or of all, in order of the rows; each row is met at least once, none of the texels twice.
#[must_use]
pub fn rows(grid: &Grid, seed: u64, least: usize) -> Vec<Row> {
    let len = grid.len();
    if len <= least {
        return (0..len).map(|texel| vec![texel]).collect();
    }
    let width = grid.axes().first().map_or(1, |a| a.len);
    let rows = len / width;
    let mut seeds = Seeds::new(seed);
    let each = least.div_ceil(rows).min(width);
    let mut columns = Columns::new(width, &mut seeds);
    let mut out = Vec::new();
    for row in 0..rows {
        let mut taken: Vec<usize> = Vec::new();
        for _ in 0..each {
            let column = columns.next(&mut seeds, &taken);
            taken.push(column);
            let mut tried = vec![row * width + column];
            for _ in 0..SPARE.min(width - each) {
                let other = seeds.index(width);
                if !taken.contains(&other) && !tried.contains(&(row * width + other)) {
                    tried.push(row * width + other);
                }
            }
            out.push(tried);
        }
    }
    out
}

/// Columns in a shuffled order, again and again: all of them are met before one is met twice.
struct Columns {
    order: Vec<usize>,
    next: usize,
}

impl Columns {
    fn new(width: usize, seeds: &mut Seeds) -> Columns {
        let mut columns = Columns { order: (0..width).collect(), next: 0 };
        columns.shuffle(seeds);
        columns
    }

    fn shuffle(&mut self, seeds: &mut Seeds) {
        for i in (1..self.order.len()).rev() {
            self.order.swap(i, seeds.index(i + 1));
        }
        self.next = 0;
    }

    /// The next column that is not in `taken`.
    fn next(&mut self, seeds: &mut Seeds, taken: &[usize]) -> usize {
        for _ in 0..=2 * self.order.len() {
            if self.next == self.order.len() {
                self.shuffle(seeds);
            }
            let column = self.order[self.next];
            self.next += 1;
            if !taken.contains(&column) {
                return column;
            }
        }
        0
    }
}
