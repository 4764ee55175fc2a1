//! NumPy `.npy`, version 1.0: one array in C order, little-endian, axes slowest first and the channels last.
//!
//! A table of 64 mu (x) by 32 roughness (y) with two channels has the shape `(32, 64, 2)`. NumPy refuses any other key
//! in the header and strict readers any byte behind the array, so that the file has no metadata: `manifest.json` does.
//!
//! Source: `numpy.lib.format`, format version 1.0.

use super::read::{Image, MAX_SAMPLES, Plane, ReadError};
use super::{EncodeError, EncodeInput, Encoder, Storage, texels};
use crate::cancel::Cancel;

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Npy;

const MAGIC: &[u8] = b"\x93NUMPY";
const FORMAT: &str = "npy";

/// Longest header that is read.
const MAX_HEADER: usize = 1 << 16;

impl Encoder for Npy {
    fn id(&self) -> &'static str {
        FORMAT
    }

    fn extension(&self) -> &'static str {
        "npy"
    }

    fn storages(&self) -> &'static [Storage] {
        &[Storage::Double, Storage::Float, Storage::Half]
    }

    fn most_channels(&self) -> usize {
        1024
    }

    fn holds_metadata(&self) -> bool {
        false
    }

    fn magic(&self) -> &'static [&'static [u8]] {
        &[MAGIC]
    }

    fn read(&self, bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
        read(bytes, cancel)
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        input.check(self)?;
        let channels = input.channels.len();
        let lengths = input.grid.axes().iter().rev().map(|a| a.len).chain([channels]);
        let shape: Vec<String> = lengths.map(|n| n.to_string()).collect();
        let kind = texels::size(input.storage, 1);
        let dict =
            format!("{{'descr': '<f{kind}', 'fortran_order': False, 'shape': ({}), }}", shape.join(", "));
        // the header ends with a newline, at a multiple of 64
        let length = (10 + dict.len() + 1).next_multiple_of(64) - 10;
        let mut out = [MAGIC, &[1, 0]].concat();
        out.extend(u16::try_from(length).unwrap_or(0).to_le_bytes());
        out.extend(format!("{dict:<width$}\n", width = length - 1).into_bytes());
        out.extend(texels::pack(input, channels)?);
        Ok(out)
    }
}

fn fault(fault: impl Into<String>) -> ReadError {
    ReadError::Fault { format: FORMAT, fault: fault.into() }
}

/// Reads an array of floats, or of bytes and words as codes over [0, 1]. The last axis of two or more is the channels; those before the width are stacked.
fn read(bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
    let cut = || fault("the header is cut short");
    let byte = |at: usize| bytes.get(at).copied().map(usize::from).ok_or_else(cut);
    let (length, start) = match byte(6)? {
        1 => (byte(8)? | byte(9)? << 8, 10),
        2 | 3 => (byte(8)? | byte(9)? << 8 | byte(10)? << 16 | byte(11)? << 24, 12),
        version => return Err(fault(format!("version {version} is not supported"))),
    };
    if length > MAX_HEADER {
        return Err(fault(format!("a header of {length} bytes; at most {MAX_HEADER} are read")));
    }
    let header = bytes.get(start..start + length).ok_or_else(cut)?;
    let header = std::str::from_utf8(header).map_err(|_| fault("the header is not text"))?;
    let storage = match value(header, "descr")?.trim_matches(['\'', '"']) {
        "<f2" => Storage::Half,
        "<f4" => Storage::Float,
        "<f8" => Storage::Double,
        // codes, as of a picture
        "|u1" => Storage::Unorm8,
        "<u2" => Storage::Unorm16,
        other => return Err(fault(format!("type {other} is not supported; <f2, <f4, <f8, |u1 and <u2 are"))),
    };
    if value(header, "fortran_order")? != "False" {
        return Err(fault("arrays in Fortran order are not supported"));
    }
    let [width, height, channels] = extent(value(header, "shape")?)?;
    let samples = width.saturating_mul(height).saturating_mul(channels);
    if samples > MAX_SAMPLES {
        return Err(ReadError::Samples { format: FORMAT, width, height });
    }
    let data = &bytes[start + length..];
    let size = samples * texels::size(storage, 1);
    if data.len() != size {
        return Err(fault(format!("{} bytes of numbers, the shape tells of {size}", data.len())));
    }
    let mut planes = texels::finish(texels::unpack(data, storage, channels, [0; 3], cancel), None);
    // an array has no colours
    let rename = |(c, p): (usize, &mut Plane)| p.name = format!("c{c}");
    planes.iter_mut().enumerate().for_each(rename);
    Ok(Image { format: FORMAT, width, height, channels: planes, provenance: None, warnings: Vec::new() })
}

/// The text behind a key, up to the comma that ends it.
fn value<'a>(header: &'a str, key: &str) -> Result<&'a str, ReadError> {
    let missing = || fault(format!("the header has no `{key}`"));
    let at = header.find(&format!("'{key}'")).ok_or_else(missing)?;
    let rest = header[at + key.len() + 2..].trim_start().strip_prefix(':').ok_or_else(missing)?.trim_start();
    let end = if rest.starts_with('(') { rest.find(')').map(|i| i + 1) } else { rest.find([',', '}']) };
    end.and_then(|end| rest.get(..end)).map(str::trim).ok_or_else(missing)
}

/// Width, height (all slower axes), channels.
fn extent(shape: &str) -> Result<[usize; 3], ReadError> {
    let wrong = || fault(format!("`{shape}` is not a shape"));
    let inner = shape.strip_prefix('(').and_then(|s| s.strip_suffix(')')).ok_or_else(wrong)?;
    let mut lengths = Vec::new();
    for part in inner.split(',').map(str::trim).filter(|p| !p.is_empty()) {
        lengths.push(part.parse::<usize>().ok().filter(|n| *n > 0).ok_or_else(wrong)?);
    }
    let channels = if lengths.len() >= 2 { lengths.pop().unwrap_or(1) } else { 1 };
    let width = lengths.pop().unwrap_or(1);
    let height = lengths.iter().fold(1usize, |h, n| h.saturating_mul(*n));
    if channels > 1024 {
        return Err(fault(format!("{channels} channels; 1 to 1024 are read")));
    }
    Ok([width, height, channels])
}
