//! OpenEXR: half or float, ZIP-compressed scan lines in one part; with option `tiled` tiles of 64 x 64 pixels, with `parts`
//! one part a slice of a table with three axes or more (`slice_000`, `slice_001`, ...), not slices below each other.
//!
//! Channel names are the ids of the table. OpenEXR reads a dot as a layer: `dfg.scale` is channel `scale` of layer
//! `dfg`. Channels lie in the file sorted by name, as the format demands.
//!
//! The provenance is the one custom attribute, `brdfbake`, a UTF-8 string, of the first part. There must not be a second one: the `exr`
//! crate keeps custom attributes in a `HashMap` with a random seed, so that two of them make the bytes differ from run
//! to run. The line order is fixed to increasing for the same reason.

use super::{EncodeError, EncodeInput, Encoder, FileOption, Image as Picture, ReadError, Storage};
use crate::grid::Channel;
use crate::grid::provenance::ATTRIBUTE;
use ::exr::image::write::WritableImage;
use ::exr::math::Vec2;
use ::exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Compression, Encoding, FlatSamples, Image,
    ImageAttributes, Layer, LayerAttributes, LineOrder, Text, f16,
};
use std::io::Cursor;
use std::ops::Range;

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Exr;

/// Side of a tile.
const TILE: usize = 64;

impl Encoder for Exr {
    fn id(&self) -> &'static str {
        "exr"
    }

    fn extension(&self) -> &'static str {
        "exr"
    }

    fn storages(&self) -> &'static [Storage] {
        &[Storage::Half, Storage::Float]
    }

    fn options(&self) -> &'static [FileOption] {
        &[FileOption::Parts, FileOption::Tiled]
    }

    fn most_channels(&self) -> usize {
        1024
    }

    fn magic(&self) -> &'static [&'static [u8]] {
        &[&[0x76, 0x2f, 0x31, 0x01]]
    }

    fn read(&self, bytes: &[u8]) -> Result<Picture, ReadError> {
        super::exr_read::read(bytes)
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        input.check(self)?;
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
            if parts > 1 {
                attributes.layer_name = Some(text(&format!("slice_{part:03}")));
            }
            if part == 0 {
                attributes.other.insert(text(ATTRIBUTE), AttributeValue::Text(text(input.provenance_json)));
            }
            let texels = part * width * height..(part + 1) * width * height;
            Layer::new((width, height), attributes, encoding, channels(input, texels))
        };
        let layers: Vec<Layer<_>> = (0..parts).map(layer).collect();
        let mut bytes = Cursor::new(Vec::new());
        Image::from_layers(ImageAttributes::with_size((width, height)), layers)
            .write()
            .non_parallel()
            .to_buffered(&mut bytes)
            .map_err(|e| EncodeError::Library { format: self.id(), source: Box::new(e) })?;
        Ok(bytes.into_inner())
    }
}

/// The channels of a run of texels, sorted by name.
fn channels(input: &EncodeInput<'_>, texels: Range<usize>) -> AnyChannels<FlatSamples> {
    let channel = |(c, channel): (usize, &Channel)| AnyChannel {
        name: text(&channel.id),
        sample_data: samples(input, c, texels.clone()),
        quantize_linearly: false,
        sampling: Vec2(1, 1),
    };
    AnyChannels::sort(input.channels.iter().enumerate().map(channel).collect())
}

/// UTF-8, as the OpenEXR file layout demands; the crate's own conversion from `str` is Latin-1.
fn text(s: &str) -> Text {
    Text::from_slice_unchecked(s.as_bytes())
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
