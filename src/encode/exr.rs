//! OpenEXR: half or float, one part, ZIP-compressed scan lines.
//!
//! Channel names are the ids of the table. OpenEXR reads a dot as a layer: `dfg.scale` is channel `scale` of layer
//! `dfg`. Channels lie in the file sorted by name, as the format demands.
//!
//! The provenance is the one custom attribute, `brdfbake`, a UTF-8 string. There must not be a second one: the `exr`
//! crate keeps custom attributes in a `HashMap` with a random seed, so that two of them make the bytes differ from run
//! to run. The line order is fixed to increasing for the same reason.

use super::{EncodeError, EncodeInput, Encoder, Image as Picture, ReadError, Storage};
use crate::grid::provenance::ATTRIBUTE;
use ::exr::image::write::WritableImage;
use ::exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Blocks, Compression, Encoding, FlatSamples, Image, Layer,
    LayerAttributes, LineOrder, Text, f16,
};
use std::io::Cursor;

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Exr;

const ENCODING: Encoding = Encoding {
    compression: Compression::ZIP16,
    blocks: Blocks::ScanLines,
    line_order: LineOrder::Increasing,
};

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
        let [width, height] = input.size();
        let channels = AnyChannels::sort(
            input
                .channels
                .iter()
                .enumerate()
                .map(|(c, channel)| AnyChannel {
                    name: text(&channel.id),
                    sample_data: samples(input, c),
                    quantize_linearly: false,
                    sampling: ::exr::math::Vec2(1, 1),
                })
                .collect(),
        );
        let mut attributes = LayerAttributes::default();
        attributes.other.insert(text(ATTRIBUTE), AttributeValue::Text(text(input.provenance_json)));
        let layer = Layer::new((width, height), attributes, ENCODING, channels);
        let mut bytes = Cursor::new(Vec::new());
        Image::from_layer(layer)
            .write()
            .non_parallel()
            .to_buffered(&mut bytes)
            .map_err(|e| EncodeError::Library { format: self.id(), source: Box::new(e) })?;
        Ok(bytes.into_inner())
    }
}

/// UTF-8, as the OpenEXR file layout demands; the crate's own conversion from `str` is Latin-1.
fn text(s: &str) -> Text {
    Text::from_slice_unchecked(s.as_bytes())
}

/// One channel. The values are numbers of the storage already (checked), so both conversions are exact.
#[allow(clippy::cast_possible_truncation, reason = "the value is a f32 number: see EncodeInput::check")]
fn samples(input: &EncodeInput<'_>, channel: usize) -> FlatSamples {
    let values = input.values.iter().skip(channel).step_by(input.channels.len());
    if input.storage == Storage::Half {
        FlatSamples::F16(values.map(|&v| f16::from_f64(v)).collect())
    } else {
        FlatSamples::F32(values.map(|&v| v as f32).collect())
    }
}
