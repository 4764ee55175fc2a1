//! The laws of a model over its declared domain, without any table: reciprocity error and largest albedo, with their
//! places, against what the model claims. `brdfbake laws` prints it.

use super::seeds::Seeds;
use crate::cancel::{Cancel, Cancelled};
use crate::math::frame;
use crate::models::{Brdf, Kind, ModelInfo, Params};
use crate::tables::integral::{Functional, integrate};
use serde::Serialize;
use std::f64::consts::TAU;

/// View cosines at which the albedo is taken, down to 89.95 degrees.
pub const COSINES: [f64; 9] = [1.0, 0.9, 0.7, 0.5, 0.3, 0.1, 0.03, 0.005, 0.000_872_664_5];

/// Absolute tolerance of the albedos.
const TOLERANCE: f64 = 1e-4;

/// Pairs of directions for each set of parameters.
const PAIRS: usize = 64;

/// Relative difference that rounding may cause between f(wo, wi) and f(wi, wo).
pub(in crate::verify) const RECIPROCAL: f64 = 1e-9;

/// Values below this are what is left of a vanished tail.
const NEGLIGIBLE: f64 = 1e-20;

/// A number and the parameters and directions where it was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Surveyed {
    /// The number.
    pub value: f64,
    /// Where.
    pub at: String,
}

/// What was found for one model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Survey {
    /// Model id.
    pub model: &'static str,
    /// Largest relative difference of f(wo, wi) and f(wi, wo).
    pub reciprocity: Surveyed,
    /// Largest directional albedo; NaN if none could be integrated.
    pub largest_e: Surveyed,
    /// Values that are negative or not finite.
    pub faulty: Option<Surveyed>,
    /// Claims that do not hold, and laws that hold although not claimed.
    pub verdict: Verdict,
    /// The verdict in words.
    pub words: String,
}

/// How the findings compare with the claims.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// All laws are claimed, and hold.
    Lawful,
    /// A law is broken, and the model says so.
    KnownBreach,
    /// A claimed law is broken: a defect.
    Defect,
}

/// Surveys a model: its default parameters, and each number at both ends of its range and in between.
#[must_use]
pub fn survey(info: &'static ModelInfo) -> Survey {
    match survey_until(&Cancel::new(), info) {
        Ok(survey) => survey,
        Err(Cancelled) => unreached(info),
    }
}

/// A model of which nothing is known yet.
fn unreached(info: &'static ModelInfo) -> Survey {
    let nothing = |value| Surveyed { value, at: "nowhere".to_owned() };
    Survey {
        model: info.id,
        reciprocity: nothing(0.0),
        largest_e: nothing(f64::NAN),
        faulty: None,
        verdict: Verdict::Lawful,
        words: String::new(),
    }
}

/// [`survey`], until it is stopped.
///
/// # Errors
/// [`Cancelled`].
pub fn survey_until(cancel: &Cancel, info: &'static ModelInfo) -> Result<Survey, Cancelled> {
    let mut s = unreached(info);
    for (label, params) in parameter_sets(info) {
        if let Ok(model) = (info.build)(&params) {
            pairs(&*model, &label, &mut s);
            albedos(cancel, &*model, &label, &mut s)?;
        }
    }
    judge(info, &mut s);
    Ok(s)
}

fn pairs(model: &dyn Brdf, label: &str, s: &mut Survey) {
    let mut seeds = Seeds::new(0x1a35);
    for _ in 0..PAIRS {
        let mut direction = || frame::spherical(libm::acos(seeds.unit()), TAU * seeds.unit());
        let (a, b) = (direction(), direction());
        let (forth, back) = (model.eval(a, b), model.eval(b, a));
        let at = || format!("{label}, mu {:.3} and {:.3}", a.z, b.z);
        if !(forth.is_finite() && forth >= 0.0) {
            s.faulty.get_or_insert(Surveyed { value: forth, at: at() });
        }
        let scale = forth.abs().max(back.abs());
        let difference = (forth - back).abs() / scale;
        if scale > NEGLIGIBLE && difference > s.reciprocity.value {
            s.reciprocity = Surveyed { value: difference, at: at() };
        }
    }
}

fn albedos(cancel: &Cancel, model: &dyn Brdf, label: &str, s: &mut Survey) -> Result<(), Cancelled> {
    for mu in COSINES {
        cancel.check()?;
        let Ok(e) = integrate(model, mu, &[Functional::One], TOLERANCE) else { continue };
        // an estimate that stays large (a divergence, a stiff corner) proves nothing
        let lower = e.value[0] - e.error[0];
        if e.value[0].is_finite()
            && (s.largest_e.value.is_nan() || lower > s.largest_e.value)
            && e.error[0] < 0.1 * e.value[0].max(1e-3)
        {
            s.largest_e = Surveyed { value: e.value[0], at: format!("{label}, mu {mu:.4}") };
        }
    }
    Ok(())
}

fn judge(info: &ModelInfo, s: &mut Survey) {
    let mut defects = Vec::new();
    let mut breaches = Vec::new();
    let mut law = |claimed: bool, holds: bool, what: &str| match (claimed, holds) {
        (true, false) => defects.push(format!("claims to be {what}")),
        (false, false) => breaches.push(format!("not {what}")),
        (false, true) => breaches.push(format!("not {what} (not seen here)")),
        (true, true) => {}
    };
    law(info.laws.reciprocal, s.reciprocity.value <= RECIPROCAL, "reciprocal");
    law(
        info.laws.passive,
        s.largest_e.value.is_nan() || s.largest_e.value <= 1.0 + 2.0 * TOLERANCE,
        "passive",
    );
    if let Some(f) = &s.faulty {
        defects.push(format!("value {} at {}", f.value, f.at));
    }
    s.verdict = match (defects.is_empty(), breaches.is_empty()) {
        (false, _) => Verdict::Defect,
        (true, false) => Verdict::KnownBreach,
        (true, true) => Verdict::Lawful,
    };
    s.words = match s.verdict {
        Verdict::Defect => format!("DEFECT: {}", defects.join(", ")),
        Verdict::KnownBreach => format!("known: {}", breaches.join(", ")),
        Verdict::Lawful => "lawful".to_owned(),
    };
}

/// The parameters at which a model is surveyed, with their words: the defaults, then each number in turn at its ends and
/// between; ranges over decades are walked in logarithms.
#[must_use]
pub fn parameter_sets(info: &'static ModelInfo) -> Vec<(String, Params)> {
    let Ok(defaults) = Params::resolve(info.id, info.params, []) else { return Vec::new() };
    let mut sets = vec![("defaults".to_owned(), defaults.clone())];
    for param in info.params {
        let Kind::Number { min, max, .. } = param.kind else { continue };
        let Ok(before) = defaults.number(param.id) else { continue };
        for value in walk(min, max) {
            let mut params = defaults.clone();
            params.set(param.id, value);
            // parameters that follow this one by default go on following it
            for other in info.params.iter().filter(|p| follows(p, param.id)) {
                if params.number(other.id).is_ok_and(|v| (v - before).abs() == 0.0) {
                    params.set(other.id, value);
                }
            }
            sets.push((format!("{} = {value}", param.id), params));
        }
    }
    sets
}

fn follows(param: &crate::models::Param, id: &str) -> bool {
    matches!(param.kind, Kind::Number { preset: crate::models::DefaultValue::Of(of), .. } if of == id)
}

fn walk(min: f64, max: f64) -> Vec<f64> {
    let top = max.min(1.0);
    if min >= 0.0 && max <= 2.0 {
        // widths and reflectances
        return [0.02, 0.1, 0.3, 0.5, 0.7, 1.0].iter().copied().filter(|v| (min..=top).contains(v)).collect();
    }
    [min, 1.1, 3.0, 10.0, 100.0, 1000.0]
        .iter()
        .copied()
        .filter(|v| (min..=max).contains(v) && v.is_finite())
        .collect()
}
