//! Reads pictures, of this program or another, into f64 channels.
//!
//! Files are not trusted. Sizes are checked before memory is asked for ([`MAX_BYTES`], [`MAX_SAMPLES`]); a damaged file
//! is an error, never a panic and never a picture with holes in it.

use super::coding::Coding;
pub use super::open::{
    load, load_until, read_bytes, read_bytes_until, read_file, read_file_until, read_level_until,
};
use super::storage::Storage;
use crate::cancel::Cancelled;
use crate::grid::Provenance;
use crate::grid::provenance::SCHEMA;
use serde::Serialize;
use std::path::PathBuf;

/// Most bytes of a file.
pub const MAX_BYTES: u64 = 1 << 31;

/// Most samples (pixels times channels, all parts together) of a file: 2 GiB as f64.
pub const MAX_SAMPLES: usize = 1 << 28;

/// A picture as f64 channels.
#[derive(Debug, Clone, PartialEq)]
pub struct Image {
    /// Container id: `exr`.
    pub format: &'static str,
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Channels in file order.
    pub channels: Vec<Plane>,
    /// What the file says of itself, if it says anything.
    pub provenance: Option<Claim>,
    /// What is wrong with a file that is read all the same, in words.
    pub warnings: Vec<String>,
}

/// One channel.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Name: as in the file, with the part before it in a file of several parts (`part.channel`). The samples of a PNG
    /// are named `Y`, `A`, `R`, `G`, `B`, or by the provenance if the file holds one.
    pub name: String,
    /// How its samples are stored.
    pub sample: Sample,
    /// The range that unorm codes are spread over: [0, 1], or that of the provenance.
    pub range: [f64; 2],
    /// Values, rows from the top.
    pub values: Vec<f64>,
}

/// What the `brdfbake` attribute of a file holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Claim {
    /// The provenance.
    Known(Box<Provenance>),
    /// Those of several tables in one file, in its order.
    Several(Vec<Provenance>),
    /// A text that is not a provenance of this version.
    Unknown {
        /// The text.
        text: String,
        /// Why it was not understood.
        fault: String,
    },
}

/// How samples are stored in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sample {
    /// 16-bit float.
    Half,
    /// 32-bit float.
    Float,
    /// 32-bit integer (EXR), the number itself.
    Uint32,
    /// 64-bit float.
    Double,
    /// 8-bit code (PNG of 1 to 8 bits, palettes included).
    Unorm8,
    /// 16-bit code.
    Unorm16,
    /// 10-bit code.
    Rgb10a2,
    /// Unsigned float of 11 or 10 bits.
    R11g11b10,
    /// 9-bit mantissa with the exponent of its texel.
    Rgb9e5,
    /// 8-bit mantissa with the exponent of its texel.
    Rgbe,
    /// 8-bit code with the divisor of its texel.
    Rgbd,
    /// Number of a ramp of its block.
    Bc4,
    /// Number of a ramp of its block; the other channel has its own.
    Bc5,
    /// Unsigned half of its block.
    Bc6h,
    /// Half of its block.
    Bc6hSigned,
}

impl Sample {
    /// The sample type of a storage.
    #[must_use]
    pub const fn of(storage: Storage) -> Sample {
        match storage {
            Storage::Half => Sample::Half,
            Storage::Float => Sample::Float,
            Storage::Double => Sample::Double,
            Storage::Unorm8 => Sample::Unorm8,
            Storage::Unorm16 => Sample::Unorm16,
            Storage::Rgb10a2 => Sample::Rgb10a2,
            Storage::R11g11b10 => Sample::R11g11b10,
            Storage::Rgb9e5 => Sample::Rgb9e5,
            Storage::Rgbe => Sample::Rgbe,
            Storage::Rgbd => Sample::Rgbd,
            Storage::Bc4 => Sample::Bc4,
            Storage::Bc5 => Sample::Bc5,
            Storage::Bc6h => Sample::Bc6h,
            Storage::Bc6hSigned => Sample::Bc6hSigned,
        }
    }

    /// The storage, if there is one for it.
    const fn storage(self) -> Option<Storage> {
        Some(match self {
            Sample::Half => Storage::Half,
            Sample::Float => Storage::Float,
            Sample::Double => Storage::Double,
            Sample::Unorm8 => Storage::Unorm8,
            Sample::Unorm16 => Storage::Unorm16,
            Sample::Rgb10a2 => Storage::Rgb10a2,
            Sample::R11g11b10 => Storage::R11g11b10,
            Sample::Rgb9e5 => Storage::Rgb9e5,
            Sample::Rgbe => Storage::Rgbe,
            Sample::Rgbd => Storage::Rgbd,
            Sample::Bc4 => Storage::Bc4,
            Sample::Bc5 => Storage::Bc5,
            Sample::Bc6h => Storage::Bc6h,
            Sample::Bc6hSigned => Storage::Bc6hSigned,
            Sample::Uint32 => return None,
        })
    }

    /// Id in reports.
    #[must_use]
    pub const fn id(self) -> &'static str {
        match self.storage() {
            Some(storage) => storage.id(),
            None => "uint32",
        }
    }

    const fn coding(self) -> Coding {
        match self.storage() {
            // of channels that differ, the coarsest
            Some(storage) => storage.coding(2),
            None => Coding::Binary { digits: 1, least: 0, largest: 1.0, signed: false },
        }
    }

    /// Distance of neighbouring stored numbers at `value`.
    #[must_use]
    pub fn ulp(self, value: f64, range: [f64; 2]) -> f64 {
        self.coding().ulp(value, range)
    }

    /// The code of a number that was read over [0, 1]; floats are their own code. Of blocks it need not be whole.
    pub(super) fn encode(self, value: f64) -> f64 {
        let storage = self.storage();
        let code = storage.filter(|s| !s.is_block()).map(|s| s.code(value, [0.0, 1.0]));
        let position = || storage.map(|s| s.position(value, [0.0, 1.0]));
        code.or_else(position).and_then(Result::ok).unwrap_or(value)
    }

    /// The number that a code stands for; floats are their own code.
    pub(super) fn decode(self, code: f64, range: [f64; 2]) -> f64 {
        self.coding().decode(code, range)
    }
}

/// A level that a file does not have.
pub(super) fn no_level(format: &'static str, level: usize, levels: usize) -> ReadError {
    let has =
        if levels == 1 { "one level, 0".to_owned() } else { format!("levels 0 to {}", levels.max(1) - 1) };
    ReadError::Fault { format, fault: format!("level {level} is not in the file, which has {has}") }
}

/// Count, extremes and mean of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Statistics {
    /// Finite values.
    pub finite: usize,
    /// NaNs.
    pub nan: usize,
    /// Infinities.
    pub infinite: usize,
    /// Least finite value; infinity if there is none.
    pub min: f64,
    /// Largest finite value; minus infinity if there is none.
    pub max: f64,
    /// Mean of the finite values; 0 if there are none.
    pub mean: f64,
}

impl Plane {
    /// Extremes and mean.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        let mut s = Statistics {
            finite: 0,
            nan: 0,
            infinite: 0,
            min: f64::INFINITY,
            max: f64::NEG_INFINITY,
            mean: 0.0,
        };
        for &v in &self.values {
            if v.is_finite() {
                s.finite += 1;
                s.min = s.min.min(v);
                s.max = s.max.max(v);
                // Running mean: a sum of floats near the end of f64 would overflow.
                s.mean += (v - s.mean) / s.finite as f64;
            } else if v.is_nan() {
                s.nan += 1;
            } else {
                s.infinite += 1;
            }
        }
        s
    }
}

impl Claim {
    pub(super) fn parse(text: String) -> Claim {
        let newer = |all: &[Provenance]| all.iter().map(|p| p.schema).find(|s| *s > SCHEMA);
        let fault = |version| {
            format!("it is of metadata version {version}; this program reads versions up to {SCHEMA}")
        };
        match serde_json::from_str::<Provenance>(&text) {
            Ok(known) => match newer(std::slice::from_ref(&known)) {
                None => Claim::Known(Box::new(known)),
                Some(version) => Claim::Unknown { text, fault: fault(version) },
            },
            Err(e) => match serde_json::from_str::<Vec<Provenance>>(&text) {
                Ok(several) => match newer(&several) {
                    None => Claim::Several(several),
                    Some(version) => Claim::Unknown { text, fault: fault(version) },
                },
                Err(_) => Claim::Unknown { text, fault: e.to_string() },
            },
        }
    }
}

impl Image {
    /// The provenance, if the file has one that is understood.
    #[must_use]
    pub fn known(&self) -> Option<&Provenance> {
        match &self.provenance {
            Some(Claim::Known(p)) => Some(p),
            _ => None,
        }
    }

    /// A channel by its name.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<&Plane> {
        self.channels.iter().find(|c| c.name == name)
    }

    /// Where the provenance and the picture contradict each other, in words; empty if they agree.
    #[must_use]
    pub fn contradictions(&self) -> Vec<String> {
        let Some(p) = self.known() else { return Vec::new() };
        let mut found = Vec::new();
        let len = |i: usize| p.axes.get(i).map_or(1, |a| a.axis.len);
        let (width, height) = (len(0), len(1).saturating_mul(len(2)).saturating_mul(len(3)));
        if (width, height) != (self.width, self.height) {
            let (w, h) = (self.width, self.height);
            found.push(format!("the metadata tells of {width} x {height} texels, the picture has {w} x {h}"));
        }
        for channel in p.channels.iter().filter(|c| self.channel(&c.id).is_none()) {
            found.push(format!("the metadata tells of channel `{}`, the picture has none", channel.id));
        }
        for plane in self.channels.iter().filter(|c| p.channels.iter().all(|d| d.id != c.name)) {
            found.push(format!("the picture has channel `{}`, the metadata does not name it", plane.name));
        }
        if let Some(e) = &p.encoding
            && let Some(plane) = self.channels.iter().find(|c| c.sample.id() != e.storage)
        {
            let (name, sample) = (&plane.name, plane.sample.id());
            found.push(format!("the metadata says {}, channel `{name}` is stored as {sample}", e.storage));
        }
        found
    }
}

/// Why a file cannot be read as a picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The file cannot be opened or read.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's message.
        source: std::io::Error,
    },
    /// Larger than [`MAX_BYTES`].
    #[error("the file has {bytes} bytes; at most {MAX_BYTES} are read")]
    Bytes {
        /// Size of the file.
        bytes: u64,
    },
    /// The header tells of more than [`MAX_SAMPLES`].
    #[error("{format}: the header tells of {width} x {height} pixels; at most 2^28 samples are read")]
    Samples {
        /// Container id.
        format: &'static str,
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
    },
    /// Of no container that is read.
    #[error("not a file of {list} (it begins with {0:02x?})", list = super::readable().join(", "))]
    Unknown(
        /// The first bytes.
        Vec<u8>,
    ),
    /// The library that reads the container refused it: damaged, or of a kind that is not supported.
    #[error("{format}: {source}")]
    Library {
        /// Container id.
        format: &'static str,
        /// Its own message.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
    /// A fault that this program found.
    #[error("{format}: {fault}")]
    Fault {
        /// Container id.
        format: &'static str,
        /// What is wrong.
        fault: String,
    },
}
