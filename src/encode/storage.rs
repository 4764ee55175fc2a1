//! How a value is stored: the bits of one number, apart from the container that holds them.
//!
//! Rounding is done once, here, straight from f64 and to the nearest even. It does not go through `half::f16::from_f64`
//! (2.7): on x86 with F16C that rounds twice (f64 to f32 to half), and its portable path ignores the low 32 bits of the
//! mantissa. Either way 1 + 2^-11 + 2^-52, just above a tie, becomes 1 instead of 1 + 2^-10 (`tests/encode.rs`).
//!
//! A new storage is one variant, one entry in [`STORAGES`] and one `Coding`. Most code each number by itself; three code
//! the channels of a texel together ([`Storage::quantise_texel`]), and four code blocks of 4 x 4 texels together, whose
//! bytes [`quantise_table`](super::quantise_table) makes.

use super::blocks::{self, Kind};
use super::coding::{self, Coding, RGBD_LARGEST, Shared, exponent, power_of_two};
use crate::math::figures::exact;
use serde::{Deserialize, Serialize};

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Storage {
    /// IEEE 754 binary16: 11 bits, largest 65504, smallest step 2^-24.
    Half,
    /// IEEE 754 binary32: 24 bits.
    Float,
    /// IEEE 754 binary64: the integral as it was computed.
    Double,
    /// 8-bit code over the range of the channel: `lo + code / 255 (hi - lo)`.
    Unorm8,
    /// 16-bit code over the range of the channel: `lo + code / 65535 (hi - lo)`.
    Unorm16,
    /// Up to three 10-bit codes over the ranges of their channels, `lo + code / 1023 (hi - lo)`; the two bits of the
    /// fourth component hold none. `A2B10G10R10` of Vulkan, `R10G10B10A2` of DXGI.
    Rgb10a2,
    /// Up to three unsigned floats without sign: 6 bits of mantissa for red and green, 5 for blue, largest 65024 and
    /// 64512. `B10G11R11` of Vulkan, `R11G11B10` of DXGI.
    R11g11b10,
    /// Up to three 9-bit mantissas with one 5-bit exponent: `m 2^(E - 24)`, largest 65408.
    Rgb9e5,
    /// Up to three 8-bit mantissas with one 8-bit exponent, as in Radiance pictures: `m 2^(E - 136)`. Radiance's own
    /// programs read `(m + 1/2)`; nearly all others, and this one, read `m`.
    Rgbe,
    /// Up to three 8-bit codes with a divisor, as Babylon.js expands them: `(code / 255)^2.2 / (d / 255)`, largest 255.
    Rgbd,
    /// One channel in blocks of 4 x 4 texels, 4 bits a texel: eight or six numbers between two 8-bit codes over the range of
    /// the channel.
    Bc4,
    /// Two channels, each as [`Storage::Bc4`], 8 bits a texel.
    Bc5,
    /// Up to three unsigned half floats in blocks of 4 x 4 texels, 8 bits a texel: numbers between two or four endpoints.
    Bc6h,
    /// [`Storage::Bc6h`] with signs.
    Bc6hSigned,
}

/// Every storage.
pub static STORAGES: &[Storage] = &[
    Storage::Half,
    Storage::Float,
    Storage::Double,
    Storage::Unorm8,
    Storage::Unorm16,
    Storage::Rgb10a2,
    Storage::R11g11b10,
    Storage::Rgb9e5,
    Storage::Rgbe,
    Storage::Rgbd,
    Storage::Bc4,
    Storage::Bc5,
    Storage::Bc6h,
    Storage::Bc6hSigned,
];

/// How far beyond an end of its range a unorm value may lie, as a part of the range, and how far below zero a value
/// without sign: the noise of sums in f64, such as an albedo of 1 + 4e-16. It is far below any step, so this is rounding;
/// anything further out is a finding.
const NOISE: f64 = 1e-12;

/// Why a value has no stored form.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QuantiseError {
    /// NaN or infinite.
    #[error("value {} is not a finite number", exact(.value))]
    NotFinite {
        /// The value.
        value: f64,
    },
    /// It would round to infinity.
    #[error("value {} overflows {storage}: the largest is {}", exact(.value), exact(.limit))]
    Overflow {
        /// The value.
        value: f64,
        /// Largest number of this storage.
        limit: f64,
        /// Storage id.
        storage: &'static str,
    },
    /// Outside the range that a unorm encodes.
    #[error(
        "value {} outside the range [{}, {}] that {storage} encodes; store it as half or float",
        exact(.value),
        exact(.lo),
        exact(.hi)
    )]
    OutOfRange {
        /// The value.
        value: f64,
        /// Low end of the range.
        lo: f64,
        /// High end of the range.
        hi: f64,
        /// Storage id.
        storage: &'static str,
    },
    /// Below zero, in a storage without sign.
    #[error("value {} is negative and {storage} has no sign; store it as half or float", exact(.value))]
    Negative {
        /// The value.
        value: f64,
        /// Storage id.
        storage: &'static str,
    },
    /// A storage that this build does not write.
    #[error("{storage} needs the feature `blocks` of the crate, which this build does not have")]
    Feature {
        /// Storage id.
        storage: &'static str,
    },
    /// More channels than a texel of this storage holds.
    #[error("{storage} holds at most {limit} channels, the table has {count}")]
    Channels {
        /// Channels of the table.
        count: usize,
        /// Most that it holds.
        limit: usize,
        /// Storage id.
        storage: &'static str,
    },
    /// The range of the channel is empty or not finite, so that a unorm cannot encode it.
    #[error(
        "{storage} needs a finite range with lo < hi, got [{}, {}]; store it as half or float",
        exact(.lo),
        exact(.hi)
    )]
    Range {
        /// Low end of the range.
        lo: f64,
        /// High end of the range.
        hi: f64,
        /// Storage id.
        storage: &'static str,
    },
}

impl Storage {
    /// Id in recipes and metadata.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self {
            Storage::Half => "half",
            Storage::Float => "float",
            Storage::Double => "double",
            Storage::Unorm8 => "unorm8",
            Storage::Unorm16 => "unorm16",
            Storage::Rgb10a2 => "rgb10a2",
            Storage::R11g11b10 => "r11g11b10",
            Storage::Rgb9e5 => "rgb9e5",
            Storage::Rgbe => "rgbe",
            Storage::Rgbd => "rgbd",
            Storage::Bc4 => "bc4",
            Storage::Bc5 => "bc5",
            Storage::Bc6h => "bc6h",
            Storage::Bc6hSigned => "bc6h-signed",
        }
    }

    /// One line of meaning.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Storage::Half => "16-bit float, 11 bits, largest 65504",
            Storage::Float => "32-bit float, 24 bits",
            Storage::Double => "64-bit float",
            Storage::Unorm8 => "lo + code / 255 (hi - lo) over the range of the channel",
            Storage::Unorm16 => "lo + code / 65535 (hi - lo) over the range of the channel",
            Storage::Rgb10a2 => "lo + code / 1023 (hi - lo) over the range of the channel, 32 bits a texel",
            Storage::R11g11b10 => {
                "unsigned floats of 7, 7 and 6 bits, largest 65024 and 64512, 32 bits a texel"
            }
            Storage::Rgb9e5 => "9 bits each with one exponent, largest 65408, not negative, 32 bits a texel",
            Storage::Rgbe => "8 bits each with one exponent, not negative, 32 bits a texel",
            Storage::Rgbd => "(code / 255)^2.2 / (d / 255), 8 bits each and d, largest 255, not negative",
            Storage::Bc4 => "blocks of 4 x 4 texels, one channel over its range, 4 bits a texel; lossy",
            Storage::Bc5 => "blocks of 4 x 4 texels, two channels over their ranges, 8 bits a texel; lossy",
            Storage::Bc6h => "blocks of 4 x 4 texels, up to three unsigned halfs, 8 bits a texel; lossy",
            Storage::Bc6hSigned => "blocks of 4 x 4 texels, up to three halfs, 8 bits a texel; lossy",
        }
    }

    /// Looks a storage up by its id.
    #[must_use]
    pub fn find(id: &str) -> Option<Storage> {
        STORAGES.iter().copied().find(|s| s.id() == id)
    }

    /// Most channels of a texel, if the storage sets a limit.
    #[must_use]
    pub const fn most_channels(self) -> Option<usize> {
        match self {
            Storage::Rgb10a2 | Storage::R11g11b10 | Storage::Rgb9e5 | Storage::Rgbe | Storage::Rgbd => {
                Some(3)
            }
            _ => match Kind::of(self) {
                Some(kind) => Some(kind.channels()),
                None => None,
            },
        }
    }

    /// True if texels are compressed in blocks of 4 x 4 and cannot be rounded one by one.
    #[must_use]
    pub const fn is_block(self) -> bool {
        Kind::of(self).is_some()
    }

    /// How channel number `channel` is stored.
    pub(crate) const fn coding(self, channel: usize) -> Coding {
        match self {
            Storage::Half | Storage::Bc6hSigned => {
                Coding::Binary { digits: 11, least: -14, largest: 65504.0, signed: true }
            }
            Storage::Bc6h => Coding::Binary { digits: 11, least: -14, largest: 65504.0, signed: false },
            Storage::Float => {
                Coding::Binary { digits: 24, least: -126, largest: f32::MAX as f64, signed: true }
            }
            Storage::Double => Coding::Binary { digits: 53, least: -1022, largest: f64::MAX, signed: true },
            Storage::Unorm8 => Coding::Unorm { top: 255.0, step: 1.0 },
            Storage::Unorm16 => Coding::Unorm { top: 65535.0, step: 1.0 },
            Storage::Rgb10a2 => Coding::Unorm { top: 1023.0, step: 1.0 },
            Storage::Bc4 | Storage::Bc5 => Coding::Unorm { top: blocks::TOP, step: blocks::STEP },
            Storage::R11g11b10 if channel == 2 => {
                Coding::Binary { digits: 6, least: -14, largest: 64512.0, signed: false }
            }
            Storage::R11g11b10 => Coding::Binary { digits: 7, least: -14, largest: 65024.0, signed: false },
            Storage::Rgb9e5 => Coding::Shared(coding::RGB9E5),
            Storage::Rgbe => Coding::Shared(coding::RGBE),
            Storage::Rgbd => Coding::Rgbd,
        }
    }

    /// The number that a reader gets back: `value` rounded to the nearest stored one, ties to even, as the only channel
    /// of its texel, and of its block.
    ///
    /// `range` is the channel's; only a unorm uses it. A unorm takes a value beyond an end of its range by at most
    /// 1e-12 of the range for that end, and a storage without sign one of at least -1e-12 for zero: the noise of sums
    /// in f64.
    ///
    /// Range: the stored numbers. Accuracy: exact, at most half a [`Storage::ulp`] from `value` (`tests/encode.rs`).
    ///
    /// ```
    /// use brdfbake::encode::Storage;
    /// assert_eq!(Storage::Half.quantise(0.1, [0.0, 1.0]), Ok(0.0999755859375));
    /// assert!(Storage::Half.quantise(65520.0, [0.0, 1.0]).is_err());
    /// assert!(Storage::Unorm16.quantise(1.0001, [0.0, 1.0]).is_err());
    /// ```
    ///
    /// # Errors
    /// [`QuantiseError`] for a value without stored form; nothing is ever clamped.
    pub fn quantise(self, value: f64, range: [f64; 2]) -> Result<f64, QuantiseError> {
        let mut texel = [value];
        self.quantise_texel(&mut texel, |_| range).map_err(|(_, e)| e)?;
        Ok(texel[0])
    }

    /// Integer code of a value, as f64: `round((value - lo) / (hi - lo) top)`, ties to even. Floats have none.
    pub(crate) fn code(self, value: f64, range: [f64; 2]) -> Result<f64, QuantiseError> {
        let position = self.position(value, range)?;
        Ok(if self.is_bounded() { position.round_ties_even() } else { position })
    }

    /// The code before it is rounded; of floats the number itself.
    pub(super) fn position(self, value: f64, range: [f64; 2]) -> Result<f64, QuantiseError> {
        let [lo, hi] = range;
        let storage = self.id();
        let Coding::Unorm { top, .. } = self.coding(0) else { return Ok(value) };
        if !(lo.is_finite() && hi.is_finite() && lo < hi && (hi - lo).is_finite()) {
            return Err(QuantiseError::Range { lo, hi, storage });
        }
        let x = (value - lo) / (hi - lo);
        if !(-NOISE..=1.0 + NOISE).contains(&x) {
            return Err(QuantiseError::OutOfRange { value, lo, hi, storage });
        }
        Ok((x.clamp(0.0, 1.0) * top).abs())
    }

    /// Quantises the channels of one texel in place; the error names the channel's index. A storage that couples them
    /// takes the stored texel whose largest error is smallest. A storage made of blocks holds it as if the whole block were
    /// that texel.
    ///
    /// # Errors
    /// The index of the channel and its [`QuantiseError`].
    pub fn quantise_texel(
        self,
        texel: &mut [f64],
        range: impl Fn(usize) -> [f64; 2],
    ) -> Result<(), (usize, QuantiseError)> {
        let (count, storage) = (texel.len(), self.id());
        self.check_written().map_err(|e| (0, e))?;
        if let Some(limit) = self.most_channels().filter(|&limit| count > limit) {
            return Err((limit, QuantiseError::Channels { count, limit, storage }));
        }
        for (c, v) in texel.iter_mut().enumerate() {
            *v = self.round(*v, c, range(c)).map_err(|e| (c, e))?;
        }
        if let (Some(kind), Coding::Unorm { .. }) = (Kind::of(self), self.coding(0)) {
            for (c, v) in texel.iter_mut().enumerate() {
                let code = self.position(*v, range(c)).map_err(|e| (c, e))?;
                *v = self.coding(c).decode(kind.uniform_block(code), range(c));
            }
        }
        match self.coding(0) {
            Coding::Shared(shared) => {
                let (mantissas, e) = shared.nearest(texel);
                for (v, m) in texel.iter_mut().zip(mantissas) {
                    *v = m * power_of_two(e);
                }
            }
            Coding::Rgbd => {
                let (codes, d) = coding::rgbd_nearest(texel);
                for (v, code) in texel.iter_mut().zip(codes) {
                    *v = coding::rgbd(code, d);
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Rounds a value if its channel is coded by itself, and checks it in any case.
    pub(super) fn round(self, value: f64, channel: usize, range: [f64; 2]) -> Result<f64, QuantiseError> {
        if !value.is_finite() {
            return Err(QuantiseError::NotFinite { value });
        }
        let storage = self.id();
        let overflow = |limit| QuantiseError::Overflow { value, limit, storage };
        let positive = |v: f64| match v {
            v if v < -NOISE => Err(QuantiseError::Negative { value, storage }),
            v => Ok(if v > 0.0 { v } else { 0.0 }),
        };
        match self.coding(channel) {
            Coding::Binary { digits: 53, .. } => Ok(value),
            Coding::Binary { digits, least, largest, signed } => {
                let v = if signed { value } else { positive(value)? };
                let step = power_of_two(exponent(v).max(least) - digits + 1);
                let rounded = (v / step).round_ties_even() * step;
                if rounded.abs() > largest { Err(overflow(largest)) } else { Ok(rounded) }
            }
            coding @ Coding::Unorm { .. } if self.is_block() => {
                Ok(coding.decode(self.position(value, range)?, range))
            }
            coding @ Coding::Unorm { .. } => Ok(coding.decode(self.code(value, range)?, range)),
            Coding::Shared(shared) => {
                let v = positive(value)?;
                let Shared { top, exponents: [_, most] } = shared;
                let rounded = (v / power_of_two(most)).round_ties_even();
                if rounded > top { Err(overflow(shared.largest())) } else { Ok(v) }
            }
            Coding::Rgbd => {
                let v = positive(value)?;
                if v > RGBD_LARGEST { Err(overflow(RGBD_LARGEST)) } else { Ok(v) }
            }
        }
    }

    /// Distance of neighbouring stored numbers at `value` (towards infinity); `range` as in [`Storage::quantise`]. If
    /// the channels differ, that of the coarsest; if they are coupled, where `value` is the largest of its texel.
    #[must_use]
    pub fn ulp(self, value: f64, range: [f64; 2]) -> f64 {
        self.coding(2).ulp(value, range)
    }

    /// True if it encodes the range of the channel, which must then be finite.
    #[must_use]
    pub const fn is_bounded(self) -> bool {
        matches!(self.coding(0), Coding::Unorm { .. })
    }

    /// The tolerance that suits this storage when the recipe names none: half a step just below 1 of the finest
    /// channel; 1e-9 for [`Storage::Double`], whose steps are beyond any integral. Of blocks it is the finest step that they
    /// have, in a block that hardly varies; the error of the others is larger, and is what reports and files tell.
    #[must_use]
    pub fn default_tolerance(self) -> f64 {
        match self.coding(0) {
            Coding::Binary { digits: 53, .. } => 1e-9,
            Coding::Binary { digits, .. } => power_of_two(-digits - 1),
            Coding::Unorm { top, step } => 0.5 * step / top,
            Coding::Shared(Shared { top, .. }) => power_of_two(-exponent(top) - 2),
            Coding::Rgbd => (1.0 - coding::rgbd(254, 255)) / 2.0,
        }
    }
}
