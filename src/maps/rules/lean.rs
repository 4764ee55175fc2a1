//! LEAN: the covariance of the slopes is added to that of the lobe.

use super::{Method, Rule};
use crate::cite;
use crate::maps::footprint::Footprint;
use crate::maps::lobe::Lobe;
use glam::DMat2;

/// The rule.
pub static RULE: Rule = Rule {
    id: "lean",
    title: "variance of slopes along its axes",
    formula: "alpha_i'^2 = alpha^2 + 2 Var_i",
    sources: &[(cite::OLANO_BAKER_2010, "the covariance of the filtered map")],
    notes: "Exact for Beckmann lobes of Gaussian slopes; GGX has no variance.",
    anisotropic: true,
    method: Method::Formula(lobe),
};

fn lobe(footprint: &Footprint) -> Lobe {
    let square = DMat2::IDENTITY * footprint.square + footprint.covariance() * 2.0;
    Lobe::from_square(footprint.normal(), square)
}
