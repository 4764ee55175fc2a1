//! The arithmetic behind a storage: which numbers there are, and which one is nearest.
//!
//! Three of the codings share something between the channels of a texel. Their shared value is chosen so that the
//! largest error of the texel's channels is smallest; among choices that are equally good, the finest one is taken.
//!
//! # Shared exponent
//! Channels `m 2^e` with integers `m` in 0 ..= top. A smaller `e` gives a finer grid that contains the coarser one, so
//! only the exponent at which the largest channel just fits and its neighbour above can be best: at the boundary it may
//! be better to take `top` for a value that rounds to `top + 1` than to halve the precision of the other channels.
//!
//! # RGBD
//! `value = (code / 255)^2.2 / (d / 255)`, `d` in 1 ..= 255: what Babylon.js computes when it expands such a texture
//! (`fromRGBD` of its shaders, with the power 2.2 and not the piecewise sRGB curve). Its own encoder takes
//! `d = floor(255 / largest)`; here every `d` is tried.

use std::sync::LazyLock;

/// How a number of one channel is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Coding {
    /// Binary floating point with `digits` significant bits, normal from `2^least` on, up to `largest`.
    Binary { digits: i32, least: i32, largest: f64, signed: bool },
    /// Integers 0 ..= `top` spread over the range of the channel; neighbours are `step` apart where they are closest.
    Unorm { top: f64, step: f64 },
    /// Mantissas 0 ..= `top` and one exponent of the texel in `exponents`.
    Shared(Shared),
    /// See the module.
    Rgbd,
}

/// Numbers `m 2^e`, `m` in 0 ..= `top`, `e` in `exponents` and common to the texel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shared {
    pub(crate) top: f64,
    pub(crate) exponents: [i32; 2],
}

/// RGB9E5: `m 2^(E - 24)`, E in 0 ..= 31.
pub(crate) const RGB9E5: Shared = Shared { top: 511.0, exponents: [-24, 7] };
/// RGBE of Radiance: `m 2^(E - 136)`, E in 1 ..= 255; E = 0 is a texel of zeros.
pub(crate) const RGBE: Shared = Shared { top: 255.0, exponents: [-135, 119] };

/// Largest value of RGBD: code 255 with d = 1.
pub(crate) const RGBD_LARGEST: f64 = 255.0;

impl Shared {
    /// Largest number.
    pub(crate) fn largest(self) -> f64 {
        self.top * power_of_two(self.exponents[1])
    }

    /// Mantissas and exponent of the nearest texel. The values are not negative and at most [`Shared::largest`] plus
    /// half a step; there are at most three.
    pub(crate) fn nearest(self, texel: &[f64]) -> ([f64; 3], i32) {
        let largest = texel.iter().copied().fold(0.0, f64::max);
        let [least, most] = self.exponents;
        // the largest value lies in [2^x, 2^(x + 1)); with top = 2^n - 1 its mantissa has n bits at e = x + 1 - n
        let bits = exponent(self.top) + 1;
        let first = (exponent(largest) + 1 - bits).clamp(least, most);
        let mut best = ([0.0; 3], first);
        let mut smallest = f64::INFINITY;
        for e in first..=(first + 1).min(most) {
            let step = power_of_two(e);
            let mut mantissas = [0.0; 3];
            let mut error = 0.0_f64;
            for (m, v) in mantissas.iter_mut().zip(texel) {
                *m = (v / step).round_ties_even().min(self.top);
                error = error.max((*m * step - v).abs());
            }
            if error < smallest {
                (smallest, best) = (error, (mantissas, e));
            }
        }
        best
    }
}

/// `(code / 255)^2.2` of every code.
fn gamma() -> &'static [f64; 256] {
    static GAMMA: LazyLock<[f64; 256]> = LazyLock::new(|| {
        let mut table = [0.0; 256];
        for (code, slot) in (0u32..).zip(&mut table) {
            *slot = libm::pow(f64::from(code) / 255.0, 2.2);
        }
        table
    });
    &GAMMA
}

/// The value of an RGBD code.
pub(crate) fn rgbd(code: u8, d: u8) -> f64 {
    gamma()[usize::from(code)] / (f64::from(d) / 255.0)
}

/// Codes and d of the nearest RGBD texel; at most three values in [0, 255].
pub(crate) fn rgbd_nearest(texel: &[f64]) -> ([u8; 3], u8) {
    let mut best = ([0; 3], 255);
    let mut smallest = f64::INFINITY;
    for d in (1..=255u8).rev() {
        let mut codes = [0; 3];
        let mut error = 0.0_f64;
        for (code, &v) in codes.iter_mut().zip(texel) {
            *code = gamma_nearest(v, d);
            error = error.max((rgbd(*code, d) - v).abs());
        }
        if error < smallest {
            (smallest, best) = (error, (codes, d));
        }
        if smallest.abs() == 0.0 {
            break;
        }
    }
    best
}

/// Equal parts of [0, 1] for each of which [`gamma_below`] knows where to begin.
const PARTS: u16 = 4096;

/// For the beginning of each part the largest code that stands for no more.
fn gamma_below(v: f64) -> u8 {
    static BELOW: LazyLock<Vec<u8>> = LazyLock::new(|| {
        let gamma = gamma();
        let of = |k: u16| {
            let v = f64::from(k) / f64::from(PARTS);
            let above = gamma.partition_point(|g| *g <= v).max(1);
            u8::try_from(above - 1).unwrap_or(u8::MAX)
        };
        (0..=PARTS).map(of).collect()
    });
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let part = (v.clamp(0.0, 1.0) * f64::from(PARTS)) as usize;
    BELOW[part]
}

/// The code whose value is nearest to `v` at `d`; ties to the even code.
fn gamma_nearest(v: f64, d: u8) -> u8 {
    // value(low) <= v < value(low + 1), or low is 0 or 254
    let mut low = gamma_below(v * (f64::from(d) / 255.0)).min(254);
    while low > 0 && rgbd(low, d) > v {
        low -= 1;
    }
    while low < 254 && rgbd(low + 1, d) <= v {
        low += 1;
    }
    let high = low + 1;
    let (below, above) = (v - rgbd(low, d), rgbd(high, d) - v);
    let tie = (below - above).abs() == 0.0;
    if below < above || tie && low.is_multiple_of(2) { low } else { high }
}

impl Coding {
    /// The number that a unorm code stands for; of other codings the number itself.
    pub(crate) fn decode(self, code: f64, range: [f64; 2]) -> f64 {
        match self {
            Coding::Unorm { top, .. } => range[0] + code / top * (range[1] - range[0]),
            _ => code,
        }
    }

    /// Distance of neighbouring numbers at `value`. Of a coding that shares something between channels: where `value`
    /// is the largest of its texel.
    pub(crate) fn ulp(self, value: f64, range: [f64; 2]) -> f64 {
        match self {
            Coding::Binary { digits, least, largest, .. } => {
                power_of_two((exponent(value).clamp(least, exponent(largest)) - digits + 1).max(-1022))
            }
            Coding::Unorm { top, step } => step * (range[1] - range[0]) / top,
            Coding::Shared(shared) => {
                let [least, most] = shared.exponents;
                power_of_two((exponent(value) - exponent(shared.top)).clamp(least, most))
            }
            Coding::Rgbd => {
                let v = value.abs().min(RGBD_LARGEST);
                let (codes, d) = rgbd_nearest(&[v]);
                let low = codes[0].min(254);
                rgbd(low + 1, d) - rgbd(low, d)
            }
        }
    }
}

/// `floor(log2 |x|)` of a normal number; -1023 for zero and subnormals, 1024 for infinity and NaN.
#[allow(clippy::cast_possible_truncation, reason = "eleven bits are left")]
pub(crate) fn exponent(x: f64) -> i32 {
    (x.to_bits() >> 52 & 0x7ff) as i32 - 1023
}

/// `2^n` for -1022 <= n <= 1023.
pub(crate) fn power_of_two(n: i32) -> f64 {
    f64::from_bits(u64::from((n + 1023).unsigned_abs()) << 52)
}
