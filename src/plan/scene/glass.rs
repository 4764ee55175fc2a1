//! Rough interfaces: R and T from both sides over roughness and index.

use super::Family;
use super::axes::Draft;
use crate::scene::{GLASS, Need};

pub(super) const FAMILY: Family = Family {
    id: GLASS,
    requests,
    serves: &[
        ("glass-compensation", None),
        ("albedo", Some("ggx-glass")),
        ("average-albedo", Some("ggx-glass")),
    ],
};

const NEAR_SMOOTH: &str = "smoother than this is Fresnel's interface to the eye, and its kink at the critical angle takes no texels";
const NO_INTERFACE: &str = "an index of 1 is no interface (R = 0, T = 1)";

/// Smallest roughness of the table (alpha = 2.5e-3).
const LEAST: f64 = 0.05;

fn requests(need: &Need) -> Vec<Draft> {
    // values of their own lie on the nodes of the axis; a range is spread
    let indices = need.ranges.get("ior").map_or(2, |ior| match ior.values.as_deref() {
        Some([_, _]) => 2,
        _ => 8,
    });
    let table =
        Draft::new("glass-albedo", "albedo").model("ggx-glass").layout("both-sides-r-t").tolerance(1e-4);
    let table = table.longest("mu", 32).longest("roughness", 24);
    let table = table.over(need, "roughness").near("roughness", [LEAST, 1.0], NEAR_SMOOTH);
    let ior = need.ranges.get("ior").cloned();
    let table = table.even("eta", indices);
    vec![match ior {
        Some(ior) => table.along("eta", ior).near("eta", [1.01, 100.0], NO_INTERFACE),
        None => table,
    }]
}
