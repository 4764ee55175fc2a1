//! The base layer: GGX over its roughness.

use super::{Answer, MIRROR, Subject, mirror};
use crate::scene::extension::{Asks, Extension, GGX, Switch};
use crate::scene::factor::{Channel, Factor};
use crate::scene::json::{IOR, NOT_NEGATIVE, UNIT};

/// `KHR_materials_ior`.
pub(in crate::scene) const INDEX: Extension = Extension {
    name: "KHR_materials_ior",
    on: Switch::Always,
    factors: &[Factor::plain("ior", 1.5, &IOR)],
    asks: Asks::BaseLayer,
};

/// `KHR_materials_specular`.
pub(in crate::scene) const SPECULAR: Extension = Extension {
    name: "KHR_materials_specular",
    on: Switch::Always,
    factors: &[
        Factor::textured("specularFactor", 1.0, &UNIT, ("specularTexture", Channel::A)),
        Factor::colour("specularColorFactor", 1.0, &NOT_NEGATIVE, "specularColorTexture", 3),
    ],
    asks: Asks::BaseLayer,
};

/// The base layer asks unless it is black, a mirror, or unless only an extension describes the material.
pub(in crate::scene) fn asks(subject: &Subject<'_>) -> Vec<Answer> {
    let material = subject.material;
    if material.extension("KHR_materials_pbrSpecularGlossiness").is_some() && !material.metallic_roughness {
        return Vec::new();
    }
    // KHR_materials_specular: a factor of 0 disables the reflection, F90 included.
    let weight = subject.range("KHR_materials_specular", "specularFactor");
    if subject.metallic().hi <= 0.0 && weight.hi <= 0.0 {
        return Answer::nothing("no reflection: specularFactor = 0 and metallicFactor = 0");
    }
    let roughness = subject.roughness();
    if mirror(roughness) {
        return Answer::nothing(MIRROR);
    }
    let mut ranges = vec![("roughness", roughness), ("f0", subject.f0())];
    // what is white at every angle needs no split: F90 falls below 1 only with the weight of the dielectric
    if subject.metallic().lo < 1.0 && weight.lo < 1.0 {
        ranges.push(("f90", weight));
    }
    vec![Answer::Ask { family: GGX, layer: "base layer", ranges }]
}
