//! The chunks of an OpenEXR file: where they are, whether the file has their bytes, and whether those can be so many pixels.
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
use ::exr::meta::attribute::Compression;
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

/// Most bytes that a byte of DEFLATE stands for: a match of 258 bytes has at least 2 bits.
const DEFLATE: usize = 1032;

/// Most bytes of pixels that a byte of a block can stand for; none for DWA, whose blocks tell more ([`dwa`]).
///
/// PXR24 stores 3 bytes of 4 of a float. A token of RLE has 2 bytes and stands for up to 128. A run of PIZ has at least 9 bits
/// and repeats a word of 2 bytes up to 255 times. A flat block of B44A has 3 bytes in place of 32.
const fn ratio(compression: Compression) -> Option<usize> {
    Some(match compression {
        Compression::Uncompressed => 1,
        Compression::RLE => 64,
        Compression::B44 | Compression::B44A => 11,
        Compression::PIZ => 454,
        Compression::ZIP1 | Compression::ZIP16 => DEFLATE,
        Compression::PXR24 => DEFLATE / 3 * 4,
        _ => return None,
    })
}

/// Checks that a block can hold the pixels that it claims, before the crate asks for their memory.
pub(super) fn guard(header: &Header, chunk: &Chunk) -> Result<()> {
    let (CompressedBlock::ScanLine(CompressedScanLineBlock { compressed_pixels_le: bytes, .. })
    | CompressedBlock::Tile(CompressedTileBlock { compressed_pixels_le: bytes, .. })) =
        &chunk.compressed_block
    else {
        return Ok(());
    };
    let place = header.get_block_data_indices(&chunk.compressed_block)?;
    let size = header.get_absolute_block_pixel_coordinates(place)?.size;
    let pixels = size.0.saturating_mul(size.1).saturating_mul(header.channels.bytes_per_pixel);
    let most = match ratio(header.compression) {
        // a block that did not shrink is stored as it is
        _ if bytes.len() == pixels => pixels,
        Some(ratio) => bytes.len().saturating_mul(ratio),
        None => {
            dwa(bytes).ok_or_else(|| Error::Invalid("a DWA block that claims more than it holds".into()))?
        }
    };
    // small blocks have tables of their own, and cost little
    if pixels > most.max(1 << 16) {
        return Err(Error::Invalid("a block that claims more pixels than its bytes can hold".into()));
    }
    Ok(())
}

/// Most bytes of pixels of a DWA block, or none if its counters claim more than its sections can hold: the crate takes them at their
/// word, and a forged one makes it ask for terabytes, which ends the process.
///
/// Counters, of 8 bytes: version, bytes of other channels unpacked and packed, packed bytes of AC, DC and RLE, bytes of RLE unpacked
/// and of what that stands for, AC and DC coefficients, how AC is packed. A DC coefficient stands for 64 samples of up to 4 bytes.
fn dwa(bytes: &[u8]) -> Option<usize> {
    let mut counters = [0_usize; 11];
    for (n, eight) in counters.iter_mut().zip(bytes.chunks_exact(8)) {
        *n = usize::try_from(u64::from_le_bytes(eight.try_into().ok()?)).ok()?;
    }
    let [_, other, other_packed, ac_packed, dc_packed, rle_packed, rle, rle_raw, ac, dc, _] = counters;
    let packed = [other_packed, ac_packed, dc_packed, rle_packed];
    let fits = |unpacked: usize, packed: usize| unpacked <= packed.saturating_mul(DEFLATE);
    let sound = packed.iter().all(|n| *n <= bytes.len())
        && fits(other, other_packed)
        && fits(ac.saturating_mul(2), ac_packed)
        && fits(dc.saturating_mul(2), dc_packed)
        && fits(rle, rle_packed)
        && rle_raw <= rle.saturating_mul(64);
    sound.then(|| other.saturating_add(rle_raw).saturating_add(dc.saturating_mul(256)))
}

fn word(bytes: &[u8], at: usize) -> Result<u32> {
    let four = at.checked_add(4).and_then(|end| bytes.get(at..end)).and_then(|b| b.try_into().ok());
    four.map(u32::from_le_bytes).ok_or_else(cut)
}

fn cut() -> Error {
    Error::Invalid("the file is cut short, or a part lies outside of it".into())
}
