//! Scattering below the surface, in the proposals' terms.

use super::{Answer, Subject};
use crate::scene::extension::{Asks, Extension, PHASE, SUBSURFACE, Switch};
use crate::scene::factor::{Factor, Interval, Spread};
use crate::scene::json::{ASYMMETRY, UNIT};

/// `KHR_materials_volume_scatter` (proposal): Henyey and Greenstein's phase function.
pub(in crate::scene) const VOLUME: Extension = Extension {
    name: "KHR_materials_volume_scatter",
    on: Switch::Always,
    factors: &[
        Factor::colour("multiscatterColor", 0.0, &UNIT, "multiscatterColorTexture", 3),
        Factor::plain("scatterAnisotropy", 0.0, &ASYMMETRY),
    ],
    asks: Asks::Layer(&[PHASE], volume),
};

/// `KHR_materials_subsurface` (proposal).
pub(in crate::scene) const LAYER: Extension = subsurface_line("KHR_materials_subsurface");
/// `KHR_materials_sss` (earlier proposal).
pub(in crate::scene) const EARLIER: Extension = subsurface_line("KHR_materials_sss");

const fn subsurface_line(name: &'static str) -> Extension {
    Extension { name, on: Switch::Always, factors: &[], asks: Asks::Layer(&[SUBSURFACE], subsurface) }
}

fn volume(subject: &Subject<'_>) -> Vec<Answer> {
    let within = ["KHR_materials_volume"].iter().all(|name| subject.has(name));
    let enters = ["KHR_materials_transmission", "KHR_materials_diffuse_transmission"];
    if !within || !enters.iter().any(|name| subject.has(name)) {
        return Answer::nothing("no effect: no light enters a volume");
    }
    let g = subject.range(VOLUME.name, "scatterAnisotropy");
    if g.lo.abs().max(g.hi.abs()) <= 0.0 {
        return Answer::nothing("g = 0: every direction alike, 1 / (4 pi)");
    }
    vec![Answer::Ask { family: PHASE, layer: "volume scattering", ranges: vec![("g", g)] }]
}

/// Normalised diffusion depends on distance over the mean free path alone once the albedo comes from a texture.
fn subsurface(_: &Subject<'_>) -> Vec<Answer> {
    vec![Answer::Ask {
        family: SUBSURFACE,
        layer: "subsurface",
        ranges: vec![("radius", Interval { lo: 0.0, hi: LONGEST, spread: Spread::Constant })],
    }]
}

/// Distance, in mean free paths, beyond which less than 1e-3 of the light leaves by normalised diffusion.
const LONGEST: f64 = 24.0;
