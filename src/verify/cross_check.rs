//! An independent integrator: the model's own sampler at scrambled Sobol points, with a standard error from
//! independent scramblings. It shares no node, no chart and no reduction with the baker.

use super::{Case, Law, Outcome, seeds};
use crate::integrate::View;
use crate::integrate::sobol::{ReplicateMean, replicate_mean};
use crate::models::Brdf;
use crate::tables::integral::Functional;
use crate::tables::{place, sweep::Sweep};
use glam::{DVec2, DVec3};

/// The law.
pub static LAW: Law = Law {
    id: "cross-check",
    statement: "the baked value agrees with sampling at scrambled Sobol points",
    margin: "6 standard errors, plus 2 / N for tails that N draws miss, plus the error estimate, minus the difference; smallest of 12 texels",
    code: 2004,
    check,
};

/// Scramblings, and points in each.
const REPLICATES: u32 = 16;
const POINTS: u32 = 512;

/// What N draws may have missed: tails that are hit less than once in N, with weights of about 1, do not show in the
/// standard error (at alpha = 0.002 the rays lost at the horizon are three in a million).
const UNSEEN: f64 = 2.0 / (REPLICATES * POINTS) as f64;

/// Texels that are checked.
const TEXELS: usize = 12;

/// Estimates `int f g mu_i dwi` for several functionals g by the model's sampler, with standard errors.
#[must_use]
pub fn estimate<const N: usize>(
    model: &dyn Brdf,
    view: impl Into<View>,
    functionals: [Functional; N],
    seed: u64,
    replicates: u32,
    points: u32,
) -> [ReplicateMean; N] {
    let wo = view.into().direction();
    replicate_mean(seed, replicates, points, |u| {
        let (weight, cos_d) = weight(model, wo, u);
        functionals.map(|g| weight * g.at(cos_d))
    })
}

/// `f mu_i / pdf` of one draw, and `wo . wh`.
fn weight(model: &dyn Brdf, wo: DVec3, u: DVec2) -> (f64, f64) {
    match model.sample(wo, u) {
        Some(s) if s.pdf > 0.0 => {
            let v = (0.5 * (1.0 + wo.dot(s.wi))).max(0.0).sqrt();
            (model.eval(wo, s.wi) * s.wi.z / s.pdf, v)
        }
        _ => (0.0, 1.0),
    }
}
/// Which functional a channel holds, if it is one.
fn functional(channel: &str) -> Option<Functional> {
    match channel {
        "dfg.scale" => Some(Functional::SchlickComplement),
        "dfg.bias" | "dfg.fc" | "ltc.fresnel" => Some(Functional::Schlick),
        "dfg.f82" => Some(Functional::F82),
        "dfg.total" | "e" | "ltc.magnitude" => Some(Functional::One),
        _ => None,
    }
}

fn check(case: &Case<'_>) -> Outcome {
    let splits = case.bound.spec.model.as_ref().is_some_and(|(info, _)| info.splits);
    let white = splits && ["dfg", "ltc-magnitude"].contains(&case.bound.spec.kind.id);
    let Ok(sweep) = Sweep::new(&case.bound.spec, white) else { return Outcome::vacuous("no model") };
    let mut outcome = Outcome::start();
    for (i, texel) in seeds::texels(case.table, TEXELS, 0xc705).into_iter().enumerate() {
        let point = case.table.grid.texel(texel);
        let view = sweep.view(point.values());
        let Ok(model) = sweep.model(point.values()) else { continue };
        // a mirror has no density to sample; at the horizon the sampler has nothing to see
        if model.mirror(view.mu).is_some() || view.mu < 1e-6 {
            continue;
        }
        for (c, channel) in case.table.channels.iter().enumerate() {
            let Some(g) = functional(&channel.id) else { continue };
            let [s] = estimate(&*model, view, [g], 0x51ed + i as u64, REPLICATES, POINTS);
            let k = texel * case.table.channels.len() + c;
            let (v, e) = (case.table.values[k], case.table.errors[k]);
            outcome.tighten(6.0 * s.standard_error + e + UNSEEN - (v - s.mean).abs(), || {
                format!(
                    "{} = {v:.6} against {:.6} +- {:.1e}, {}",
                    channel.id,
                    s.mean,
                    s.standard_error,
                    place(&case.table.grid, texel)
                )
            });
        }
    }
    if outcome.at.is_empty() { Outcome::vacuous("no texel with a density") } else { outcome }
}
