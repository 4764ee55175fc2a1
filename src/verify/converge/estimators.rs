//! The methods: the baker's own rule, and samplers.

use super::{Asked, ConvergeError, LEAST_POWER};
use crate::integrate::View;
use crate::integrate::sobol::Sobol;
use crate::math::sum::Sum;
use crate::models::Brdf;
use crate::tables::Role;
use crate::tables::role::{Light, Side};
use crate::tables::spec::Bound;
use crate::verify::baseline::hammersley_f32;
use crate::verify::linear::Linear;
use crate::verify::lobes::Lobes;
use crate::verify::seeds::Seeds;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use std::time::Instant;

/// A method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    /// The rule of the baker at falling tolerances.
    Adaptive,
    /// The sampler of the model at scrambled Sobol points.
    Sobol,
    /// The sampler of the model at independent points.
    Independent,
    /// D-sampling at Hammersley points in f32, as most bakers of split sums have it.
    Hammersley,
    /// Cosine-weighted directions at scrambled Sobol points.
    Cosine,
}

const ALL: [Method; 5] =
    [Method::Adaptive, Method::Sobol, Method::Independent, Method::Hammersley, Method::Cosine];

impl Method {
    pub(super) const fn id(self) -> &'static str {
        match self {
            Method::Adaptive => "adaptive",
            Method::Sobol => "visible-normals-sobol",
            Method::Independent => "visible-normals-independent",
            Method::Hammersley => "hammersley-f32",
            Method::Cosine => "cosine-sobol",
        }
    }

    pub(super) const fn title(self) -> &'static str {
        match self {
            Method::Adaptive => "this baker, to a tolerance",
            Method::Sobol => "model's sampler, Sobol",
            Method::Independent => "model's sampler, random",
            Method::Hammersley => "D, Hammersley, f32",
            Method::Cosine => "cosine, Sobol",
        }
    }
}

/// Tolerances of the baker's rule.
const TOLERANCES: [f64; 19] = [
    1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 1e-9, 1e-10,
    1e-11, 1e-12,
];

/// Least cosine of a view that samplers are asked for.
const HORIZON: f64 = 1e-6;

/// A texel at every budget.
pub(super) struct Run {
    /// `[budget][channel]`.
    pub(super) values: Vec<Vec<f64>>,
    pub(super) evaluations: Vec<f64>,
    pub(super) seconds: Vec<f64>,
}

struct Texel {
    number: usize,
    at: Vec<f64>,
    model: Box<dyn Brdf>,
    view: View,
    channels: Vec<Linear>,
}

pub(super) struct Estimators<'a> {
    texels: Vec<Texel>,
    asked: Asked<'a>,
    /// Axis number of alpha where the table is that of the usual bakers: the split sum of white GGX, scale and bias.
    alpha: Option<[usize; 2]>,
}

impl<'a> Estimators<'a> {
    pub(super) fn new(
        bound: &Bound,
        numbers: &[usize],
        asked: Asked<'a>,
    ) -> Result<Estimators<'a>, ConvergeError> {
        let spec = &bound.spec;
        let lobes = Lobes::new(spec);
        let mut texels = Vec::new();
        for &number in numbers {
            let point = spec.grid.texel(number);
            let mut channels = Vec::new();
            let mut first = None;
            for info in &spec.layout.channels {
                let refused = || ConvergeError::NoIntegral { kind: spec.kind.id, channel: info.id };
                let lobe = info.role.lobe().ok_or_else(refused)?;
                let view = lobes.view(lobe, point.values());
                let linear = Linear::of(info.role, spec, view, point.values())
                    .filter(|l| l.side == Side::Above && l.light != Light::Transmitted)
                    .ok_or_else(refused)?;
                first.get_or_insert((lobe, view));
                channels.push(linear);
            }
            let Some((lobe, view)) = first else { continue };
            let model = lobes.build(lobe, point.values(), Side::Above);
            // light that crosses is drawn by no method here
            let crosses = model.as_ref().is_some_and(|m| m.transmission().is_some());
            if let Some(c) = channels.iter().position(|l| crosses && l.light == Light::All) {
                let channel = spec.layout.channels[c].id;
                return Err(ConvergeError::NoIntegral { kind: spec.kind.id, channel });
            }
            // a mirror has nothing to sample, and at the horizon a sampler has nothing to see
            let Some(model) = model.filter(|m| m.mirror(view.mu).is_none() && view.mu >= HORIZON) else {
                continue;
            };
            texels.push(Texel { number, at: point.values().to_vec(), model, view, channels });
        }
        Ok(Estimators { texels, asked, alpha: split_of_ggx(bound) })
    }

    /// Numbers of the texels that are looked at.
    pub(super) fn numbers(&self) -> Vec<usize> {
        self.texels.iter().map(|t| t.number).collect()
    }

    pub(super) fn methods(&self) -> impl Iterator<Item = Method> {
        let hammersley = self.alpha.is_some();
        ALL.into_iter().filter(move |m| *m != Method::Hammersley || hammersley)
    }

    pub(super) fn run(&self, method: Method, bound: &Bound) -> Result<Vec<Run>, ConvergeError> {
        let one = |texel: &Texel| {
            self.asked.cancel.check()?;
            Ok(match method {
                Method::Adaptive => adaptive(texel, bound)?,
                Method::Hammersley => self.hammersley(texel),
                _ => self.sampled(texel, method),
            })
        };
        self.texels.par_iter().map(one).collect()
    }

    fn budgets(&self) -> impl Iterator<Item = u32> {
        (LEAST_POWER..=self.asked.power).map(|k| 1u32 << k)
    }

    /// Sums of one run, told at every budget.
    fn sampled(&self, texel: &Texel, method: Method) -> Run {
        let wo = texel.view.direction();
        let seed = self.asked.seed ^ (texel.number as u64) << 20;
        let (sobol, mut seeds) = (Sobol::new(seed), Seeds::new(seed));
        let mut sums = vec![Sum::default(); texel.channels.len()];
        let mut run = Run { values: Vec::new(), evaluations: Vec::new(), seconds: Vec::new() };
        let start = Instant::now();
        let mut drawn = 0;
        for budget in self.budgets() {
            for i in drawn..budget {
                let u = match method {
                    Method::Independent => DVec2::new(seeds.unit(), seeds.unit()),
                    _ => sobol.point(i),
                };
                let (weight, v) = match method {
                    Method::Cosine => cosine(&*texel.model, wo, u),
                    _ => drawn_by(&*texel.model, wo, u),
                };
                for (sum, channel) in sums.iter_mut().zip(&texel.channels) {
                    sum.add(weight * channel.terms.iter().map(|(g, factor)| factor * g.at(v)).sum::<f64>());
                }
            }
            drawn = budget;
            let mean = |(sum, c): (&Sum, &Linear)| c.constant + sum.total() / f64::from(budget);
            run.values.push(sums.iter().zip(&texel.channels).map(mean).collect());
            run.evaluations.push(f64::from(budget));
            run.seconds.push(start.elapsed().as_secs_f64());
            if self.asked.cancel.is_set() {
                break;
            }
        }
        run
    }

    #[allow(clippy::cast_possible_truncation, reason = "others compute in f32")]
    fn hammersley(&self, texel: &Texel) -> Run {
        let mut run = Run { values: Vec::new(), evaluations: Vec::new(), seconds: Vec::new() };
        let [mu, alpha] = self.alpha.unwrap_or_default().map(|i| texel.at[i] as f32);
        for budget in self.budgets().take_while(|_| !self.asked.cancel.is_set()) {
            let start = Instant::now();
            let [scale, bias] = hammersley_f32(mu, alpha, budget).map(f64::from);
            run.seconds.push(start.elapsed().as_secs_f64());
            run.values.push(vec![scale, bias]);
            run.evaluations.push(f64::from(budget));
        }
        run
    }
}

fn adaptive(texel: &Texel, bound: &Bound) -> Result<Run, ConvergeError> {
    let mut run = Run { values: Vec::new(), evaluations: Vec::new(), seconds: Vec::new() };
    for tolerance in TOLERANCES {
        let start = Instant::now();
        let e = bound.baker.texel(&texel.at, tolerance).map_err(|error| ConvergeError::Texel {
            at: crate::tables::place(&bound.spec.grid, texel.number),
            error,
        })?;
        run.seconds.push(start.elapsed().as_secs_f64());
        run.values.push(e.value[..texel.channels.len()].to_vec());
        run.evaluations.push(f64::from(e.evaluations));
    }
    Ok(run)
}

/// `f mu_i / pdf` of a draw of the model, and `wo . wh`.
fn drawn_by(model: &dyn Brdf, wo: DVec3, u: DVec2) -> (f64, f64) {
    match model.sample(wo, u) {
        Some(s) if s.pdf > 0.0 => (model.eval(wo, s.wi) * s.wi.z / s.pdf, half(wo, s.wi)),
        _ => (0.0, 1.0),
    }
}

/// The same of a direction drawn by its cosine.
fn cosine(model: &dyn Brdf, wo: DVec3, u: DVec2) -> (f64, f64) {
    let (s, c) = libm::sincos(TAU * u.y);
    let r = u.x.sqrt();
    let wi = DVec3::new(r * c, r * s, (1.0 - u.x).max(0.0).sqrt());
    (PI * model.eval(wo, wi), half(wo, wi))
}

fn half(wo: DVec3, wi: DVec3) -> f64 {
    (0.5 * (1.0 + wo.dot(wi))).max(0.0).sqrt()
}

/// Axes of mu and alpha, if the channels are scale and bias of GGX with correlated masking, over these two alone.
pub(crate) fn split_of_ggx(bound: &Bound) -> Option<[usize; 2]> {
    let spec = &bound.spec;
    let (info, params) = spec.model.as_ref()?;
    let usual = info.id == "ggx" && params.choice("masking").map_or(true, |m| m == "correlated");
    let ids = spec.layout.ids().eq(["dfg.scale", "dfg.bias"]);
    let split = spec.roles().iter().all(|r| matches!(r, Role::Split(..)));
    (usual && ids && split && spec.grid.axes().len() == 2).then_some(())?;
    Some([spec.axis("mu")?, spec.axis("alpha")?])
}
