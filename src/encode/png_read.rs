//! Reads PNG: 1 to 16 bits, grey, colour, alpha, palette. Samples are codes as they stand: no gamma, no profile.

use super::read::{Claim, Image, MAX_SAMPLES, Plane, ReadError, Sample};
use super::stoppable::Stoppable;
use super::texels;
use crate::cancel::Cancel;
use crate::grid::provenance::ATTRIBUTE;
use crate::picture::Png;
use std::io::Cursor;

const FORMAT: &str = "png";

/// Most bytes that the decoder may take for rows, text and profiles.
const MAX_ALLOC: usize = 1 << 30;

/// Longest provenance that is unpacked.
const MAX_TEXT: usize = 1 << 24;

/// Most bytes that a byte of DEFLATE stands for: a match of 258 bytes has at least 2 bits.
const MAX_RATIO: usize = 1032;

pub(super) fn read(bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
    // crate png 0.18 can panic on a damaged palette; the panic is caught and told as an error
    std::panic::catch_unwind(|| decode(bytes, cancel)).unwrap_or_else(|_| {
        Err(ReadError::Fault {
            format: FORMAT,
            fault: "the data are damaged (the decoder gave up)".to_owned(),
        })
    })
}

fn decode(bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
    let (width, height, planes) = pixels(bytes, cancel)?;
    let provenance = text(bytes).map(Claim::parse);
    let channels = texels::finish(planes, provenance.as_ref());
    Ok(Image { format: FORMAT, width, height, channels, provenance, warnings: Vec::new() })
}

fn library(e: impl std::error::Error + Send + Sync + 'static) -> ReadError {
    ReadError::Library { format: FORMAT, source: Box::new(e) }
}

/// Size and codes of each channel.
fn pixels(bytes: &[u8], cancel: &Cancel) -> Result<(usize, usize, Vec<Plane>), ReadError> {
    let file = Png::open(Stoppable::new(Cursor::new(bytes), cancel), MAX_ALLOC).map_err(library)?;
    let (w, h) = file.size();
    let (width, height) = (w as usize, h as usize);
    let pixels = width.checked_mul(height);
    let samples = pixels.and_then(|a| a.checked_mul(file.channels)).unwrap_or(usize::MAX);
    if samples > MAX_SAMPLES {
        return Err(ReadError::Samples { format: FORMAT, width, height });
    }
    if width * height / 8 * stored_bits(bytes) > bytes.len().saturating_mul(MAX_RATIO) {
        let fault =
            format!("{} bytes cannot hold {width} x {height} pixels: the file is cut short", bytes.len());
        return Err(ReadError::Fault { format: FORMAT, fault });
    }
    let samples = file.read().map_err(library)?;
    let sample = if samples.are_wide() { Sample::Unorm16 } else { Sample::Unorm8 };
    let plane = |(c, name): (usize, &&str)| Plane {
        name: (*name).to_owned(),
        sample,
        range: [0.0, 1.0],
        values: samples.codes(c).map(f64::from).collect(),
    };
    Ok((width, height, samples.names().iter().enumerate().map(plane).collect()))
}

/// Bits of a pixel in the file, from the first chunk, which the decoder has checked.
fn stored_bits(bytes: &[u8]) -> usize {
    let byte = |at: usize| usize::from(bytes.get(at).copied().unwrap_or(0));
    let samples = match byte(25) {
        2 => 3,
        4 => 2,
        6 => 4,
        _ => 1,
    };
    byte(24) * samples
}

/// The text of the `brdfbake` chunk (iTXt, tEXt or zTXt), wherever it stands. A file that is damaged behind its pixels
/// has none.
fn text(bytes: &[u8]) -> Option<String> {
    let limits = png::Limits { bytes: MAX_TEXT * 4 };
    let mut reader = png::Decoder::new_with_limits(Cursor::new(bytes), limits).read_info().ok()?;
    found(reader.info()).or_else(|| {
        reader.finish().ok()?;
        found(reader.info())
    })
}

fn found(info: &png::Info<'_>) -> Option<String> {
    let utf8 = info.utf8_text.iter().find(|t| t.keyword == ATTRIBUTE).and_then(|t| {
        let mut t = t.clone();
        t.decompress_text_with_limit(MAX_TEXT).ok()?;
        t.get_text().ok()
    });
    let plain =
        || info.uncompressed_latin1_text.iter().find(|t| t.keyword == ATTRIBUTE).map(|t| t.text.clone());
    let packed = || {
        let mut t = info.compressed_latin1_text.iter().find(|t| t.keyword == ATTRIBUTE)?.clone();
        t.decompress_text_with_limit(MAX_TEXT).ok()?;
        t.get_text().ok()
    };
    utf8.or_else(plain).or_else(packed)
}
