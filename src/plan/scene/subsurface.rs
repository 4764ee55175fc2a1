//! Subsurface scattering: normalised diffusion over distance in mean free paths; the albedo comes from the texture.

use super::Family;
use super::axes::Draft;
use crate::scene::{Need, SUBSURFACE};

pub(super) const FAMILY: Family = Family {
    id: SUBSURFACE,
    requests,
    serves: &[
        ("diffusion-profile", None),
        ("diffusion-kernel", None),
        ("diffusion-sampling", None),
        ("preintegrated-skin", None),
        ("skin-transmittance", None),
        ("gaussian-fit", None),
    ],
};

fn requests(need: &Need) -> Vec<Draft> {
    let mut table = Draft::new("subsurface-profile", "diffusion-profile").layout("ring");
    table = table.param("profile", "burley").over(need, "radius");
    for c in ["r", "g", "b"] {
        table = table.param(&format!("length_{c}"), 1.0);
    }
    vec![table]
}
