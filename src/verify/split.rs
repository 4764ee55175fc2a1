//! Scale plus bias is the white albedo, as the one-dimensional reduction of the model gives it.

use super::{Case, Law, Outcome, energy, seeds};
use crate::tables::{place, sweep::Sweep};

/// The law.
pub static LAW: Law = Law {
    id: "split",
    statement: "scale + bias (or total) equals the white albedo of a one-dimensional reduction",
    margin: "sum of both error estimates minus the difference, smallest of 64 texels",
    code: 2002,
    check,
};

fn check(case: &Case<'_>) -> Outcome {
    let Ok(sweep) = Sweep::new(&case.bound.spec, true) else { return Outcome::vacuous("no model") };
    let mut outcome = Outcome::start();
    for texel in seeds::texels(case.table, 64, 0x5b17).into_iter().take_while(|_| case.goes_on()) {
        let point = case.table.grid.texel(texel);
        let Ok(model) = sweep.model(point.values()) else { continue };
        let mu = sweep.mu(point.values());
        let reference = model
            .mirror(mu)
            .map(|e| (e, 1e-15))
            .or_else(|| model.reduced_albedo(mu, 0.1 * case.tolerance).map(|e| (e.value[0], e.error[0])));
        let (Some((e, error)), Some((r, r_error))) = (energy::white(case, texel), reference) else {
            continue;
        };
        outcome.tighten(error + r_error + 1e-14 - (e - r).abs(), || {
            format!("{e:.12} against {r:.12}, {}", place(&case.table.grid, texel))
        });
    }
    if outcome.at.is_empty() { Outcome::vacuous("the model has no reduction") } else { outcome }
}
