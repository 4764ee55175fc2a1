//! Reads KTX2 of the formats that are written: one face, one level, slices and layers stacked.
//!
//! By hand: the crate `ktx2` (0.5) panics on a descriptor with a block dimension of 256, and little of it would be used.

use super::Storage;
use super::ktx2::{SCHEME_ZSTD, storage};
use super::read::{Claim, Image, MAX_SAMPLES, ReadError, no_level};
use super::stoppable::Stoppable;
use super::texels;
use crate::cancel::Cancel;
use crate::grid::provenance::ATTRIBUTE;
use std::io::Read;

const FORMAT: &str = "ktx2";

/// Longest provenance that is taken.
const MAX_TEXT: usize = 1 << 24;

/// A file taken apart.
struct Raw {
    storage: Storage,
    components: usize,
    /// Width, height, depth, layers; 0 where there is none.
    extent: [usize; 4],
    /// The value of the key `brdfbake`; empty if there is none.
    provenance: String,
    /// The bytes of the level, unpacked.
    pixels: Vec<u8>,
}

fn raw(bytes: &[u8], level: usize, cancel: &Cancel) -> Result<Raw, ReadError> {
    let format = word(bytes, 12)?;
    if let Some(basis) = basis(bytes)? {
        return Err(fault(format!(
            "{basis} of Basis Universal (KHR_texture_basisu) is not decoded here; give the image as PNG, WebP, or as KTX2 without it"
        )));
    }
    let (storage, components) =
        storage(format).ok_or_else(|| fault(format!("VkFormat {format} is not supported")))?;
    let faces = word(bytes, 36)?;
    if faces != 1 {
        return Err(fault(format!("{faces} faces; cube maps are not supported")));
    }
    let mut extent = [0; 4];
    for (n, at) in extent.iter_mut().zip([20, 24, 28, 32]) {
        *n = word(bytes, at)? as usize;
    }
    let levels = (word(bytes, 40)? as usize).max(1);
    if level >= levels.min(31) {
        return Err(no_level(FORMAT, level, levels));
    }
    // layers have no levels; a side of 0 is none
    extent.iter_mut().take(3).filter(|n| **n > 0).for_each(|n| *n = (*n >> level).max(1));
    let width = extent[0];
    let height = extent[1..].iter().fold(1usize, |height, n| height.saturating_mul((*n).max(1)));
    if width == 0 {
        return Err(fault("the width is 0".to_owned()));
    }
    if width.saturating_mul(height).saturating_mul(components) > MAX_SAMPLES {
        return Err(ReadError::Samples { format: FORMAT, width, height });
    }
    let slices = extent[2].max(1).saturating_mul(extent[3].max(1));
    let size = texels::bytes(storage, components, [width, extent[1].max(1), slices])
        .ok_or(ReadError::Samples { format: FORMAT, width, height })?;
    let [start, length] = [80, 88].map(|at| long(bytes, at + 24 * level));
    let level = part(bytes, start?, length?)?;
    let scheme = word(bytes, 44)?;
    let pixels = match scheme {
        0 => level.to_vec(),
        SCHEME_ZSTD => decompress(level, size, cancel)?,
        other => return Err(fault(format!("supercompression {other} is not supported"))),
    };
    if pixels.len() != size {
        return Err(fault(format!("the level has {} bytes, its size tells of {size}", pixels.len())));
    }
    let keys = part(bytes, word(bytes, 56)?.into(), word(bytes, 60)?.into())?;
    let text = value(keys, ATTRIBUTE.as_bytes()).filter(|t| t.len() <= MAX_TEXT).unwrap_or_default();
    let provenance = String::from_utf8_lossy(text.strip_suffix(&[0]).unwrap_or(text)).into_owned();
    Ok(Raw { storage, components, extent, provenance, pixels })
}

/// The coding of Basis Universal, if it is one: no Vulkan format, and the colour model of the descriptor (Khronos Data Format 1.3,
/// section 5.6).
fn basis(bytes: &[u8]) -> Result<Option<&'static str>, ReadError> {
    if word(bytes, 12)? != 0 {
        return Ok(None);
    }
    let start = word(bytes, 48)? as usize;
    let model = start.checked_add(12).and_then(|at| bytes.get(at)).copied();
    Ok(match (word(bytes, 44)?, model) {
        (1, _) | (_, Some(163)) => Some("ETC1S"),
        (_, Some(166)) => Some("UASTC"),
        _ => None,
    })
}

pub(super) fn read(bytes: &[u8], level: usize, cancel: &Cancel) -> Result<Image, ReadError> {
    let raw = raw(bytes, level, cancel)?;
    let [width, rest @ ..] = raw.extent;
    let [rows, depth, layers] = rest.map(|n| n.max(1));
    let height = rows * depth * layers;
    let provenance = (!raw.provenance.is_empty()).then(|| Claim::parse(raw.provenance));
    let planes =
        texels::unpack(&raw.pixels, raw.storage, raw.components, [width, rows, depth * layers], cancel);
    Ok(Image {
        format: FORMAT,
        width,
        height,
        channels: texels::finish(planes, provenance.as_ref()),
        provenance,
        warnings: descriptor(bytes)?,
    })
}

/// What is wrong with the data format descriptor. Its numbers are not needed, since the Vulkan format says the same, but other readers
/// refuse a file without them.
fn descriptor(bytes: &[u8]) -> Result<Vec<String>, ReadError> {
    let (start, length) = (word(bytes, 48)?, word(bytes, 52)?);
    let block = part(bytes, start.into(), length.into())?;
    let told = word(block, 0).unwrap_or(0);
    // total size, then a block with a header of 24 bytes and 16 bytes a sample (Khronos Data Format 1.3, section 3)
    let samples = length.saturating_sub(28) / 16;
    let fault = match () {
        () if length < 28 => "is missing",
        () if told != length => "gives another size than the header",
        () if samples == 0 => "describes no channel",
        () => return Ok(Vec::new()),
    };
    Ok(vec![format!(
        "the data format descriptor {fault}: the pixels are taken as their VkFormat tells, other readers may refuse the file"
    )])
}

fn part(bytes: &[u8], start: u64, length: u64) -> Result<&[u8], ReadError> {
    let index = |n: u64| usize::try_from(n).ok();
    let range = index(start).and_then(|s| Some(s..s.checked_add(index(length)?)?));
    range.and_then(|r| bytes.get(r)).ok_or_else(cut)
}

fn word(bytes: &[u8], at: usize) -> Result<u32, ReadError> {
    bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes).ok_or_else(cut)
}

fn long(bytes: &[u8], at: usize) -> Result<u64, ReadError> {
    bytes.get(at..at + 8).and_then(|b| b.try_into().ok()).map(u64::from_le_bytes).ok_or_else(cut)
}

/// The value of a key, if the entries before it are sound.
fn value<'a>(mut keys: &'a [u8], wanted: &[u8]) -> Option<&'a [u8]> {
    loop {
        let length = word(keys, 0).ok()? as usize;
        let entry = keys.get(4..4usize.checked_add(length)?)?;
        let end = entry.iter().position(|b| *b == 0)?;
        if &entry[..end] == wanted {
            return Some(&entry[end + 1..]);
        }
        keys = keys.get((4 + length).next_multiple_of(4)..)?;
    }
}

fn cut() -> ReadError {
    fault("the file is cut short, or a part lies outside of it".to_owned())
}

/// Decompresses at most `size` bytes and one more, so that a frame that tells lies is found out and asks for no memory.
fn decompress(data: &[u8], size: usize, cancel: &Cancel) -> Result<Vec<u8>, ReadError> {
    // the decoder refuses a window of more than its default limit, 128 MiB
    let decoder = ruzstd::decoding::StreamingDecoder::new(Stoppable::new(data, cancel)).map_err(library)?;
    let mut out = Vec::new();
    decoder.take(size as u64 + 1).read_to_end(&mut out).map_err(library)?;
    Ok(out)
}

fn library(e: impl std::error::Error + Send + Sync + 'static) -> ReadError {
    ReadError::Library { format: FORMAT, source: Box::new(e) }
}

fn fault(fault: String) -> ReadError {
    ReadError::Fault { format: FORMAT, fault }
}
