//! Base colours of dielectrics that no measured surface has, as codes of sRGB.

use super::{Breaks, Rule, Texel};
use crate::picture::Space;

pub(super) static DARK: Rule = Rule {
    id: "dark-base",
    title: "the brightest channel of a dielectric's base colour is no darker than coal (code of sRGB)",
    measure: |texel, _| code(texel),
    breaks: Breaks::Below,
    bound: 30.0,
    share: 0.0,
};

pub(super) static BRIGHT: Rule = Rule {
    id: "bright-base",
    title: "the brightest channel of a dielectric's base colour is no brighter than fresh snow (code of sRGB)",
    measure: |texel, _| code(texel),
    breaks: Breaks::Above,
    bound: 240.0,
    share: 0.0,
};

/// The brightest channel as a code of sRGB, of what is more a dielectric than a metal.
fn code(texel: &Texel) -> Option<f64> {
    let brightest = texel.base.iter().copied().fold(0.0, f64::max);
    (texel.metallic < 0.5).then(|| Space::Srgb.encode(brightest) * 255.0)
}
