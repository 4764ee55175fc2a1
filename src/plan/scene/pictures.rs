//! The images of a scene, read for the levels of their channels: from the scene's own file, or from files below a root.

use super::covered::cover;
use crate::encode::read as pictures;
use crate::picture::{self, Covered, Levels, Picture, PictureError};
use crate::plan::map::Source as MapSource;
use crate::scene::{Image, Look, Reading, Scene, Source, UriError, resolve};
use rayon::prelude::*;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Condvar, Mutex, PoisonError};

/// Most pixels of an image, if nothing else is said: 8192 x 8192.
pub const PIXELS: u64 = 1 << 26;

/// Largest image file, in bytes.
const LARGEST: u64 = 1 << 30;

/// Bytes of memory that decoding takes of f64 planes of four channels, for each pixel: containers of this program.
const PLANES: u64 = 40;

/// Steps of following meshes over the images of a scene, shared evenly: beyond them nobody waits.
const MOST_STEPS: u64 = 1 << 28;

const KTX2: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";

/// Reads images, several at once, with memory for [`bytes_of`] a number of pixels together.
#[derive(Debug)]
pub struct Pictures {
    root: Option<PathBuf>,
    limit: u64,
    left: Mutex<u64>,
    freed: Condvar,
}

/// Memory for images of so many pixels: four bytes each.
#[must_use]
pub const fn bytes_of(pixels: u64) -> u64 {
    pixels.saturating_mul(4)
}

impl Pictures {
    /// Reads files below `root`, or below the folder of each scene if there is none, of at most `pixels` pixels.
    #[must_use]
    pub fn new(root: Option<PathBuf>, pixels: u64) -> Pictures {
        let limit = bytes_of(pixels);
        Pictures { root, limit, left: Mutex::new(limit), freed: Condvar::new() }
    }

    /// What is in the images of a scene in `folder`, and in the texels that its meshes cover where it was read with these. What
    /// cannot be read is noted with the reason.
    #[must_use]
    pub fn look(&self, scene: &Scene, folder: &Path) -> Look {
        let mut readings: BTreeMap<usize, BTreeSet<Reading>> = BTreeMap::new();
        for sampled in scene.readings() {
            if let (Some(image), Some(reading)) = (sampled.image, sampled.reading) {
                readings.entry(image).or_default().insert(reading);
            }
        }
        let count = readings.values().map(BTreeSet::len).sum::<usize>().max(1) as u64;
        let bytes = |source, part| self.part(source, part, folder);
        let cover = |reading: &Reading, size: [usize; 2]| {
            let mut covered = Covered::new(size, reading.wrap, reading.linear, MOST_STEPS / count);
            cover(&scene.geometry, reading, &bytes, &mut covered).map(|()| covered)
        };
        let none = BTreeSet::new();
        let one = |image: &Image| {
            let readings = readings.get(&image.index).unwrap_or(&none);
            self.with(image, folder, |bytes| self.decode(bytes, readings, &cover))
        };
        let found: Vec<_> = scene.images.par_iter().map(one).collect();
        let mut look = Look::none();
        for (image, found) in scene.images.iter().zip(found) {
            let (whole, parts) = match found {
                Ok((whole, parts)) => (Ok(whole), parts),
                Err(why) => (Err(why), Vec::new()),
            };
            look.add(image.index, whole);
            for (reading, part) in readings.get(&image.index).into_iter().flatten().zip(parts) {
                look.cover(image.index, *reading, part);
            }
        }
        look
    }

    /// A part of a buffer of a scene in `folder`.
    pub(super) fn part<'a>(
        &self,
        source: &'a Source,
        part: [u64; 2],
        folder: &Path,
    ) -> Result<Cow<'a, [u8]>, String> {
        let [from, length] = part.map(|n| usize::try_from(n).unwrap_or(usize::MAX));
        match source {
            Source::Missing(why) => Err(why.clone()),
            Source::Embedded(bytes) => {
                let part = bytes.get(from..from.saturating_add(length));
                part.map(Cow::Borrowed).ok_or_else(|| {
                    format!("a buffer view ends beyond the {} bytes of its buffer", bytes.len())
                })
            }
            Source::File { names, .. } => {
                let said = |why: String| format!("{}: {why}", crate::math::shown::show(&names.join("/")));
                let root = self.root.as_deref().unwrap_or(folder);
                let path = resolve(folder, root, names).map_err(|e| said(e.to_string()))?;
                file(&path, Some(part)).map(Cow::Owned).map_err(said)
            }
        }
    }

    /// All of a picture of a scene in `folder`.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub fn picture(&self, scene: &Scene, image: usize, folder: &Path) -> Result<Picture, String> {
        let found = scene.images.iter().find(|i| i.index == image);
        let image = found.ok_or_else(|| format!("images[{image}] is not read"))?;
        self.with(image, folder, |bytes| picture::read_within(bytes, self.limit).map_err(|e| e.to_string()))
    }

    /// An image of a scene in `folder`, not decoded: its file, or its bytes where it is a part of one.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub fn source(&self, scene: &Scene, image: usize, folder: &Path) -> Result<MapSource, String> {
        let found = scene.images.iter().find(|i| i.index == image);
        let image = found.ok_or_else(|| format!("images[{image}] is not read"))?;
        if let Source::File { names, part: None } = &image.source {
            let root = self.root.as_deref().unwrap_or(folder);
            let said = |e: UriError| format!("{}: {e}", crate::math::shown::show(&names.join("/")));
            return resolve(folder, root, names).map(MapSource::File).map_err(said);
        }
        let name = image.at.clone();
        self.with(image, folder, |bytes| Ok(MapSource::Memory { name, bytes: bytes.into() }))
    }

    /// What is made of the bytes of an image.
    fn with<T>(
        &self,
        image: &Image,
        folder: &Path,
        make: impl FnOnce(&[u8]) -> Result<T, String>,
    ) -> Result<T, String> {
        match &image.source {
            Source::Missing(why) => Err(why.clone()),
            Source::Embedded(bytes) => make(bytes),
            Source::File { names, part } => {
                let shown = crate::math::shown::show(&names.join("/"));
                let said = |why: String| format!("{shown}: {why}");
                let root = self.root.as_deref().unwrap_or(folder);
                let path = resolve(folder, root, names).map_err(|e| said(e.to_string()))?;
                let bytes = file(&path, *part).map_err(said)?;
                make(&bytes).map_err(said)
            }
        }
    }

    /// The files that the images and the geometry of a scene in `folder` lie in, as far as they may be read.
    #[must_use]
    pub fn files(&self, scene: &Scene, folder: &Path) -> Vec<PathBuf> {
        let root = self.root.as_deref().unwrap_or(folder);
        let file = |source: &Source| match source {
            Source::File { names, .. } => resolve(folder, root, names).ok(),
            _ => None,
        };
        let images = scene.images.iter().map(|image| &image.source);
        images.chain(scene.geometry.buffers.values()).filter_map(file).collect()
    }

    fn decode(&self, bytes: &[u8], readings: &BTreeSet<Reading>, cover: &Cover<'_>) -> Result<Seen, String> {
        let mut taken = Taken { from: self, bytes: 0 };
        if bytes.starts_with(KTX2) {
            let image = plain(bytes, &mut taken)?;
            let part = |reading| {
                let covered = cover(reading, [image.width, image.height])?;
                plain_levels(&image, |i| covered.has(i))
            };
            return Ok((plain_levels(&image, |_| true)?, readings.iter().map(part).collect()));
        }
        let make = |codes: &picture::Codes<'_>| {
            let part = |reading| cover(reading, codes.size).map(|covered| codes.levels(|i| covered.has(i)));
            (codes.levels(|_| true), readings.iter().map(part).collect())
        };
        picture::codes(bytes, |needed| taken.take(needed), make).map_err(|e| match e {
            PictureError::Memory { .. } => format!("{e}; allow more with `--pixels`"),
            other => other.to_string(),
        })
    }
}

/// Marks what a reading reads of a picture of a size.
type Cover<'a> = dyn Fn(&Reading, [usize; 2]) -> Result<Covered, String> + Sync + 'a;

/// The levels of an image, and those of what each reading of it covers.
type Seen = ([Levels; 4], Vec<Result<[Levels; 4], String>>);

/// Memory that is given back when the picture is gone.
struct Taken<'a> {
    from: &'a Pictures,
    bytes: u64,
}

impl Taken<'_> {
    /// Waits until so many bytes are free.
    fn take(&mut self, needed: u64) -> Result<(), u64> {
        if needed > self.from.limit {
            return Err(self.from.limit);
        }
        let mut left = self.from.left.lock().unwrap_or_else(PoisonError::into_inner);
        while *left < needed {
            left = self.from.freed.wait(left).unwrap_or_else(PoisonError::into_inner);
        }
        *left -= needed;
        self.bytes += needed;
        Ok(())
    }
}

impl Drop for Taken<'_> {
    fn drop(&mut self) {
        *self.from.left.lock().unwrap_or_else(PoisonError::into_inner) += self.bytes;
        self.from.freed.notify_all();
    }
}

/// A KTX2 texture of a plain format.
fn plain(bytes: &[u8], taken: &mut Taken<'_>) -> Result<pictures::Image, String> {
    let word =
        |at: usize| bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map_or(0, u32::from_le_bytes);
    let (width, height) = (word(20), word(24).max(1));
    let needed = u64::from(width).saturating_mul(u64::from(height)).saturating_mul(PLANES);
    taken.take(needed).map_err(|limit| {
        format!("{}; allow more with `--pixels`", PictureError::Memory { width, height, needed, limit })
    })?;
    pictures::read_bytes(bytes).map_err(|e| e.to_string())
}

/// The levels of its first level's texels that count.
fn plain_levels(image: &pictures::Image, counts: impl Fn(usize) -> bool) -> Result<[Levels; 4], String> {
    let mut all = [Levels::ONE; 4];
    for (name, levels) in ["R", "G", "B", "A"].iter().zip(&mut all) {
        let grey = if *name == "A" { None } else { image.channel("Y") };
        let Some(plane) = image.channel(name).or(grey) else { continue };
        let values = plane.values.iter().enumerate().filter(|(i, _)| counts(*i));
        let mut codes: Vec<f64> = values.map(|(_, value)| *value).collect();
        codes.sort_by(f64::total_cmp);
        codes.dedup();
        let [lo, hi] = [codes.first(), codes.last()].map(|v| v.copied().unwrap_or(0.0));
        if !(0.0..=1.0).contains(&lo) || !(0.0..=1.0).contains(&hi) {
            return Err(format!(
                "its channel {name} goes from {lo} to {hi}, and factors are multiplied by [0, 1]"
            ));
        }
        *levels = Levels { lo, hi, count: u32::try_from(codes.len()).unwrap_or(u32::MAX) };
    }
    Ok(all)
}

/// A file, or a part of it.
fn file(path: &Path, part: Option<[u64; 2]>) -> Result<Vec<u8>, String> {
    let said = |e: std::io::Error| e.to_string();
    // asked before opening: opening a pipe would wait for a writer
    if !path.metadata().map_err(said)?.is_file() {
        return Err("not a regular file".to_owned());
    }
    let mut file = File::open(path).map_err(said)?;
    let size = file.metadata().map_err(said)?.len();
    let [from, length] = part.unwrap_or([0, size]);
    if from.checked_add(length).is_none_or(|end| end > size) {
        return Err(format!("bytes {from} to {} of a file of {size}", from.saturating_add(length)));
    }
    if length > LARGEST {
        return Err(format!("{length} bytes, and images of at most {LARGEST} are read"));
    }
    file.seek(SeekFrom::Start(from)).map_err(said)?;
    let mut bytes = Vec::new();
    file.take(length).read_to_end(&mut bytes).map_err(said)?;
    Ok(bytes)
}
