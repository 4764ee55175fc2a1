//! PNG: 16-bit codes over the range of each channel.
//!
//! | channels | colour type | samples |
//! |---|---|---|
//! | 1 | grey | the channel |
//! | 2 | RGB | first, second, 0 |
//! | 3 | RGB | in order |
//! | 4 | RGBA | in order |
//!
//! Two channels are not grey with alpha: many programs multiply by alpha, or drop it. With four channels there is no
//! choice: a program that multiplies by alpha (OpenImageIO does, unless `oiio:UnassociatedAlpha` is set) reads three of
//! them wrongly. EXR has no such trap.
//!
//! The samples are linear data: gAMA is 1 and there is no sRGB chunk. The provenance is an uncompressed iTXt chunk with
//! the keyword `brdfbake`; it holds the ids and ranges of the channels, without which the codes mean nothing.
//! Filter and compression level are fixed, so that one version of this program always makes the same bytes.

use super::{EncodeError, EncodeInput, Encoder, Storage};
use crate::grid::provenance::ATTRIBUTE;

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Png;

/// Samples of a pixel that holds a table of `channels` channels: the blue of two channels is empty.
pub(super) const fn samples_per_pixel(channels: usize) -> usize {
    if channels == 2 { 3 } else { channels }
}

impl Encoder for Png {
    fn id(&self) -> &'static str {
        "png"
    }

    fn extension(&self) -> &'static str {
        "png"
    }

    fn storages(&self) -> &'static [Storage] {
        &[Storage::Unorm16]
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        input.check(self, 4)?;
        let [width, height] = input.size();
        let (Ok(w), Ok(h)) = (u32::try_from(width), u32::try_from(height)) else {
            return Err(EncodeError::Size { format: self.id(), width, height, limit: 1 << 24 });
        };
        let library =
            |e: ::png::EncodingError| EncodeError::Library { format: self.id(), source: Box::new(e) };
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, w, h);
        encoder.set_color(match input.channels.len() {
            1 => ::png::ColorType::Grayscale,
            4 => ::png::ColorType::Rgba,
            _ => ::png::ColorType::Rgb,
        });
        encoder.set_depth(::png::BitDepth::Sixteen);
        encoder.set_filter(::png::Filter::Paeth);
        encoder.set_deflate_compression(::png::DeflateCompression::Level(6));
        encoder.set_source_gamma(::png::ScaledFloat::new(1.0));
        encoder.add_itxt_chunk(ATTRIBUTE.to_owned(), input.provenance_json.to_owned()).map_err(library)?;
        let mut writer = encoder.write_header().map_err(library)?;
        writer.write_image_data(&pixels(input)?).map_err(library)?;
        writer.finish().map_err(library)?;
        Ok(bytes)
    }
}

/// Big-endian samples, rows from the top.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a code is an integer in 0 ..= 65535"
)]
fn pixels(input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
    let n = input.channels.len();
    let pad = samples_per_pixel(n) - n;
    let mut data = Vec::with_capacity(input.grid.len() * (n + pad) * 2);
    for (t, texel) in input.values.chunks_exact(n).enumerate() {
        for (channel, &value) in input.channels.iter().zip(texel) {
            let storage = input.storage;
            let code = storage.code(value, channel.range).map_err(|_| EncodeError::NotQuantised {
                texel: t,
                channel: channel.id.clone(),
                value,
                storage: storage.id(),
            })?;
            data.extend_from_slice(&(code as u16).to_be_bytes());
        }
        data.resize(data.len() + pad * 2, 0);
    }
    Ok(data)
}
