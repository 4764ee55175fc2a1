//! Area lights: transformed cosines over the roughness of every lobe that they light.

use super::Family;
use super::axes::Draft;
use crate::scene::{AREA_LIGHT, Need};

pub(super) const FAMILY: Family =
    Family { id: AREA_LIGHT, requests, serves: &[("ltc-matrix", None), ("ltc-magnitude", None)] };

const NO_WIDTH: &str = "a mirror has no matrix";

/// alpha = 1e-3.
const LEAST: f64 = 0.031_622_776_601_683_794;

fn requests(need: &Need) -> Vec<Draft> {
    let table = |name: &str, kind: &str| {
        Draft::new(name, kind).over(need, "roughness").near("roughness", [LEAST, 1.0], NO_WIDTH)
    };
    vec![table("area-light-matrix", "ltc-matrix"), table("area-light-magnitude", "ltc-magnitude")]
}
