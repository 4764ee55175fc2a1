//! PNG: 8-bit or 16-bit codes over the range of each channel, or 8-bit RGBD.
//!
//! | channels | colour type | samples |
//! |---|---|---|
//! | 1 | grey | the channel |
//! | 2 | RGB | first, second, 0 |
//! | 3 | RGB | in order |
//! | 4 | RGBA | in order |
//! | 1 to 3, RGBD | RGBA | in order, 0 where there is none; alpha is the divisor |
//!
//! Option `rgba` makes it four samples in any case. Samples without channel are 0, and 1 for alpha; `fill-zero` and
//! `fill-one` change that.
//!
//! Two channels are not grey with alpha: many programs multiply by alpha, or drop it. With four channels there is no
//! choice: a program that multiplies by alpha (OpenImageIO does, unless `oiio:UnassociatedAlpha` is set) reads three of
//! them wrongly, and those of RGBD. EXR has no such trap.
//!
//! The samples are linear data: gAMA is 1 and there is no sRGB chunk. Browsers convert by gAMA as they decode a picture, also
//! for a texture; `untagged` leaves it out. The provenance is an uncompressed iTXt chunk with
//! the keyword `brdfbake`; it holds the ids and ranges of the channels, without which the codes mean nothing.
//! Filter and compression level are fixed, so that one version of this program always makes the same bytes.

use super::mips::Mips;
use super::{EncodeError, EncodeInput, Encoder, FileOption, Image, ReadError, Shape, Storage, texels};
use crate::cancel::Cancel;
use crate::grid::provenance::ATTRIBUTE;

/// The container. See the module.
#[derive(Debug, Clone, Copy)]
pub struct Png;

impl Encoder for Png {
    fn id(&self) -> &'static str {
        "png"
    }

    fn extension(&self) -> &'static str {
        "png"
    }

    fn media_type(&self) -> &'static str {
        "image/png"
    }

    fn storages(&self) -> &'static [Storage] {
        &[Storage::Unorm16, Storage::Unorm8, Storage::Rgbd]
    }

    fn options(&self) -> &'static [FileOption] {
        &[FileOption::Rgba, FileOption::FillZero, FileOption::FillOne, FileOption::Untagged]
    }

    fn most_channels(&self) -> usize {
        4
    }

    fn components(&self, shape: &Shape<'_>) -> usize {
        match shape.channels {
            _ if shape.storage == Storage::Rgbd => 3,
            _ if shape.has(FileOption::Rgba) => 4,
            2 => 3,
            n => n,
        }
    }

    fn colours(&self, count: usize) -> &'static [&'static str] {
        if count == 1 { &["grey"] } else { super::COLOURS }
    }

    fn magic(&self) -> &'static [&'static [u8]] {
        &[b"\x89PNG\r\n\x1a\n"]
    }

    fn read(&self, bytes: &[u8], cancel: &Cancel) -> Result<Image, ReadError> {
        super::png_read::read(bytes, cancel)
    }

    fn mip_storages(&self) -> &'static [Storage] {
        &[Storage::Unorm8, Storage::Unorm16]
    }

    fn holds_all_levels(&self) -> bool {
        false
    }

    fn encode_mips(&self, mips: &Mips<'_>) -> Result<Vec<Vec<u8>>, EncodeError> {
        // no PNG has two channels that are both numbers
        let components = if mips.channels.len() == 2 { 3 } else { mips.channels.len() };
        let levels = mips.packed(components)?.into_iter().zip(mips.levels);
        levels.map(|(bytes, level)| self::level(mips, level.size, components, bytes)).collect()
    }

    fn encode(&self, input: &EncodeInput<'_>) -> Result<Vec<u8>, EncodeError> {
        input.check(self)?;
        let components = self.components(&input.shape());
        let file = File {
            size: input.size(),
            colour: match (input.storage, components) {
                (Storage::Rgbd, _) | (_, 4) => ::png::ColorType::Rgba,
                (_, 1) => ::png::ColorType::Grayscale,
                _ => ::png::ColorType::Rgb,
            },
            wide: input.storage == Storage::Unorm16,
            tagged: !input.shape().has(FileOption::Untagged),
            provenance: input.label.provenance_json,
        };
        file.write(texels::pack(input, components)?)
    }
}

/// One level of a pyramid, packed.
fn level(
    mips: &Mips<'_>,
    size: [usize; 2],
    components: usize,
    pixels: Vec<u8>,
) -> Result<Vec<u8>, EncodeError> {
    let colour = match components {
        1 => ::png::ColorType::Grayscale,
        4 => ::png::ColorType::Rgba,
        _ => ::png::ColorType::Rgb,
    };
    let wide = mips.storage == Storage::Unorm16;
    File { size, colour, wide, tagged: false, provenance: mips.provenance_json }.write(pixels)
}

/// What stands round the pixels.
struct File<'a> {
    size: [usize; 2],
    colour: ::png::ColorType,
    wide: bool,
    tagged: bool,
    provenance: &'a str,
}

impl File<'_> {
    fn write(&self, mut pixels: Vec<u8>) -> Result<Vec<u8>, EncodeError> {
        let [width, height] = self.size;
        let (Ok(w), Ok(h)) = (u32::try_from(width), u32::try_from(height)) else {
            return Err(EncodeError::Size { format: Png.id(), width, height, limit: 1 << 24 });
        };
        let library =
            |e: ::png::EncodingError| EncodeError::Library { format: Png.id(), source: Box::new(e) };
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, w, h);
        encoder.set_color(self.colour);
        encoder.set_depth(if self.wide { ::png::BitDepth::Sixteen } else { ::png::BitDepth::Eight });
        encoder.set_filter(::png::Filter::Paeth);
        encoder.set_deflate_compression(::png::DeflateCompression::Level(6));
        if self.tagged {
            encoder.set_source_gamma(::png::ScaledFloat::new(1.0));
        }
        encoder.add_itxt_chunk(ATTRIBUTE.to_owned(), self.provenance.to_owned()).map_err(library)?;
        let mut writer = encoder.write_header().map_err(library)?;
        if self.wide {
            // PNG is big-endian
            pixels.chunks_exact_mut(2).for_each(<[u8]>::reverse);
        }
        writer.write_image_data(&pixels).map_err(library)?;
        writer.finish().map_err(library)?;
        Ok(bytes)
    }
}
