//! Scale plus bias is the white albedo, as another rule gives it.

use super::{Case, Law, Outcome, Watch, energy, honest, lobes::Lobes, seeds};
use crate::models::Functional;
use crate::tables::place;
use crate::tables::role::{Lobe, Side};

/// The law.
pub static LAW: Law = Law {
    id: "split",
    statement: "scale + bias (or total) equals the white albedo of a one-dimensional reduction, or of an independent sum",
    margin: "sum of both error estimates minus the difference, smallest of 64 texels",
    code: 2002,
    formal: false,
    concerns: |spec| white(spec).next().is_some(),
    check,
};

fn white(spec: &crate::tables::Spec) -> impl Iterator<Item = energy::Sum> {
    energy::albedos(spec).into_iter().filter(|s| s.lobe == Lobe::White && !s.average)
}

fn check(case: &Case<'_>) -> Outcome {
    let lobes = Lobes::new(case.spec());
    let mut watch = Watch::default();
    for sum in white(case.spec()) {
        for texel in seeds::texels(case.table, 64, 0x5b17).into_iter().take_while(|_| case.goes_on()) {
            let point = case.table.grid.texel(texel);
            let Some(model) = lobes.build(Lobe::White, point.values(), Side::Above) else { continue };
            let view = lobes.view(Lobe::White, point.values());
            let reference = model
                .mirror(view.mu)
                .map(|e| (e, 1e-15))
                .or_else(|| {
                    model
                        .reduced(view.mu, &[Functional::One], 0.1 * case.tolerance)
                        .map(|e| (e.value[0], e.error[0]))
                })
                .or_else(|| honest::albedo(&*model, view, 0.1 * case.tolerance).map(|t| (t.value, t.error)));
            let Some((r, r_error)) = reference.filter(|r| r.1 <= case.tolerance) else {
                watch.miss(|| "neither a reduction nor an independent sum reaches the tolerance".to_owned());
                continue;
            };
            let (e, error) = sum.at(case, texel);
            watch.see(error + r_error + 1e-14 - (e - r).abs(), || {
                format!("{e:.12} against {r:.12}, {}", place(&case.table.grid, texel))
            });
        }
    }
    watch.outcome("no white albedo among the channels")
}
