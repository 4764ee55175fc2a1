//! Reads KTX2 of the formats that are written: one face, the largest level, slices and layers stacked.

use super::ktx2::storage;
use super::read::{Claim, Image, MAX_SAMPLES, ReadError};
use super::texels;
use crate::grid::provenance::ATTRIBUTE;
use ::ktx2::SupercompressionScheme;
use std::io::Read;

const FORMAT: &str = "ktx2";

/// Longest provenance that is taken.
const MAX_TEXT: usize = 1 << 24;

pub(super) fn read(bytes: &[u8]) -> Result<Image, ReadError> {
    let reader = ::ktx2::Reader::new(bytes).map_err(library)?;
    let header = reader.header();
    let format = header.format.map_or(0, |f| f.value());
    let (storage, components) =
        storage(format).ok_or_else(|| fault(format!("VkFormat {format} is not supported")))?;
    if header.face_count != 1 {
        return Err(fault(format!("{} faces; cube maps are not supported", header.face_count)));
    }
    let length = |n: u32| (n as usize).max(1);
    let width = header.pixel_width as usize;
    let height = length(header.pixel_height)
        .saturating_mul(length(header.pixel_depth))
        .saturating_mul(length(header.layer_count));
    let samples = width.saturating_mul(height).saturating_mul(components);
    if width == 0 {
        return Err(fault("the width is 0".to_owned()));
    }
    if samples > MAX_SAMPLES {
        return Err(ReadError::Samples { format: FORMAT, width, height });
    }
    let size = width * height * texels::size(storage, components);
    let level = reader.levels().next().ok_or_else(|| fault("the file has no level".to_owned()))?;
    let unpacked = match header.supercompression_scheme {
        None => None,
        Some(SupercompressionScheme::Zstandard) => Some(decompress(level.data, size)?),
        Some(other) => return Err(fault(format!("supercompression {} is not supported", other.value()))),
    };
    let data = unpacked.as_deref().unwrap_or(level.data);
    if data.len() != size {
        return Err(fault(format!("the level has {} bytes, its size tells of {size}", data.len())));
    }
    let text = reader.key_value_data().find(|(key, _)| *key == ATTRIBUTE).map(|(_, value)| value);
    let provenance = text.filter(|t| t.len() <= MAX_TEXT).map(|value| {
        let value = value.strip_suffix(&[0]).unwrap_or(value);
        Claim::parse(String::from_utf8_lossy(value).into_owned())
    });
    let channels = texels::finish(texels::unpack(data, storage, components), provenance.as_ref());
    Ok(Image { format: FORMAT, width, height, channels, provenance })
}

/// Decompresses at most `size` bytes and one more, so that a frame that tells lies is found out and asks for no memory.
fn decompress(data: &[u8], size: usize) -> Result<Vec<u8>, ReadError> {
    // the decoder refuses a window of more than its default limit, 128 MiB
    let decoder = ruzstd::decoding::StreamingDecoder::new(data).map_err(library)?;
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
