//! Which texels of a table are shown: all of a small one; of a large one every k-th, and a few slices. Errors are then the largest of
//! the texels that a pixel stands for, so that the worst one is seen.

use crate::grid::Grid;
use crate::grid::axis::count;

/// Most slices that are shown.
const SLICES: usize = 8;
/// Most texels along a side.
const SIDE: usize = 256;
/// Most numbers of a table.
const NUMBERS: usize = 1 << 16;

/// The texels that stand for all.
#[derive(Debug)]
pub(super) struct Shown {
    /// Texels along each of four axes.
    len: [usize; 4],
    x: Vec<usize>,
    y: Vec<usize>,
    /// Indices on the third and fourth axis.
    pub(super) slices: Vec<[usize; 2]>,
}

impl Shown {
    /// Chooses among the texels of a grid; the slice of the worst one is always there.
    pub(super) fn new(grid: &Grid, channels: usize, worst: Option<usize>) -> Shown {
        let mut len = [1; 4];
        for (slot, axis) in len.iter_mut().zip(grid.axes()) {
            *slot = axis.len;
        }
        let all = len[2] * len[3];
        let mut slices = spread(all, SLICES);
        if let Some(worst) = worst {
            let slice = worst / (len[0] * len[1]);
            if !slices.contains(&slice)
                && let Some(nearest) = slices.iter_mut().min_by_key(|s| s.abs_diff(slice))
            {
                *nearest = slice;
                slices.sort_unstable();
            }
        }
        let mut side = SIDE;
        while side > 1 && len[0].min(side) * len[1].min(side) * slices.len() * channels > NUMBERS {
            side /= 2;
        }
        let every = |n: usize| (0..n).step_by(n.div_ceil(side).max(1)).collect();
        let slices = slices.iter().map(|s| [s % len[2], s / len[2]]).collect();
        Shown { x: every(len[0]), y: every(len[1]), slices, len }
    }

    /// Width and height of a picture.
    pub(super) fn size(&self) -> [usize; 2] {
        [self.x.len(), self.y.len()]
    }

    /// Is every texel shown?
    pub(super) fn is_whole(&self) -> bool {
        self.x.len() == self.len[0]
            && self.y.len() == self.len[1]
            && self.slices.len() == self.len[2] * self.len[3]
    }

    /// Texels that a pixel stands for, along x and y.
    pub(super) fn step(&self) -> [usize; 2] {
        let step = |kept: &[usize]| kept.get(1).copied().unwrap_or(1);
        [step(&self.x), step(&self.y)]
    }

    /// The number of a texel.
    pub(super) fn texel(&self, slice: usize, i: usize, j: usize) -> usize {
        let [z, w] = self.slices[slice];
        self.number(self.x[i], self.y[j], z, w)
    }

    fn number(&self, x: usize, y: usize, z: usize, w: usize) -> usize {
        let [a, b, c, _] = self.len;
        x + a * (y + b * (z + c * w))
    }

    /// The texels of a slice, rows from the top.
    pub(super) fn texels(&self, slice: usize) -> impl Iterator<Item = usize> + Clone {
        let [width, height] = self.size();
        (0..width * height).map(move |n| self.texel(slice, n % width, n / width))
    }

    /// The largest of something over the texels that each pixel of a slice stands for; NaN where none is known.
    pub(super) fn largest(&self, slice: usize, of: &dyn Fn(usize) -> f64) -> Vec<f64> {
        let [width, height] = self.size();
        let [dx, dy] = self.step();
        let [z, w] = self.slices[slice];
        let pixel = |n: usize| {
            let (x0, y0) = (self.x[n % width], self.y[n / width]);
            let block = (y0..(y0 + dy).min(self.len[1]))
                .flat_map(|y| (x0..(x0 + dx).min(self.len[0])).map(move |x| (x, y)));
            block.map(|(x, y)| of(self.number(x, y, z, w))).fold(f64::NAN, f64::max)
        };
        (0..width * height).map(pixel).collect()
    }

    /// The pixel of a texel: slice, column, row; none if its slice is not shown.
    pub(super) fn pixel(&self, texel: usize) -> Option<[usize; 3]> {
        let plane = self.len[0] * self.len[1];
        let rest = texel / plane;
        let place = [rest % self.len[2], rest / self.len[2]];
        let slice = self.slices.iter().position(|s| *s == place)?;
        let [dx, dy] = self.step();
        Some([slice, texel % self.len[0] / dx, texel % plane / self.len[0] / dy])
    }
}

/// At most so many of the first `n` numbers, evenly.
pub(super) fn spread(n: usize, most: usize) -> Vec<usize> {
    if n <= most {
        return (0..n).collect();
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in [0, n - 1]")]
    let place = |i: usize| (count(i) * count(n - 1) / count(most - 1)).round() as usize;
    (0..most).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::Shown;
    use crate::grid::{Axis, Grid, Quantity, Texel};

    fn grid(lengths: &[usize]) -> Grid {
        let ids = ["mu", "roughness", "eta", "k"];
        let axis = |(id, n): (&str, &usize)| Axis::new(Quantity::find(id).unwrap(), *n, Texel::Center);
        Grid::new(ids.into_iter().zip(lengths).map(axis).collect()).unwrap()
    }

    #[test]
    fn a_large_table_keeps_its_worst_texel() {
        let worst = 700 + 1000 * (333 + 500 * 17);
        let shown = Shown::new(&grid(&[1000, 500, 40]), 2, Some(worst));
        assert!(!shown.is_whole() && shown.slices.len() == 8);
        let [slice, i, j] = shown.pixel(worst).unwrap();
        let errors = shown.largest(slice, &|t| if t == worst { 1.0 } else { 0.0 });
        let [width, height] = shown.size();
        let places: Vec<usize> = (0..errors.len()).filter(|n| errors[*n] > 0.0).collect();
        assert_eq!((places, errors.len()), (vec![i + width * j], width * height));
    }

    #[test]
    fn a_small_table_is_whole() {
        let shown = Shown::new(&grid(&[5, 3, 2]), 1, None);
        assert!(shown.is_whole());
        let all: Vec<usize> = (0..2).flat_map(|s| shown.texels(s).collect::<Vec<_>>()).collect();
        assert_eq!(all, (0..30).collect::<Vec<_>>());
        assert_eq!(shown.pixel(29), Some([1, 4, 2]));
    }
}
