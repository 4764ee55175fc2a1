//! The reference reader: multilinear interpolation between texels, clamped at the edges, as a GPU sampler does it
//! (in f64; a GPU's 8-bit filter weights add up to 1/512 of the difference of two neighbours on top).

use super::layout::{Grid, MAX_AXES, Point};

/// Most texels that one reading touches.
pub const MAX_CORNERS: usize = 1 << MAX_AXES;

/// The texels that a reader at `point` adds up, with their weights: the first `n` entries, n = 2^axes. Corners with
/// weight 0 are there too.
#[must_use]
pub fn corners(grid: &Grid, point: &Point) -> ([(usize, f64); MAX_CORNERS], usize) {
    let index = grid.index(point);
    let n = grid.axes().len();
    let mut low = [0usize; MAX_AXES];
    let mut high = [0usize; MAX_AXES];
    let mut t = [0.0; MAX_AXES];
    for (i, axis) in grid.axes().iter().enumerate() {
        let last = axis.len - 1;
        let f = index[i].clamp(0.0, super::axis::count(last));
        low[i] = floor(f).min(last);
        high[i] = (low[i] + 1).min(last);
        t[i] = f - super::axis::count(low[i]);
    }
    let mut all = [(0, 0.0); MAX_CORNERS];
    for (corner, entry) in all.iter_mut().enumerate().take(1 << n) {
        let mut weight = 1.0;
        let mut texel = 0;
        let mut stride = 1;
        for (i, axis) in grid.axes().iter().enumerate() {
            let upper = corner >> i & 1 == 1;
            weight *= if upper { t[i] } else { 1.0 - t[i] };
            texel += stride * if upper { high[i] } else { low[i] };
            stride *= axis.len;
        }
        *entry = (texel, weight);
    }
    (all, 1 << n)
}

/// Is a point beyond the outermost texels of some axis, where the reader clamps?
#[must_use]
pub fn is_clamped(grid: &Grid, point: &Point) -> bool {
    /// Rounding of a place that is a texel's own.
    const CLOSE: f64 = 1e-9;
    let index = grid.index(point);
    grid.axes().iter().zip(index).any(|(axis, f)| f < -CLOSE || f > super::axis::count(axis.len - 1) + CLOSE)
}

/// Reads all channels at `point` into `out`. `values` is `[texel][channel]`, channel fastest.
pub fn read(grid: &Grid, values: &[f64], point: &Point, out: &mut [f64]) {
    let channels = out.len();
    let (corners, n) = corners(grid, point);
    out.fill(0.0);
    for (texel, weight) in &corners[..n] {
        if *weight > 0.0 {
            for (c, o) in out.iter_mut().enumerate() {
                *o += weight * values[texel * channels + c];
            }
        }
    }
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to [0, len) by the caller"
)]
fn floor(x: f64) -> usize {
    x as usize
}
