//! The published rule of The Order: 1886: 1/(2 kappa) in place of 2/kappa.

use super::{Method, Rule, about_mean, vmf_width};
use crate::cite;
use crate::maps::footprint::Footprint;
use crate::maps::lobe::Lobe;

/// The rule.
pub static RULE: Rule = Rule {
    id: "the-order",
    title: "the rule of The Order: 1886",
    formula: "alpha'^2 = alpha^2 + 1/(2 kappa), kappa = (3 |N| - |N|^3)/(1 - |N|^2)",
    sources: &[(cite::NEUBELT_PETTINEO_2013, "the section on specular antialiasing")],
    notes: "Gives back less than half of the width of vmf; several engines have taken it over.",
    anisotropic: false,
    method: Method::Formula(lobe),
};

fn lobe(footprint: &Footprint) -> Lobe {
    about_mean(footprint, footprint.square + 0.5 * vmf_width(footprint))
}
