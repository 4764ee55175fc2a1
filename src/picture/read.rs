//! PNG and JPEG, and WebP for its levels. The other containers are read by `encode`.

use super::jpeg;
use super::{MAX_PIXELS, Picture, PictureError, Plane};
use image::codecs::jpeg::JpegDecoder;
use image::codecs::png::PngDecoder;
use image::codecs::webp::WebPDecoder;
use image::{ImageDecoder, Limits};
use std::io::Cursor;

/// How these files begin.
pub const MAGIC: [(&[u8], &str); 2] = [(b"\x89PNG\r\n\x1a\n", "png"), (b"\xff\xd8\xff", "jpeg")];

/// Most bytes that a decoder may take for rows, text and profiles.
const MAX_ALLOC: u64 = 1 << 31;

/// Bytes beside the picture: rows, tables, text, profiles.
pub(super) const SLACK: u64 = 32 << 20;

/// A decoder whose rows, text and profiles take no more than [`SLACK`], from its first chunk on.
fn png(file: Cursor<&[u8]>) -> image::ImageResult<PngDecoder<Cursor<&[u8]>>> {
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(SLACK);
    PngDecoder::with_limits(file, limits)
}

/// Bytes of memory for each pixel that WebP takes at most.
const WEBP: f64 = 9.0;

/// Reads a PNG or JPEG image from memory. Profiles and gamma are left alone: samples are codes as they stand.
///
/// # Errors
/// [`PictureError`] for what is no sound image of at most [`MAX_PIXELS`].
pub fn read_bytes(bytes: &[u8]) -> Result<Picture, PictureError> {
    read_within(bytes, u64::MAX)
}

/// As [`read_bytes`], of an image that takes no more than `limit` bytes to decode.
///
/// # Errors
/// As [`read_bytes`], and [`PictureError::Memory`].
pub fn read_within(bytes: &[u8], limit: u64) -> Result<Picture, PictureError> {
    let allow = |header: &Header| {
        let (width, height) = (header.width as usize, header.height as usize);
        if width.saturating_mul(height) > MAX_PIXELS {
            return Err(PictureError::Pixels { width, height });
        }
        header.within(limit)?;
        Ok(MAX_ALLOC)
    };
    decode(bytes, named(bytes), allow, planes)
}

/// Width and height of a PNG or JPEG image, and the names of its channels, from what stands before its pixels.
///
/// # Errors
/// [`PictureError::Unknown`] for another format, [`PictureError::Damaged`].
pub fn facts(bytes: &[u8]) -> Result<([usize; 2], Vec<String>), PictureError> {
    let Some(format) = named(bytes) else {
        return Err(PictureError::Unknown(bytes.iter().copied().take(8).collect()));
    };
    let of = |decoder: &dyn ImageDecoder| {
        let (width, height) = decoder.dimensions();
        let names = names(usize::from(decoder.color_type().channel_count()));
        ([width as usize, height as usize], names.iter().map(|n| (*n).to_owned()).collect())
    };
    let damaged = |fault: String| PictureError::Damaged { format, fault };
    // as in `decode`
    let all = std::panic::AssertUnwindSafe(|| {
        let file = Cursor::new(bytes);
        match format {
            "png" => png(file).map(|d| of(&d)),
            _ => JpegDecoder::new(file).map(|d| of(&d)),
        }
    });
    let found = std::panic::catch_unwind(all);
    found.map_or_else(
        |_| Err(damaged("the decoder gave up".to_owned())),
        |r| r.map_err(|e| damaged(e.to_string())),
    )
}

/// Names of so many channels.
const fn names(channels: usize) -> &'static [&'static str] {
    match channels {
        1 => &["Y"],
        2 => &["Y", "A"],
        3 => &["R", "G", "B"],
        _ => &["R", "G", "B", "A"],
    }
}

fn planes(header: &Header, samples: &Samples) -> Picture {
    let one = if samples.are_wide() { 65535.0 } else { 255.0 };
    let plane = |(c, name): (usize, &&str)| Plane {
        name: (*name).to_owned(),
        values: samples.codes(c).map(|code| f32::from(code) / one).collect(),
    };
    let planes = samples.names().iter().enumerate().map(plane).collect();
    Picture { width: header.width as usize, height: header.height as usize, planes }
}

/// The format of a PNG or JPEG image.
pub(super) fn named(bytes: &[u8]) -> Option<&'static str> {
    MAGIC.iter().find(|(magic, _)| bytes.starts_with(magic)).map(|(_, format)| *format)
}

/// What is known of an image before it is decoded.
pub(super) struct Header {
    pub(super) width: u32,
    pub(super) height: u32,
    /// Bytes that decoding takes at most, but for rows, tables and profiles.
    pub(super) needed: u64,
}

impl Header {
    /// # Errors
    /// [`PictureError::Memory`] if it takes more than `limit` bytes.
    pub(super) fn within(&self, limit: u64) -> Result<(), PictureError> {
        let Header { width, height, needed } = *self;
        if needed > limit { Err(PictureError::Memory { width, height, needed, limit }) } else { Ok(()) }
    }
}

/// Decodes an image of a format, `png`, `jpeg` or `webp`. `allow` sees the header first, and says how many bytes the decoder may
/// take.
pub(super) fn decode<T>(
    bytes: &[u8],
    format: Option<&'static str>,
    allow: impl FnOnce(&Header) -> Result<u64, PictureError>,
    make: impl FnOnce(&Header, &Samples) -> T,
) -> Result<T, PictureError> {
    let Some(format) = format else {
        return Err(PictureError::Unknown(bytes.iter().copied().take(8).collect()));
    };
    let damaged = |fault: String| PictureError::Damaged { format, fault };
    let library = |e: image::ImageError| damaged(e.to_string());
    // decoders can panic on damaged files; that is told as an error
    let all = std::panic::AssertUnwindSafe(|| {
        let file = Cursor::new(bytes);
        let (header, samples) = match format {
            "png" => unpack(png(file).map_err(library)?, format, 0.0, allow)?,
            "webp" => unpack(WebPDecoder::new(file).map_err(library)?, format, WEBP, allow)?,
            _ => {
                let frame = jpeg::frame(bytes).map_err(|fault| damaged(fault.to_owned()))?;
                // the picture, and coefficients of 16 bits
                let a_pixel = f64::from(frame.components) + 2.0 * frame.kept;
                unpack(JpegDecoder::new(file).map_err(library)?, format, a_pixel, allow)?
            }
        };
        Ok(make(&header, &samples))
    });
    std::panic::catch_unwind(all).unwrap_or_else(|_| Err(damaged("the decoder gave up".to_owned())))
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "not negative, and below 2^36")]
fn unpack(
    mut decoder: impl ImageDecoder,
    format: &'static str,
    bytes_a_pixel: f64,
    allow: impl FnOnce(&Header) -> Result<u64, PictureError>,
) -> Result<(Header, Samples), PictureError> {
    let (width, height) = decoder.dimensions();
    let pixels = u64::from(width).saturating_mul(u64::from(height));
    let needed = decoder.total_bytes().max((pixels as f64 * bytes_a_pixel) as u64);
    let size = usize::try_from(pixels).ok().filter(|n| *n > 0 && usize::try_from(needed).is_ok());
    let Some(size) = size else {
        return Err(PictureError::Pixels { width: width as usize, height: height as usize });
    };
    let header = Header { width, height, needed };
    let library = |e: image::ImageError| PictureError::Damaged { format, fault: e.to_string() };
    let mut limits = Limits::default();
    limits.max_alloc = Some(allow(&header)?);
    decoder.set_limits(limits).map_err(library)?;
    let samples = Samples::read(decoder, size).map_err(library)?;
    Ok((header, samples))
}

/// A decoded image: codes of 8 or 16 bits, all channels of a pixel together. Greys of fewer bits and palettes are unfolded to 8.
#[derive(Debug)]
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
        names(self.channels)
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
