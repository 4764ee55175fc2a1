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
    // greys of fewer bits and palettes are unfolded to 8
    let colour = decoder.color_type();
    let n = usize::from(colour.channel_count());
    let size = usize::from(colour.bytes_per_pixel()) / n;
    let mut data = vec![0; pixels * n * size];
    decoder.read_image(&mut data).map_err(library)?;
    let names: &[&str] = match n {
        1 => &["Y"],
        2 => &["Y", "A"],
        3 => &["R", "G", "B"],
        _ => &["R", "G", "B", "A"],
    };
    let plane = |(c, name): (usize, &&str)| Plane {
        name: (*name).to_owned(),
        values: data.chunks_exact(size).skip(c).step_by(n).map(code).collect(),
    };
    Ok(Picture { width, height, planes: names.iter().enumerate().map(plane).collect() })
}

fn code(sample: &[u8]) -> f32 {
    match sample {
        [a, b] => f32::from(u16::from_ne_bytes([*a, *b])) / 65535.0,
        _ => sample.first().map_or(0.0, |&a| f32::from(a) / 255.0),
    }
}
