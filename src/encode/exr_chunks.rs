//! The chunks of an OpenEXR file: where they are, and whether the file has their bytes.
//!
//! They are taken out of the file here and not by the `exr` crate: that one asks for the memory that a chunk claims, up to the size that the
//! header tells, before it looks for the bytes.
//!
//! Source: OpenEXR, "OpenEXR File Layout": header, offset tables, chunks.

use ::exr::block::chunk::{
    Chunk, CompressedBlock, CompressedScanLineBlock, CompressedTileBlock, TileCoordinates,
};
use ::exr::error::{Error, Result};
use ::exr::math::Vec2;
use ::exr::meta::header::Header;

/// Bit of the version field: several parts.
const MULTIPART: u32 = 0x1000;

/// The chunks of a file, in the order of its offset tables.
pub(super) struct Chunks<'a> {
    bytes: &'a [u8],
    headers: &'a [Header],
    multipart: bool,
    /// The offset tables, one behind the other.
    offsets: std::slice::ChunksExact<'a, u8>,
}

impl<'a> Chunks<'a> {
    /// The chunks of a file with these headers.
    pub(super) fn new(bytes: &'a [u8], headers: &'a [Header]) -> Result<Chunks<'a>> {
        if headers.iter().any(|h| h.deep) {
            return Err(Error::NotSupported("deep data".into()));
        }
        let multipart = word(bytes, 4)? & MULTIPART != 0;
        let start = headers_end(bytes, multipart)?;
        let count = headers.iter().fold(0usize, |n, h| n.saturating_add(h.chunk_count));
        let table = count.checked_mul(8).and_then(|n| bytes.get(start..start.checked_add(n)?));
        let offsets = table.ok_or_else(cut)?.chunks_exact(8);
        Ok(Chunks { bytes, headers, multipart, offsets })
    }

    fn chunk(&self, at: usize) -> Result<Chunk> {
        let mut at = at;
        let mut next = || {
            let n = word(self.bytes, at)?;
            at = at.checked_add(4).ok_or_else(cut)?;
            Ok::<u32, Error>(n)
        };
        let layer_index = if self.multipart { next()? as usize } else { 0 };
        let header =
            self.headers.get(layer_index).ok_or_else(|| Error::Invalid("a chunk of no part".into()))?;
        let tiled = header.blocks.has_tiles();
        let place = if tiled { [next()?, next()?, next()?, next()?] } else { [next()?, 0, 0, 0] };
        let size = next()? as usize;
        let end = at.checked_add(size).ok_or_else(cut)?;
        let compressed_pixels_le = self.bytes.get(at..end).ok_or_else(cut)?.to_vec();
        let compressed_block = if tiled {
            let [x, y, level_x, level_y] = place.map(|n| n as usize);
            // an index has 31 bits, and there are 31 levels
            if x.max(y) > 0x7fff_ffff || level_x.max(level_y) > 31 {
                return Err(Error::Invalid("a tile beyond the picture".into()));
            }
            let coordinates = TileCoordinates { tile_index: Vec2(x, y), level_index: Vec2(level_x, level_y) };
            CompressedBlock::Tile(CompressedTileBlock { coordinates, compressed_pixels_le })
        } else {
            let y_coordinate = i32::from_le_bytes(place[0].to_le_bytes());
            CompressedBlock::ScanLine(CompressedScanLineBlock { y_coordinate, compressed_pixels_le })
        };
        Ok(Chunk { layer_index, compressed_block })
    }
}

impl Iterator for Chunks<'_> {
    type Item = Result<Chunk>;

    fn next(&mut self) -> Option<Result<Chunk>> {
        let offset = self.offsets.next()?.try_into().map(u64::from_le_bytes).unwrap_or(u64::MAX);
        Some(usize::try_from(offset).map_err(|_| cut()).and_then(|at| self.chunk(at)))
    }
}

/// Where the offset tables begin. A header is a list of attributes (name, type, size, value) and a zero; of several
/// headers the last one is empty.
fn headers_end(bytes: &[u8], multipart: bool) -> Result<usize> {
    let text_end = |from: usize| {
        let length = bytes.get(from..)?.iter().position(|b| *b == 0)?;
        Some(from + length)
    };
    let mut at = 8;
    loop {
        let start = at;
        loop {
            let name = text_end(at).ok_or_else(cut)?;
            if name == at {
                break;
            }
            let kind = text_end(name + 1).ok_or_else(cut)?;
            let size = word(bytes, kind + 1)? as usize;
            at = (kind + 5).checked_add(size).ok_or_else(cut)?;
        }
        let empty = at == start;
        at += 1;
        if empty || !multipart {
            return Ok(at);
        }
    }
}

fn word(bytes: &[u8], at: usize) -> Result<u32> {
    let four = at.checked_add(4).and_then(|end| bytes.get(at..end)).and_then(|b| b.try_into().ok());
    four.map(u32::from_le_bytes).ok_or_else(cut)
}

fn cut() -> Error {
    Error::Invalid("the file is cut short, or a part lies outside of it".into())
}
