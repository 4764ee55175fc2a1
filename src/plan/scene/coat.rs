//! Coats: the albedo of GGX under a dielectric Schlick factor, which is what the coat reflects and what it takes from below.

use super::axes::Draft;
use super::ggx::rough;
use super::{ALBEDO_TOLERANCE, Family};
use crate::scene::{COAT, Need, Range, dielectric_f0};

pub(super) const FAMILY: Family =
    Family { id: COAT, requests, serves: &[("dfg", None), ("albedo", Some("ggx"))] };

fn requests(need: &Need) -> Vec<Draft> {
    let range = need.ranges.get("ior").map_or(Range { lo: 0.04, hi: 0.04, values: None }, |ior| {
        let values = ior.values.as_ref().map(|all| all.iter().map(|n| dielectric_f0(*n)).collect());
        let ends = [dielectric_f0(ior.lo), dielectric_f0(ior.hi)];
        Range { lo: ends[0].min(ends[1]), hi: ends[0].max(ends[1]), values }
    });
    let albedo = Draft::new("coat-albedo", "albedo").tolerance(ALBEDO_TOLERANCE);
    vec![rough(albedo, need).even("f0", 2).along("f0", range)]
}
