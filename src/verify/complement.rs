//! What is missing is what the albedos leave: 1 - E, from the model by another route than the table's.

use super::{Case, Law, Outcome, cross_check, seeds};
use crate::tables::{place, sweep::Sweep};

/// The law.
pub static LAW: Law = Law {
    id: "complement",
    statement: "the missing energy is one minus the sampled albedo",
    margin: "6 standard errors, plus 2 / N for tails that N draws miss, plus the error estimate, minus the difference; smallest of 12 texels",
    code: 2005,
    check,
};

fn check(case: &Case<'_>) -> Outcome {
    let white = case.bound.spec.kind.id == "compensation";
    let Ok(sweep) = Sweep::new(&case.bound.spec, white) else { return Outcome::vacuous("no model") };
    let n = case.table.channels.len();
    let mut outcome = Outcome::start();
    for (i, texel) in seeds::texels(case.table, cross_check::TEXELS, 0xc0a1)
        .into_iter()
        .enumerate()
        .take_while(|_| case.goes_on())
    {
        let point = case.table.grid.texel(texel);
        let view = sweep.view(point.values());
        for (c, channel) in case.table.channels.iter().enumerate() {
            let inside = match channel.id.as_str() {
                "ms.missing" => false,
                "ms.missing.inside" => true,
                _ => continue,
            };
            let Ok(model) = sweep.model_from(point.values(), inside) else { continue };
            if model.mirror(view.mu).is_some() || view.mu < 1e-6 {
                continue;
            }
            let s = cross_check::leaving(&*model, view, true, true, 0x3a11 + i as u64);
            let (v, e) = (case.table.values[texel * n + c], case.table.errors[texel * n + c]);
            outcome.tighten(
                6.0 * s.standard_error + e + cross_check::UNSEEN - (v - (1.0 - s.mean)).abs(),
                || {
                    format!(
                        "{} = {v:.6} against {:.6} +- {:.1e}, {}",
                        channel.id,
                        1.0 - s.mean,
                        s.standard_error,
                        place(&case.table.grid, texel)
                    )
                },
            );
        }
    }
    if outcome.at.is_empty() { Outcome::vacuous("no texel with a density") } else { outcome }
}
