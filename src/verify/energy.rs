//! No surface reflects more than it receives: E <= 1 within the error estimate, at every texel.

use super::{Case, Law, Outcome};
use crate::tables::place;

/// The law.
pub static LAW: Law = Law {
    id: "energy",
    statement: "E <= 1 (R + T <= 1) within the error estimate at every texel, from every side",
    margin: "1 - E plus the error estimate",
    code: 2001,
    check,
};

fn check(case: &Case<'_>) -> Outcome {
    let mut outcome = Outcome::start();
    for texel in (0..case.table.grid.len()).take_while(|_| case.goes_on()) {
        for (e, error) in white(case, texel).into_iter().chain(parts(case, texel)) {
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
    if let Some(i) = position("dfg.loss") {
        return Some((1.0 - values[i], errors[i]));
    }
    let i = ["dfg.total", "e", "e-avg", "ltc.magnitude"].into_iter().find_map(position)?;
    Some((values[i], errors[i]))
}

/// Sums of reflected and transmitted parts, and what is seen from inside: all of them at most 1.
fn parts(case: &Case<'_>, texel: usize) -> impl Iterator<Item = (f64, f64)> {
    const SUMS: [&[&str]; 6] = [
        &["r", "t"],
        &["r.inside", "t.inside"],
        &["e.inside"],
        &["r-avg", "t-avg"],
        &["r-avg.inside", "t-avg.inside"],
        &["e-avg.inside"],
    ];
    let n = case.table.channels.len();
    SUMS.into_iter().filter_map(move |ids| {
        let mut sum: Option<(f64, f64)> = None;
        let found = case.table.channels.iter().enumerate().filter(|(_, c)| ids.contains(&c.id.as_str()));
        for (c, _) in found {
            let (v, e) = sum.unwrap_or((0.0, 0.0));
            sum = Some((v + case.table.at(texel)[c], e + case.table.errors[texel * n + c]));
        }
        sum
    })
}
