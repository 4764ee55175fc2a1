//! Every value that a model's entry claims to be known, through the public interface.
#![allow(clippy::unwrap_used, reason = "test")]

use crate::tolerance::{DIGIT_LOST, LIMIT_NEAR, RECIPROCITY, near};
use brdfbake::integrate::View;
use brdfbake::math::frame;
use brdfbake::models::{Kind, KnownValue, MODELS, ModelInfo, ParamError, Params};
use brdfbake::tables::TexelError;
use brdfbake::tables::integral::{Functional, integrate};
use brdfbake::verify::seeds::Seeds;
use rayon::prelude::*;
use serde_json::{Map, Value};
use std::f64::consts::TAU;

fn params(info: &'static ModelInfo, set: &[(&str, &str)]) -> Params {
    let map: Map<String, Value> =
        set.iter().map(|(k, v)| ((*k).to_owned(), serde_json::from_str(v).unwrap())).collect();
    Params::resolve(info.id, info.params, map.iter().map(|(k, v)| (k.as_str(), v))).unwrap()
}

#[test]
fn known_values_are_reproduced() {
    for info in MODELS {
        for known in info.known {
            let model = (info.build)(&params(info, known.params)).unwrap();
            let what = format!("{} {:?} {:?}", info.id, known.what, known.params);
            let got = match known.what {
                KnownValue::Value([ti, pi, to, po]) => {
                    model.eval(frame::spherical(to, po), frame::spherical(ti, pi))
                }
                KnownValue::Albedo(mu) => {
                    // by the chart and, where there is one, by the reduction
                    let tolerance = (0.1 * known.relative * known.value).max(1e-13);
                    let both = [Functional::One, Functional::One];
                    let chart = integrate(&*model, mu, &both, tolerance).unwrap();
                    let reduced = integrate(&*model, mu, &[Functional::One], tolerance).unwrap();
                    let apart = (chart.value[0] - reduced.value[0]).abs();
                    assert!(
                        apart <= chart.error[0] + reduced.error[0] + DIGIT_LOST,
                        "{what}: chart and reduction {apart:e}"
                    );
                    let slack = 1e-12 * known.value;
                    let off = (chart.value[0] - known.value).abs();
                    assert!(off <= chart.error[0] + slack, "{what}: {off:e}, estimate {:e}", chart.error[0]);
                    if reduced.error[0] < chart.error[0] { reduced.value[0] } else { chart.value[0] }
                }
            };
            let error = (got - known.value).abs() / known.value.abs();
            assert!(
                error <= known.relative,
                "{what}: got {got:.17}, expected {:.17}, off by {error:e}",
                known.value
            );
        }
    }
}

/// A parameter set at random: widths not below 0.05 and exponents not above 500, where rounding is not magnified.
fn random(info: &'static ModelInfo, seeds: &mut Seeds) -> Params {
    let mut params = Params::resolve(info.id, info.params, []).unwrap();
    for p in info.params {
        if let Kind::Number { min, max, .. } = p.kind {
            let u = seeds.unit();
            let value = if max > 100.0 { libm::pow(500.0, u) - 1.0 + min } else { min + (max - min) * u };
            params.set(p.id, if p.id.starts_with("alpha") { value.max(0.05) } else { value });
        }
    }
    params
}

#[test]
fn every_model_holds_the_laws_that_it_claims() {
    MODELS.par_iter().enumerate().for_each(|(i, info)| {
        let mut seeds = Seeds::new(7 + i as u64);
        let mut sets: Vec<Params> = Vec::new();
        for alpha in ["0.01", "0.1", "0.5", "1"] {
            let has_alpha = info.params.iter().any(|p| p.id == "alpha");
            let set: &[(&str, &str)] = if has_alpha { &[("alpha", alpha)] } else { &[] };
            sets.push(params(info, set));
        }
        sets.extend((0..12).map(|_| random(info, &mut seeds)));
        for params in sets {
            let what = format!("{} {:?}", info.id, params.values());
            let model = match (info.build)(&params) {
                Err(ParamError::Together { .. }) => continue,
                model => model.unwrap(),
            };
            for _ in 0..200 {
                let mut direction = || frame::spherical(1.55 * seeds.unit(), TAU * seeds.unit());
                let (a, b) = (direction(), direction());
                let (forth, back) = (model.eval(a, b), model.eval(b, a));
                assert!(forth.is_finite() && forth >= 0.0, "{what}: f = {forth}");
                if info.laws.reciprocal {
                    let scale = forth.abs().max(back.abs()).max(1e-20);
                    near!(forth, back, RECIPROCITY * scale, "{what}: {forth} {back}");
                }
            }
            for mu in [0.0, 1e-3, 0.05, 0.3, 0.7, 1.0] {
                let view = View { mu, phi: TAU * seeds.unit() };
                let e = match integrate(&*model, view, &[Functional::One], 1e-4) {
                    // some of those that are not passive have an infinite albedo at grazing, and say so
                    Err(TexelError::NotFinite { .. }) if mu <= 0.0 && !info.laws.passive => continue,
                    e => e.unwrap_or_else(|e| panic!("{what} {view:?}: {e}")),
                };
                if info.laws.passive {
                    assert!(e.value[0] <= 1.0 + e.error[0], "{what} {view:?}: E = {}", e.value[0]);
                }
                if info.laws.isotropic {
                    assert!(!model.turns(), "{what} turns");
                }
            }
        }
    });
}

#[test]
fn a_model_that_is_not_passive_is_known_not_to_be() {
    // Cook-Torrance as printed is four times the modern form: E -> 4 at small alpha
    let info = MODELS.iter().find(|m| m.id == "cook-torrance-1982").unwrap();
    let model = (info.build)(&params(info, &[("alpha", "0.05")])).unwrap();
    let e = integrate(&*model, 1.0, &[Functional::One], 1e-3).unwrap();
    near!(e.value[0], 4.0, LIMIT_NEAR, "{}", e.value[0]);
}

#[test]
fn no_model_breaks_a_law_that_it_claims() {
    use brdfbake::verify::survey::{Verdict, survey};
    for info in MODELS {
        let s = survey(info);
        assert_ne!(s.verdict, Verdict::Defect, "{}: {}", info.id, s.words);
        assert!(info.laws.passive || s.verdict == Verdict::KnownBreach, "{}: {}", info.id, s.words);
    }
}
