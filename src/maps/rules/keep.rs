//! The roughness as it is: what an engine's own mips come to.

use super::{Method, Rule, about_mean};
use crate::maps::footprint::Footprint;
use crate::maps::lobe::Lobe;

/// The rule.
pub static RULE: Rule = Rule {
    id: "keep",
    title: "the mean roughness, whatever the normals do",
    formula: "alpha'^2 = alpha^2",
    sources: &[],
    notes: "What a mip chain without filtering holds.",
    anisotropic: false,
    method: Method::Formula(lobe),
};

fn lobe(footprint: &Footprint) -> Lobe {
    about_mean(footprint, footprint.square)
}
