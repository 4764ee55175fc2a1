//! The codes that occur in each channel of an image, without planes of floats: as little memory as the decoder takes.

use super::PictureError;
use super::read::{MAGIC, Samples};
use image::codecs::jpeg::JpegDecoder;
use image::codecs::png::PngDecoder;
use image::codecs::webp::WebPDecoder;
use image::{ImageDecoder, Limits};
use std::io::Cursor;

/// The codes of a channel, as numbers in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    /// Smallest.
    pub lo: f64,
    /// Largest.
    pub hi: f64,
    /// How many different ones.
    pub count: u32,
}

impl Levels {
    /// One value everywhere.
    pub const ONE: Levels = Levels { lo: 1.0, hi: 1.0, count: 1 };
}

/// Bytes of memory for each pixel that JPEG and WebP take at most: coefficients of three components, and the picture.
const BYTES_A_PIXEL: u64 = 9;

/// The levels of R, G, B and A of a PNG, JPEG or WebP image; alpha is 1 where there is none, and grey is all three colours.
/// `allow` is asked with the bytes that decoding takes before they are taken.
///
/// # Errors
/// [`PictureError::Unknown`] for another format, [`PictureError::Memory`] where `allow` refuses, [`PictureError::Damaged`].
pub fn levels(bytes: &[u8], allow: impl FnOnce(u64) -> Result<(), u64>) -> Result<[Levels; 4], PictureError> {
    let webp = bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP");
    let format = match MAGIC.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        Some((_, format)) => *format,
        None if webp => "webp",
        None => return Err(PictureError::Unknown(bytes.iter().copied().take(8).collect())),
    };
    let damaged = |fault: String| PictureError::Damaged { format, fault };
    let library = |e: image::ImageError| damaged(e.to_string());
    // decoders can panic on damaged files; that is told as an error
    let decode = std::panic::AssertUnwindSafe(|| {
        let file = Cursor::new(bytes);
        match format {
            "png" => read(PngDecoder::new(file).map_err(library)?, format, 0, allow),
            "webp" => read(WebPDecoder::new(file).map_err(library)?, format, BYTES_A_PIXEL, allow),
            _ => read(JpegDecoder::new(file).map_err(library)?, format, BYTES_A_PIXEL, allow),
        }
    });
    std::panic::catch_unwind(decode).unwrap_or_else(|_| Err(damaged("the decoder gave up".to_owned())))
}

fn read(
    mut decoder: impl ImageDecoder,
    format: &'static str,
    least: u64,
    allow: impl FnOnce(u64) -> Result<(), u64>,
) -> Result<[Levels; 4], PictureError> {
    let (width, height) = decoder.dimensions();
    let pixels = u64::from(width).saturating_mul(u64::from(height));
    let needed = decoder.total_bytes().max(pixels.saturating_mul(least));
    let size = usize::try_from(pixels).ok().filter(|n| *n > 0 && usize::try_from(needed).is_ok());
    let Some(size) = size else {
        return Err(PictureError::Pixels { width: width as usize, height: height as usize });
    };
    allow(needed).map_err(|limit| PictureError::Memory { width, height, needed, limit })?;
    let library = |e: image::ImageError| PictureError::Damaged { format, fault: e.to_string() };
    let mut limits = Limits::default();
    limits.max_alloc = Some(needed.saturating_add(SLACK));
    decoder.set_limits(limits).map_err(library)?;
    Ok(count(&Samples::read(decoder, size).map_err(library)?))
}

/// Bytes beside the picture: rows, tables, profiles.
const SLACK: u64 = 32 << 20;

fn count(samples: &Samples) -> [Levels; 4] {
    let most = if samples.are_wide() { 65535_u16 } else { 255 };
    let of = |channel: usize| {
        let mut seen = vec![false; usize::from(most) + 1];
        for code in samples.codes(channel) {
            seen[usize::from(code)] = true;
        }
        let occur = || (0..=most).zip(&seen).filter(|(_, seen)| **seen).map(|(code, _)| code);
        let [lo, hi] =
            [occur().next(), occur().next_back()].map(|code| f64::from(code.unwrap_or(0)) / f64::from(most));
        Levels { lo, hi, count: u32::try_from(occur().count()).unwrap_or(u32::MAX) }
    };
    let names = samples.names();
    let find = |name: &str| names.iter().position(|n| *n == name);
    ["R", "G", "B", "A"].map(|name| {
        let grey = || if name == "A" { None } else { find("Y") };
        find(name).or_else(grey).map_or(Levels::ONE, of)
    })
}
