//! An independent integrator: the model's own sampler at scrambled Sobol points, with a standard error from
//! independent scramblings. It shares no node, no chart and no reduction with the baker.

use super::linear::Linear;
use super::lobes::Lobes;
use super::{Case, Law, Outcome, Watch, linear, seeds, walk};
use crate::integrate::sobol::{ReplicateMean, replicate_mean};
use crate::integrate::{MAX_CHANNELS, View};
use crate::models::Brdf;
use crate::tables::integral::Functional;
use crate::tables::role::{Light, Lobe, Side};
use crate::tables::{Role, place};
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// The law.
pub static LAW: Law = Law {
    id: "cross-check",
    statement: "the baked value agrees with sampling at scrambled Sobol points, or with random walks",
    margin: "6 standard errors, plus 2 / N for tails that N draws miss, plus the error estimate, minus the difference; smallest of 12 texels",
    code: 2004,
    formal: false,
    concerns: |spec| {
        spec.roles().into_iter().any(|role| linear::is_linear(role) || matches!(role, Role::FibreAlbedo(_)))
    },
    check: |case| check(case, 0x51ed),
};

/// Scramblings, and points in each.
const REPLICATES: u32 = 16;
const POINTS: u32 = 512;

/// What N draws may have missed: tails that are hit less than once in N, with weights of about 1, do not show in the
/// standard error (at alpha = 0.002 the rays lost at the horizon are three in a million).
const UNSEEN: f64 = 2.0 / (REPLICATES * POINTS) as f64;

/// Walks through a layer.
const WALKS: u32 = 8192;

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

/// Estimates the integrals of channels of one lobe by the same draws: of the light on the side of the view, through the surface, or
/// both.
fn sampled(model: &dyn Brdf, view: View, channels: &[Linear], seed: u64) -> Vec<ReplicateMean> {
    let wo = view.direction();
    let crosses = channels.iter().any(|c| c.light != Light::Reflected);
    let stays = channels.iter().any(|c| c.light != Light::Transmitted);
    let btdf = model.transmission().filter(|_| crosses);
    let means: [ReplicateMean; MAX_CHANNELS] = replicate_mean(seed, REPLICATES, POINTS, |u| {
        let (weight, cos_d) = if stays { weight(model, wo, u) } else { (0.0, 1.0) };
        let t = btdf.and_then(|t| {
            let s = t.sample(wo, u).filter(|s| s.pdf > 0.0)?;
            // the flux along wo: light from wo, seen from the drawn side
            Some(t.eval(s.wi, wo) * s.wi.z.abs() / s.pdf)
        });
        let mut values = [0.0; MAX_CHANNELS];
        for (value, channel) in values.iter_mut().zip(channels) {
            let term = |(g, factor): &(Functional, f64)| factor * weight * g.at(cos_d);
            let r: f64 =
                if channel.light == Light::Transmitted { 0.0 } else { channel.terms.iter().map(term).sum() };
            let factor: f64 = channel.terms.iter().map(|(_, factor)| factor).sum();
            let t = if channel.light == Light::Reflected { 0.0 } else { t.unwrap_or(0.0) };
            *value = r + factor * t;
        }
        values
    });
    let shifted = |(c, m): (&Linear, &ReplicateMean)| ReplicateMean { mean: c.constant + m.mean, ..*m };
    channels.iter().zip(&means).map(shifted).collect()
}

/// Compares channels that are linear in integrals of their lobes with sampling.
pub(super) fn check(case: &Case<'_>, seed: u64) -> Outcome {
    let lobes = Lobes::new(case.spec());
    let texels = seeds::texels(case.table, TEXELS, 0xc705);
    let look = |(i, texel): (usize, usize)| match case.goes_on() {
        true => look(case, &lobes, texel, seed + i as u64),
        false => Watch::default(),
    };
    let seen: Vec<Watch> = texels.into_par_iter().enumerate().map(look).collect();
    let mut watch = Watch::default();
    seen.into_iter().for_each(|w| watch.join(w));
    watch.outcome("no texel with a density")
}

/// The channels of a texel that are integrals of one lobe from one side.
struct Group {
    lobe: Lobe,
    side: Side,
    /// None: a mirror has no density to sample, and at the horizon the sampler has nothing to see.
    model: Option<Box<dyn Brdf>>,
    view: View,
    channels: Vec<(usize, Linear)>,
}

/// One texel.
fn look(case: &Case<'_>, lobes: &Lobes, texel: usize, seed: u64) -> Watch {
    let mut watch = Watch::default();
    let point = case.table.grid.texel(texel);
    walks(case, texel, seed, &mut watch);
    let mut groups: Vec<Group> = Vec::new();
    for (c, role) in case.spec().roles().into_iter().enumerate() {
        let Some(lobe) = role.lobe() else { continue };
        let view = lobes.view(lobe, point.values());
        let Some(channel) = Linear::of(role, case.spec(), view, point.values()) else { continue };
        let side = channel.side;
        if let Some(group) = groups.iter_mut().find(|g| g.lobe == lobe && g.side == side) {
            group.channels.push((c, channel));
            continue;
        }
        let Some(model) = lobes.build(lobe, point.values(), side) else { continue };
        let model = (model.mirror(view.mu).is_none() && view.mu >= 1e-6).then_some(model);
        groups.push(Group { lobe, side, model, view, channels: vec![(c, channel)] });
    }
    for Group { model, view, channels, .. } in groups {
        let Some(model) = model else {
            let why = || "a mirror, or a view in the horizon, has no density to sample".to_owned();
            channels.iter().for_each(|_| watch.miss(why));
            continue;
        };
        let (numbers, channels): (Vec<usize>, Vec<Linear>) = channels.into_iter().unzip();
        for ((c, channel), s) in numbers.iter().zip(&channels).zip(sampled(&*model, view, &channels, seed)) {
            let (v, e) = case.at(texel, *c);
            let unseen = UNSEEN * channel.terms.iter().map(|(_, factor)| factor.abs()).fold(0.0, f64::max);
            watch.see(6.0 * s.standard_error + e + unseen - (v - s.mean).abs(), || {
                let id = &case.table.channels[*c].id;
                let place = place(&case.table.grid, texel);
                format!("{id} = {v:.6} against {:.6} +- {:.1e}, {place}", s.mean, s.standard_error)
            });
        }
    }
    watch
}

/// Compares the albedo of a layer of fibres with random walks.
fn walks(case: &Case<'_>, texel: usize, seed: u64, watch: &mut Watch) {
    let spec = case.spec();
    let point = case.table.grid.texel(texel);
    for (c, channel) in spec.layout.channels.iter().enumerate() {
        let Role::FibreAlbedo(scale) = channel.role else { continue };
        let Ok(r) = spec.number("r", point.values()) else { continue };
        let Some(mu) = spec.axis("mu").map(|i| point.values()[i]) else { continue };
        let found = walk::reflected(r * r, mu, WALKS, seed);
        // a part of n walks that is near 0 or 1 still has the spread of one walk
        let n = f64::from(WALKS);
        let spread = ((found * (1.0 - found)).max(1.0 / n) / n).sqrt();
        let code = |r: f64| scale.map_or(r, |scale| (r / scale).min(1.0));
        let (v, e) = case.at(texel, c);
        let apart = (v - code(found)).abs();
        watch.see(6.0 * spread / scale.unwrap_or(1.0) + e - apart, || {
            let place = place(&case.table.grid, texel);
            format!("{} = {v:.6} against {:.6} +- {spread:.1e}, {place}", channel.id, code(found))
        });
    }
}
