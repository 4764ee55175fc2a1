//! A stored matrix is a lobe, and lies as far from the model as the fit says: seen by drawing from the model.

use super::lobes::Lobes;
use super::{Case, Law, Outcome, Watch, seeds};
use crate::integrate::View;
use crate::integrate::sobol::replicate_mean;
use crate::models::Brdf;
use crate::tables::role::{Lobe, Side};
use crate::tables::{Role, Spec, ltc_fit, ltc_matrix, place};
use crate::terms::ltc::Inverse;

/// The law.
pub static LAW: Law = Law {
    id: "lobe",
    statement: "every matrix is a lobe (finite, det > 0), at the distance from the model that sampling finds",
    margin: "6 standard errors, plus 1e-3, plus how far the last levels of the fit's nodes are apart, minus the difference of the total variation by the fit's nodes and by 8192 draws; \
        smallest of 12 texels; -inf for a matrix that is no lobe",
    code: 4004,
    formal: false,
    concerns: |spec| lobe(spec).is_some(),
    check,
};

/// Texels at which the distance is measured again.
const TEXELS: usize = 12;

/// Scramblings, and points in each.
const REPLICATES: u32 = 16;
const POINTS: u32 = 512;

/// What the sum on the fit's side may be off by where its levels tell the same.
const SLACK: f64 = 1e-3;

/// The lobe that the matrices of a table are fitted to, if its channels make a matrix.
fn lobe(spec: &Spec) -> Option<Lobe> {
    let roles = spec.roles();
    ltc_matrix::stored(&roles, &vec![1.0; roles.len()])?;
    roles.into_iter().find_map(|role| if let Role::Matrix(lobe, _) = role { Some(lobe) } else { None })
}

fn check(case: &Case<'_>) -> Outcome {
    let (roles, lobes) = (case.spec().roles(), Lobes::new(case.spec()));
    let Some(lobe) = lobe(case.spec()) else {
        return Outcome::NotChecked("the channels make no matrix".to_owned());
    };
    let mut watch = Watch::default();
    for texel in (0..case.table.grid.len()).take_while(|_| case.goes_on()) {
        let Some(m) = ltc_matrix::stored(&roles, case.table.at(texel)) else { continue };
        // NaN is no lobe
        if !(m.minor() > 0.0 && m.m22 > 0.0 && m.apply(glam::DVec3::ONE).is_finite()) {
            watch.see(f64::NEG_INFINITY, || format!("{m:?}, {}", place(&case.table.grid, texel)));
        }
    }
    for (i, texel) in
        seeds::texels(case.table, TEXELS, 0x17c).into_iter().enumerate().take_while(|_| case.goes_on())
    {
        let point = case.table.grid.texel(texel);
        let view = lobes.view(lobe, point.values());
        let (Some(model), Some(m)) = (
            lobes.build(lobe, point.values(), Side::Above),
            ltc_matrix::stored(&roles, case.table.at(texel)),
        ) else {
            continue;
        };
        if view.mu < 1e-6 {
            watch.miss(|| "in the horizon the sampler has nothing to see".to_owned());
            continue;
        }
        let Ok((fit, off)) = ltc_fit::judged(&*model, view, &m) else { continue };
        if fit.albedo <= f64::MIN_POSITIVE {
            continue;
        }
        let seen = variation(&*model, view, &m, fit.albedo, 0x10be + i as u64);
        let margin = 6.0 * seen.standard_error + SLACK + off - (fit.variation - seen.mean).abs();
        watch.see(margin, || {
            format!(
                "total variation {:.5} against {:.5} +- {:.1e}, {}",
                fit.variation,
                seen.mean,
                seen.standard_error,
                place(&case.table.grid, texel)
            )
        });
    }
    watch.outcome("no texel with a density")
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
