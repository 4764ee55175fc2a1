//! The two containers of a scene, taken apart and put together again: what is not changed keeps its bytes.
//!
//! Of a GLB only the JSON, the lengths and what is put behind the binary chunk differ: the old chunk is a prefix of the new one.
//! Chunks of other types follow as they were. Bytes behind the declared length belong to no container and are left out.
//!
//! Source: [glTF 2.0 §4.4](https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#glb-file-format-specification).

use crate::scene::Fault;
use crate::scene::glb::{MAGIC, chunks};

const BYTE_ORDER_MARK: &str = "\u{feff}";

/// A scene file in its parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parts {
    /// True for a GLB.
    pub binary: bool,
    /// The JSON text, without padding and byte order mark.
    pub text: String,
    /// The binary chunk, padding included; none in a `.gltf` file.
    pub bin: Option<Vec<u8>>,
    /// Is there a byte order mark before the text? It has no business there, but it is the author's.
    mark: bool,
    /// Chunks of other types, with their headers.
    rest: Vec<u8>,
}

/// Header (12 bytes) and header of the first chunk (8 bytes).
const FIRST: usize = 20;

impl Parts {
    /// Takes a file apart. The content decides what it is.
    ///
    /// # Errors
    /// [`Fault`] for a container that cannot be, or a text that is no UTF-8.
    pub fn open(bytes: &[u8]) -> Result<Parts, Fault> {
        let binary = bytes.starts_with(MAGIC);
        let chunk = if binary { chunks(bytes, &mut Vec::new())?.0 } else { bytes.into() };
        let text = std::str::from_utf8(&chunk).map_err(|e| Fault::Utf8 { offset: e.valid_up_to() })?;
        let mark = text.starts_with(BYTE_ORDER_MARK);
        let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
        let (mut bin, mut rest) = (None, Vec::new());
        if binary {
            let word = |at: usize| {
                let bytes = bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
                usize::try_from(bytes.unwrap_or(0)).unwrap_or(usize::MAX)
            };
            let end = word(8).min(bytes.len());
            let second = FIRST.saturating_add(word(12)).min(end);
            let data = second.saturating_add(8).min(end);
            let after = data.saturating_add(if data > second { word(second) } else { 0 }).min(end);
            if data > second {
                bin = Some(bytes[data..after].to_vec());
            }
            rest = bytes[after..end].to_vec();
        }
        // padding of the chunk; in a text of its own blanks at the end are the author's
        let text = if binary { text.trim_end_matches(' ') } else { text };
        Ok(Parts { binary, text: text.to_owned(), bin, mark, rest })
    }

    /// Puts the file together.
    ///
    /// # Errors
    /// [`TooLarge`] for a GLB of 4 GiB and more.
    pub fn to_bytes(&self) -> Result<Vec<u8>, TooLarge> {
        let mark = if self.mark { BYTE_ORDER_MARK } else { "" };
        let mut text = [mark, &self.text].concat().into_bytes();
        if !self.binary {
            return Ok(text);
        }
        pad(&mut text, b' ');
        let mut bin = self.bin.clone();
        bin.iter_mut().for_each(|bin| pad(bin, 0));
        let all = FIRST + text.len() + bin.as_ref().map_or(0, |b| 8 + b.len()) + self.rest.len();
        let length = |n: usize| u32::try_from(n).map(u32::to_le_bytes).map_err(|_| TooLarge { bytes: all });
        let mut out = Vec::with_capacity(all);
        out.extend_from_slice(MAGIC);
        out.extend_from_slice(&2_u32.to_le_bytes());
        out.extend_from_slice(&length(all)?);
        out.extend_from_slice(&length(text.len())?);
        out.extend_from_slice(b"JSON");
        out.extend_from_slice(&text);
        if let Some(bin) = bin {
            out.extend_from_slice(&length(bin.len())?);
            out.extend_from_slice(b"BIN\0");
            out.extend_from_slice(&bin);
        }
        out.extend_from_slice(&self.rest);
        Ok(out)
    }
}

/// A container that would be longer than its lengths can say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "the GLB would have {bytes} bytes, and 4294967295 are allowed; write a .gltf file, whose tables lie beside it"
)]
pub struct TooLarge {
    /// Bytes that it would have.
    pub bytes: usize,
}

/// Fills up to a multiple of 4.
pub(super) fn pad(bytes: &mut Vec<u8>, with: u8) {
    bytes.resize(bytes.len().next_multiple_of(4), with);
}
