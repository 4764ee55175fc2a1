//! The archived specular-glossiness workflow.

use super::{Answer, MIRROR, Subject, mirror};
use crate::scene::extension::{Asks, Extension, GGX, Switch};
use crate::scene::factor::{Channel, Factor};
use crate::scene::json::UNIT;

/// `KHR_materials_pbrSpecularGlossiness`: roughness = 1 - glossiness, F0 = specular, F90 = 1.
pub(in crate::scene) const LAYER: Extension = Extension {
    name: "KHR_materials_pbrSpecularGlossiness",
    on: Switch::Always,
    factors: &[
        Factor::textured("glossinessFactor", 1.0, &UNIT, ("specularGlossinessTexture", Channel::A)),
        Factor::colour("specularFactor", 1.0, &UNIT, "specularGlossinessTexture", 3),
        Factor::colour("diffuseFactor", 1.0, &UNIT, "diffuseTexture", 4),
    ],
    asks: Asks::Layer(&[GGX], asks),
};

fn asks(subject: &Subject<'_>) -> Vec<Answer> {
    let roughness = subject.reader.roughness(subject.range(LAYER.name, "glossinessFactor").map(|g| 1.0 - g));
    if mirror(roughness) {
        return Answer::nothing(MIRROR);
    }
    let f0 = subject.range(LAYER.name, "specularFactor");
    let ranges = vec![("roughness", roughness), ("f0", f0)];
    vec![Answer::Ask { family: GGX, layer: "specular-glossiness layer", ranges }]
}
