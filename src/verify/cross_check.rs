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
pub(super) const UNSEEN: f64 = 2.0 / (REPLICATES * POINTS) as f64;

/// Texels that are checked.
pub(super) const TEXELS: usize = 12;

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

/// Estimates the light that leaves a surface: on the side of the view, through it, or both.
pub(super) fn leaving(
    model: &dyn Brdf,
    view: View,
    reflected: bool,
    through: bool,
    seed: u64,
) -> ReplicateMean {
    let wo = view.direction();
    let btdf = model.transmission().filter(|_| through);
    let [mean] = replicate_mean(seed, REPLICATES, POINTS, |u| {
        let r = if reflected { weight(model, wo, u).0 } else { 0.0 };
        let t = btdf.and_then(|t| {
            let s = t.sample(wo, u).filter(|s| s.pdf > 0.0)?;
            // the flux along wo: light from wo, seen from the drawn side
            Some(t.eval(s.wi, wo) * s.wi.z.abs() / s.pdf)
        });
        [r + t.unwrap_or(0.0)]
    });
    mean
}

/// Reflected, transmitted, from inside: which light a channel counts, if it is an albedo.
fn parts(channel: &str) -> Option<(bool, bool, bool)> {
    let (name, inside) = channel.strip_suffix(".inside").map_or((channel, false), |name| (name, true));
    match name {
        "e" => Some((true, true, inside)),
        "r" => Some((true, false, inside)),
        "t" => Some((false, true, inside)),
        _ => None,
    }
}

/// Which functional a channel holds, if it is one.
fn functional(channel: &str) -> Option<Functional> {
    match channel {
        "dfg.scale" => Some(Functional::SchlickComplement),
        "dfg.bias" | "dfg.fc" | "ltc.fresnel" => Some(Functional::Schlick),
        "dfg.f82" => Some(Functional::F82),
        "dfg.total" | "dfg.loss" | "ltc.magnitude" => Some(Functional::One),
        _ => None,
    }
}

fn check(case: &Case<'_>) -> Outcome {
    let splits = case.bound.spec.model.as_ref().is_some_and(|(info, _)| info.splits);
    let white = splits && ["dfg", "ltc-magnitude"].contains(&case.bound.spec.kind.id);
    let Ok(sweep) = Sweep::new(&case.bound.spec, white) else { return Outcome::vacuous("no model") };
    let mut outcome = Outcome::start();
    for (i, texel) in
        seeds::texels(case.table, TEXELS, 0xc705).into_iter().enumerate().take_while(|_| case.goes_on())
    {
        let point = case.table.grid.texel(texel);
        let view = sweep.view(point.values());
        let Ok(model) = sweep.model(point.values()) else { continue };
        // a mirror has no density to sample; at the horizon the sampler has nothing to see
        if model.mirror(view.mu).is_some() || view.mu < 1e-6 {
            continue;
        }
        let seed = 0x51ed + i as u64;
        for (c, channel) in case.table.channels.iter().enumerate() {
            let s = if let Some(g) = functional(&channel.id) {
                let [s] = estimate(&*model, view, [g], seed, REPLICATES, POINTS);
                s
            } else if let Some((reflected, through, inside)) = parts(&channel.id)
                && let Ok(model) = sweep.model_from(point.values(), inside)
            {
                leaving(&*model, view, reflected, through, seed)
            } else {
                continue;
            };
            let k = texel * case.table.channels.len() + c;
            let (stored, e) = (case.table.values[k], case.table.errors[k]);
            let v = if channel.id == "dfg.loss" { 1.0 - stored } else { stored };
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
