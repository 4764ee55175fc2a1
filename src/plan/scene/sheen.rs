//! Charlie's sheen: its albedo, by which the layers below are scaled.

use super::Family;
use super::axes::Draft;
use crate::scene::{Need, SHEEN};
use crate::tables::sheen_scaling::LEAST_SHEEN_ROUGHNESS;

pub(super) const FAMILY: Family = Family {
    id: SHEEN,
    requests,
    serves: &[("sheen-scaling", None), ("albedo", Some("charlie")), ("sheen-ltc", None)],
};

const TOO_BRIGHT: &str = "below it E of Charlie exceeds 1 at grazing views, and productions clamp";

fn requests(need: &Need) -> Vec<Draft> {
    let table = Draft::new("sheen-albedo", "sheen-scaling").layout("e").over(need, "sheen_roughness");
    vec![table.within("sheen_roughness", [LEAST_SHEEN_ROUGHNESS, 1.0], TOO_BRIGHT)]
}
