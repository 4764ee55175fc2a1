//! The texels of a picture that a mesh reads: triangles, lines and points in texture coordinates, marked on a grid of bits.

use super::Wrap;

/// Largest coordinate in texels that is followed: beyond it f32, which shaders compute in, has lost the texel.
const FARTHEST: f64 = 1_073_741_824.0;

/// Why what is read of a picture is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum CoverError {
    /// NaN, infinite, or beyond what shaders resolve.
    #[error("a texture coordinate is not finite, or so large that no shader finds its texel")]
    Far,
    /// Too many triangles, or repeated too often.
    #[error("its triangles are too many, or repeat the texture too often, to be followed")]
    Work,
}

/// Texels that are read at the picture's own size: those with a weight in the filter of the sampler. With a linear filter that
/// is the texels whose centres lie less than a texel away in both directions, with the nearest one those that are met.
#[derive(Debug)]
pub struct Covered {
    size: [usize; 2],
    wrap: [Wrap; 2],
    /// How far beyond its own square a texel is read.
    reach: f64,
    /// A bit a texel, each row from a word of its own.
    marks: Vec<u64>,
    words: usize,
    left: usize,
    /// Steps, of 64 texels each, that are left.
    steps: u64,
}

impl Covered {
    /// Nothing of a picture of this size; `linear` is the filter, and `steps` the work that may be done: one for each figure and for
    /// each 64 texels of a row of it.
    #[must_use]
    pub fn new(size: [usize; 2], wrap: [Wrap; 2], linear: bool, steps: u64) -> Covered {
        let words = size[0].div_ceil(64);
        let reach = if linear { 0.5 } else { 0.0 };
        let marks = vec![0; words * size[1]];
        Covered { size, wrap, reach, marks, words, left: size[0] * size[1], steps }
    }

    /// Is texel `i` marked, rows from the top?
    #[must_use]
    pub fn has(&self, i: usize) -> bool {
        let (x, y) = (i % self.size[0].max(1), i / self.size[0].max(1));
        self.marks.get(y * self.words + x / 64).is_some_and(|word| word >> (x % 64) & 1 == 1)
    }

    /// Number of texels that are marked.
    #[must_use]
    pub fn len(&self) -> usize {
        self.size[0] * self.size[1] - self.left
    }

    /// Is none marked?
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Is every one marked?
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.left == 0
    }

    /// Is there work left for so many figures?
    #[must_use]
    pub fn affords(&self, figures: u64) -> bool {
        figures <= self.steps
    }

    /// Marks what a triangle, a line or a point reads, by its one to three corners in texture coordinates.
    ///
    /// # Errors
    /// [`CoverError`]; what was marked before stays.
    pub fn mark(&mut self, corners: &[[f64; 2]]) -> Result<(), CoverError> {
        let size = self.size.map(|n| n as f64);
        let mut placed = [[0.0; 2]; 3];
        for (to, corner) in placed.iter_mut().zip(corners) {
            *to = [corner[0] * size[0], corner[1] * size[1]];
            if !to.iter().all(|x| x.abs() <= FARTHEST) {
                return Err(CoverError::Far);
            }
        }
        self.spend()?;
        let corners = &placed[..corners.len().min(3)];
        let ends = extent(corners.iter().map(|c| c[1]));
        let rows = self.line(ends, 1);
        for row in rows[0]..=rows[1] {
            if self.is_full() {
                return Ok(());
            }
            let band = self.band(row);
            // a flat line on the edge of two rows lies in its band all the same
            let Some(across) = crossing(corners, band)
                .or((ends[0] >= ends[1]).then(|| extent(corners.iter().map(|c| c[0]))))
            else {
                continue;
            };
            let columns = self.line(across, 0);
            self.row(self.wrap[1].at(row, self.size[1]), columns)?;
        }
        Ok(())
    }

    fn spend(&mut self) -> Result<(), CoverError> {
        self.steps = self.steps.checked_sub(1).ok_or(CoverError::Work)?;
        Ok(())
    }

    /// Texels of a line that an interval reads, first and last, before they are wrapped.
    #[allow(clippy::cast_possible_truncation, reason = "coordinates are bounded")]
    fn line(&self, [lo, hi]: [f64; 2], axis: usize) -> [i64; 2] {
        let last = self.size[axis] as i64 - 1;
        let mut ends = if lo >= hi && self.reach == 0.0 {
            [lo.floor() as i64; 2]
        } else {
            [(lo - 1.0 - self.reach).floor() as i64 + 1, (hi + self.reach).ceil() as i64 - 1]
        };
        if self.wrap[axis] == Wrap::Clamp {
            ends = ends.map(|end| end.clamp(0, last));
        }
        ends
    }

    /// Where the rows of coordinates lie that read a row of texels.
    fn band(&self, row: i64) -> [f64; 2] {
        let clamp = self.wrap[1] == Wrap::Clamp;
        let from = if clamp && row == 0 { f64::NEG_INFINITY } else { row as f64 - self.reach };
        let to = row as f64 + 1.0 + self.reach;
        [from, if clamp && row + 1 == self.size[1] as i64 { f64::INFINITY } else { to }]
    }

    /// Marks texels of a row, wrapped.
    #[allow(clippy::cast_sign_loss, clippy::cast_possible_truncation, reason = "wrapped into the row")]
    fn row(&mut self, row: usize, [first, last]: [i64; 2]) -> Result<(), CoverError> {
        let n = self.size[0] as i64;
        let turns = if self.wrap[0] == Wrap::Mirror { 2 * n } else { n };
        if last - first >= turns - 1 {
            return self.bits(row, 0, self.size[0]);
        }
        let mut from = first;
        while from <= last {
            let tile = from.div_euclid(n);
            let to = last.min((tile + 1) * n - 1);
            let ends = [self.wrap[0].at(from, self.size[0]), self.wrap[0].at(to, self.size[0])];
            self.bits(row, ends[0].min(ends[1]), ends[0].max(ends[1]) + 1)?;
            from = to + 1;
        }
        Ok(())
    }

    fn bits(&mut self, row: usize, from: usize, to: usize) -> Result<(), CoverError> {
        let mut x = from;
        while x < to {
            let end = to.min((x / 64 + 1) * 64);
            let mask = (u64::MAX >> (64 - (end - x))) << (x % 64);
            if let Some(word) = self.marks.get_mut(row * self.words + x / 64) {
                self.left -= (mask & !*word).count_ones() as usize;
                *word |= mask;
            }
            self.spend()?;
            x = end;
        }
        Ok(())
    }
}

fn extent(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], v| [lo.min(v), hi.max(v)])
}

/// Least and largest x of the part of a convex figure with y in a band.
fn crossing(corners: &[[f64; 2]], [from, to]: [f64; 2]) -> Option<[f64; 2]> {
    let mut ends = extent(corners.iter().filter(|c| (from..=to).contains(&c[1])).map(|c| c[0]));
    for (i, a) in corners.iter().enumerate() {
        let b = &corners[(i + 1) % corners.len()];
        for y in [from, to] {
            if (a[1] - y) * (b[1] - y) < 0.0 {
                let x = a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1]));
                ends = [ends[0].min(x), ends[1].max(x)];
            }
        }
    }
    (ends[0] <= ends[1]).then_some(ends)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "test")]
    use super::*;
    use std::collections::BTreeSet;

    fn marked(size: [usize; 2], wrap: Wrap, linear: bool, figures: &[&[[f64; 2]]]) -> BTreeSet<usize> {
        let mut covered = Covered::new(size, [wrap; 2], linear, 1 << 20);
        for figure in figures {
            covered.mark(figure).unwrap();
        }
        let all: BTreeSet<usize> = (0..size[0] * size[1]).filter(|i| covered.has(*i)).collect();
        assert_eq!(all.len(), covered.len());
        all
    }

    #[test]
    fn points_read_the_texels_of_their_filter() {
        let at = |u: f64, v: f64, wrap, linear| marked([4, 4], wrap, linear, &[&[[u, v]]]);
        assert_eq!(at(0.3, 0.3, Wrap::Repeat, false), [5].into());
        // on a centre a linear filter reads one texel, between centres four
        assert_eq!(at(0.375, 0.375, Wrap::Repeat, true), [5].into());
        assert_eq!(at(0.5, 0.5, Wrap::Repeat, true), [5, 6, 9, 10].into());
        assert_eq!(at(0.5, 0.5, Wrap::Repeat, false), [10].into());
        // on the border it reads the other side, itself, or the border
        assert_eq!(at(0.0, 0.375, Wrap::Repeat, true), [4, 7].into());
        assert_eq!(at(0.0, 0.375, Wrap::Mirror, true), [4].into());
        assert_eq!(at(-3.0, 0.375, Wrap::Clamp, true), [4].into());
        assert_eq!(at(1.375, 0.375, Wrap::Mirror, true), [6].into());
    }

    #[test]
    fn what_cannot_be_followed_is_told() {
        let mut covered = Covered::new([4096, 4096], [Wrap::Repeat; 2], true, 1 << 20);
        assert_eq!(covered.mark(&[[f64::NAN, 0.0]]), Err(CoverError::Far));
        assert_eq!(covered.mark(&[[1e9, 0.0]]), Err(CoverError::Far));
        let sliver = [[0.0, 0.0], [1e-9, 200_000.0], [0.0, 200_000.0]];
        let worked: Result<(), _> = (0..3).try_for_each(|_| covered.mark(&sliver));
        assert_eq!(worked, Err(CoverError::Work));
    }
}
