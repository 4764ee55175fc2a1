//! How a value is stored: the bits of one number, apart from the container that holds them.
//!
//! Rounding is done once, here, straight from f64 and to the nearest even. It does not go through `half::f16::from_f64`
//! (2.7): on x86 with F16C that rounds twice (f64 to f32 to half), and its portable path ignores the low 32 bits of the
//! mantissa. Either way 1 + 2^-11 + 2^-52, just above a tie, becomes 1 instead of 1 + 2^-10 (`tests/encode.rs`).
//!
//! A new storage is one variant, one entry in [`STORAGES`] and one `Coding`. A coding that couples the channels of a
//! texel (RGBD, RGB9E5) hooks into [`Storage::quantise_texel`].

use crate::grid::Table;
use crate::grid::table::{Extreme, place};
use serde::{Deserialize, Serialize};

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Storage {
    /// IEEE 754 binary16: 11 bits, largest 65504, smallest step 2^-24.
    Half,
    /// IEEE 754 binary32: 24 bits.
    Float,
    /// 16-bit code over the range of the channel: `lo + code / 65535 (hi - lo)`.
    Unorm16,
}

/// Every storage.
pub static STORAGES: &[Storage] = &[Storage::Half, Storage::Float, Storage::Unorm16];

/// The arithmetic behind a storage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Coding {
    /// Binary floating point with `digits` significant bits, normal from `2^least` on, up to `largest`.
    Binary { digits: i32, least: i32, largest: f64 },
    /// Integers 0 ..= `top` spread over the range of the channel.
    Unorm { top: f64 },
}

/// How far beyond an end of its range a unorm value may lie, as a part of the range: the noise of sums in f64, such as
/// an albedo of 1 + 4e-16. It is far below any step, so this is rounding; anything further out is a finding.
const NOISE: f64 = 1e-12;

/// Why a value has no stored form.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QuantiseError {
    /// NaN or infinite.
    #[error("value {value} is not a finite number")]
    NotFinite {
        /// The value.
        value: f64,
    },
    /// It would round to infinity.
    #[error("value {value} overflows {storage}: the largest is {limit}")]
    Overflow {
        /// The value.
        value: f64,
        /// Largest number of this storage.
        limit: f64,
        /// Storage id.
        storage: &'static str,
    },
    /// Outside the range that a unorm encodes.
    #[error("value {value} outside the range [{lo}, {hi}] that {storage} encodes; store it as half or float")]
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
    /// The range of the channel is empty or not finite, so that a unorm cannot encode it.
    #[error("{storage} needs a finite range with lo < hi, got [{lo}, {hi}]; store it as half or float")]
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
            Storage::Unorm16 => "unorm16",
        }
    }

    /// Looks a storage up by its id.
    #[must_use]
    pub fn find(id: &str) -> Option<Storage> {
        STORAGES.iter().copied().find(|s| s.id() == id)
    }

    pub(crate) const fn coding(self) -> Coding {
        match self {
            Storage::Half => Coding::Binary { digits: 11, least: -14, largest: 65504.0 },
            Storage::Float => Coding::Binary { digits: 24, least: -126, largest: f32::MAX as f64 },
            Storage::Unorm16 => Coding::Unorm { top: 65535.0 },
        }
    }

    /// The number that a reader gets back: `value` rounded to the nearest stored one, ties to even.
    ///
    /// `range` is the channel's; only a unorm uses it. A unorm takes a value beyond an end of its range by at most
    /// 1e-12 of the range for that end: the noise of sums in f64.
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
        if !value.is_finite() {
            return Err(QuantiseError::NotFinite { value });
        }
        match self.coding() {
            Coding::Binary { digits, least, largest } => {
                let step = power_of_two(exponent(value).max(least) - digits + 1);
                let rounded = (value / step).round_ties_even() * step;
                if rounded.abs() > largest {
                    return Err(QuantiseError::Overflow { value, limit: largest, storage: self.id() });
                }
                Ok(rounded)
            }
            coding @ Coding::Unorm { .. } => Ok(coding.decode(self.code(value, range)?, range)),
        }
    }

    /// Integer code of a value, as f64: `round((value - lo) / (hi - lo) top)`, ties to even. Floats have none.
    pub(crate) fn code(self, value: f64, range: [f64; 2]) -> Result<f64, QuantiseError> {
        let [lo, hi] = range;
        let storage = self.id();
        let Coding::Unorm { top } = self.coding() else { return Ok(value) };
        if !(lo.is_finite() && hi.is_finite() && lo < hi && (hi - lo).is_finite()) {
            return Err(QuantiseError::Range { lo, hi, storage });
        }
        let x = (value - lo) / (hi - lo);
        if !(-NOISE..=1.0 + NOISE).contains(&x) {
            return Err(QuantiseError::OutOfRange { value, lo, hi, storage });
        }
        Ok((x * top).round_ties_even().abs())
    }

    /// Quantises the channels of one texel in place; the error names the channel's index.
    ///
    /// # Errors
    /// The index of the channel and its [`QuantiseError`].
    pub fn quantise_texel(
        self,
        texel: &mut [f64],
        range: impl Fn(usize) -> [f64; 2],
    ) -> Result<(), (usize, QuantiseError)> {
        for (c, v) in texel.iter_mut().enumerate() {
            *v = self.quantise(*v, range(c)).map_err(|e| (c, e))?;
        }
        Ok(())
    }

    /// Distance of neighbouring stored numbers at `value` (towards infinity); `range` as in [`Storage::quantise`].
    #[must_use]
    pub fn ulp(self, value: f64, range: [f64; 2]) -> f64 {
        self.coding().ulp(value, range)
    }

    /// True if it encodes the range of the channel, which must then be finite.
    #[must_use]
    pub const fn is_bounded(self) -> bool {
        matches!(self.coding(), Coding::Unorm { .. })
    }

    /// The tolerance that suits this storage when the recipe names none: half a step just below 1.
    #[must_use]
    pub fn default_tolerance(self) -> f64 {
        match self.coding() {
            Coding::Binary { digits, .. } => power_of_two(-digits - 1),
            Coding::Unorm { top } => 0.5 / top,
        }
    }
}

impl Coding {
    /// The number that a unorm code stands for.
    pub(crate) fn decode(self, code: f64, range: [f64; 2]) -> f64 {
        match self {
            Coding::Unorm { top } => range[0] + code / top * (range[1] - range[0]),
            Coding::Binary { .. } => code,
        }
    }

    pub(crate) fn ulp(self, value: f64, range: [f64; 2]) -> f64 {
        match self {
            Coding::Binary { digits, least, largest } => {
                power_of_two(exponent(value).clamp(least, exponent(largest)) - digits + 1)
            }
            Coding::Unorm { top } => (range[1] - range[0]) / top,
        }
    }
}

/// `floor(log2 |x|)` of a normal number; -1023 for zero and subnormals, 1024 for infinity and NaN.
#[allow(clippy::cast_possible_truncation, reason = "eleven bits are left")]
fn exponent(x: f64) -> i32 {
    (x.to_bits() >> 52 & 0x7ff) as i32 - 1023
}

/// `2^n` for -1022 <= n <= 1023.
fn power_of_two(n: i32) -> f64 {
    f64::from_bits(u64::from((n + 1023).unsigned_abs()) << 52)
}

/// A table as a reader will see it.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantised {
    /// Stored values, `[texel][channel]`.
    pub values: Vec<f64>,
    /// Largest |stored - integral| and where it lies.
    pub largest_error: Extreme,
}

/// A value of a table that its storage cannot hold, and where it is.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("channel {channel} at {}: {fault}", place(.at))]
pub struct RangeFault {
    /// Texel number.
    pub texel: usize,
    /// Channel id.
    pub channel: String,
    /// Axis ids and values.
    pub at: Vec<(String, f64)>,
    /// The value and its limit.
    #[source]
    pub fault: QuantiseError,
}

/// Rounds every value of a table to its stored form.
///
/// # Errors
/// [`RangeFault`] for the first value (in file order) that `storage` cannot hold.
pub fn quantise_table(table: &Table, storage: Storage) -> Result<Quantised, RangeFault> {
    let n = table.channels.len();
    let mut values = table.values.clone();
    let (mut largest, mut worst) = (0.0, 0);
    for (t, texel) in values.chunks_exact_mut(n.max(1)).enumerate() {
        storage.quantise_texel(texel, |c| table.channels[c].range).map_err(|(c, fault)| RangeFault {
            texel: t,
            channel: table.channels[c].id.clone(),
            at: table.coordinates(t),
            fault,
        })?;
        for (c, v) in texel.iter().enumerate() {
            let error = (v - table.values[t * n + c]).abs();
            if error > largest {
                (largest, worst) = (error, t * n + c);
            }
        }
    }
    let channel = table.channels.get(worst % n.max(1)).map_or_else(String::new, |c| c.id.clone());
    let largest_error = Extreme { value: largest, channel, at: table.coordinates(worst / n.max(1)) };
    Ok(Quantised { values, largest_error })
}
