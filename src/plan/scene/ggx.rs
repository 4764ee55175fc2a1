//! The GGX lobe of the base layer: split sum, directional albedo, average albedo.

use super::axes::Draft;
use super::{ALBEDO_TOLERANCE, Family};
use crate::scene::{GGX, Need};
use crate::tables::default_axes::LEAST_ROUGHNESS;

pub(super) const FAMILY: Family = Family {
    id: GGX,
    requests,
    serves: &[
        ("dfg", None),
        ("albedo", Some("ggx")),
        ("average-albedo", Some("ggx")),
        ("compensation", Some("ggx")),
        ("generalised-schlick", None),
    ],
};

pub(super) const NEAR_MIRROR: &str = "smoother than this is a mirror to the eye (alpha = 1e-4)";

fn requests(need: &Need) -> Vec<Draft> {
    let white = |id: &str| need.ranges.get(id).is_none_or(|r| r.lo >= 1.0);
    let split = Draft::new("ggx-dfg", "dfg");
    // F0 = F90 = 1: the two parts are only ever added
    let split = if white("f0") && white("f90") { split.channels(&["dfg.total"]) } else { split };
    let mut all = vec![rough(split, need)];
    // at one roughness E is the sum of two numbers of a row, and its average one number
    if need.ranges.get("roughness").is_none_or(|r| r.value().is_none()) {
        all.push(rough(Draft::new("ggx-albedo", "albedo").tolerance(ALBEDO_TOLERANCE), need));
        let average = Draft::new("ggx-average-albedo", "average-albedo").tolerance(ALBEDO_TOLERANCE);
        all.push(average.over(need, "roughness"));
    }
    all
}

/// Over the roughness of the need, as far down as axes follow the dip beside the mirror.
pub(super) fn rough(draft: Draft, need: &Need) -> Draft {
    draft.over(need, "roughness").near("roughness", [LEAST_ROUGHNESS, 1.0], NEAR_MIRROR)
}
