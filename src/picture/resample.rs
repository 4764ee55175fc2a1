//! Planes of another size.

/// What lies beyond the border, as samplers of glTF name it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Wrap {
    /// The image again.
    Repeat,
    /// The image mirrored.
    Mirror,
    /// The texel on the border.
    Clamp,
}

impl Wrap {
    /// The texel of a line of `n` that stands at `i`.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        clippy::cast_sign_loss,
        reason = "a line has at most 2^26 texels"
    )]
    pub fn at(self, i: i64, n: usize) -> usize {
        let n = n.max(1) as i64;
        let place = match self {
            Wrap::Repeat => i.rem_euclid(n),
            Wrap::Mirror => {
                let i = i.rem_euclid(2 * n);
                if i < n { i } else { 2 * n - 1 - i }
            }
            Wrap::Clamp => i.clamp(0, n - 1),
        };
        place as usize
    }
}

impl super::Plane {
    /// The plane in another size, by what a sampler with a linear filter reads at the middle of each new texel.
    #[must_use]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "rounded to f32 on purpose; a line has at most 2^26 texels"
    )]
    pub fn resampled(&self, from: [usize; 2], to: [usize; 2], wrap: [Wrap; 2]) -> Self {
        let line = |from: usize, to: usize, wrap: Wrap| -> Vec<(usize, usize, f64)> {
            let place = |i: usize| {
                let at = (i as f64 + 0.5) * from as f64 / to as f64 - 0.5;
                let floor = at.floor();
                (wrap.at(floor as i64, from), wrap.at(floor as i64 + 1, from), at - floor)
            };
            (0..to).map(place).collect()
        };
        let (columns, rows) = (line(from[0], to[0], wrap[0]), line(from[1], to[1], wrap[1]));
        let value = |x: usize, y: usize| f64::from(self.values[y * from[0] + x]);
        let mut values = Vec::with_capacity(to[0] * to[1]);
        for (y0, y1, v) in &rows {
            for (x0, x1, u) in &columns {
                let top = value(*x0, *y0) * (1.0 - u) + value(*x1, *y0) * u;
                let bottom = value(*x0, *y1) * (1.0 - u) + value(*x1, *y1) * u;
                values.push((top * (1.0 - v) + bottom * v) as f32);
            }
        }
        Self { name: self.name.clone(), values }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_go_on_as_they_are_told() {
        let line = |wrap: Wrap| (-3..6).map(|i| wrap.at(i, 3)).collect::<Vec<_>>();
        assert_eq!(line(Wrap::Repeat), [0, 1, 2, 0, 1, 2, 0, 1, 2]);
        assert_eq!(line(Wrap::Mirror), [2, 1, 0, 0, 1, 2, 2, 1, 0]);
        assert_eq!(line(Wrap::Clamp), [0, 0, 0, 0, 1, 2, 2, 2, 2]);
    }

    #[test]
    fn borders_mix_with_what_lies_beyond() {
        let plane = crate::picture::Plane { name: "Y".into(), values: vec![0.0, 1.0] };
        let wide = |wrap| plane.resampled([2, 1], [4, 1], [wrap, Wrap::Clamp]).values;
        assert_eq!(wide(Wrap::Clamp), [0.0, 0.25, 0.75, 1.0]);
        assert_eq!(wide(Wrap::Repeat), [0.25, 0.25, 0.75, 0.75]);
    }
}
