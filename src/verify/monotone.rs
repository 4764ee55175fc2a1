//! A cumulative distribution, its inverse and a transmittance rise, or fall, from texel to texel.

use super::{Case, Law, Outcome};
use crate::tables::place;

/// The law.
pub static LAW: Law = Law {
    id: "monotone",
    statement: "values rise (cumulative distributions, their inverses, masking) or fall (transmittances) along their axis",
    margin: "smallest step in the right direction plus both error estimates",
    code: 4003,
    check,
};

/// Kind, layout (all if empty), axis, and whether the first channels rise (1), fall (-1) or do either (0) along it.
const PROMISES: &[(&str, &str, &str, &[f64])] = &[
    ("diffusion-profile", "inside", "radius", &[1.0, 1.0, 1.0]),
    ("diffusion-kernel", "cumulative", "offset", &[1.0, 1.0, 1.0]),
    ("diffusion-kernel", "line", "offset", &[-1.0, -1.0, -1.0]),
    ("diffusion-sampling", "", "u", &[1.0, 1.0, 1.0]),
    ("skin-transmittance", "", "thickness", &[-1.0, -1.0, -1.0]),
    ("beer-lambert", "transmitted", "path", &[-1.0, -1.0, -1.0]),
    ("beer-lambert", "lost", "path", &[1.0, 1.0, 1.0]),
    ("phase-sampling", "cosine", "u", &[1.0]),
    ("phase-sampling", "angle", "u", &[-1.0]),
    ("masking", "", "mu", &[1.0]),
    ("importance", "angles", "u", &[-1.0]),
    ("importance", "direction", "u", &[0.0, 0.0, -1.0]),
    ("importance", "direction-pdf", "u", &[0.0, 0.0, -1.0]),
];

fn check(case: &Case<'_>) -> Outcome {
    let spec = &case.bound.spec;
    let promise = PROMISES
        .iter()
        .find(|p| p.0 == spec.kind.id && (p.1.is_empty() || p.1 == spec.layout.id))
        .and_then(|p| Some((spec.axis(p.2)?, p.3)));
    let Some((axis, signs)) = promise else { return Outcome::vacuous("no promise for this layout") };
    let grid = &spec.grid;
    let stride: usize = grid.axes()[..axis].iter().map(|a| a.len).product();
    let channels = case.table.channels.len();
    let mut outcome = Outcome::start();
    for texel in (0..grid.len()).take_while(|_| case.goes_on()) {
        if grid.unravel(texel)[axis] == 0 {
            continue;
        }
        let before = texel - stride;
        let forward = grid.texel(texel).values()[axis] - grid.texel(before).values()[axis];
        for (c, sign) in signs.iter().enumerate().filter(|s| *s.1 != 0.0) {
            let step = (case.table.values[texel * channels + c] - case.table.values[before * channels + c])
                * sign
                * if forward < 0.0 { -1.0 } else { 1.0 };
            let slack = case.table.errors[texel * channels + c] + case.table.errors[before * channels + c];
            outcome
                .tighten(step + slack, || format!("{}, {}", case.table.channels[c].id, place(grid, texel)));
        }
    }
    if outcome.at.is_empty() { Outcome::vacuous("one texel") } else { outcome }
}
