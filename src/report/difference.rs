//! The difference of two pictures, drawn: for each channel the first, the second, and how far they are apart.

use crate::encode::Image;
use crate::picture::{PictureError, write_png};

/// White gap between the panels, in pixels.
const GAP: usize = 4;

/// An 8-bit PNG: rows are the channels that both have; columns are the first, the second, and |difference| over its
/// largest value (black where equal). None if the pictures have no channel of one size in common.
///
/// # Errors
/// What the PNG encoder says.
pub fn draw(a: &Image, b: &Image) -> Result<Option<Vec<u8>>, PictureError> {
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
    let size = |n: usize, count: usize| n * count + GAP * (count - 1);
    let [wide, high] = [size(w, 3), size(h, common.len())];
    let mut canvas = vec![255; wide * high];
    for (row, (p, q)) in common.iter().enumerate() {
        let largest = |values: &[f64]| values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        let apart: Vec<f64> = p.values.iter().zip(&q.values).map(|(a, b)| (a - b).abs()).collect();
        let top = largest(&p.values).max(largest(&q.values));
        let panels = [(&p.values, top), (&q.values, top), (&apart, largest(&apart))];
        for (column, (values, top)) in panels.into_iter().enumerate() {
            for (i, v) in values.iter().enumerate() {
                let (x, y) = (column * (w + GAP) + i % w, row * (h + GAP) + i / w);
                if let Some(pixel) = canvas.get_mut(y * wide + x) {
                    *pixel = grey(*v, top);
                }
            }
        }
    }
    write_png([wide, high], 1, &canvas).map(Some)
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [0, 255] first")]
fn grey(v: f64, top: f64) -> u8 {
    if top > 0.0 && v.is_finite() { (255.0 * (v / top)).clamp(0.0, 255.0).round() as u8 } else { 0 }
}
