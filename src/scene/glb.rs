//! The GLB container: finds its chunks.
//!
//! The chunks are split by `gltf::binary::Glb::from_slice`. Two of its habits are guarded against here, and
//! tested: it subtracts 12 from the header's length before it looks at it (a panic with overflow checks), and
//! it reads chunks beyond the length that the header declares. The rest of the crate is not used: it holds
//! back whole files for an unknown extension and panics on a dangling index.
//!
//! Source: [glTF 2.0 §4.4](https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#glb-file-format-specification).

use std::borrow::Cow;

use gltf::binary::{ChunkType, Error, Glb};

use super::Warning;
use super::error::Fault;
use crate::math::shown::show;

/// First four bytes of a GLB.
pub(super) const MAGIC: &[u8] = b"glTF";

/// Header (12 bytes) and header of the first chunk (8 bytes).
const SMALLEST: usize = 20;

/// JSON and BIN of a container.
type Chunks<'a> = (Cow<'a, [u8]>, Option<Cow<'a, [u8]>>);

/// The chunks of a container. Bytes after the declared length are a warning, missing ones a fault.
pub(super) fn chunks<'a>(bytes: &'a [u8], warnings: &mut Vec<Warning>) -> Result<Chunks<'a>, Fault> {
    let word = |at: usize| bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
    let (Some(version), Some(declared), true) = (word(4), word(8), bytes.len() >= SMALLEST) else {
        return Err(Fault::GlbShort { got: bytes.len() });
    };
    if version != 2 {
        return Err(Fault::GlbVersion { got: version });
    }
    let length = usize::try_from(declared).unwrap_or(usize::MAX);
    let Some(container) = bytes.get(..length).filter(|container| container.len() >= SMALLEST) else {
        return Err(Fault::GlbLength { declared, actual: bytes.len() });
    };
    if bytes.len() > length {
        warnings.push(Warning::TrailingBytes { declared, actual: bytes.len() });
    }
    let first_is_json = container.get(16..SMALLEST) == Some(b"JSON".as_slice());
    let glb = Glb::from_slice(container).map_err(|error| fault(&error, first_is_json))?;
    Ok((glb.json, glb.bin))
}

/// The crate's error in our words, with its numbers.
fn fault(error: &gltf::Error, first_is_json: bool) -> Fault {
    let expected = if first_is_json { "BIN as the second chunk" } else { "JSON as the first chunk" };
    let gltf::Error::Binary(error) = error else { return Fault::GlbChunkHeader };
    match error {
        Error::ChunkLength { ty, length, length_read } => {
            Fault::GlbChunk { chunk: name(*ty), declared: *length, left: *length_read }
        }
        Error::ChunkType(ty) => Fault::GlbChunkType { got: name(*ty).to_owned(), expected },
        Error::UnknownChunkType(ty) => {
            Fault::GlbChunkType { got: format!("\"{}\"", show(&String::from_utf8_lossy(ty))), expected }
        }
        Error::Version(got) => Fault::GlbVersion { got: *got },
        Error::Length { length, length_read } => Fault::GlbLength { declared: *length, actual: *length_read },
        Error::Magic(got) => Fault::NotGltf { got: format!("\"{}\"", show(&String::from_utf8_lossy(got))) },
        // The only read that can still fail is the header of the second chunk.
        Error::Io(_) => Fault::GlbChunkHeader,
    }
}

fn name(ty: ChunkType) -> &'static str {
    match ty {
        ChunkType::Json => "JSON",
        ChunkType::Bin => "BIN",
    }
}
