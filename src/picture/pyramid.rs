//! Levels of a pyramid: each is floor(n/2) of the one before, and every texel is the mean of the area that it covers.
//!
//! Where n is odd the texels of the smaller level are n/m wide, m = floor(n/2), and share the texels on their borders. The
//! boxes end at the border of the image, so that no wrap mode changes a level.

/// Sizes of all levels, the largest first, down to 1 x 1.
#[must_use]
pub fn halved(width: usize, height: usize) -> Vec<[usize; 2]> {
    let mut sizes = vec![[width.max(1), height.max(1)]];
    while let Some(&[w, h]) = sizes.last()
        && (w > 1 || h > 1)
    {
        sizes.push([(w / 2).max(1), (h / 2).max(1)]);
    }
    sizes
}

/// How many levels an image has: 1 + floor(log2 of its longer side).
#[must_use]
pub fn count_levels(width: usize, height: usize) -> usize {
    halved(width, height).len()
}

/// Which texels of a line each texel of a shorter line covers, and which share of it they make up.
#[derive(Debug, Clone, PartialEq)]
pub struct Coverage(Vec<Vec<(usize, f64)>>);

impl Coverage {
    /// Of a line of `from` texels by one of `to`, `to` ≤ `from`.
    #[must_use]
    pub fn new(from: usize, to: usize) -> Coverage {
        let (from, to) = (from.max(1), to.max(1).min(from.max(1)));
        // in units of 1/to of a source texel all borders are integers
        let cover = |i: usize| {
            let (start, end) = (i * from, (i + 1) * from);
            let part = |j: usize| {
                let shared = end.min((j + 1) * to) - start.max(j * to);
                (j, shared as f64 / from as f64)
            };
            (start / to..end.div_ceil(to)).map(part).collect()
        };
        Coverage((0..to).map(cover).collect())
    }

    /// That of two steps, one after the other.
    #[must_use]
    pub fn then(&self, next: &Coverage) -> Coverage {
        let compose = |list: &Vec<(usize, f64)>| {
            let mut out: Vec<(usize, f64)> = Vec::new();
            for (middle, w) in list {
                for (j, v) in &self.0[*middle] {
                    match out.iter_mut().find(|(k, _)| k == j) {
                        Some(slot) => slot.1 += w * v,
                        None => out.push((*j, w * v)),
                    }
                }
            }
            out
        };
        Coverage(next.0.iter().map(compose).collect())
    }

    /// Texels under texel `i`, with shares that sum to 1.
    #[must_use]
    pub fn of(&self, i: usize) -> &[(usize, f64)] {
        self.0.get(i).map_or(&[], Vec::as_slice)
    }
}

/// The next level of a plane, `[width, height]` to `[to_width, to_height]`.
#[must_use]
#[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
pub fn shrink(values: &[f32], from: [usize; 2], to: [usize; 2]) -> Vec<f32> {
    let (across, down) = (Coverage::new(from[0], to[0]), Coverage::new(from[1], to[1]));
    let mut out = Vec::with_capacity(to[0] * to[1]);
    for y in 0..to[1] {
        for x in 0..to[0] {
            let mut sum = 0.0;
            for (row, wy) in down.of(y) {
                for (column, wx) in across.of(x) {
                    sum += wx * wy * f64::from(values[row * from[0] + column]);
                }
            }
            out.push(sum as f32);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_halved_and_rounded_down() {
        assert_eq!(halved(7, 2), [[7, 2], [3, 1], [1, 1]]);
        assert_eq!(halved(1, 1), [[1, 1]]);
        assert_eq!(count_levels(1024, 3), 11);
    }

    /// 5 to 2: texel 0 covers 0, 1 and half of 2.
    #[test]
    fn odd_lines_share_their_middle() {
        let coverage = Coverage::new(5, 2);
        assert_eq!(coverage.of(0), [(0, 0.4), (1, 0.4), (2, 0.2)]);
        assert_eq!(coverage.of(1), [(2, 0.2), (3, 0.4), (4, 0.4)]);
        assert_eq!(Coverage::new(1, 1).of(0), [(0, 1.0)]);
    }

    #[test]
    fn every_level_keeps_the_mean() {
        let (w, h) = (13, 7);
        let values: Vec<f32> = (0..w * h).map(|i| ((i * 37) % 101) as f32).collect();
        let mean = |v: &[f32]| v.iter().map(|x| f64::from(*x)).sum::<f64>() / v.len() as f64;
        let mut level = values.clone();
        for pair in halved(w, h).windows(2) {
            level = shrink(&level, pair[0], pair[1]);
            assert!((mean(&level) - mean(&values)).abs() < 1e-4);
        }
    }

    #[test]
    fn two_steps_are_one() {
        let two = Coverage::new(13, 6).then(&Coverage::new(6, 3));
        for i in 0..3 {
            assert!((two.of(i).iter().map(|p| p.1).sum::<f64>() - 1.0).abs() < 1e-15);
        }
        assert_eq!(Coverage::new(8, 4).then(&Coverage::new(4, 2)), Coverage::new(8, 2));
    }
}
