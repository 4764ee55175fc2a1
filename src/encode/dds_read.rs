//! Reads DDS: the formats that are written; the formats of the header without DX10 (Direct3D 9 codes 36 and 111 to 116, as
//! tables of linearly transformed cosines are often shipped, and the codes of BC4 and BC5); pixels that are told by bit masks.
//! One level, slices and layers stacked.

use super::dds::{HEAD, TEXTURE2D, TEXTURE3D, storage};
use super::dds_masks::Masks;
use super::read::{Image, MAX_SAMPLES, Plane, ReadError, no_level};
use super::{Storage, texels};
use crate::cancel::Cancel;

const FORMAT: &str = "dds";

/// `DDPF_FOURCC`: the pixel format is a code.
const FOURCC: u32 = 0x4;

/// What the headers tell.
struct Header {
    width: usize,
    height: usize,
    /// Slices of a volume, or layers of an array.
    slices: usize,
    levels: u32,
    pixels: Pixels,
    /// Where the pixels begin.
    start: usize,
}

/// How a pixel lies in the file.
enum Pixels {
    Stored(Storage, usize),
    Masked(Masks),
}

impl Pixels {
    fn components(&self) -> usize {
        match self {
            Pixels::Stored(_, components) => *components,
            Pixels::Masked(masks) => masks.channels(),
        }
    }

    /// Bytes of a picture; nothing if they cannot be counted.
    fn bytes(&self, extent: [usize; 3]) -> Option<usize> {
        match self {
            Pixels::Stored(storage, components) => texels::bytes(*storage, *components, extent),
            Pixels::Masked(masks) => extent.iter().try_fold(masks.bytes(), |n, side| n.checked_mul(*side)),
        }
    }

    fn unpack(&self, data: &[u8], extent: [usize; 3], cancel: &Cancel) -> Vec<Plane> {
        match self {
            Pixels::Stored(storage, components) => {
                texels::finish(texels::unpack(data, *storage, *components, extent, cancel), None)
            }
            Pixels::Masked(masks) => masks.unpack(data, cancel),
        }
    }
}

pub(super) fn read(bytes: &[u8], level: usize, cancel: &Cancel) -> Result<Image, ReadError> {
    let mut h = header(bytes)?;
    let height = h.height.saturating_mul(h.slices);
    if h.width.saturating_mul(height).saturating_mul(h.pixels.components()) > MAX_SAMPLES {
        return Err(ReadError::Samples { format: FORMAT, width: h.width, height });
    }
    if h.levels > 1 && h.slices > 1 {
        return Err(fault(format!("{} levels of {} slices are not supported", h.levels, h.slices)));
    }
    if level >= (h.levels as usize).clamp(1, 31) {
        return Err(no_level(FORMAT, level, h.levels as usize));
    }
    let size = |h: &Header| {
        let bytes = h.pixels.bytes([h.width, h.height, h.slices]);
        bytes.ok_or(ReadError::Samples { format: FORMAT, width: h.width, height })
    };
    for _ in 0..level {
        h.start = h.start.saturating_add(size(&h)?);
        (h.width, h.height) = ((h.width / 2).max(1), (h.height / 2).max(1));
    }
    let (extent, size) = ([h.width, h.height, h.slices], size(&h)?);
    let height = h.height.saturating_mul(h.slices);
    let data = bytes.get(h.start..h.start.saturating_add(size)).ok_or_else(|| {
        let got = bytes.len().saturating_sub(h.start);
        fault(format!("the file has {got} bytes of pixels, its header tells of {size}"))
    })?;
    let channels = h.pixels.unpack(data, extent, cancel);
    Ok(Image { format: FORMAT, width: h.width, height, channels, provenance: None, warnings: Vec::new() })
}

fn header(bytes: &[u8]) -> Result<Header, ReadError> {
    let word = |at: usize| {
        let four = bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
        four.ok_or_else(|| fault("the header is cut short".to_owned()))
    };
    if word(4)? != 124 || word(76)? != 32 {
        return Err(fault("the header is not that of a DDS file".to_owned()));
    }
    let length = |n: u32| (n as usize).max(1);
    let (height, width, depth, levels) = (length(word(12)?), length(word(16)?), word(24)?, word(28)?);
    let caps2 = word(112)?;
    if caps2 & 0x200 != 0 {
        return Err(fault("cube maps are not supported".to_owned()));
    }
    let volume = if caps2 & 0x20_0000 != 0 { length(depth) } else { 1 };
    let (flags, code) = (word(80)?, word(84)?);
    if flags & FOURCC == 0 {
        let masks = [word(92)?, word(96)?, word(100)?, word(104)?];
        let pixels = Pixels::Masked(Masks::new(flags, word(88)?, masks)?);
        return Ok(Header { width, height, slices: volume, levels, pixels, start: 128 });
    }
    if code != u32::from_le_bytes(*b"DX10") {
        let (storage, components) =
            legacy(code).ok_or_else(|| fault(format!("pixel format {} is not supported", name(code))))?;
        let pixels = Pixels::Stored(storage, components);
        return Ok(Header { width, height, slices: volume, levels, pixels, start: 128 });
    }
    let (format, dimension, misc, layers) = (word(128)?, word(132)?, word(136)?, length(word(140)?));
    let (storage, components) =
        storage(format).ok_or_else(|| fault(format!("DXGI format {format} is not supported")))?;
    let slices = match dimension {
        TEXTURE2D if misc & 4 == 0 => layers,
        TEXTURE3D => length(depth),
        _ => return Err(fault(format!("resource dimension {dimension} is not supported"))),
    };
    word(HEAD - 4)?;
    let pixels = Pixels::Stored(storage, components);
    Ok(Header { width, height, slices, levels, pixels, start: HEAD })
}

/// A code as it is written: four letters, or a number.
fn name(code: u32) -> String {
    let letters = code.to_le_bytes();
    let is_text = letters.iter().all(|b| b.is_ascii_graphic() || *b == b' ');
    if is_text { format!("`{}`", String::from_utf8_lossy(&letters)) } else { format!("{code:#x}") }
}

/// `D3DFMT` codes of unorm and floats, and the older names of BC4 and BC5.
const fn legacy(code: u32) -> Option<(Storage, usize)> {
    const BC4U: u32 = u32::from_le_bytes(*b"BC4U");
    const ATI1: u32 = u32::from_le_bytes(*b"ATI1");
    const BC5U: u32 = u32::from_le_bytes(*b"BC5U");
    const ATI2: u32 = u32::from_le_bytes(*b"ATI2");
    Some(match code {
        36 => (Storage::Unorm16, 4),
        BC4U | ATI1 => (Storage::Bc4, 1),
        BC5U | ATI2 => (Storage::Bc5, 2),
        111 => (Storage::Half, 1),
        112 => (Storage::Half, 2),
        113 => (Storage::Half, 4),
        114 => (Storage::Float, 1),
        115 => (Storage::Float, 2),
        116 => (Storage::Float, 4),
        _ => return None,
    })
}

pub(super) fn fault(fault: String) -> ReadError {
    ReadError::Fault { format: FORMAT, fault }
}
