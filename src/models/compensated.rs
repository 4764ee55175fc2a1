//! The body of microfacet models whose multiple scattering is given back: any single-scattering lobe, and a rule.
//!
//! The white albedo of the lobe is a curve made when the model is built; 1 - E of the curve and its average are consistent, so
//! a white surface reflects everything to the accuracy of the curve.

use super::albedo_curve::{AlbedoCurve, directional_albedo};
use super::microfacet::MASKING;
use super::{Brdf, Param, ParamError, Params, Preset, Sample, microfacet};
use crate::integrate::{BATCH, Chart, Estimate, Nodes};
use crate::math::{frame, special};
use crate::terms::multiple_scattering as ms;
use crate::terms::schlick;
use glam::{DVec2, DVec3};
use serde_json::Value as Json;
use std::f64::consts::FRAC_1_PI;
use std::sync::Arc;

/// Parameters of every compensated model.
pub(super) const PARAMS: &[Param] =
    &[BASE, microfacet::ALPHA, GAMMA, microfacet::F0, microfacet::F90, MASKING];

/// The same and the colour of Kulla and Conty.
pub(super) const PARAMS_WITH_COLOUR: &[Param] =
    &[BASE, microfacet::ALPHA, GAMMA, microfacet::F0, microfacet::F90, MASKING, COLOUR];

const BASE: Param = Param::choice(
    "base",
    "the single-scattering lobe, a model of this name",
    &["ggx", "beckmann", "student-t"],
);
const GAMMA: Param = Param::number(
    "gamma",
    "gamma",
    "exponent of the tail, for base = student-t only",
    [1.501, 1e8],
    Preset::Value(4.0),
);
const COLOUR: Param = Param::choice(
    "colour",
    "F_avg^2 E_avg / (1 - F_avg (1 - E_avg)), the series of bounces; or as on the slides, with F_avg in place of its square",
    &["series", "slides"],
);

/// How the missing energy is given back.
#[derive(Debug)]
pub(super) enum Rule {
    /// `f_s + F_ms (1 - E_o)(1 - E_i) / (pi (1 - E_avg))`.
    KullaConty {
        /// `F_ms`.
        colour: f64,
    },
    /// `f_s (1 + F0 (1 - E_o) / E_o)`.
    Turquin {
        /// F0.
        f0: f64,
    },
    /// `f_s + F_ms E_ms / pi`, both of the view cosine.
    FdezAguera {
        /// Average Fresnel factor.
        f_avg: f64,
        /// Albedo of `f_s` with its Fresnel factor.
        coloured: Arc<AlbedoCurve>,
    },
}

/// A lobe with a rule.
#[derive(Debug)]
struct Compensated {
    single: Box<dyn Brdf>,
    white: Arc<AlbedoCurve>,
    rule: Rule,
}

/// Builds the single-scattering lobe, its white curve, and the rule that `make` chooses.
pub(super) fn build(
    model: &'static str,
    params: &Params,
    make: fn(&Params, &Parts) -> Option<Rule>,
) -> Result<Box<dyn Brdf>, ParamError> {
    let single = lobe(model, params, None)?;
    if single.mirror(1.0).is_some() {
        // a mirror loses nothing
        return Ok(single);
    }
    let no_chart =
        || ParamError::Together { model, why: "the single-scattering lobe declares no chart".to_owned() };
    let white_lobe = lobe(model, params, Some(1.0))?;
    let white = AlbedoCurve::shared(&key(params, true), &*white_lobe).ok_or_else(no_chart)?;
    let parts = Parts { single: &*single, white: &white, key: key(params, false) };
    let rule = make(params, &parts).ok_or_else(no_chart)?;
    Ok(Box::new(Compensated { single, white, rule }))
}

/// What a rule is made from.
#[derive(Debug)]
pub(super) struct Parts<'a> {
    single: &'a dyn Brdf,
    white: &'a AlbedoCurve,
    key: String,
}

impl Parts<'_> {
    /// The white average albedo.
    pub(super) fn e_avg(&self) -> f64 {
        1.0 - self.white.missing_average()
    }

    /// The curve of the lobe with its Fresnel factor.
    pub(super) fn coloured(&self) -> Option<Arc<AlbedoCurve>> {
        AlbedoCurve::shared(&self.key, self.single)
    }
}

/// Schlick's average of the parameters.
pub(super) fn f_avg(params: &Params) -> f64 {
    schlick::schlick_average(params.number("f0"), params.number("f90"))
}

/// The base model, white if `fresnel` says so.
fn lobe(model: &'static str, params: &Params, fresnel: Option<f64>) -> Result<Box<dyn Brdf>, ParamError> {
    let base = params.choice("base");
    let (info, _) = super::find(base)
        .ok_or_else(|| ParamError::Together { model, why: format!("no model is called {base}") })?;
    let number = |id: &str| (id.to_owned(), Json::from(params.number(id)));
    let mut given: serde_json::Map<String, Json> =
        [number("alpha"), number("f0"), number("f90")].into_iter().collect();
    given.insert("masking".to_owned(), params.choice("masking").into());
    if base == "student-t" {
        given.extend([number("gamma")]);
    }
    if let Some(f) = fresnel {
        given.insert("f0".to_owned(), f.into());
        given.insert("f90".to_owned(), f.into());
    }
    let resolved = Params::resolve(info.id, info.params, given.iter().map(|(k, v)| (k.as_str(), v)))?;
    (info.build)(&resolved)
}

/// Names the lobe in full.
fn key(params: &Params, white: bool) -> String {
    let [alpha, gamma, f0, f90] = ["alpha", "gamma", "f0", "f90"].map(|id| params.number(id));
    let (f0, f90) = if white { (1.0, 1.0) } else { (f0, f90) };
    let (base, masking) = (params.choice("base"), params.choice("masking"));
    let gamma = if base == "student-t" { gamma } else { 0.0 };
    format!("{base} {masking} {alpha:e} {gamma:e} {f0:e} {f90:e}")
}

impl Compensated {
    /// Factor of the single-scattering lobe, and what is added to it, as a function of `mu_i`.
    fn factor(&self, mu_o: f64) -> f64 {
        match self.rule {
            Rule::Turquin { f0 } => ms::turquin(f0, self.white.albedo(mu_o)),
            _ => 1.0,
        }
    }

    /// The added lobe is `self.height(mu_o) g(mu_i)`.
    fn height(&self, mu_o: f64) -> f64 {
        let missing = self.white.missing(mu_o).max(0.0);
        match &self.rule {
            Rule::KullaConty { colour } => {
                colour * ms::kulla_conty(missing, 1.0, self.white.missing_average())
            }
            Rule::Turquin { .. } => 0.0,
            Rule::FdezAguera { .. } => FRAC_1_PI * self.multiple(mu_o),
        }
    }

    fn g(&self, mu_i: f64) -> f64 {
        match self.rule {
            Rule::KullaConty { .. } => self.white.missing(mu_i).max(0.0),
            _ => 1.0,
        }
    }

    /// Albedo of the added lobe, exactly.
    fn multiple(&self, mu_o: f64) -> f64 {
        let missing = self.white.missing(mu_o).max(0.0);
        match &self.rule {
            Rule::KullaConty { colour } => colour * missing,
            Rule::Turquin { .. } => 0.0,
            Rule::FdezAguera { f_avg, coloured } => {
                coloured.albedo(mu_o) * f_avg * missing / (1.0 - f_avg * missing)
            }
        }
    }

    /// Share of the samples that go to the single-scattering lobe.
    fn share(&self, mu_o: f64) -> f64 {
        (1.0 - self.multiple(mu_o)).clamp(0.05, 1.0)
    }
}

impl Brdf for Compensated {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if !frame::both_above(wo, wi) {
            return 0.0;
        }
        self.single.eval(wo, wi) * self.factor(wo.z) + self.height(wo.z) * self.g(wi.z)
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let share = self.share(wo.z);
        let wi = if u.x < share {
            self.single.sample(wo, DVec2::new(u.x / share, u.y))?.wi
        } else {
            let x = (u.x - share) / (1.0 - share);
            let (cos, sin) = special::circle(u.y);
            let r = x.sqrt();
            DVec3::new(r * cos, r * sin, (1.0 - x).max(0.0).sqrt())
        };
        (wi.z > 0.0).then(|| Sample { wi, pdf: self.pdf(wo, wi) })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        if !frame::both_above(wo, wi) {
            return 0.0;
        }
        let share = self.share(wo.z);
        share * self.single.pdf(wo, wi) + (1.0 - share) * wi.z * FRAC_1_PI
    }

    /// That of the lobe, without an end: the added lobe covers the hemisphere.
    fn chart(&self) -> Option<Chart> {
        match self.single.chart()? {
            Chart::HalfVector { alpha, kinks, .. } => {
                Some(Chart::HalfVector { alpha, reach: f64::INFINITY, kinks })
            }
            other => Some(other),
        }
    }

    fn eval_nodes(&self, nodes: &Nodes, out: &mut [f64; BATCH]) {
        self.single.eval_nodes(nodes, out);
        let (factor, height) = (self.factor(nodes.mu_o), self.height(nodes.mu_o));
        for (o, mu_i) in out[..nodes.len].iter_mut().zip(&nodes.mu_i) {
            *o = *o * factor + height * self.g(*mu_i);
        }
    }

    /// The lobe's own, times the factor, plus that of the added lobe.
    fn reduced_albedo(&self, mu_o: f64, tolerance: f64) -> Option<Estimate> {
        let mut e = directional_albedo(&*self.single, mu_o, tolerance)?;
        let factor = self.factor(mu_o);
        e.value[0] = e.value[0] * factor + self.multiple(mu_o);
        e.error[0] = e.error[0] * factor + self.white.error();
        Some(e)
    }
}
