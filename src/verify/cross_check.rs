//! An independent integrator: the model's own sampler at scrambled Sobol points, with a standard error from
//! independent scramblings. It shares no node, no chart and no reduction with the baker.

use super::{Case, Law, Outcome, seeds};
use crate::integrate::sobol;
use crate::models::Brdf;
use crate::tables::integral::Functional;
use crate::tables::{place, sweep::Sweep};
use glam::{DVec2, DVec3};

/// The law.
pub static LAW: Law = Law {
    id: "cross-check",
    statement: "the baked value agrees with sampling at scrambled Sobol points",
    margin: "6 standard errors plus the error estimate minus the difference, smallest of 12 texels",
    code: 2004,
    check,
};

/// Scramblings, and points in each.
const REPLICATES: u32 = 16;
const POINTS: u32 = 512;

/// Texels that are checked.
const TEXELS: usize = 12;

/// A mean with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sampled {
    /// Mean over all replicates.
    pub mean: f64,
    /// Standard error of the mean, from the spread of the replicates.
    pub standard_error: f64,
}

/// Estimates `int f g mu_i dwi` by the model's sampler.
#[must_use]
pub fn estimate(
    model: &dyn Brdf,
    mu_o: f64,
    functional: Functional,
    seed: u32,
    replicates: u32,
    points: u32,
) -> Sampled {
    let wo = DVec3::new(((1.0 - mu_o) * (1.0 + mu_o)).max(0.0).sqrt(), 0.0, mu_o);
    let (mut sum, mut squares) = (0.0, 0.0);
    for r in 0..replicates {
        let mut inner = 0.0;
        for i in 0..points {
            let u = sobol::point(i, seed.wrapping_add(r));
            inner += weight(model, wo, DVec2::from_array(u), functional);
        }
        let mean = inner / f64::from(points);
        sum += mean;
        squares += mean * mean;
    }
    let n = f64::from(replicates);
    let mean = sum / n;
    let variance = (squares / n - mean * mean).max(0.0) / (n - 1.0).max(1.0);
    Sampled { mean, standard_error: variance.sqrt() }
}

fn weight(model: &dyn Brdf, wo: DVec3, u: DVec2, functional: Functional) -> f64 {
    match model.sample(wo, u) {
        Some(s) if s.pdf > 0.0 => {
            let v = (0.5 * (1.0 + wo.dot(s.wi))).max(0.0).sqrt();
            model.eval(wo, s.wi) * s.wi.z * functional.at(v) / s.pdf
        }
        _ => 0.0,
    }
}

/// Which functional a channel holds, if it is one.
fn functional(channel: &str) -> Option<Functional> {
    match channel {
        "dfg.scale" => Some(Functional::SchlickComplement),
        "dfg.bias" | "dfg.fc" => Some(Functional::Schlick),
        "dfg.total" | "e" => Some(Functional::One),
        _ => None,
    }
}

fn check(case: &Case<'_>) -> Outcome {
    let white = case.bound.spec.kind.id == "dfg";
    let Ok(sweep) = Sweep::new(&case.bound.spec, white) else { return Outcome::vacuous("no model") };
    let mut outcome = Outcome::start();
    for (i, texel) in seeds::texels(case.table, TEXELS, 0xc705).into_iter().enumerate() {
        let point = case.table.grid.texel(texel);
        let mu = sweep.mu(point.values());
        let Ok(model) = sweep.model(point.values()) else { continue };
        // a mirror has no density to sample; at the horizon the sampler has nothing to see
        if model.mirror(mu).is_some() || mu < 1e-6 {
            continue;
        }
        for (c, channel) in case.table.channels.iter().enumerate() {
            let Some(g) = functional(&channel.id) else { continue };
            let seed = 0x51ed_u32.wrapping_mul(u32::try_from(i).unwrap_or(0) + 1);
            let s = estimate(&*model, mu, g, seed, REPLICATES, POINTS);
            let k = texel * case.table.channels.len() + c;
            let (v, e) = (case.table.values[k], case.table.errors[k]);
            outcome.tighten(6.0 * s.standard_error + e + 1e-6 - (v - s.mean).abs(), || {
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
