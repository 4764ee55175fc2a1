//! The images of a map: where they are, how their numbers are to be read, and what is known of them before they are decoded.

use crate::cancel::Cancel;
use crate::encode::{ReadError, read};
use crate::functions::conversion::{By, Conversion};
use crate::maps::Convention;
use crate::picture::{self, PictureError, Space, Wrap};
use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Arc;

/// An image, not decoded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Source {
    /// A file.
    File(PathBuf),
    /// The bytes of one, such as a part of a scene.
    Memory {
        /// What it is called in messages: `images[3]`.
        name: String,
        /// The bytes.
        bytes: Arc<[u8]>,
    },
}

impl From<PathBuf> for Source {
    fn from(path: PathBuf) -> Source {
        Source::File(path)
    }
}

impl Source {
    /// Its path, or what it is called.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        match self {
            Source::File(path) => path.clone(),
            Source::Memory { name, .. } => PathBuf::from(name),
        }
    }

    /// Its name without folders: what files say of it.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Source::File(path) => {
                path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned())
            }
            Source::Memory { name, .. } => name.clone(),
        }
    }

    /// Its bytes.
    ///
    /// # Errors
    /// [`ReadError::Io`] for a file that cannot be read, and if stopped.
    pub fn bytes(&self, cancel: &Cancel) -> Result<Cow<'_, [u8]>, ReadError> {
        match self {
            Source::File(path) => read::load_until(cancel, path).map(Cow::Owned),
            Source::Memory { bytes, .. } => Ok(Cow::Borrowed(bytes)),
        }
    }
}

/// A normal map.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// The image.
    pub image: Source,
    /// Names of the channels of x, y and z.
    pub channels: [String; 3],
    /// How its numbers are to be read.
    pub convention: Convention,
    /// True if the numbers are on [−1, 1] already, as float images may have them.
    pub signed: bool,
    /// What lies beyond the border, where a map is resampled.
    pub wrap: [Wrap; 2],
    /// Resample the smaller map to the size of the larger one.
    pub resample: bool,
}

impl Input {
    /// Codes in R, G and B, as glTF has them.
    #[must_use]
    pub fn new(image: impl Into<Source>) -> Input {
        Input {
            image: image.into(),
            channels: ["R", "G", "B"].map(str::to_owned),
            convention: Convention::default(),
            signed: false,
            wrap: [Wrap::Repeat; 2],
            resample: false,
        }
    }

    /// The channels that are read.
    pub(crate) fn used(&self) -> &[String] {
        &self.channels[..if self.convention.derive_z { 2 } else { 3 }]
    }
}

/// Facets of two widths, as `KHR_materials_anisotropy` tells them: α_b = r² across, α_t = mix(α_b, 1, strength²) along the direction.
#[derive(Debug, Clone, PartialEq)]
pub struct AnisotropyInput {
    /// Direction in R and G, codes of [−1, 1], and strength in B; along the tangent, with a strength of 1, without one.
    pub image: Option<Source>,
    /// Factor of the strength.
    pub strength: f64,
    /// Turn of the direction, in rad against the clock from the tangent.
    pub rotation: f64,
    /// What lies beyond the border, where the image is resampled.
    pub wrap: [Wrap; 2],
    /// Resample the smaller images to the size of the largest one.
    pub resample: bool,
}

impl AnisotropyInput {
    /// Channels of its image.
    pub const CHANNELS: [&'static str; 3] = ["R", "G", "B"];
}

impl Default for AnisotropyInput {
    fn default() -> AnisotropyInput {
        AnisotropyInput {
            image: None,
            strength: 1.0,
            rotation: 0.0,
            wrap: [Wrap::Repeat; 2],
            resample: false,
        }
    }
}

/// Where the roughness comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum RoughnessInput {
    /// One number for all texels.
    Constant(f64),
    /// A channel of an image.
    Image {
        /// The image.
        image: Source,
        /// Name of the channel.
        channel: String,
        /// True if its codes are coded as sRGB, which no format of materials asks for.
        space: Space,
        /// True if it holds 1 − r: gloss, smoothness.
        gloss: bool,
        /// What the codes tell of, if it is no roughness.
        from: Option<FromLobe>,
    },
}

impl RoughnessInput {
    /// Roughness in G of an image, as glTF has it.
    #[must_use]
    pub fn new(image: impl Into<Source>) -> RoughnessInput {
        let (channel, space) = ("G".to_owned(), Space::Linear);
        RoughnessInput::Image { image: image.into(), channel, space, gloss: false, from: None }
    }

    /// What the codes tell of, if it is no roughness.
    #[must_use]
    pub fn from(&self) -> Option<&FromLobe> {
        match self {
            RoughnessInput::Image { from, .. } => from.as_ref(),
            RoughnessInput::Constant(_) => None,
        }
    }

    /// May the other channels of the image be written beside the roughness? Not where they are numbers of lobes of another kind.
    #[must_use]
    pub fn packs(&self) -> bool {
        self.from().is_none_or(|from| from.second.is_none())
    }
}

/// Codes of lobes of another kind.
#[derive(Debug, Clone)]
pub struct FromLobe {
    /// The parametrisation.
    pub conversion: &'static Conversion,
    /// Numbers of the codes 0 and 1.
    pub range: [f64; 2],
    /// True if the codes are spread over the logarithm.
    pub log: bool,
    /// How the lobe becomes GGX.
    pub by: By,
    /// The second number, of a parametrisation of two.
    pub second: Option<Second>,
}

/// Where the second number comes from: the same image, range and spread.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Second {
    /// Name of its channel.
    pub channel: String,
    /// Name of the channel of the angle of the first axis from the tangent, if there is one: codes 0..1 are half a turn.
    pub angle: Option<String>,
}

impl PartialEq for FromLobe {
    fn eq(&self, other: &FromLobe) -> bool {
        let key = |f: &FromLobe| (f.conversion.id, f.range.map(f64::to_bits), f.log, f.by);
        key(self) == key(other) && self.second == other.second
    }
}

impl FromLobe {
    /// The number of a code.
    #[must_use]
    pub fn number(&self, code: f64) -> f64 {
        let [lo, hi] = self.range;
        let number = if self.log { lo * libm::pow(hi / lo, code) } else { lo + (hi - lo) * code };
        number.clamp(lo.min(hi), lo.max(hi))
    }
}

/// What is known of an image without its pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Facts {
    /// Id of the reader: of a container, or `picture`.
    pub(super) format: &'static str,
    pub(super) size: [usize; 2],
    pub(super) names: Vec<String>,
    pub(super) blake3: String,
}

/// Why nothing is known of an image.
pub(super) enum Unknown {
    Read(ReadError),
    Picture(PictureError),
}

impl std::fmt::Display for Unknown {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Unknown::Read(e) => e.fmt(f),
            Unknown::Picture(e) => e.fmt(f),
        }
    }
}

/// Size, channels and hash of an image.
pub(super) fn facts(source: &Source) -> Result<Facts, Unknown> {
    let cancel = Cancel::new();
    let bytes = source.bytes(&cancel).map_err(Unknown::Read)?;
    let blake3 = blake3::hash(&bytes).to_hex().to_string();
    let (format, size, names) = if picture::is_picture(&bytes) {
        let (size, names) = picture::facts(&bytes).map_err(Unknown::Picture)?;
        ("picture", size, names)
    } else {
        let image = read::read_bytes_until(&cancel, &bytes).map_err(Unknown::Read)?;
        let names = image.channels.into_iter().map(|c| c.name).collect();
        (image.format, [image.width, image.height], names)
    };
    let [width, height] = size;
    if width.saturating_mul(height) > picture::MAX_PIXELS || width * height == 0 {
        return Err(Unknown::Picture(PictureError::Pixels { width, height }));
    }
    Ok(Facts { format, size, names, blake3 })
}
