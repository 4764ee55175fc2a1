//! Reads OpenEXR: every channel of every flat part, one level of resolution.
//!
//! The blocks are put into the picture here and not by the `exr` crate's own collector: that one trusts the offset
//! table, and a table that names one block twice and another never gives a picture with zeros in it and no error.
//!
//! Memory is asked for by what the blocks hold, not by the size that the header tells: a block must not claim more pixels than its bytes
//! can stand for, and the picture is made when all of its blocks are there.

use super::exr_chunks::{self, Chunks};
use super::exr_names;
use super::read::{Claim, Image, MAX_SAMPLES, Plane, ReadError, Sample, no_level};
use crate::cancel::Cancel;
use crate::grid::provenance::ATTRIBUTE;
use ::exr::block::UncompressedBlock;
use ::exr::block::chunk::{Chunk, CompressedBlock};
use ::exr::error::{Error, Result as ExrResult};
use ::exr::math::Vec2;
use ::exr::meta::attribute::{AttributeValue, LevelMode, SampleType, Text};
use ::exr::meta::{BlockDescription, MetaData, compute_level_count, compute_level_size};

use ::exr::meta::header::Header;
use ::exr::prelude::f16;
use std::collections::BTreeSet;
use std::io::Cursor;

const FORMAT: &str = "exr";

/// Most channels of a file, all parts together: names are compared pair by pair.
const MAX_CHANNELS: usize = 4096;

/// Reads a file. The crate (1.74) panics on some damaged B44 blocks where overflow checks are on, so a panic is caught
/// and told as an error; the message of the panic hook, if the program has one, is still printed.
pub(super) fn read(bytes: &[u8], level: usize, cancel: &Cancel) -> Result<Image, ReadError> {
    std::panic::catch_unwind(|| decode(bytes, level, cancel))
        .unwrap_or_else(|_| Err(fault("the data are damaged (the decoder gave up)".to_owned())))
}

fn decode(bytes: &[u8], level: usize, cancel: &Cancel) -> Result<Image, ReadError> {
    let meta = ::exr::block::read(Cursor::new(bytes), false).map_err(library)?.into_meta_data();
    let headers = meta.headers.as_slice();
    size(headers)?;
    let (width, height) = headers.first().map_or(Ok((0, 0)), |h| extent(h, level))?;
    let provenance = claims(headers.iter().filter_map(claim).collect());
    let mut picture = Picture::new(headers, level)?;
    for chunk in Chunks::new(bytes, headers).map_err(library)? {
        cancel.check()?;
        chunk.and_then(|c| picture.insert(&meta, c)).map_err(library)?;
    }
    if picture.pixels_left > 0 {
        return Err(fault(format!("{} pixels are in no block of the file", picture.pixels_left)));
    }
    let parts = slices(&provenance, picture.first.len());
    let mut channels = stack(picture.finish(headers, cancel).map_err(library)?, parts);
    let mut warnings = Vec::new();
    if let Some(Claim::Known(p)) = &provenance {
        (channels, warnings) = exr_names::as_channels(channels, p);
    }
    let height = channels.first().map_or(height, |c| c.values.len() / width.max(1));
    Ok(Image { format: FORMAT, width, height, channels, provenance, warnings })
}

/// Number of parts, if the provenance tells of as many slices.
fn slices(provenance: &Option<Claim>, parts: usize) -> usize {
    let Some(Claim::Known(p)) = provenance else { return 1 };
    let slices = p.axes.iter().skip(2).fold(1usize, |n, a| n.saturating_mul(a.axis.len));
    if slices == parts { parts } else { 1 }
}

/// Slices that are parts, below each other as in a file of one part. Parts that are not alike are left as they are.
fn stack(planes: Vec<Plane>, parts: usize) -> Vec<Plane> {
    let n = planes.len() / parts.max(1);
    let name = |p: &Plane| p.name.split_once('.').map_or(String::new(), |(_, name)| name.to_owned());
    let like = |(i, p): (usize, &Plane)| name(p) == name(&planes[i % n]) && p.sample == planes[i % n].sample;
    if parts < 2 || n == 0 || !planes.len().is_multiple_of(parts) || !planes.iter().enumerate().all(like) {
        return planes;
    }
    let mut stacked: Vec<Plane> = Vec::with_capacity(n);
    for (i, plane) in planes.into_iter().enumerate() {
        match stacked.get_mut(i % n) {
            Some(first) => first.values.extend(plane.values),
            None => stacked.push(Plane { name: name(&plane), ..plane }),
        }
    }
    stacked
}

fn library(e: Error) -> ReadError {
    ReadError::Library { format: FORMAT, source: Box::new(e) }
}

fn fault(fault: String) -> ReadError {
    ReadError::Fault { format: FORMAT, fault }
}

/// The one size of all parts, within the limit.
fn size(headers: &[Header]) -> Result<(usize, usize), ReadError> {
    let Some(first) = headers.first() else { return Err(fault("the file has no part".to_owned())) };
    let (width, height) = (first.layer_size.0, first.layer_size.1);
    let channels: usize = headers.iter().map(|h| h.channels.list.len()).sum();
    if channels == 0 || channels > MAX_CHANNELS {
        return Err(fault(format!("{channels} channels; 1 to {MAX_CHANNELS} are read")));
    }
    let mut samples = 0usize;
    for h in headers {
        if (h.layer_size.0, h.layer_size.1) != (width, height) {
            let (w, h) = (h.layer_size.0, h.layer_size.1);
            return Err(fault(format!("parts of different sizes ({width} x {height}, {w} x {h})")));
        }
        let part = width.checked_mul(height).and_then(|n| n.checked_mul(h.channels.list.len().max(1)));
        samples = part.and_then(|n| n.checked_add(samples)).unwrap_or(usize::MAX);
    }
    if samples > MAX_SAMPLES {
        return Err(ReadError::Samples { format: FORMAT, width, height });
    }
    Ok((width, height))
}

/// Width and height of a level of a part.
fn extent(header: &Header, level: usize) -> Result<(usize, usize), ReadError> {
    let (width, height) = (header.layer_size.0, header.layer_size.1);
    let (levels, rounding) = match header.blocks {
        BlockDescription::Tiles(t) if t.level_mode == LevelMode::MipMap => {
            (compute_level_count(t.rounding_mode, width.max(height).max(1)), Some(t.rounding_mode))
        }
        _ => (1, None),
    };
    if level >= levels {
        return Err(no_level(FORMAT, level, levels));
    }
    let side = |n: usize| rounding.map_or(n, |r| compute_level_size(r, n, level));
    Ok((side(width), side(height)))
}

fn utf8(text: &Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}

fn claim(header: &Header) -> Option<Claim> {
    let key = Text::from_slice_unchecked(ATTRIBUTE.as_bytes());
    let own = header.own_attributes.other.get(&key);
    match own.or_else(|| header.shared_attributes.other.get(&key)) {
        Some(AttributeValue::Text(text)) => Some(Claim::parse(utf8(text))),
        _ => None,
    }
}

/// The claims of all parts as that of the file.
fn claims(mut all: Vec<Claim>) -> Option<Claim> {
    let known = |c: &Claim| match c {
        Claim::Known(p) => Some((**p).clone()),
        _ => None,
    };
    match all.iter().map(known).collect::<Option<Vec<_>>>() {
        Some(several) if several.len() > 1 => Some(Claim::Several(several)),
        _ if all.is_empty() => None,
        _ => Some(all.swap_remove(0)),
    }
}

/// The blocks of all parts while they come in.
struct Picture {
    /// Without values yet.
    planes: Vec<Plane>,
    /// Index of the first plane of each part.
    first: Vec<usize>,
    blocks: Vec<UncompressedBlock>,
    /// Part, x, y of the blocks that are in.
    seen: BTreeSet<(usize, usize, usize)>,
    pixels_left: usize,
    width: usize,
    level: usize,
}

impl Picture {
    fn new(headers: &[Header], level: usize) -> Result<Picture, ReadError> {
        let mut planes = Vec::<Plane>::new();
        let mut first = Vec::new();
        let (mut pixels_left, mut width) = (0, 0);
        for header in headers {
            first.push(planes.len());
            let (own, height) = extent(header, level)?;
            width = own;
            pixels_left += width * height;
            let part = header.own_attributes.layer_name.as_ref().filter(|_| headers.len() > 1);
            for channel in &header.channels.list {
                let name = utf8(&channel.name);
                let name = part.map_or(name.clone(), |p| format!("{}.{name}", utf8(p)));
                if planes.iter().any(|p| p.name == name) {
                    return Err(fault(format!("two channels are named `{name}`")));
                }
                let sample = match channel.sample_type {
                    SampleType::F16 => Sample::Half,
                    SampleType::F32 => Sample::Float,
                    SampleType::U32 => Sample::Uint32,
                };
                planes.push(Plane { name, sample, range: [0.0, 1.0], values: Vec::new() });
            }
        }
        let (blocks, seen) = (Vec::new(), BTreeSet::new());
        Ok(Picture { planes, first, blocks, seen, pixels_left, width, level })
    }

    fn insert(&mut self, meta: &MetaData, chunk: Chunk) -> ExrResult<()> {
        let layer = chunk.layer_index;
        let header = meta.headers.get(layer).ok_or_else(|| invalid("a block of no part"))?;
        if let CompressedBlock::Tile(tile) = &chunk.compressed_block
            && tile.coordinates.level_index != Vec2(self.level, self.level)
        {
            return Ok(());
        }
        exr_chunks::guard(header, &chunk)?;
        let block = UncompressedBlock::decompress_chunk(chunk, meta, false)?;
        let (at, size) = (block.index.pixel_position, block.index.pixel_size);
        if !self.seen.insert((layer, at.0, at.1)) {
            return Err(invalid("a block is there twice"));
        }
        self.pixels_left =
            self.pixels_left.checked_sub(size.0 * size.1).ok_or_else(|| invalid("blocks overlap"))?;
        self.blocks.push(block);
        Ok(())
    }

    /// The planes, when every block is there.
    fn finish(mut self, headers: &[Header], cancel: &Cancel) -> ExrResult<Vec<Plane>> {
        for (layer, header) in headers.iter().enumerate() {
            let area = extent(header, self.level).map_or(0, |(w, h)| w * h);
            let planes = self.planes.iter_mut().skip(self.first[layer]);
            planes.take(header.channels.list.len()).for_each(|plane| plane.values = vec![0.0; area]);
        }
        for block in std::mem::take(&mut self.blocks).into_iter().take_while(|_| !cancel.is_set()) {
            let (at, size, layer) = (block.index.pixel_position, block.index.pixel_size, block.index.layer);
            let (first, count) = (self.first[layer], headers[layer].channels.list.len());
            let mut bytes = block.data.as_slice();
            for y in at.1..at.1 + size.1 {
                let row = y * self.width + at.0;
                for plane in self.planes.iter_mut().skip(first).take(count) {
                    let width = if plane.sample == Sample::Half { 2 } else { 4 };
                    let line = bytes.split_at_checked(size.0 * width);
                    let slots = plane.values.get_mut(row..row + size.0);
                    let (Some((line, rest)), Some(slots)) = (line, slots) else {
                        return Err(invalid("a block of the wrong size"));
                    };
                    fill(slots, line, plane.sample);
                    bytes = rest;
                }
            }
        }
        Ok(self.planes)
    }
}

fn invalid(what: &'static str) -> Error {
    Error::Invalid(what.into())
}

/// Decodes a line of samples; the crate hands them over in the byte order of the machine.
fn fill(slots: &mut [f64], line: &[u8], sample: Sample) {
    let word = |b: &[u8]| [b[0], b[1], b[2], b[3]];
    match sample {
        Sample::Half => {
            for (slot, b) in slots.iter_mut().zip(line.chunks_exact(2)) {
                *slot = f16::from_ne_bytes([b[0], b[1]]).to_f64();
            }
        }
        Sample::Float => {
            for (slot, b) in slots.iter_mut().zip(line.chunks_exact(4)) {
                *slot = f64::from(f32::from_ne_bytes(word(b)));
            }
        }
        _ => {
            for (slot, b) in slots.iter_mut().zip(line.chunks_exact(4)) {
                *slot = f64::from(u32::from_ne_bytes(word(b)));
            }
        }
    }
}
