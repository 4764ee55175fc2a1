//! Charlie's sheen: its albedo, by which the layers below are scaled.

use super::Family;
use super::axes::Draft;
use crate::scene::{Need, SHEEN};

pub(super) const FAMILY: Family = Family {
    id: SHEEN,
    requests,
    serves: &[("sheen-scaling", None), ("albedo", Some("charlie")), ("sheen-ltc", None)],
};

const TOO_BRIGHT: &str = "below it E of Charlie exceeds 1 at grazing views, and productions clamp";

/// The clamp of productions, r = 0.073.
const LEAST: f64 = 0.27;

fn requests(need: &Need) -> Vec<Draft> {
    let table = Draft::new("sheen-albedo", "sheen-scaling").layout("e").over(need, "sheen_roughness");
    vec![table.within("sheen_roughness", [LEAST, 1.0], TOO_BRIGHT)]
}
