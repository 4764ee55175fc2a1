//! Decoded images: planes of f32 with names, and their pyramids. Knows nothing of what the numbers mean.
//!
//! Rows run from the top. Codes of 8 and 16 bits are divided by their largest; a colour space is undone only where it is
//! asked for. Palettes, interlacing and one-bit greys are unfolded by the decoder. Files are not trusted: sizes are checked
//! before memory is asked for ([`MAX_PIXELS`]), and what is damaged is an error.

mod covered;
#[cfg(feature = "pictures")]
mod jpeg;
mod levels;
mod png;
mod pyramid;
mod read;
mod resample;
mod write;

pub use covered::{CoverError, Covered};
pub use levels::{Codes, Levels, codes, levels};
pub(crate) use png::Png;
pub use pyramid::{Coverage, count_levels, halved, shrink};
pub use read::{facts, is_picture, read_bytes, read_within};
pub use resample::Wrap;
pub use write::write_png;

/// Most pixels of a picture: 8192 x 8192.
pub const MAX_PIXELS: usize = 1 << 26;

/// A decoded image.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Channels in file order.
    pub planes: Vec<Plane>,
}

/// One channel.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Name: `R`, `G`, `B`, `A`, `Y`, or as in the file.
    pub name: String,
    /// Values, rows from the top.
    pub values: Vec<f32>,
}

/// What the codes of colours mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Space {
    /// The number itself: parameters, normals.
    Linear,
    /// The transfer curve of sRGB (IEC 61966-2-1).
    Srgb,
}

/// Why an image cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// Of no kind that is read here.
    #[error("not an image of a format that is read here (it begins with {0:02x?})")]
    Unknown(
        /// The first bytes.
        Vec<u8>,
    ),
    /// More pixels than are read.
    #[error("{width} x {height} pixels: from 1 to {MAX_PIXELS} (8192 x 8192) are read")]
    Pixels {
        /// Width in pixels.
        width: usize,
        /// Height in pixels.
        height: usize,
    },
    /// More memory than may be taken.
    #[error("{width} x {height} pixels take {needed} bytes to decode, and {limit} may be taken")]
    Memory {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Bytes that decoding takes.
        needed: u64,
        /// Bytes that may be taken.
        limit: u64,
    },
    /// Damaged, cut short, or of a kind that the decoder does not know.
    #[error("{format}: {fault}")]
    Damaged {
        /// `png` or `jpeg`.
        format: &'static str,
        /// The decoder's message.
        fault: String,
    },
    /// A format that this build does not read.
    #[error("{format} needs the feature `pictures` of the crate, which this build does not have")]
    Feature {
        /// `jpeg` or `webp`.
        format: &'static str,
    },
    /// A channel that is not there.
    #[error("no channel `{wanted}`; there is {got}")]
    Channel {
        /// The name asked for.
        wanted: String,
        /// Names in the file.
        got: String,
    },
}

impl Picture {
    /// A channel by its name. Grey serves for any of the colours, and `R` for grey.
    ///
    /// # Errors
    /// [`PictureError::Channel`] if there is none.
    pub fn plane(&self, name: &str) -> Result<&Plane, PictureError> {
        let find = |name: &str| self.planes.iter().find(|p| p.name == name);
        let grey = || if ["R", "G", "B"].contains(&name) { find("Y") } else { None };
        find(name).or_else(grey).ok_or_else(|| PictureError::Channel {
            wanted: name.to_owned(),
            got: self.planes.iter().map(|p| p.name.as_str()).collect::<Vec<_>>().join(", "),
        })
    }
}

impl Space {
    /// A code in [0, 1] as a linear number.
    #[must_use]
    pub fn decode(self, code: f32) -> f32 {
        match self {
            Space::Linear => code,
            Space::Srgb if code <= 0.040_45 => code / 12.92,
            Space::Srgb => libm::powf((code + 0.055) / 1.055, 2.4),
        }
    }

    /// A linear number as a code.
    #[must_use]
    pub fn encode(self, linear: f64) -> f64 {
        match self {
            Space::Linear => linear,
            Space::Srgb if linear <= 0.003_130_8 => linear * 12.92,
            Space::Srgb => 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055,
        }
    }

    /// A linear number, clamped to [0, 1], as a code of 8 bits.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in [0, 255] by the clamp")]
    pub fn byte(self, linear: f64) -> u8 {
        (255.0 * self.encode(linear.clamp(0.0, 1.0))).round() as u8
    }
}

#[cfg(test)]
mod tests {
    use super::Space;

    #[test]
    fn codes_are_those_of_the_standard() {
        // middle grey of 18 % is code 118 in every table of the standard; 188 is half the light
        let codes = [0.0, 0.002, 0.18, 0.5, 1.0, 7.0, f64::NAN].map(|v| Space::Srgb.byte(v));
        assert_eq!(codes, [0, 7, 118, 188, 255, 255, 0]);
    }
}
