//! Rough diffuse lobes: the albedo of the single bounce, from which the energy-preserving lobe follows (EON).

use super::Family;
use super::axes::Draft;
use crate::scene::{Need, ROUGH_DIFFUSE};

pub(super) const FAMILY: Family = Family {
    id: ROUGH_DIFFUSE,
    requests,
    serves: &[("albedo", Some("fujii")), ("albedo", Some("eon")), ("average-albedo", Some("fujii"))],
};

fn requests(need: &Need) -> Vec<Draft> {
    vec![Draft::new("rough-diffuse-albedo", "albedo").model("fujii").over(need, "r")]
}
