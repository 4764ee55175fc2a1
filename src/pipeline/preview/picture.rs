//! Previews as pictures: integrated, read, and what lies between, below each other.

use super::Preview;
use crate::encode::EncodeError;
use crate::picture::{PictureError, Space, write_png};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage,
};
use std::io::Cursor;

/// Difference, linear, at which the colours of the third row end.
pub(super) const FULL: f64 = 0.05;

/// Largest difference of the three colours.
fn largest_difference(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// An 8-bit sRGB PNG without tone mapping; the difference in colours from black (none) to light yellow (0.05 and more); grey outside.
///
/// # Errors
/// What the PNG encoder says.
pub fn png(preview: &Preview) -> Result<Vec<u8>, PictureError> {
    let width = preview.integrated.len() / preview.size.max(1);
    let mut bytes = Vec::with_capacity(9 * preview.integrated.len());
    let mut push = |known: bool, rgb: [u8; 3]| bytes.extend(if known { rgb } else { [118; 3] });
    for plane in [&preview.integrated, &preview.read] {
        for pixel in plane {
            push(!pixel[0].is_nan(), pixel.map(|v| Space::Srgb.byte(v)));
        }
    }
    for (a, b) in preview.integrated.iter().zip(&preview.read) {
        let part = (largest_difference(a, b) / FULL).min(1.0);
        push(!a[0].is_nan(), colorous::MAGMA.eval_continuous(part).as_array());
    }
    write_png([width, bytes.len() / (3 * width.max(1))], 3, &bytes)
}

/// An EXR of 32-bit floats, linear: layers `integrated`, `read` and `difference`; 0 outside the spheres.
///
/// # Errors
/// [`EncodeError::Library`].
pub fn exr(preview: &Preview) -> Result<Vec<u8>, EncodeError> {
    let width = preview.integrated.len() / preview.size.max(1);
    #[allow(clippy::cast_possible_truncation, reason = "stored as 32-bit floats")]
    let plane = |of: &dyn Fn(usize) -> f64| {
        let values = (0..preview.integrated.len()).map(|i| of(i) as f32);
        FlatSamples::F32(values.map(|v| if v.is_nan() { 0.0 } else { v }).collect())
    };
    let mut channels = Vec::new();
    for (c, colour) in ["R", "G", "B"].into_iter().enumerate() {
        let (a, b) = (&preview.integrated, &preview.read);
        channels.push(AnyChannel::new(format!("integrated.{colour}").as_str(), plane(&|i| a[i][c])));
        channels.push(AnyChannel::new(format!("read.{colour}").as_str(), plane(&|i| b[i][c])));
        channels
            .push(AnyChannel::new(format!("difference.{colour}").as_str(), plane(&|i| b[i][c] - a[i][c])));
    }
    let layer = Layer::new(
        (width, preview.size),
        LayerAttributes::named("preview"),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels.into_iter().collect()),
    );
    let mut out = Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .non_parallel()
        .to_buffered(&mut out)
        .map_err(|e| EncodeError::Library { format: "exr", source: Box::new(e) })?;
    Ok(out.into_inner())
}
