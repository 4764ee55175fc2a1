//! The images of a map: where they are, how their numbers are to be read, and what is known of them before they are decoded.

use crate::cancel::Cancel;
use crate::encode::{ReadError, read};
use crate::functions::conversion::{By, Conversion};
use crate::maps::Convention;
use crate::picture::{self, PictureError, Space, Wrap};
use rayon::prelude::*;
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
    pub(super) fn used(&self) -> &[String] {
        &self.channels[..if self.convention.derive_z { 2 } else { 3 }]
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
}

/// Codes of lobes of another kind.
#[derive(Debug, Clone, Copy)]
pub struct FromLobe {
    /// The parametrisation, of one number.
    pub conversion: &'static Conversion,
    /// Numbers of the codes 0 and 1.
    pub range: [f64; 2],
    /// True if the codes are spread over the logarithm.
    pub log: bool,
    /// How the lobe becomes GGX.
    pub by: By,
}

impl PartialEq for FromLobe {
    fn eq(&self, other: &FromLobe) -> bool {
        let key = |f: &FromLobe| (f.conversion.id, f.range.map(f64::to_bits), f.log, f.by);
        key(self) == key(other)
    }
}

impl FromLobe {
    /// Roughness and D of a code.
    #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
    fn convert(&self, code: f32) -> [f32; 2] {
        let [lo, hi] = self.range;
        let c = f64::from(code);
        let number = if self.log { lo * libm::pow(hi / lo, c) } else { lo + (hi - lo) * c };
        let found = self.conversion.convert([number.clamp(lo.min(hi), lo.max(hi)); 2], self.by);
        [found.alphas[0].min(1.0).sqrt() as f32, found.distance as f32]
    }

    /// The same of many codes, each of them once.
    #[must_use]
    pub fn convert_all(&self, codes: &[f32]) -> Vec<[f32; 2]> {
        let mut keys: Vec<u32> = codes.iter().map(|c| c.to_bits()).collect();
        keys.sort_unstable();
        keys.dedup();
        let found: Vec<[f32; 2]> = keys.par_iter().map(|k| self.convert(f32::from_bits(*k))).collect();
        let at = |c: &f32| keys.binary_search(&c.to_bits()).map_or([0.0; 2], |i| found[i]);
        codes.iter().map(at).collect()
    }
}

/// What is known of an image without its pixels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Facts {
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
    let (size, names) = if picture::MAGIC.iter().any(|(magic, _)| bytes.starts_with(magic)) {
        picture::facts(&bytes).map_err(Unknown::Picture)?
    } else {
        let image = read::read_bytes_until(&cancel, &bytes).map_err(Unknown::Read)?;
        ([image.width, image.height], image.channels.into_iter().map(|c| c.name).collect())
    };
    let [width, height] = size;
    if width.saturating_mul(height) > picture::MAX_PIXELS || width * height == 0 {
        return Err(Unknown::Picture(PictureError::Pixels { width, height }));
    }
    Ok(Facts { size, names, blake3 })
}
