//! The von Mises-Fisher distribution of the normals, its width added to that of the lobe.

use super::{Method, Rule, about_mean, vmf_width};
use crate::cite;
use crate::maps::footprint::Footprint;
use crate::maps::lobe::Lobe;

/// The rule.
pub static RULE: Rule = Rule {
    id: "vmf",
    title: "von Mises-Fisher concentration",
    formula: "alpha'^2 = alpha^2 + 2/kappa, kappa = (3 |N| - |N|^3)/(1 - |N|^2)",
    sources: &[(cite::BANERJEE_2005, "Eq. 4.4")],
    notes: "exp(kappa (cos - 1)) is exp(-tan^2/m^2) with m^2 = 2/kappa near the normal.",
    anisotropic: false,
    method: Method::Formula(lobe),
};

fn lobe(footprint: &Footprint) -> Lobe {
    about_mean(footprint, footprint.square + 2.0 * vmf_width(footprint))
}
