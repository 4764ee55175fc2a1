//! Diffuse lobes: rough ones have a table, Lambert's law is closed.

use super::{Answer, Subject};
use crate::scene::extension::{Asks, Extension, ROUGH_DIFFUSE, Switch};
use crate::scene::factor::{Channel, Factor};
use crate::scene::json::UNIT;

/// `KHR_materials_diffuse_roughness` (proposal): the energy-preserving Oren-Nayar lobe.
pub(in crate::scene) const ROUGH: Extension = Extension {
    name: "KHR_materials_diffuse_roughness",
    on: Switch::Factor("diffuseRoughnessFactor"),
    factors: &[Factor::textured(
        "diffuseRoughnessFactor",
        0.0,
        &UNIT,
        ("diffuseRoughnessTexture", Channel::R),
    )],
    asks: Asks::Layer(&[ROUGH_DIFFUSE], rough),
};

/// `KHR_materials_diffuse_transmission`.
pub(in crate::scene) const TRANSMITTED: Extension = Extension {
    name: "KHR_materials_diffuse_transmission",
    on: Switch::Factor("diffuseTransmissionFactor"),
    factors: &[Factor::textured(
        "diffuseTransmissionFactor",
        0.0,
        &UNIT,
        ("diffuseTransmissionTexture", Channel::A),
    )],
    asks: Asks::Layer(&[], transmitted),
};

fn rough(subject: &Subject<'_>) -> Vec<Answer> {
    let r = subject.range(ROUGH.name, "diffuseRoughnessFactor");
    if subject.metallic().lo >= 1.0 {
        return Answer::nothing("no effect: a metal has no diffuse lobe");
    }
    vec![Answer::Ask { family: ROUGH_DIFFUSE, layer: "rough diffuse", ranges: vec![("r", r)] }]
}

fn transmitted(subject: &Subject<'_>) -> Vec<Answer> {
    if subject.metallic().lo >= 1.0 {
        return Answer::nothing("no effect: a metal has no diffuse lobe");
    }
    Answer::nothing(
        "Lambert's law on the other side; its weight, 1 - E, is read from the tables of the base layer",
    )
}
