//! Filament's command: 2/kappa on the square of the stored roughness.

use super::{Method, Rule, about_mean, vmf_width};
use crate::cite;
use crate::maps::footprint::Footprint;
use crate::maps::lobe::Lobe;

/// The rule.
pub static RULE: Rule = Rule {
    id: "filament",
    title: "the rule of Filament's roughness-prefilter",
    formula: "r'^2 = r^2 + 2/kappa of the stored roughness r, alpha = r^2",
    sources: &[(cite::FILAMENT_PREFILTER, "as its results show")],
    notes: "Adds to the square of the roughness, not of alpha.",
    anisotropic: false,
    method: Method::Formula(lobe),
};

fn lobe(footprint: &Footprint) -> Lobe {
    let alpha = footprint.square.sqrt() + 2.0 * vmf_width(footprint);
    about_mean(footprint, alpha * alpha)
}
