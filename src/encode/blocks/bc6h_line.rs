//! A line through texels in the space where BC6H interpolates, and what errors cost.

use super::super::coding::{exponent, power_of_two};
use super::bc6h::{Mode, TEXELS};

/// Rounds of least squares.
const ROUNDS: usize = 5;

/// What a block is to hold.
pub(super) struct Target<'a> {
    values: &'a [[f64; 3]; TEXELS],
    /// Where a value lies among the wide integers, as a real number, and what a step there is worth.
    wide: [[f64; 3]; TEXELS],
    slope: [[f64; 3]; TEXELS],
    pub(super) channels: usize,
    pub(super) signed: bool,
}

/// Two endpoints as wide numbers.
#[derive(Clone, Copy)]
pub(super) struct Line(pub(super) [[f64; 3]; 2]);

/// Texels that share a pair of endpoints; the index of the anchor lacks its highest bit.
pub(super) struct Subset {
    pub(super) texels: Vec<usize>,
    anchor: usize,
}

/// Costs of a subset: `[channel][texel of the block][index]`.
pub(super) type Costs = [[[f64; 16]; TEXELS]; 3];

impl Subset {
    /// Texels of one of the pairs of a partition.
    pub(super) fn new(mode: &Mode, partition: usize, pair: usize) -> Subset {
        let texels: Vec<usize> = (0..TEXELS).filter(|t| mode.subset(partition, *t) == pair).collect();
        let anchor = texels.iter().copied().find(|t| mode.is_anchor(partition, *t)).unwrap_or(0);
        Subset { texels, anchor }
    }
}

impl Target<'_> {
    pub(super) fn new(values: &[[f64; 3]; TEXELS], channels: usize, signed: bool) -> Target<'_> {
        let mut wide = [[0.0; 3]; TEXELS];
        let mut slope = [[0.0; 3]; TEXELS];
        for (t, texel) in values.iter().enumerate() {
            for (c, &v) in texel.iter().enumerate().take(channels) {
                (wide[t][c], slope[t][c]) = widen(v, signed);
            }
        }
        Target { values, wide, slope, channels, signed }
    }

    /// What it costs to give the texels of a subset these values of a channel, one an index.
    pub(super) fn cost(&self, subset: &Subset, c: usize, palette: &[f64], costs: &mut [[f64; 16]; TEXELS]) {
        for &t in &subset.texels {
            let v = self.values[t][c];
            for (slot, p) in costs[t].iter_mut().zip(palette) {
                let square = (p - v) * (p - v);
                let fourth = square * square;
                *slot = fourth * fourth;
            }
        }
    }

    /// Gives each texel of a subset its cheapest index; returns the sum, or some number from `limit` on.
    pub(super) fn assign(
        &self,
        subset: &Subset,
        costs: [&[[f64; 16]; TEXELS]; 3],
        indices: usize,
        limit: f64,
        into: &mut [u8; TEXELS],
    ) -> f64 {
        let mut total = 0.0;
        for &t in &subset.texels {
            let usable = if t == subset.anchor { indices / 2 } else { indices };
            let (mut least, mut best) = (f64::INFINITY, 0);
            for (index, i) in (0u8..).zip(0..usable) {
                let sum: f64 = costs[..self.channels].iter().map(|channel| channel[t][i]).sum();
                if sum < least {
                    (least, best) = (sum, index);
                }
            }
            into[t] = best;
            total += least;
            if total >= limit {
                return total;
            }
        }
        total
    }

    /// The line of a subset and its cost, before anything is rounded.
    pub(super) fn line(&self, subset: &Subset, weights: &[i32]) -> (Line, f64) {
        let mut line = self.farthest(subset);
        let mut indices = [0; TEXELS];
        let mut costs: Costs = [[[0.0; 16]; TEXELS]; 3];
        let mut best = (line, f64::INFINITY);
        for _ in 0..ROUNDS {
            for (c, costs) in costs.iter_mut().enumerate().take(self.channels) {
                let mut palette = [0.0; 16];
                for (p, w) in palette.iter_mut().zip(weights) {
                    let w = f64::from(*w) / 64.0;
                    *p = narrow(line.0[0][c] * (1.0 - w) + line.0[1][c] * w, self.signed);
                }
                self.cost(subset, c, &palette[..weights.len()], costs);
            }
            let total = self.assign(subset, costs.each_ref(), weights.len(), f64::INFINITY, &mut indices);
            if total >= best.1 {
                break;
            }
            best = (line, total);
            line = self.least_squares(subset, weights, &indices, line);
        }
        best
    }

    /// The two texels of a subset that are farthest apart; the anchor is nearer to the first.
    fn farthest(&self, subset: &Subset) -> Line {
        let distance = |a: usize, b: usize| {
            let (a, b) = (&self.values[a], &self.values[b]);
            (0..self.channels).map(|c| (a[c] - b[c]) * (a[c] - b[c])).sum::<f64>()
        };
        let (mut ends, mut longest) = ([subset.anchor; 2], 0.0);
        for (i, &a) in subset.texels.iter().enumerate() {
            for &b in &subset.texels[..i] {
                let d = distance(a, b);
                if d > longest {
                    (ends, longest) = ([b, a], d);
                }
            }
        }
        if distance(subset.anchor, ends[0]) > distance(subset.anchor, ends[1]) {
            ends.swap(0, 1);
        }
        Line(ends.map(|t| self.wide[t]))
    }

    /// Endpoints with the least squares at these indices, each texel weighted by what a step is worth there.
    fn least_squares(
        &self,
        subset: &Subset,
        weights: &[i32],
        indices: &[u8; TEXELS],
        mut line: Line,
    ) -> Line {
        let [low, high] = if self.signed { [-32767.0, 32767.0] } else { [0.0, 65535.0] };
        for c in 0..self.channels {
            // normal equations of the two ends
            let (mut aa, mut ab, mut bb, mut ay, mut by) = (0.0, 0.0, 0.0, 0.0, 0.0);
            for &t in &subset.texels {
                let b = f64::from(weights[usize::from(indices[t])]) / 64.0;
                let a = 1.0 - b;
                let weight = self.slope[t][c] * self.slope[t][c];
                aa += weight * a * a;
                ab += weight * a * b;
                bb += weight * b * b;
                ay += weight * a * self.wide[t][c];
                by += weight * b * self.wide[t][c];
            }
            let determinant = aa * bb - ab * ab;
            if determinant > 1e-9 * aa * bb {
                line.0[0][c] = ((bb * ay - ab * by) / determinant).clamp(low, high);
                line.0[1][c] = ((aa * by - ab * ay) / determinant).clamp(low, high);
            }
        }
        line
    }
}

/// Wide integers a half.
const fn scale(signed: bool) -> f64 {
    if signed { 32.0 / 31.0 } else { 64.0 / 31.0 }
}

/// Where a value lies among the wide integers, and what a step there is worth. Bits of halfs rise by 1024 an octave,
/// evenly within it; decoding drops the fraction, so that the middle of a half is what stands for it.
fn widen(v: f64, signed: bool) -> (f64, f64) {
    let magnitude = v.abs();
    let e = exponent(magnitude).max(-14);
    let step = power_of_two(e - 10);
    let bits = magnitude / step + 1024.0 * f64::from(e + 14);
    let wide = (bits + 0.5) * scale(signed);
    (if v < 0.0 { -wide } else { wide }, step / scale(signed))
}

/// The value of a wide real number: the inverse of [`widen`].
#[allow(clippy::cast_possible_truncation, reason = "at most 31")]
fn narrow(wide: f64, signed: bool) -> f64 {
    let bits = (wide.abs() / scale(signed) - 0.5).max(0.0);
    let e = ((bits / 1024.0) as i32 - 15).max(-14);
    let v = (bits - 1024.0 * f64::from(e + 14)) * power_of_two(e - 10);
    if wide < 0.0 { -v } else { v }
}
