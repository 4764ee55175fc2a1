//! Portable float map, `.pfm`: one or three channels of 32-bit floats, rows from the bottom, little-endian.
//!
//! A short header and bare numbers, which image viewers and many renderers read. Two channels are filled with 0 to three. The
//! header has no place for metadata: `manifest.json` has it.
//!
//! Source: Debevec, "PFM Portable FloatMap Image Format" (2001), and `pfm(5)` of Netpbm.

use super::read::{Image, MAX_SAMPLES, ReadError};
use super::{EncodeError, EncodeInput, Encoder, Shape, Storage, texels};
use crate::cancel::Cancel;

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Pfm;

const FORMAT: &str = "pfm";
const COLOUR: &[u8] = b"PF\n";
const GREY: &[u8] = b"Pf\n";

/// Longest number of the header, in digits.
const MAX_WORD: usize = 32;

impl Encoder for Pfm {
    fn id(&self) -> &'static str {
        FORMAT
    }

    fn extension(&self) -> &'static str {
        "pfm"
    }

    fn media_type(&self) -> &'static str {
        "image/x-portable-floatmap"
    }

    fn storages(&self) -> &'static [Storage] {
        &[Storage::Float]
    }

    fn most_channels(&self) -> usize {
        3
    }

    fn components(&self, shape: &Shape<'_>) -> usize {
        if shape.channels == 1 { 1 } else { 3 }
    }

    fn colours(&self, _count: usize) -> &'static [&'static str] {
        super::COLOURS
    }

    fn holds_metadata(&self) -> bool {
        false
    }

    fn magic(&self) -> &'static [&'static [u8]] {
        &[COLOUR, GREY]
    }

    fn read(&self, bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
        read(bytes, cancel)
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        input.check(self)?;
        let components = self.components(&input.shape());
        let [width, height] = input.size();
        let mut out = if components == 1 { GREY } else { COLOUR }.to_vec();
        // the sign of the last number says little-endian
        out.extend(format!("{width} {height}\n-1.0\n").into_bytes());
        let pixels = texels::pack(input, components)?;
        out.reserve_exact(pixels.len());
        for row in pixels.rchunks_exact(texels::size(Storage::Float, components) * width) {
            out.extend(row);
        }
        Ok(out)
    }
}

fn fault(fault: impl Into<String>) -> ReadError {
    ReadError::Fault { format: FORMAT, fault: fault.into() }
}

fn read(bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
    let channels = if bytes.starts_with(GREY) { 1 } else { 3 };
    let mut rest = bytes.get(COLOUR.len()..).unwrap_or_default();
    let width = length(word(&mut rest)?)?;
    let height = length(word(&mut rest)?)?;
    let scale = word(&mut rest)?;
    let big = match scale.parse::<f64>() {
        Ok(-1.0) => false,
        Ok(1.0) => true,
        _ => return Err(fault(format!("the scale is {scale:?}; -1 (low byte first) and 1 are read"))),
    };
    if width.saturating_mul(height).saturating_mul(channels) > MAX_SAMPLES {
        return Err(ReadError::Samples { format: FORMAT, width, height });
    }
    let row = texels::size(Storage::Float, channels) * width;
    if rest.len() != row * height {
        let expected = row * height;
        return Err(fault(format!("{} bytes of pixels, the header tells of {expected}", rest.len())));
    }
    let mut pixels = Vec::with_capacity(rest.len());
    for row in rest.rchunks_exact(row) {
        cancel.check()?;
        pixels.extend_from_slice(row);
    }
    if big {
        pixels.chunks_exact_mut(4).for_each(<[u8]>::reverse);
    }
    let planes = texels::unpack(&pixels, Storage::Float, channels, [width, height, 1], cancel);
    let channels = texels::finish(planes, None);
    Ok(Image { format: FORMAT, width, height, channels, provenance: None, warnings: Vec::new() })
}

/// The next word of the header, with the one space or line end behind it taken off.
fn word<'a>(rest: &mut &'a [u8]) -> Result<&'a str, ReadError> {
    let bytes = *rest;
    let end = bytes.iter().take(MAX_WORD).position(u8::is_ascii_whitespace);
    let end = end.ok_or_else(|| fault("the header is cut short or has a word that is too long"))?;
    *rest = &bytes[end + 1..];
    std::str::from_utf8(&bytes[..end]).map_err(|_| fault("the header is not text"))
}

fn length(word: &str) -> Result<usize, ReadError> {
    word.parse::<usize>()
        .ok()
        .filter(|n| *n > 0)
        .ok_or_else(|| fault(format!("the size {word:?} is not a whole number above 0")))
}
