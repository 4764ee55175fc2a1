//! PNG of 8 bits, for pictures of materials.

use super::PictureError;

/// Writes codes of 8 bits, all channels of a pixel together, as PNG: 1 channel as grey, 3 as RGB, 4 as RGBA. One version of this program always
/// makes the same bytes.
///
/// # Errors
/// [`PictureError`] for a size that has no picture or does not fit the codes.
pub fn write_png(size: [usize; 2], channels: usize, codes: &[u8]) -> Result<Vec<u8>, PictureError> {
    let [width, height] = size;
    let pixels = PictureError::Pixels { width, height };
    let (Ok(w), Ok(h)) = (u32::try_from(width), u32::try_from(height)) else { return Err(pixels) };
    if codes.len() != width.saturating_mul(height).saturating_mul(channels) {
        return Err(pixels);
    }
    let library = |e: png::EncodingError| PictureError::Damaged { format: "png", fault: e.to_string() };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, w, h);
    encoder.set_color(match channels {
        1 => png::ColorType::Grayscale,
        4 => png::ColorType::Rgba,
        _ => png::ColorType::Rgb,
    });
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_filter(png::Filter::Paeth);
    encoder.set_deflate_compression(png::DeflateCompression::Level(6));
    let mut writer = encoder.write_header().map_err(library)?;
    writer.write_image_data(codes).map_err(library)?;
    writer.finish().map_err(library)?;
    Ok(bytes)
}
