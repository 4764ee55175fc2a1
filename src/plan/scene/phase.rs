//! Phase functions: angles drawn from Henyey and Greenstein's.

use super::Family;
use super::axes::Draft;
use crate::scene::{Need, PHASE};

pub(super) const FAMILY: Family =
    Family { id: PHASE, requests, serves: &[("phase-function", None), ("phase-sampling", None)] };

const NARROWEST: &str = "beyond it the peak is narrower than the table's first step";

fn requests(need: &Need) -> Vec<Draft> {
    let table = Draft::new("phase-function", "phase-function").even("g", 33).over(need, "g");
    vec![table.near("g", [-0.999, 0.999], NARROWEST)]
}
