//! The variance of the slopes, the same in all directions.

use super::{Method, Rule, about_mean};
use crate::cite;
use crate::maps::footprint::Footprint;
use crate::maps::lobe::Lobe;

/// The rule.
pub static RULE: Rule = Rule {
    id: "variance",
    title: "trace of the variance of slopes",
    formula: "alpha'^2 = alpha^2 + Var_x + Var_y",
    sources: &[(cite::OLANO_BAKER_2010, "the covariance of the filtered map, its trace")],
    notes: "The isotropic reading of LEAN.",
    anisotropic: false,
    method: Method::Formula(lobe),
};

fn lobe(footprint: &Footprint) -> Lobe {
    let covariance = footprint.covariance();
    about_mean(footprint, footprint.square + covariance.x_axis.x + covariance.y_axis.y)
}
