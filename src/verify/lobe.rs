//! A stored matrix is a lobe, and lies as far from the model as the fit says: seen by drawing from the model.

use super::{Case, Law, Outcome, seeds};
use crate::integrate::View;
use crate::integrate::sobol::replicate_mean;
use crate::models::Brdf;
use crate::tables::{ltc_fit, ltc_matrix, place, sweep::Sweep};
use crate::terms::ltc::Inverse;

/// The law.
pub static LAW: Law = Law {
    id: "lobe",
    statement: "every matrix is a lobe (finite, det > 0), at the distance from the model that sampling finds",
    margin: "6 standard errors, plus 1e-3, minus the difference of the total variation by the fit's nodes and by 8192 draws; \
        smallest of 12 texels; -inf for a matrix that is no lobe",
    code: 4004,
    check,
};

/// Texels at which the distance is measured again.
const TEXELS: usize = 12;

/// Scramblings, and points in each.
const REPLICATES: u32 = 16;
const POINTS: u32 = 512;

/// Level of the charts on the fit's side, and what its sum may be off by.
const LEVEL: f64 = 20.0;
const SLACK: f64 = 1e-3;

fn check(case: &Case<'_>) -> Outcome {
    let splits = case.bound.spec.model.as_ref().is_some_and(|(info, _)| info.splits);
    let Ok(sweep) = Sweep::new(&case.bound.spec, splits) else { return Outcome::vacuous("no model") };
    let mut outcome = Outcome::start();
    for texel in (0..case.table.grid.len()).take_while(|_| case.goes_on()) {
        let Some(m) = ltc_matrix::stored(case.table, texel) else {
            return Outcome::vacuous("no matrix in these channels");
        };
        // NaN is no lobe
        if !(m.minor() > 0.0 && m.m22 > 0.0 && m.apply(glam::DVec3::ONE).is_finite()) {
            outcome.tighten(f64::NEG_INFINITY, || format!("{m:?}, {}", place(&case.table.grid, texel)));
        }
    }
    for (i, texel) in
        seeds::texels(case.table, TEXELS, 0x17c).into_iter().enumerate().take_while(|_| case.goes_on())
    {
        let point = case.table.grid.texel(texel);
        let view = sweep.view(point.values());
        let (Ok(model), Some(m)) = (sweep.model(point.values()), ltc_matrix::stored(case.table, texel))
        else {
            continue;
        };
        // in the horizon the sampler has nothing to see
        if view.mu < 1e-6 {
            continue;
        }
        let Ok(fit) = ltc_fit::judge(&*model, view, &m, LEVEL) else { continue };
        if fit.albedo <= f64::MIN_POSITIVE {
            continue;
        }
        let seen = variation(&*model, view, &m, fit.albedo, 0x10be + i as u64);
        let margin = 6.0 * seen.standard_error + SLACK - (fit.variation - seen.mean).abs();
        outcome.tighten(margin, || {
            format!(
                "total variation {:.5} against {:.5} +- {:.1e}, {}",
                fit.variation,
                seen.mean,
                seen.standard_error,
                place(&case.table.grid, texel)
            )
        });
    }
    if outcome.at.is_empty() { Outcome::vacuous("no texel with a density") } else { outcome }
}

/// `int max(0, f mu_i / E - D)` by the model's sampler.
fn variation(
    model: &dyn Brdf,
    view: View,
    m: &Inverse,
    albedo: f64,
    seed: u64,
) -> crate::integrate::sobol::ReplicateMean {
    let wo = view.direction();
    let [mean] = replicate_mean(seed, REPLICATES, POINTS, |u| {
        let weight = model
            .sample(wo, u)
            .filter(|s| s.pdf > 0.0)
            .map_or(0.0, |s| (model.eval(wo, s.wi) * s.wi.z / albedo - m.density(s.wi)).max(0.0) / s.pdf);
        [weight]
    });
    mean
}
