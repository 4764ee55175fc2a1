//! Fuzz: the layer of fibres as a transformed cosine.

use super::Family;
use super::axes::Draft;
use crate::scene::{FUZZ, Need};

pub(super) const FAMILY: Family = Family { id: FUZZ, requests, serves: &[("sheen-ltc", None)] };

const NARROWEST: &str = "the narrowest layer that is solved";

fn requests(need: &Need) -> Vec<Draft> {
    let table = Draft::new("fuzz-ltc", "sheen-ltc").over(need, "r");
    vec![table.within("r", [0.01, 1.0], NARROWEST)]
}
