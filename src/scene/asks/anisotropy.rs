//! An anisotropic base layer.

use super::{Answer, Subject, mirror};
use crate::scene::extension::{ANISOTROPIC, Asks, Extension, Switch};
use crate::scene::factor::{Channel, Factor};
use crate::scene::json::UNIT;

/// `KHR_materials_anisotropy`: alpha_b = roughness², alpha_t = mix(alpha_b, 1, strength²).
pub(in crate::scene) const LAYER: Extension = Extension {
    name: "KHR_materials_anisotropy",
    on: Switch::Factor("anisotropyStrength"),
    factors: &[Factor::textured("anisotropyStrength", 0.0, &UNIT, ("anisotropyTexture", Channel::B))],
    asks: Asks::Layer(&[ANISOTROPIC], asks),
};

fn asks(subject: &Subject<'_>) -> Vec<Answer> {
    let strength = subject.range(LAYER.name, "anisotropyStrength");
    let alpha_b = subject.roughness().map(|r| r * r);
    if mirror(alpha_b) && mirror(strength) {
        return Answer::nothing("roughness 0 and strength 0: a mirror");
    }
    let alpha_t = alpha_b.rising(strength, |alpha, s| alpha + s * s * (1.0 - alpha));
    let ranges = vec![("alpha_x", alpha_t), ("alpha_y", alpha_b)];
    vec![Answer::Ask { family: ANISOTROPIC, layer: "anisotropic base layer", ranges }]
}
