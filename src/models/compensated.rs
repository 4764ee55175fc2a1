//! The body of microfacet models whose multiple scattering is given back: any single-scattering lobe, and a rule.
//!
//! The white albedo of the lobe is a curve made when the model is built; 1 - E of the curve and its average are consistent, so
//! a white surface reflects everything to the accuracy of the curve.

use super::albedo_curve::{AlbedoCurve, TOLERANCE};
use super::integral::directional_albedo;
use super::lobes::{Diffuse, Part, Reflector, Sum};
use super::microfacet::MASKING;
use super::{Brdf, DefaultValue, Functional, Param, ParamError, Params, Sample, microfacet};
use crate::integrate::{BATCH, Chart, Estimate, Nodes};
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
    DefaultValue::Value(4.0),
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
        /// How much it changes with `E_avg`.
        slope: f64,
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

/// Builds the single-scattering lobe, its white curve, and what the rule adds or multiplies.
pub(super) fn build(
    model: &'static str,
    params: &Params,
    make: fn(&Params, &Parts) -> Result<Rule, ParamError>,
) -> Result<Box<dyn Brdf>, ParamError> {
    let single = lobe(model, params, None)?;
    if single.mirror(1.0).is_some() {
        // a mirror loses nothing
        return Ok(single);
    }
    let white = AlbedoCurve::shared(&key(params, true)?, &*lobe(model, params, Some(1.0))?, TOLERANCE);
    let rule = make(params, &Parts { single: &*single, white: &white, key: key(params, false)? })?;
    if let Rule::Turquin { f0 } = rule {
        return Ok(Box::new(Scaled { single, white, f0 }));
    }
    let average = white.missing_average();
    let single = Part { weight: 1.0, chance: 1.0 - average, lobe: single };
    let added = Part { weight: 1.0, chance: average, lobe: Box::new(Diffuse(Added { white, rule })) };
    Ok(Box::new(Sum::new(vec![single, added])))
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
    pub(super) fn coloured(&self) -> Arc<AlbedoCurve> {
        AlbedoCurve::shared(&self.key, self.single, TOLERANCE)
    }
}

/// Schlick's average of the parameters.
///
/// # Errors
/// [`ParamError`] where `f0` or `f90` are not declared.
pub(super) fn f_avg(params: &Params) -> Result<f64, ParamError> {
    Ok(schlick::schlick_average(params.number("f0")?, params.number("f90")?))
}

/// The base model, white if `fresnel` says so.
fn lobe(model: &'static str, params: &Params, fresnel: Option<f64>) -> Result<Box<dyn Brdf>, ParamError> {
    let base = params.choice("base")?;
    let (info, _) = super::find(base)
        .ok_or_else(|| ParamError::Together { model, why: format!("no model is called {base}") })?;
    let number = |id: &str| Ok((id.to_owned(), Json::from(params.number(id)?)));
    let mut given: serde_json::Map<String, Json> =
        [number("alpha")?, number("f0")?, number("f90")?].into_iter().collect();
    given.insert("masking".to_owned(), params.choice("masking")?.into());
    if base == "student-t" {
        given.extend([number("gamma")?]);
    }
    if let Some(f) = fresnel {
        given.insert("f0".to_owned(), f.into());
        given.insert("f90".to_owned(), f.into());
    }
    let resolved = Params::resolve(info.id, info.params, given.iter().map(|(k, v)| (k.as_str(), v)))?;
    (info.build)(&resolved)
}

/// Names the lobe in full.
fn key(params: &Params, white: bool) -> Result<String, ParamError> {
    let [alpha, gamma, f0, f90] = params.numbers(["alpha", "gamma", "f0", "f90"])?;
    let (f0, f90) = if white { (1.0, 1.0) } else { (f0, f90) };
    let (base, masking) = (params.choice("base")?, params.choice("masking")?);
    let gamma = if base == "student-t" { gamma } else { 0.0 };
    Ok(format!("{base} {masking} {alpha:e} {gamma:e} {f0:e} {f90:e}"))
}

/// The lobe that Kulla-Conty and Fdez-Aguera add.
#[derive(Debug)]
struct Added {
    white: Arc<AlbedoCurve>,
    rule: Rule,
}

impl Added {
    fn missing(&self, mu: f64) -> f64 {
        self.white.missing(mu).max(0.0)
    }
}

impl Reflector for Added {
    fn f(&self, wo: DVec3, wi: DVec3) -> f64 {
        match &self.rule {
            Rule::KullaConty { colour, .. } => {
                let average = self.white.missing_average();
                colour * ms::kulla_conty(self.missing(wo.z), self.missing(wi.z), average)
            }
            _ => FRAC_1_PI * self.albedo(wo.z).unwrap_or(0.0),
        }
    }

    fn albedo(&self, mu_o: f64) -> Option<f64> {
        let missing = self.missing(mu_o);
        Some(match &self.rule {
            Rule::KullaConty { colour, .. } => colour * missing,
            Rule::Turquin { .. } => 0.0,
            Rule::FdezAguera { f_avg, coloured } => {
                coloured.albedo(mu_o) * f_avg * missing / (1.0 - f_avg * missing)
            }
        })
    }

    /// What is missing is known to the error of its curve, and so are the colours, to first order.
    fn own_error(&self, mu_o: f64) -> f64 {
        let (missing, error) = (self.missing(mu_o), self.white.error_at(mu_o));
        match &self.rule {
            Rule::KullaConty { colour, slope } => {
                colour * error + slope * missing * self.white.average_error()
            }
            Rule::Turquin { .. } => 0.0,
            Rule::FdezAguera { f_avg, coloured } => {
                let rest = 1.0 - f_avg * missing;
                let e = coloured.albedo(mu_o);
                f_avg / rest * (coloured.error_at(mu_o) * missing + e * error / rest)
            }
        }
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Broad { kinks: false, floor: 0.0 })
    }
}

/// Turquin's: the lobe times a factor of the view.
#[derive(Debug)]
struct Scaled {
    single: Box<dyn Brdf>,
    white: Arc<AlbedoCurve>,
    f0: f64,
}

impl Scaled {
    fn factor(&self, mu_o: f64) -> f64 {
        ms::turquin(self.f0, self.white.albedo(mu_o))
    }
}

impl Brdf for Scaled {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.single.eval(wo, wi) * self.factor(wo.z)
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        self.single.sample(wo, u)
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.single.pdf(wo, wi)
    }

    fn chart(&self) -> Option<Chart> {
        self.single.chart()
    }

    fn eval_nodes(&self, nodes: &Nodes, out: &mut [f64; BATCH]) {
        self.single.eval_nodes(nodes, out);
        let factor = self.factor(nodes.mu_o);
        out[..nodes.len].iter_mut().for_each(|o| *o *= factor);
    }

    fn reduced(&self, mu_o: f64, functionals: &[Functional], tolerance: f64) -> Option<Estimate> {
        let [Functional::One] = functionals else { return None };
        let factor = self.factor(mu_o);
        let single = directional_albedo(&*self.single, mu_o, tolerance / factor);
        let mut e = Estimate::ZERO;
        e.add(factor, &single);
        e.error[0] += self.own_error(mu_o);
        Some(e)
    }

    /// The factor is `1 + F0 (1 / E - 1)`, times at most E.
    fn own_error(&self, mu_o: f64) -> f64 {
        self.f0 * self.white.error_at(mu_o) / self.white.albedo(mu_o).max(f64::MIN_POSITIVE)
    }
}
