//! PNG, JPEG and WebP. The other containers are read by `encode`.

use super::png::Png;
use super::{MAX_PIXELS, Picture, PictureError, Plane};
use std::io::Cursor;

/// How these files begin; a WebP goes on with its length and `WEBP`.
const MAGIC: [(&[u8], &str); 2] = [(b"\x89PNG\r\n\x1a\n", "png"), (b"\xff\xd8\xff", "jpeg")];

/// Is it a file of a format that is read here?
#[must_use]
pub fn is_picture(bytes: &[u8]) -> bool {
    named(bytes).is_some()
}

/// Most bytes that a decoder may take for rows, text and profiles.
const MAX_ALLOC: u64 = 1 << 31;

/// Bytes beside the picture: rows, tables, text, profiles.
pub(super) const SLACK: u64 = 32 << 20;

/// Reads a PNG, JPEG or WebP image from memory. Profiles and gamma are left alone: samples are codes as they stand.
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

/// Width and height of a PNG, JPEG or WebP image, and the names of its channels, from what stands before its pixels.
///
/// # Errors
/// [`PictureError::Unknown`] for another format, [`PictureError::Damaged`].
pub fn facts(bytes: &[u8]) -> Result<([usize; 2], Vec<String>), PictureError> {
    let Some(format) = named(bytes) else {
        return Err(PictureError::Unknown(bytes.iter().copied().take(8).collect()));
    };
    guarded(format, || {
        let ((width, height), channels) = match format {
            "png" => {
                let png = open(bytes)?;
                (png.size(), png.channels)
            }
            _ => library::facts(bytes, format)?,
        };
        let names = names(channels).iter().map(|n| (*n).to_owned()).collect();
        Ok(([width as usize, height as usize], names))
    })
}

/// What a decoder makes of a file: decoders can panic on damaged ones, and that is told as an error.
fn guarded<T>(
    format: &'static str,
    read: impl FnOnce() -> Result<T, PictureError>,
) -> Result<T, PictureError> {
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(read))
        .unwrap_or_else(|_| Err(PictureError::Damaged { format, fault: "the decoder gave up".to_owned() }))
}

fn open(bytes: &[u8]) -> Result<Png<Cursor<&[u8]>>, PictureError> {
    // its rows, text and profiles, from the first chunk on
    let limit = usize::try_from(SLACK).unwrap_or(usize::MAX);
    Png::open(Cursor::new(bytes), limit).map_err(damaged_png)
}

fn damaged_png(e: png::DecodingError) -> PictureError {
    PictureError::Damaged { format: "png", fault: e.to_string() }
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

/// The format of a PNG, JPEG or WebP image.
pub(super) fn named(bytes: &[u8]) -> Option<&'static str> {
    let is_webp = bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP");
    let found = MAGIC.iter().find(|(magic, _)| bytes.starts_with(magic)).map(|(_, format)| *format);
    found.or(is_webp.then_some("webp"))
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
    guarded(format, || {
        let (header, samples) = match format {
            "png" => {
                let png = open(bytes)?;
                let (header, _) = header(png.size(), png.bytes(), allow)?;
                (header, png.read().map_err(damaged_png)?)
            }
            _ => library::read(bytes, format, allow)?,
        };
        Ok(make(&header, &samples))
    })
}

/// The header of an image of a size, and what `allow` says to it. `decoded`: bytes of what is decoded.
fn header(
    (width, height): (u32, u32),
    decoded: u64,
    allow: impl FnOnce(&Header) -> Result<u64, PictureError>,
) -> Result<(Header, u64), PictureError> {
    let pixels = u64::from(width).saturating_mul(u64::from(height));
    if pixels == 0 || usize::try_from(decoded).is_err() {
        return Err(PictureError::Pixels { width: width as usize, height: height as usize });
    }
    let header = Header { width, height, needed: decoded };
    let allowed = allow(&header)?;
    Ok((header, allowed))
}

/// Formats that a decoder of the crate `image` reads.
#[cfg(feature = "pictures")]
mod library {
    use super::super::{PictureError, jpeg};
    use super::{Header, Samples, header};
    use image::codecs::jpeg::JpegDecoder;
    use image::codecs::webp::WebPDecoder;
    use image::{ImageDecoder, ImageError, Limits};
    use std::io::Cursor;

    /// Bytes of memory for each pixel that WebP takes at most.
    const WEBP: f64 = 9.0;

    /// Width and height, and the number of channels.
    pub(super) fn facts(bytes: &[u8], format: &'static str) -> Result<((u32, u32), usize), PictureError> {
        let damaged = |e: ImageError| damaged(format, &e);
        let told = |d: &dyn ImageDecoder| (d.dimensions(), usize::from(d.color_type().channel_count()));
        Ok(match format {
            "webp" => told(&WebPDecoder::new(Cursor::new(bytes)).map_err(damaged)?),
            _ => told(&JpegDecoder::new(Cursor::new(bytes)).map_err(damaged)?),
        })
    }

    pub(super) fn read(
        bytes: &[u8],
        format: &'static str,
        allow: impl FnOnce(&Header) -> Result<u64, PictureError>,
    ) -> Result<(Header, Samples), PictureError> {
        let (file, damaged) = (Cursor::new(bytes), |e: ImageError| damaged(format, &e));
        match format {
            "webp" => unpack(WebPDecoder::new(file).map_err(damaged)?, format, WEBP, allow),
            _ => {
                let frame = jpeg::frame(bytes)
                    .map_err(|fault| PictureError::Damaged { format, fault: fault.to_owned() })?;
                // the picture, and coefficients of 16 bits
                let a_pixel = f64::from(frame.components) + 2.0 * frame.kept;
                unpack(JpegDecoder::new(file).map_err(damaged)?, format, a_pixel, allow)
            }
        }
    }

    fn damaged(format: &'static str, e: &ImageError) -> PictureError {
        PictureError::Damaged { format, fault: e.to_string() }
    }

    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "not negative, and below 2^36"
    )]
    fn unpack(
        mut decoder: impl ImageDecoder,
        format: &'static str,
        bytes_a_pixel: f64,
        allow: impl FnOnce(&Header) -> Result<u64, PictureError>,
    ) -> Result<(Header, Samples), PictureError> {
        let (width, height) = decoder.dimensions();
        let pixels = u64::from(width).saturating_mul(u64::from(height));
        let needed = decoder.total_bytes().max((pixels as f64 * bytes_a_pixel) as u64);
        let (header, allowed) = header((width, height), needed, allow)?;
        let library = |e: ImageError| damaged(format, &e);
        let mut limits = Limits::default();
        limits.max_alloc = Some(allowed);
        decoder.set_limits(limits).map_err(library)?;
        let colour = decoder.color_type();
        let channels = usize::from(colour.channel_count());
        let size = usize::from(colour.bytes_per_pixel()) / channels;
        let bytes = usize::try_from(decoder.total_bytes()).unwrap_or(usize::MAX);
        let mut data = vec![0; bytes];
        decoder.read_image(&mut data).map_err(library)?;
        Ok((header, Samples::new(channels, size, data)))
    }
}

#[cfg(not(feature = "pictures"))]
mod library {
    use super::super::PictureError;
    use super::{Header, Samples};

    pub(super) fn facts(_: &[u8], format: &'static str) -> Result<((u32, u32), usize), PictureError> {
        Err(PictureError::Feature { format })
    }

    pub(super) fn read(
        _: &[u8],
        format: &'static str,
        _: impl FnOnce(&Header) -> Result<u64, PictureError>,
    ) -> Result<(Header, Samples), PictureError> {
        Err(PictureError::Feature { format })
    }
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
    pub(super) const fn new(channels: usize, size: usize, data: Vec<u8>) -> Samples {
        Samples { channels, size, data }
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
