//! Coats: a clear dielectric GGX layer over all others. Its index is fixed, so that one albedo is all it needs.

use super::{Answer, MIRROR, Subject, mirror};
use crate::scene::extension::{Asks, COAT, Extension, Switch};
use crate::scene::factor::{Channel, Factor, Interval};
use crate::scene::json::{IOR, UNIT};

/// `KHR_materials_clearcoat`: index 1.5, F0 = 0.04.
pub(in crate::scene) const CLEARCOAT: Extension = Extension {
    name: "KHR_materials_clearcoat",
    on: Switch::Factor("clearcoatFactor"),
    factors: &[
        Factor::textured("clearcoatFactor", 0.0, &UNIT, ("clearcoatTexture", Channel::R)),
        Factor::textured("clearcoatRoughnessFactor", 0.0, &UNIT, ("clearcoatRoughnessTexture", Channel::G)),
    ],
    asks: Asks::Layer(&[COAT], clearcoat),
};

/// `KHR_materials_coat` (proposal): as the clear coat, with an index of its own and the darkening of what lies below.
pub(in crate::scene) const COAT_LAYER: Extension = Extension {
    name: "KHR_materials_coat",
    on: Switch::Factor("coatFactor"),
    factors: &[
        Factor::textured("coatFactor", 0.0, &UNIT, ("coatTexture", Channel::R)),
        Factor::textured("coatRoughnessFactor", 0.0, &UNIT, ("coatRoughnessTexture", Channel::G)),
        Factor::plain("coatIor", 1.5, &IOR),
    ],
    asks: Asks::Layer(&[COAT], coat),
};

fn clearcoat(subject: &Subject<'_>) -> Vec<Answer> {
    let roughness = subject.rough("KHR_materials_clearcoat", "clearcoatRoughnessFactor");
    ask("clearcoat", roughness, Interval::constant(1.5))
}

fn coat(subject: &Subject<'_>) -> Vec<Answer> {
    const NAME: &str = "KHR_materials_coat";
    ask("coat", subject.rough(NAME, "coatRoughnessFactor"), subject.range(NAME, "coatIor"))
}

fn ask(layer: &'static str, roughness: Interval, ior: Interval) -> Vec<Answer> {
    if mirror(roughness) {
        return Answer::nothing(MIRROR);
    }
    vec![Answer::Ask { family: COAT, layer, ranges: vec![("roughness", roughness), ("ior", ior)] }]
}
