//! No surface reflects more than it receives: E <= 1 within the error estimate, at every texel.

use super::{Case, Law, Outcome};
use crate::tables::place;

/// The law.
pub static LAW: Law = Law {
    id: "energy",
    statement: "E <= 1 within the error estimate at every texel",
    margin: "1 - E plus the error estimate",
    code: 2001,
    check,
};

fn check(case: &Case<'_>) -> Outcome {
    let mut outcome = Outcome::start();
    for texel in 0..case.table.grid.len() {
        if let Some((e, error)) = white(case, texel) {
            outcome.tighten(1.0 - e + error, || format!("E = {e:.6}, {}", place(&case.table.grid, texel)));
        }
    }
    if outcome.at.is_empty() { Outcome::vacuous("no albedo in this layout") } else { outcome }
}

/// The albedo that the channels of a texel hold, with its error: one channel, or scale plus bias.
pub(super) fn white(case: &Case<'_>, texel: usize) -> Option<(f64, f64)> {
    let n = case.table.channels.len();
    let (values, errors) = (case.table.at(texel), &case.table.errors[texel * n..(texel + 1) * n]);
    let position = |id: &str| case.table.channels.iter().position(|c| c.id == id);
    if let (Some(a), Some(b)) = (position("dfg.scale"), position("dfg.bias")) {
        return Some((values[a] + values[b], errors[a] + errors[b]));
    }
    let i = ["dfg.total", "e", "e-avg", "ltc.magnitude"].into_iter().find_map(position)?;
    Some((values[i], errors[i]))
}
