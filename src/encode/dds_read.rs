//! Reads DDS: the formats that are written, and the float formats of the header without DX10 (Direct3D 9 codes 111 to
//! 116, as tables of linearly transformed cosines are often shipped). Largest level, slices and layers stacked.

use super::dds::{HEAD, TEXTURE2D, TEXTURE3D, storage};
use super::read::{Image, MAX_SAMPLES, ReadError};
use super::{Storage, texels};
use crate::cancel::Cancel;

const FORMAT: &str = "dds";

/// What the headers tell.
struct Header {
    width: usize,
    height: usize,
    /// Slices of a volume, or layers of an array.
    slices: usize,
    levels: u32,
    storage: Storage,
    components: usize,
    /// Where the pixels begin.
    start: usize,
}

pub(super) fn read(bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
    let h = header(bytes)?;
    let height = h.height.saturating_mul(h.slices);
    if h.width.saturating_mul(height).saturating_mul(h.components) > MAX_SAMPLES {
        return Err(ReadError::Samples { format: FORMAT, width: h.width, height });
    }
    if h.levels > 1 && h.slices > 1 {
        return Err(fault(format!("{} levels of {} slices are not supported", h.levels, h.slices)));
    }
    let extent = [h.width, h.height, h.slices];
    let size = texels::bytes(h.storage, h.components, extent).ok_or(ReadError::Samples {
        format: FORMAT,
        width: h.width,
        height,
    })?;
    let data = bytes.get(h.start..h.start.saturating_add(size)).ok_or_else(|| {
        let got = bytes.len().saturating_sub(h.start);
        fault(format!("the file has {got} bytes of pixels, its header tells of {size}"))
    })?;
    let channels = texels::finish(texels::unpack(data, h.storage, h.components, extent, cancel), None);
    Ok(Image { format: FORMAT, width: h.width, height, channels, provenance: None })
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
    let code = word(84)?;
    if code != u32::from_le_bytes(*b"DX10") {
        let (storage, components) =
            legacy(code).ok_or_else(|| fault(format!("pixel format {code:#x} is not supported")))?;
        return Ok(Header { width, height, slices: volume, levels, storage, components, start: 128 });
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
    Ok(Header { width, height, slices, levels, storage, components, start: HEAD })
}

/// `D3DFMT` codes of floats.
const fn legacy(code: u32) -> Option<(Storage, usize)> {
    Some(match code {
        111 => (Storage::Half, 1),
        112 => (Storage::Half, 2),
        113 => (Storage::Half, 4),
        114 => (Storage::Float, 1),
        115 => (Storage::Float, 2),
        116 => (Storage::Float, 4),
        _ => return None,
    })
}

fn fault(fault: String) -> ReadError {
    ReadError::Fault { format: FORMAT, fault }
}
