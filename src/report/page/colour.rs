//! Numbers as colours: maps whose lightness rises evenly, so that they read in grey and with any colour vision, and pictures of them.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use colorous::Gradient;

/// Code of a number that is not known.
const UNKNOWN: u8 = 255;
/// Colours of known numbers.
const STEPS: usize = 255;
/// Decades that a logarithmic scale shows below its end.
const DECADES: f64 = 8.0;

/// What the colours stand for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Meaning {
    /// Values: equal steps.
    Value,
    /// Errors: equal ratios.
    Error,
}

/// A map from numbers to colours.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    meaning: Meaning,
    /// The numbers at both ends.
    pub(super) ends: [f64; 2],
}

impl Scale {
    /// The scale that just holds what is known of these numbers; none if that is nothing.
    pub(super) fn of(meaning: Meaning, values: impl Iterator<Item = f64> + Clone) -> Option<Scale> {
        let known = values.filter(|v| v.is_finite());
        let top = known.clone().fold(f64::NEG_INFINITY, f64::max);
        let least = match meaning {
            Meaning::Value => known.fold(f64::INFINITY, f64::min),
            Meaning::Error => {
                let positive = known.filter(|v| *v > 0.0).fold(f64::INFINITY, f64::min);
                positive.max(top * libm::pow(10.0, -DECADES))
            }
        };
        (top > f64::NEG_INFINITY).then(|| Scale { meaning, ends: [least.min(top), top] })
    }

    fn gradient(&self) -> Gradient {
        match self.meaning {
            Meaning::Value => colorous::CIVIDIS,
            Meaning::Error => colorous::MAGMA,
        }
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in [0, 254] by the clamp")]
    fn code(&self, v: f64) -> u8 {
        if !v.is_finite() {
            return UNKNOWN;
        }
        let [lo, hi] = match self.meaning {
            Meaning::Value => self.ends,
            Meaning::Error => self.ends.map(libm::log),
        };
        let v = if self.meaning == Meaning::Error { libm::log(v.max(f64::MIN_POSITIVE)) } else { v };
        let part = if hi > lo { (v - lo) / (hi - lo) } else { 1.0 };
        ((STEPS - 1) as f64 * part.clamp(0.0, 1.0)).round() as u8
    }

    /// The colours of all codes; grey for what is not known.
    pub(super) fn palette(&self) -> Vec<u8> {
        let map = self.gradient();
        let steps = (0..STEPS).map(|i| map.eval_rational(i, STEPS).as_array());
        steps.chain([[128; 3]]).flatten().collect()
    }

    /// A picture, one pixel a number, as a data URI.
    pub(super) fn picture(&self, width: usize, values: impl Iterator<Item = f64>) -> String {
        let codes: Vec<u8> = values.map(|v| self.code(v)).collect();
        png(width, &codes, Some(self.palette()))
    }

    /// The scale itself, from its low end.
    pub(super) fn legend(&self) -> String {
        let codes: Vec<u8> = (0..UNKNOWN).collect();
        png(STEPS, &codes, Some(self.palette()))
    }
}

/// A PNG of 8-bit codes, with a palette or grey, as a data URI; empty if it has no pixel.
pub(super) fn png(width: usize, codes: &[u8], palette: Option<Vec<u8>>) -> String {
    let size = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let height = codes.len() / width.max(1);
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size(width), size(height));
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_color(if palette.is_some() { png::ColorType::Indexed } else { png::ColorType::Grayscale });
    encoder.set_compression(png::Compression::High);
    if let Some(palette) = palette {
        encoder.set_palette(palette);
    }
    let written = encoder.write_header().and_then(|mut w| w.write_image_data(codes));
    if written.is_ok() { uri("image/png", &bytes) } else { String::new() }
}

/// A square PNG of RGB codes, as a data URI; empty if it has no pixel.
pub(super) fn png_rgb(side: usize, codes: &[[u8; 3]]) -> String {
    let height = codes.len() / side.max(1);
    crate::picture::write_png([side, height], 3, codes.as_flattened())
        .map_or_else(|_| String::new(), |bytes| uri("image/png", &bytes))
}

/// Bytes as a data URI.
pub(super) fn uri(media: &str, bytes: &[u8]) -> String {
    format!("data:{media};base64,{}", STANDARD.encode(bytes))
}

/// Numbers as base64 of 32-bit floats, low byte first.
pub(super) fn floats(values: impl Iterator<Item = f64>) -> String {
    #[allow(clippy::cast_possible_truncation, reason = "what the page shows has six digits")]
    let bytes: Vec<u8> = values.flat_map(|v| (v as f32).to_le_bytes()).collect();
    STANDARD.encode(bytes)
}

/// Numbers as base64 of the upper halves of 32-bit floats: two digits are enough for an error.
pub(super) fn short_floats(values: impl Iterator<Item = f64>) -> String {
    let bytes: Vec<u8> = values.flat_map(|v| half::bf16::from_f64(v).to_le_bytes()).collect();
    STANDARD.encode(bytes)
}

#[cfg(test)]
mod tests {
    use super::{Meaning, STEPS, Scale};

    /// CIE L* of linear light.
    fn lightness(linear: [f64; 3]) -> f64 {
        let [r, g, b] = linear;
        let y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        if y > 0.008856 { 116.0 * libm::cbrt(y) - 16.0 } else { 903.3 * y }
    }

    /// What is left of a colour without one kind of cones: Machado, Oliveira, Fernandes 2009, severity 1.
    const SEEN: [[[f64; 3]; 3]; 4] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
    ];

    #[test]
    fn colours_get_lighter_evenly_for_every_eye() {
        for meaning in [Meaning::Value, Meaning::Error] {
            let palette = Scale { meaning, ends: [0.1, 1.0] }.palette();
            for seen in SEEN {
                let light: Vec<f64> = palette
                    .chunks_exact(3)
                    .take(STEPS)
                    .map(|c| {
                        let linear = |v: &u8| {
                            let v = f64::from(*v) / 255.0;
                            if v <= 0.04045 { v / 12.92 } else { libm::pow((v + 0.055) / 1.055, 2.4) }
                        };
                        let c: Vec<f64> = c.iter().map(linear).collect();
                        lightness(seen.map(|row| row.iter().zip(&c).map(|(a, b)| a * b).sum()))
                    })
                    .collect();
                // over an eighth of the scale: rounding to bytes makes single steps uneven
                let part = STEPS / 8;
                for pair in light.windows(part + 1) {
                    let step = (pair[part] - pair[0]) / (light[STEPS - 1] - light[0]);
                    assert!((0.04..0.25).contains(&step), "{meaning:?} {seen:?}: {step}");
                }
            }
        }
    }

    #[test]
    fn what_is_not_known_is_grey() {
        let scale = Scale::of(Meaning::Error, [f64::NAN, 0.0, 1e-9, 1e-3].into_iter()).unwrap();
        assert_eq!([f64::NAN, 0.0, 1e-3].map(|v| scale.code(v)), [255, 0, 254]);
        assert!(Scale::of(Meaning::Value, std::iter::once(f64::NAN)).is_none());
    }
}
