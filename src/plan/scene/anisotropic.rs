//! Anisotropic GGX: its albedo over the azimuth of the view.

use super::Family;
use super::axes::Draft;
use super::ggx::NEAR_MIRROR;
use crate::scene::{ANISOTROPIC, Need, Range};
use std::f64::consts::FRAC_PI_2;

pub(super) const FAMILY: Family = Family { id: ANISOTROPIC, requests, serves: &[("albedo", Some("ggx"))] };

/// Texels over a quarter turn: the albedo is even in both tangents.
const AZIMUTHS: usize = 17;
/// Widths along each tangent, where they differ.
const WIDTHS: usize = 12;

fn requests(need: &Need) -> Vec<Draft> {
    let quarter = Range { lo: 0.0, hi: FRAC_PI_2, values: None };
    let table = Draft::new("anisotropic-albedo", "albedo").channels(&["e"]).tolerance(1e-4);
    let table = table.even("phi", AZIMUTHS).even("alpha_x", WIDTHS).even("alpha_y", WIDTHS);
    // a table of four axes has to be a coarse one
    let swept =
        ["alpha_x", "alpha_y"].iter().all(|id| need.ranges.get(*id).is_some_and(|r| r.value().is_none()));
    let table = if swept {
        table.longest("mu", 32).longest("phi", 9).longest("alpha_x", 8).longest("alpha_y", 8)
    } else {
        table
    };
    let table = table.along("phi", quarter).over(need, "alpha_x").over(need, "alpha_y").without("alpha");
    vec![["alpha_x", "alpha_y"].iter().fold(table, |t, id| t.near(id, [1e-4, 1.0], NEAR_MIRROR))]
}
