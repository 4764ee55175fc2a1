//! OpenEXR: half or float, ZIP-compressed scan lines in one part; with option `tiled` tiles of 64 x 64 pixels, with `parts`
//! one part a slice of a table with three axes or more (`slice_000`, `slice_001`, ...), not slices below each other. Tables that
//! name the same file become parts of it, named after them, each with its own provenance.
//!
//! Channel names are the ids of the table. OpenEXR reads a dot as a layer: `dfg.scale` is channel `scale` of layer
//! `dfg`. Channels lie in the file sorted by name, as the format demands.
//!
//! Loaders of pictures often know the names R, G, B, A and Y only, and refuse others: option `positional` names the channels so, by
//! position (of two channels B is 0, one channel is written as R, G and B), option `y` names the one channel Y. The ids and their
//! meaning then stand in the provenance alone.
//!
//! The provenance is the one custom attribute, `brdfbake`, a UTF-8 string, of the first part. There must not be a second one: the `exr`
//! crate keeps custom attributes in a `HashMap` with a random seed, so that two of them make the bytes differ from run
//! to run. The line order is fixed to increasing for the same reason.

use super::mips::Mips;
use super::stoppable::Stoppable;
use super::{
    EncodeError, EncodeInput, Encoder, FileOption, Image as Picture, ReadError, Shape, Storage, texels,
};
use crate::cancel::Cancel;
use crate::grid::Channel;
use crate::grid::provenance::ATTRIBUTE;
use ::exr::image::write::WritableImage;
use ::exr::math::{RoundingMode, Vec2};
use ::exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Compression, Encoding, FlatSamples, Image,
    ImageAttributes, Layer, LayerAttributes, Levels, LineOrder, Text, f16,
};
use std::io::Cursor;
use std::ops::Range;

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Exr;

/// Side of a tile.
const TILE: usize = 64;

/// Bytes that are reserved for the header of a part.
const RESERVE: usize = 1 << 16;

impl Encoder for Exr {
    fn id(&self) -> &'static str {
        "exr"
    }

    fn extension(&self) -> &'static str {
        "exr"
    }

    fn media_type(&self) -> &'static str {
        "image/x-exr"
    }

    fn storages(&self) -> &'static [Storage] {
        &[Storage::Half, Storage::Float]
    }

    fn options(&self) -> &'static [FileOption] {
        &[FileOption::Parts, FileOption::Tiled, FileOption::Positional, FileOption::Luminance]
    }

    /// With option `positional` two channels get a third, which is 0.
    fn components(&self, shape: &Shape<'_>) -> usize {
        if shape.has(FileOption::Positional) && shape.channels == 2 { 3 } else { shape.channels }
    }

    /// A channel that is written three times is there three times.
    fn most_bytes(&self, shape: &Shape<'_>) -> usize {
        let written = self.components(shape).max(self.names(shape).len());
        texels::bytes(shape.storage, written, shape.extent()).unwrap_or(usize::MAX)
    }

    fn names(&self, shape: &Shape<'_>) -> &'static [&'static str] {
        match shape.channels {
            _ if shape.has(FileOption::Luminance) => &["Y"],
            _ if !shape.has(FileOption::Positional) => &[],
            4 => &["R", "G", "B", "A"],
            _ => &["R", "G", "B"],
        }
    }

    fn most_channels(&self) -> usize {
        1024
    }

    fn magic(&self) -> &'static [&'static [u8]] {
        &[&[0x76, 0x2f, 0x31, 0x01]]
    }

    fn read(&self, bytes: &[u8], cancel: &Cancel) -> Result<Picture, ReadError> {
        super::exr_read::read(bytes, 0, cancel)
    }

    fn read_level(&self, bytes: &[u8], level: usize, cancel: &Cancel) -> Result<Picture, ReadError> {
        super::exr_read::read(bytes, level, cancel)
    }

    fn joins(&self) -> bool {
        true
    }

    /// Parts named after their tables.
    fn encode_together(&self, tables: &[EncodeInput<'_>]) -> Result<Vec<u8>, EncodeError> {
        let mut layers = Vec::new();
        for table in tables {
            layers.extend(parts(table, Some(table.label.name))?);
        }
        let size = layers.first().map_or(Vec2(1, 1), |l| l.size);
        if layers.iter().any(|l| l.size != size) {
            let fault = "the tables of one file are parts of one size";
            return Err(EncodeError::Axes { format: self.id(), fault });
        }
        let Some(first) = tables.first() else {
            return Err(EncodeError::Axes { format: self.id(), fault: "there is no table" });
        };
        write(ImageAttributes::with_size(size), layers, first.cancel)
    }

    fn mip_storages(&self) -> &'static [Storage] {
        &[Storage::Half, Storage::Float]
    }

    fn encode_mips(&self, mips: &Mips<'_>) -> Result<Vec<Vec<u8>>, EncodeError> {
        self::mips(mips).map(|bytes| vec![bytes])
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        let layers = parts(input, None)?;
        let size = layers.first().map_or(Vec2(1, 1), |l| l.size);
        write(ImageAttributes::with_size(size), layers, input.cancel)
    }
}

/// The parts that a table takes, the provenance in the first: one, or one a slice. They are named after the table where others are
/// in the file.
fn parts(
    input: &EncodeInput<'_>,
    name: Option<&str>,
) -> Result<Vec<Layer<AnyChannels<FlatSamples>>>, EncodeError> {
    input.check(&Exr)?;
    let shape = input.shape();
    let [width, rows, slices] = shape.extent();
    let (parts, height) = if shape.has(FileOption::Parts) { (slices, rows) } else { (1, rows * slices) };
    let tiled = shape.has(FileOption::Tiled);
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: if tiled { Blocks::Tiles(Vec2(TILE, TILE)) } else { Blocks::ScanLines },
        line_order: LineOrder::Increasing,
    };
    let layer = |part: usize| {
        let mut attributes = LayerAttributes::default();
        let slice = (parts > 1).then(|| format!("slice_{part:03}"));
        attributes.layer_name = match (name, slice) {
            (None, slice) => slice,
            (Some(name), None) => Some(name.to_owned()),
            (Some(name), Some(slice)) => Some(format!("{name}.{slice}")),
        }
        .map(|name| text(&name));
        if part == 0 {
            let json = AttributeValue::Text(text(input.label.provenance_json));
            attributes.other.insert(text(ATTRIBUTE), json);
        }
        let texels = part * width * height..(part + 1) * width * height;
        Layer::new((width, height), attributes, encoding, channels(input, texels))
    };
    Ok((0..parts).map(layer).collect())
}

/// A pyramid: tiles of 64 x 64 pixels, levels rounded down.
#[allow(clippy::cast_possible_truncation, reason = "the value has been rounded to a half")]
fn mips(mips: &Mips<'_>) -> Result<Vec<u8>, EncodeError> {
    let n = mips.channels.len();
    let mut levels = Vec::new();
    for k in 0..mips.levels.len() {
        mips.cancel.check()?;
        levels.push(super::mips::stored(mips, k)?);
    }
    let samples = |values: &[f32], c: usize| {
        let own = values.iter().skip(c).step_by(n);
        if mips.storage == Storage::Half {
            FlatSamples::F16(own.map(|v| f16::from_f32(*v)).collect())
        } else {
            FlatSamples::F32(own.copied().collect())
        }
    };
    let channel = |(c, channel): (usize, &Channel)| AnyChannel {
        name: text(&channel.id),
        sample_data: Levels::Mip {
            rounding_mode: RoundingMode::Down,
            level_data: levels.iter().map(|values| samples(values, c)).collect(),
        },
        quantize_linearly: false,
        sampling: Vec2(1, 1),
    };
    let channels = AnyChannels::sort(mips.channels.iter().enumerate().map(channel).collect());
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::Tiles(Vec2(TILE, TILE)),
        line_order: LineOrder::Increasing,
    };
    let mut attributes = LayerAttributes::default();
    attributes.other.insert(text(ATTRIBUTE), AttributeValue::Text(text(mips.provenance_json)));
    let [width, height] = mips.levels.first().map_or([1, 1], |l| l.size);
    let layer = Layer::new((width, height), attributes, encoding, channels);
    let mut bytes = Stoppable::new(Cursor::new(Vec::new()), mips.cancel);
    Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes).map_err(library)?;
    Ok(bytes.into_inner().into_inner())
}

fn library(e: ::exr::error::Error) -> EncodeError {
    EncodeError::Library { format: "exr", source: Box::new(e) }
}

fn write(
    attributes: ImageAttributes,
    layers: Vec<Layer<AnyChannels<FlatSamples>>>,
    cancel: &Cancel,
) -> Result<Vec<u8>, EncodeError> {
    // a block that does not shrink is stored as it is; it has a place, a size and an offset
    let size = |l: &Layer<AnyChannels<FlatSamples>>| {
        let width = |s: &FlatSamples| if matches!(s, FlatSamples::F16(_)) { 2 } else { 4 };
        let samples = l.channel_data.list.iter().map(|c| c.sample_data.len() * width(&c.sample_data));
        samples.sum::<usize>() / 63 * 64 + l.size.1 * 16 + RESERVE
    };
    let room = Vec::with_capacity(layers.iter().map(size).sum());
    let mut bytes = Stoppable::new(Cursor::new(room), cancel);
    Image::from_layers(attributes, layers).write().non_parallel().to_buffered(&mut bytes).map_err(library)?;
    let mut bytes = bytes.into_inner().into_inner();
    bytes.shrink_to_fit();
    Ok(bytes)
}

/// The channels of a run of texels, sorted by name.
fn channels(input: &EncodeInput<'_>, texels: Range<usize>) -> AnyChannels<FlatSamples> {
    let channel = |name: &str, sample_data: FlatSamples| AnyChannel {
        name: text(name),
        sample_data,
        quantize_linearly: false,
        sampling: Vec2(1, 1),
    };
    let shape = input.shape();
    let (n, fill) = (input.channels.len(), shape.fill(Exr.components(&shape)));
    let named = |(i, name): (usize, &&str)| {
        let data = match fill.get(i.wrapping_sub(n)) {
            Some(&value) => constant(input.storage, value, texels.len()),
            None => samples(input, i.min(n - 1), texels.clone()),
        };
        channel(name, data)
    };
    let own = |(c, id): (usize, &Channel)| channel(&id.id, samples(input, c, texels.clone()));
    AnyChannels::sort(match Exr.names(&shape) {
        [] => input.channels.iter().enumerate().map(own).collect(),
        names => names.iter().enumerate().map(named).collect(),
    })
}

/// UTF-8, as the OpenEXR file layout demands; the crate's own conversion from `str` is Latin-1.
fn text(s: &str) -> Text {
    Text::from_slice_unchecked(s.as_bytes())
}

#[allow(clippy::cast_possible_truncation, reason = "the value is 0 or 1")]
fn constant(storage: Storage, value: f64, count: usize) -> FlatSamples {
    match storage {
        Storage::Half => FlatSamples::F16(vec![f16::from_f64(value); count]),
        _ => FlatSamples::F32(vec![value as f32; count]),
    }
}

/// One channel. The values are numbers of the storage already (checked), so both conversions are exact.
#[allow(clippy::cast_possible_truncation, reason = "the value is a f32 number: see EncodeInput::check")]
fn samples(input: &EncodeInput<'_>, channel: usize, texels: Range<usize>) -> FlatSamples {
    let n = input.channels.len();
    let values = input.values[texels.start * n..texels.end * n].iter().skip(channel).step_by(n);
    if input.storage == Storage::Half {
        FlatSamples::F16(values.map(|&v| f16::from_f64(v)).collect())
    } else {
        FlatSamples::F32(values.map(|&v| v as f32).collect())
    }
}
