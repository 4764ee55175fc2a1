//! Light that crosses the surface: thin walls by the tables of the base layer, volumes by R and T from both sides.

use super::{Answer, Subject, mirror};
use crate::scene::extension::{Asks, Extension, GLASS, Switch};
use crate::scene::factor::{Channel, Factor, Interval};
use crate::scene::json::{NOT_NEGATIVE, UNIT};

/// `KHR_materials_transmission`.
pub(in crate::scene) const TRANSMISSION: Extension = Extension {
    name: "KHR_materials_transmission",
    on: Switch::Factor("transmissionFactor"),
    factors: &[Factor::textured("transmissionFactor", 0.0, &UNIT, ("transmissionTexture", Channel::R))],
    asks: Asks::Layer(&[GLASS], transmission),
};

/// `KHR_materials_volume`.
pub(in crate::scene) const VOLUME: Extension = Extension {
    name: "KHR_materials_volume",
    on: Switch::Factor("thicknessFactor"),
    factors: &[Factor::textured("thicknessFactor", 0.0, &NOT_NEGATIVE, ("thicknessTexture", Channel::G))],
    asks: Asks::Layer(&[], volume),
};

/// `KHR_materials_dispersion`.
pub(in crate::scene) const DISPERSION: Extension = Extension {
    name: "KHR_materials_dispersion",
    on: Switch::Factor("dispersion"),
    factors: &[Factor::plain("dispersion", 0.0, &NOT_NEGATIVE)],
    asks: Asks::Layer(&[], dispersion),
};

/// `ADOBE_materials_thin_transparency`.
pub(in crate::scene) const THIN: Extension = Extension {
    name: "ADOBE_materials_thin_transparency",
    on: Switch::Factor("transmissionFactor"),
    factors: &[Factor::textured("transmissionFactor", 1.0, &UNIT, ("transmissionTexture", Channel::R))],
    asks: Asks::Layer(&[], thin),
};

const TRANSMITS: &str = "KHR_materials_transmission";
const SCATTERS: &str = "KHR_materials_diffuse_transmission";
const SMOOTH: &str = "roughness 0: R and T are Fresnel's formula and 1 - R";
const WALLS: &str =
    "thin walls: T is the lobe of the base layer mirrored, with 1 - F in place of F, read from its tables";

fn thin(subject: &Subject<'_>) -> Vec<Answer> {
    Answer::nothing(if mirror(subject.roughness()) { SMOOTH } else { WALLS })
}

fn transmission(subject: &Subject<'_>) -> Vec<Answer> {
    if mirror(subject.roughness()) || !subject.has(VOLUME.name) {
        return thin(subject);
    }
    let ior = subject.ior();
    if ior.hi <= 1.0 && ior.lo > 0.0 {
        return Answer::nothing("index 1: there is no interface, R = 0 and T = 1");
    }
    if ior.hi <= 0.0 {
        return Answer::nothing("ior = 0: F = 1, so nothing is transmitted");
    }
    if ior.hi > MOST {
        return vec![Answer::Unknown("ior is animated, without a bound".to_owned())];
    }
    vec![Answer::Ask {
        family: GLASS,
        layer: "transmission",
        ranges: vec![("roughness", subject.roughness()), ("ior", spread(subject, ior))],
    }]
}

/// The largest index that counts as one.
const MOST: f64 = 100.0;

/// The index over the spectrum: `KHR_materials_dispersion` sets it apart by (n - 1) 0.025 dispersion on either side.
fn spread(subject: &Subject<'_>, ior: Interval) -> Interval {
    let half = |n: f64, d: f64| (n - 1.0) * 0.025 * d;
    let dispersion = subject.range(DISPERSION.name, "dispersion").hi;
    Interval {
        lo: (ior.lo - half(ior.lo, dispersion)).max(1.0),
        hi: ior.hi + half(ior.hi, dispersion),
        ..ior
    }
}

fn volume(subject: &Subject<'_>) -> Vec<Answer> {
    if subject.has(TRANSMITS) || subject.has(SCATTERS) {
        return Answer::nothing(
            "its interface is asked for by what lets light in; what it absorbs is exp(-sigma x)",
        );
    }
    Answer::nothing("no effect: nothing lets light into the volume (no transmission)")
}

fn dispersion(subject: &Subject<'_>) -> Vec<Answer> {
    if subject.has(TRANSMITS) && subject.has(VOLUME.name) {
        return Answer::nothing("three indices, on the axis of the transmission that it belongs to");
    }
    Answer::nothing("no effect: nothing is refracted (no transmission into a volume)")
}
