//! The difference of two pictures, drawn: for each channel the first, the second, and how far they are apart.

use crate::encode::Image;

/// White gap between the panels, in pixels.
const GAP: usize = 4;

/// An 8-bit PNG: rows are the channels that both have; columns are the first, the second, and |difference| over its
/// largest value (black where equal). None if the pictures have no channel of one size in common.
///
/// # Errors
/// What the PNG encoder says.
pub fn draw(a: &Image, b: &Image) -> Result<Option<Vec<u8>>, image::ImageError> {
    let common: Vec<_> = a
        .channels
        .iter()
        .filter_map(|p| Some((p, b.channel(&p.name)?)))
        .filter(|(p, q)| p.values.len() == q.values.len() && a.width == b.width)
        .collect();
    if common.is_empty() {
        return Ok(None);
    }
    let (w, h) = (a.width, a.height);
    let size = |n: usize, count: usize| u32::try_from(n * count + GAP * (count - 1)).unwrap_or(u32::MAX);
    let mut canvas = image::GrayImage::from_pixel(size(w, 3), size(h, common.len()), image::Luma([255]));
    for (row, (p, q)) in common.iter().enumerate() {
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let apart: Vec<f64> = p.values.iter().zip(&q.values).map(|(a, b)| (a - b).abs()).collect();
        let top = largest(&p.values).max(largest(&q.values));
        let panels = [(&p.values, top), (&q.values, top), (&apart, largest(&apart))];
        for (column, (values, top)) in panels.into_iter().enumerate() {
            for (i, v) in values.iter().enumerate() {
                let x = u32::try_from(column * (w + GAP) + i % w).unwrap_or(u32::MAX);
                let y = u32::try_from(row * (h + GAP) + i / w).unwrap_or(u32::MAX);
                if let Some(pixel) = canvas.get_pixel_mut_checked(x, y) {
                    pixel.0 = [grey(*v, top)];
                }
            }
        }
    }
    let mut bytes = std::io::Cursor::new(Vec::new());
    canvas.write_to(&mut bytes, image::ImageFormat::Png)?;
    Ok(Some(bytes.into_inner()))
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [0, 255] first")]
fn grey(v: f64, top: f64) -> u8 {
    if top > 0.0 && v.is_finite() { (255.0 * (v / top)).clamp(0.0, 255.0).round() as u8 } else { 0 }
}
