//! PNG and JPEG. The other containers are read by `encode`.

use super::{MAX_PIXELS, Picture, PictureError, Plane};
use image::codecs::jpeg::JpegDecoder;
use image::codecs::png::PngDecoder;
use image::{ImageDecoder, Limits};
use std::io::Cursor;

/// How these files begin.
pub const MAGIC: [(&[u8], &str); 2] = [(b"\x89PNG\r\n\x1a\n", "png"), (b"\xff\xd8\xff", "jpeg")];

/// Most bytes that a decoder may take for rows, text and profiles.
const MAX_ALLOC: u64 = 1 << 31;

/// Reads a PNG or JPEG image from memory. Profiles and gamma are left alone: samples are codes as they stand.
///
/// # Errors
/// [`PictureError`] for what is no sound image of at most [`MAX_PIXELS`].
pub fn read_bytes(bytes: &[u8]) -> Result<Picture, PictureError> {
    let Some((_, format)) = MAGIC.iter().find(|(magic, _)| bytes.starts_with(magic)) else {
        return Err(PictureError::Unknown(bytes.iter().copied().take(8).collect()));
    };
    let damaged = |fault: String| PictureError::Damaged { format, fault };
    let library = |e: image::ImageError| damaged(e.to_string());
    let decode = || {
        if *format == "png" {
            planes(PngDecoder::new(Cursor::new(bytes)).map_err(library)?, format)
        } else {
            planes(JpegDecoder::new(Cursor::new(bytes)).map_err(library)?, format)
        }
    };
    // decoders can panic on damaged files; that is told as an error
    std::panic::catch_unwind(decode).unwrap_or_else(|_| Err(damaged("the decoder gave up".to_owned())))
}

fn planes(mut decoder: impl ImageDecoder, format: &'static str) -> Result<Picture, PictureError> {
    let (w, h) = decoder.dimensions();
    let (width, height) = (w as usize, h as usize);
    let pixels = width.saturating_mul(height);
    if pixels == 0 || pixels > MAX_PIXELS {
        return Err(PictureError::Pixels { width, height });
    }
    let library = |e: image::ImageError| PictureError::Damaged { format, fault: e.to_string() };
    let mut limits = Limits::default();
    limits.max_alloc = Some(MAX_ALLOC);
    decoder.set_limits(limits).map_err(library)?;
    let samples = Samples::read(decoder, pixels).map_err(library)?;
    let one = if samples.are_wide() { 65535.0 } else { 255.0 };
    let plane = |(c, name): (usize, &&str)| Plane {
        name: (*name).to_owned(),
        values: samples.codes(c).map(|code| f32::from(code) / one).collect(),
    };
    Ok(Picture { width, height, planes: samples.names().iter().enumerate().map(plane).collect() })
}

/// A decoded image: codes of 8 or 16 bits, all channels of a pixel together. Greys of fewer bits and palettes are unfolded to 8.
pub(crate) struct Samples {
    channels: usize,
    /// Bytes of a sample.
    size: usize,
    data: Vec<u8>,
}

impl Samples {
    /// All of an image of so many pixels.
    pub(crate) fn read(decoder: impl ImageDecoder, pixels: usize) -> image::ImageResult<Samples> {
        let colour = decoder.color_type();
        let channels = usize::from(colour.channel_count());
        let size = usize::from(colour.bytes_per_pixel()) / channels;
        let mut data = vec![0; pixels * channels * size];
        decoder.read_image(&mut data)?;
        Ok(Samples { channels, size, data })
    }

    /// Names of the channels.
    pub(crate) const fn names(&self) -> &'static [&'static str] {
        match self.channels {
            1 => &["Y"],
            2 => &["Y", "A"],
            3 => &["R", "G", "B"],
            _ => &["R", "G", "B", "A"],
        }
    }

    /// Are the codes of 16 bits?
    pub(crate) const fn are_wide(&self) -> bool {
        self.size > 1
    }

    /// The codes of a channel, rows from the top.
    pub(crate) fn codes(&self, channel: usize) -> impl Iterator<Item = u16> + '_ {
        self.data.chunks_exact(self.size).skip(channel).step_by(self.channels).map(|sample| match sample {
            [a, b] => u16::from_ne_bytes([*a, *b]),
            _ => sample.first().map_or(0, |&a| u16::from(a)),
        })
    }
}
