//! A thin film on the base layer.

use super::{Answer, Subject};
use crate::scene::extension::{Asks, Extension, FILM, Switch};
use crate::scene::factor::{Channel, Factor, Interval};
use crate::scene::json::{IOR, NOT_NEGATIVE, UNIT};

/// `KHR_materials_iridescence`.
pub(in crate::scene) const LAYER: Extension = Extension {
    name: "KHR_materials_iridescence",
    on: Switch::Factor("iridescenceFactor"),
    factors: &[
        Factor::textured("iridescenceFactor", 0.0, &UNIT, ("iridescenceTexture", Channel::R)),
        Factor::plain("iridescenceIor", 1.3, &IOR),
        Factor::plain("iridescenceThicknessMinimum", 100.0, &NOT_NEGATIVE),
        Factor::plain("iridescenceThicknessMaximum", 400.0, &NOT_NEGATIVE),
    ],
    asks: Asks::Layer(&[FILM], asks),
};

/// Renderers invert F0 = ((n - 1) / (n + 1))² to find the index below the film, and stop here: the index of a perfect mirror
/// is infinite.
const MOST_F0: f64 = 0.9999;

/// Thickest film that is asked for, in nm, where an animation says nothing.
const THICKEST: f64 = 1200.0;

/// Thickness in nm between minimum and maximum, whichever comes first, whatever the texture picks between them.
fn asks(subject: &Subject<'_>) -> Vec<Answer> {
    let range = |key| subject.range(LAYER.name, key);
    let [from, to] = [range("iridescenceThicknessMinimum"), range("iridescenceThicknessMaximum")];
    if from.hi > f64::from(f32::MAX) || to.hi > f64::from(f32::MAX) {
        return vec![Answer::Unknown(format!(
            "the thickness is animated, without a bound; say up to {THICKEST} nm"
        ))];
    }
    let thickness = Interval { lo: from.lo.min(to.lo), hi: from.hi.max(to.hi), spread: from.spread };
    if thickness.hi <= 0.0 {
        return Answer::nothing("no film: its thickness is 0");
    }
    let index = |f0: f64| {
        let root = f0.clamp(0.0, MOST_F0).sqrt();
        (1.0 + root) / (1.0 - root)
    };
    let ranges = vec![("film", thickness), ("n2", range("iridescenceIor")), ("n3", subject.f0().map(index))];
    vec![Answer::Ask { family: FILM, layer: "iridescence", ranges }]
}
