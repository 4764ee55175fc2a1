//! Sampled directions, against closed inverses and against the chart's albedo; the piecewise density.

use super::helpers::close;
use crate::tolerance::{
    DIGIT_LOST, DIGITS_LOST, DRAWN_FEW, FEW_ROUNDINGS, INTEGRAL_7_TWICE, INTEGRAL_9, MANY_ROUNDINGS, near,
};
use brdfbake::grid::{Axis, Quantity, Texel};
use brdfbake::integrate::density::Density;
use brdfbake::integrate::{Estimate, View};
use brdfbake::models::{self, Params};
use brdfbake::tables::importance::marginal;
use brdfbake::tables::integral::{Functional, integrate};
use brdfbake::tables::spec::{Bound, Request};
use brdfbake::verify;
use std::f64::consts::{PI, TAU};

fn table(model: &str, params: &str, layout: &str, more: &[&str]) -> Bound {
    let axis = |id: &&str| Axis::new(Quantity::find(id).unwrap(), 4, Texel::Center);
    Request {
        kind: "importance".into(),
        model: Some(model.into()),
        layout: Some(layout.into()),
        channels: None,
        params: serde_json::from_str(params).unwrap(),
        axes: Some(["u", "v", "mu"].iter().chain(more).map(axis).collect()),
    }
    .bind()
    .unwrap()
}

fn texel(bound: &Bound, at: &[f64], tolerance: f64) -> Estimate {
    bound.baker.texel(at, tolerance).unwrap()
}

#[test]
fn a_piecewise_density_is_inverted() {
    // 3 x^2 on (0, 2), with a break: quantile 2 u^(1/3)
    let d = Density::new(&[0.0, 0.7, 2.0], 1e-12, &mut |x| (3.0 * x * x, 0.0, 1));
    close("total", d.total, 8.0, DIGIT_LOST);
    for u in [1e-9, 0.01, 0.3, 0.9, 1.0] {
        let (x, error) = d.quantile(u);
        close("cube root", x, 2.0 * libm::cbrt(u), DIGITS_LOST + error);
    }
    // a peak that needs halving: Cauchy, width 1e-3
    let w = 1e-3;
    let end = libm::atan(1.0 / w);
    for tolerance in [1e-3, 1e-6, 1e-10] {
        let d = Density::new(&[0.0, 1.0], tolerance / w, &mut |x| (1.0 / (x * x + w * w), 0.0, 1));
        close("peak", d.total * w, end, tolerance);
        near!(d.total * w, end, d.error * w + FEW_ROUNDINGS);
        for u in [0.1, 0.5, 0.99] {
            let (x, error) = d.quantile(u);
            close("peak", x, w * libm::tan(u * end), error + MANY_ROUNDINGS);
        }
    }
}

#[test]
fn a_matte_surface_is_sampled_by_the_cosine() {
    let bound = table("lambert", "{}", "angles", &[]);
    for (u, v) in [(0.1, 0.2), (0.5, 0.5), (0.9, 0.99)] {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let e = texel(&bound, &[u, v, 0.6], tolerance);
            close("mu_i", e.value[0], (1.0f64 - u).sqrt(), tolerance.min(e.error[0] + DIGIT_LOST));
            close("phi", e.value[1], TAU * v, tolerance.min(e.error[1] + DIGIT_LOST));
        }
    }
    let bound = table("lambert", "{}", "direction-pdf", &[]);
    let e = texel(&bound, &[0.3, 0.1, 0.6], 1e-9);
    close("pdf", e.value[3], 0.7f64.sqrt() / PI, INTEGRAL_9);
    close("x", e.value[0], 0.3f64.sqrt() * libm::cos(TAU * 0.1), INTEGRAL_9);
    close("y", e.value[1], 0.3f64.sqrt() * libm::sin(TAU * 0.1), INTEGRAL_9);
}

#[test]
fn a_cosine_lobe_seen_from_above_is_sampled_by_its_power() {
    // Phong at normal incidence: f mu_i ~ mu_i^(n + 1)
    for n in [1.0, 20.0, 500.0] {
        let bound = table("phong", &format!(r#"{{"n": {n}, "ks": 1, "kd": 0}}"#), "angles", &[]);
        for u in [0.02, 0.5, 0.98] {
            for tolerance in [1e-3, 1e-6] {
                let e = texel(&bound, &[u, 0.25, 1.0], tolerance);
                let expected = libm::pow(1.0 - u, 1.0 / (n + 2.0));
                close(
                    &format!("{n} {u} {tolerance:e}"),
                    e.value[0],
                    expected,
                    tolerance.min(e.error[0] + DIGIT_LOST),
                );
                close("phi", e.value[1], 0.25 * TAU, tolerance);
            }
        }
    }
}

fn model(id: &str, params: &str) -> Box<dyn models::Brdf> {
    let (info, _) = models::find(id).unwrap();
    let map: serde_json::Map<String, serde_json::Value> = serde_json::from_str(params).unwrap();
    let params = Params::resolve(info.id, info.params, map.iter().map(|(k, v)| (k.as_str(), v))).unwrap();
    (info.build)(&params).unwrap()
}

/// Another chart: the albedo of the marginal is that of the half-vector rule.
#[test]
fn marginals_add_up_to_the_albedo() {
    for (id, params) in [
        ("ggx", r#"{"alpha": 0.05}"#),
        ("ggx", r#"{"alpha": 0.5}"#),
        ("ggx", r#"{"alpha_x": 0.4, "alpha_y": 0.15}"#),
        ("beckmann", r#"{"alpha": 0.2}"#),
        ("ward", "{}"),
        ("charlie", "{}"),
        ("oren-nayar", "{}"),
    ] {
        let model = model(id, params);
        for mu in [0.1, 0.6, 1.0] {
            let view = View { mu, phi: 0.4 };
            let marginal = marginal(&*model, view, 1e-7);
            let chart = integrate(&*model, view, &[Functional::One], 1e-9).unwrap();
            let error = (marginal.total - chart.value[0]).abs();
            assert!(
                error <= marginal.error + chart.error[0] + 1e-10,
                "{id} {params} {mu}: {error:e} {:e}",
                marginal.error
            );
            assert!(error < INTEGRAL_7_TWICE, "{id} {params} {mu}: {error:e}");
        }
    }
}

/// Moments by the chart: the mean of mu_i over samples is int f mu_i^2 / int f mu_i.
#[test]
fn samples_have_the_mean_of_the_model() {
    let bound = table("ggx", "{}", "direction-pdf", &["alpha"]);
    let (mu, alpha) = (0.7, 0.4);
    let n = 48;
    let mut mean = [0.0; 3];
    for i in 0..n {
        for j in 0..n {
            let at = [(f64::from(i) + 0.5) / f64::from(n), (f64::from(j) + 0.5) / f64::from(n), mu, alpha];
            let e = texel(&bound, &at, 1e-4);
            for (mean, v) in mean.iter_mut().zip(e.value) {
                *mean += v / f64::from(n * n);
            }
        }
    }
    // the same by random directions of the model's own sampler, weighted
    let model = model("ggx", r#"{"alpha": 0.4}"#);
    let wo = glam::DVec3::new((1.0f64 - mu * mu).sqrt(), 0.0, mu);
    let (mut sum, mut total) = (glam::DVec3::ZERO, 0.0);
    let m = 512;
    for i in 0..m {
        for j in 0..m {
            let u =
                glam::DVec2::new((f64::from(i) + 0.5) / f64::from(m), (f64::from(j) + 0.5) / f64::from(m));
            if let Some(s) = model.sample(wo, u) {
                let weight = model.eval(wo, s.wi) * s.wi.z / model.pdf(wo, s.wi);
                sum += weight * s.wi;
                total += weight;
            }
        }
    }
    let expected = sum / total;
    for (c, e) in expected.to_array().into_iter().enumerate() {
        close("mean", mean[c], e, DRAWN_FEW);
    }
}

#[test]
fn laws_hold_and_mirrors_are_refused() {
    for (id, layout, more) in [
        ("ggx", "angles", &["roughness"][..]),
        ("ggx", "direction-pdf", &[]),
        ("oren-nayar", "direction", &[]),
    ] {
        let bound = table(id, "{}", layout, more);
        let table = crate::common::bake(&bound, 1e-4).unwrap();
        let checked = verify::check(&bound, table, 1e-4, &[]);
        assert!(checked.is_ok(), "{id}: {:?}", checked.unwrap_err());
    }
    let request = Request { kind: "importance".into(), model: Some("mirror".into()), ..Request::default() };
    assert!(request.bind().is_err());
}
