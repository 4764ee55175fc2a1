//! Cloth: Charlie's sheen, and the fuzz of the proposals.

use super::{Answer, Subject};
use crate::scene::extension::{Asks, Extension, FUZZ, SHEEN, Switch};
use crate::scene::factor::{Channel, Factor};
use crate::scene::json::UNIT;

/// `KHR_materials_sheen`: Charlie with r = sheenRoughness².
pub(in crate::scene) const LAYER: Extension = Extension {
    name: "KHR_materials_sheen",
    on: Switch::Factor("sheenColorFactor"),
    factors: &[
        Factor::colour("sheenColorFactor", 0.0, &UNIT, "sheenColorTexture", 3),
        Factor::textured("sheenRoughnessFactor", 0.0, &UNIT, ("sheenRoughnessTexture", Channel::A)),
    ],
    asks: Asks::Layer(&[SHEEN], sheen),
};

/// `KHR_materials_fuzz` (proposal): the layer of fibres of OpenPBR.
pub(in crate::scene) const FIBRES: Extension = Extension {
    name: "KHR_materials_fuzz",
    on: Switch::Factor("fuzzFactor"),
    factors: &[
        Factor::textured("fuzzFactor", 0.0, &UNIT, ("fuzzTexture", Channel::R)),
        Factor::textured("fuzzRoughnessFactor", 0.5, &UNIT, ("fuzzRoughnessTexture", Channel::A)),
    ],
    asks: Asks::Layer(&[FUZZ], fuzz),
};

fn sheen(subject: &Subject<'_>) -> Vec<Answer> {
    let roughness = subject.range("KHR_materials_sheen", "sheenRoughnessFactor");
    vec![Answer::Ask { family: SHEEN, layer: "sheen", ranges: vec![("sheen_roughness", roughness)] }]
}

fn fuzz(subject: &Subject<'_>) -> Vec<Answer> {
    let roughness = subject.range("KHR_materials_fuzz", "fuzzRoughnessFactor");
    vec![Answer::Ask { family: FUZZ, layer: "fuzz", ranges: vec![("r", roughness)] }]
}
