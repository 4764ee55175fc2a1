//! Toksvig's rule: the exponent of Blinn-Phong shrinks with the mean normal.

use super::{Method, Rule, about_mean};
use crate::cite;
use crate::maps::footprint::Footprint;
use crate::maps::lobe::Lobe;

/// The rule.
pub static RULE: Rule = Rule {
    id: "toksvig",
    title: "Toksvig's shortened normal",
    formula: "n = 2/alpha^2 - 2, n' = n |N|/(|N| + n (1 - |N|)), alpha'^2 = 2/(n' + 2)",
    sources: &[(cite::TOKSVIG_2005, "the shortened exponent")],
    notes: "The normals are made unit before they are averaged: a map of short normals is not a rough one.",
    anisotropic: false,
    method: Method::Formula(lobe),
};

fn lobe(footprint: &Footprint) -> Lobe {
    let power = (2.0 / footprint.square - 2.0).max(0.0);
    let length = footprint.mean.length();
    // 1 - |N| without a difference of near numbers
    let gap = footprint.spread / (1.0 + length);
    let power = power * length / (length + power * gap);
    about_mean(footprint, 2.0 / (power + 2.0))
}
