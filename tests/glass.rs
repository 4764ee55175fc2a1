//! Rough dielectrics that transmit: R and T against reference values, reciprocity, reversibility, samplers, limits.
#![allow(clippy::unwrap_used, clippy::float_cmp, reason = "test; exact values are asserted exactly")]

use crate::tolerance::{DIGIT_LOST, DIGITS_LOST, DRAWN, INTEGRAL_5, INTEGRAL_8, INTEGRAL_9, near};
use brdfbake::integrate::View;
use brdfbake::integrate::sobol::Sobol;
use brdfbake::math::frame;
use brdfbake::models::{self, Brdf, Params};
use brdfbake::terms::fresnel;
use serde_json::{Value as Json, json};

fn build(name: &str, params: &Json) -> Box<dyn Brdf> {
    let (info, _) = models::find(name).unwrap();
    let all = params.as_object().unwrap().iter().map(|(k, v)| (k.as_str(), v));
    (info.build)(&Params::resolve(info.id, info.params, all).unwrap()).unwrap()
}

fn transmitted(model: &dyn Brdf, mu: f64, tolerance: f64) -> (f64, f64) {
    let e = model.transmission().unwrap().albedo(mu.into(), tolerance);
    (e.value[0], e.error[0])
}

fn reflected(model: &dyn Brdf, mu: f64, tolerance: f64) -> (f64, f64) {
    let e = models::integral::directional_albedo(model, mu, tolerance);
    (e.value[0], e.error[0])
}

#[test]
fn both_parts_match_reference_values() {
    let path = format!("{}/tests/values/integrals.csv", env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for record in csv::Reader::from_path(path).unwrap().records() {
        let r = record.unwrap();
        let Some(part) = r[0].strip_prefix("E_glass_ggx_separable_") else { continue };
        let p: Json = serde_json::from_str(&r[1]).unwrap();
        let model = build("ggx-glass", &json!({ "alpha": p["alpha"], "eta": p["eta"] }));
        let mu = libm::cos(p["theta"].as_f64().unwrap());
        let (got, error) =
            if part == "R" { reflected(&*model, mu, 1e-13) } else { transmitted(&*model, mu, 1e-13) };
        let expected: f64 = r[2].parse().unwrap();
        let digits: i32 = r[3].parse().unwrap();
        let known = libm::pow(10.0, f64::from(1 - digits)) * expected;
        let off = (got - expected).abs();
        assert!(off <= error + known + DIGIT_LOST, "{} {}: off by {off:e}, estimate {error:e}", &r[0], &r[1]);
        assert!(error <= INTEGRAL_9, "{} {}: estimate {error:e}", &r[0], &r[1]);
        count += 1;
    }
    assert_eq!(count, 14);
}

#[test]
fn radiance_over_the_squared_index_is_reciprocal() {
    for masking in ["separable", "beta", "sum"] {
        for eta in [0.7, 1.5, 2.4] {
            let model = build("ggx-glass", &json!({ "alpha": 0.4, "eta": eta, "masking": masking }));
            for i in 0..20 {
                let i = f64::from(i);
                let above = frame::spherical(0.07 * i, 0.3 * i);
                let below = frame::spherical(std::f64::consts::PI - 0.06 * i, 1.0 + 0.2 * i);
                let (down, up) = (model.eval(below, above), model.eval(above, below));
                // light leaving below has n_o = eta
                let scale = down.abs().max(1e-12);
                near!(down / (eta * eta), up, DIGITS_LOST * scale, "{masking} {eta} {i}: {down} {up}");
                assert!(down >= 0.0 && down.is_finite());
            }
        }
    }
}

#[test]
fn nothing_is_made_and_smooth_interfaces_lose_nothing() {
    for name in ["ggx-glass", "beckmann-glass"] {
        for eta in [0.6, 0.95, 1.05, 1.5, 3.0] {
            for alpha in [0.02, 0.3, 1.0] {
                for masking in ["separable", "beta", "sum"] {
                    let model = build(name, &json!({ "alpha": alpha, "eta": eta, "masking": masking }));
                    for mu in [0.05, 0.5, 1.0] {
                        let ((r, re), (t, te)) =
                            (reflected(&*model, mu, 1e-5), transmitted(&*model, mu, 1e-5));
                        assert!(r >= 0.0 && t >= 0.0, "{name} {eta} {alpha} {masking} {mu}: {r} {t}");
                        let sum = r + t;
                        assert!(sum <= 1.0 + re + te, "{name} {eta} {alpha} {masking} {mu}: R + T = {sum}");
                    }
                }
            }
            // alpha -> 0
            let (narrow, smooth) = (
                build(name, &json!({ "alpha": 1e-3, "eta": eta })),
                build(name, &json!({ "alpha": 0, "eta": eta })),
            );
            for mu in [0.6, 1.0] {
                // not at the critical angle, where the slope is infinite
                let f = fresnel::dielectric(mu, eta).unpolarised();
                assert_eq!(
                    (smooth.mirror(mu), transmitted(&*smooth, mu, 1e-9).0),
                    (Some(f), fresnel::dielectric_transmittance(mu, eta).unpolarised())
                );
                let (t, error) = transmitted(&*narrow, mu, 1e-6);
                if (mu - fresnel::cos_critical(eta)).abs() > 0.05 {
                    near!(t, (1.0 - f), error + 1e-3, "{name} {eta} {mu}: T = {t}, 1 - F = {}", 1.0 - f);
                }
            }
        }
    }
}

#[test]
fn flux_is_reversible_in_the_average() {
    // int T(mu) mu dmu from above = eta^2 int T'(mu) mu dmu from below: f_t is reciprocal
    let average = |eta: f64| {
        let model = build("ggx-glass", &json!({ "alpha": 0.5, "eta": eta }));
        brdfbake::integrate::gauss::rule(64)
            .integrate(0.0, 1.0, |x| 4.0 * x * x * x * transmitted(&*model, x * x, 1e-7).0)
    };
    let eta = 1.5;
    let (down, up) = (average(eta), average(1.0 / eta));
    near!(down, eta * eta * up, INTEGRAL_5, "{down} {}", eta * eta * up);
}

#[test]
fn the_sampler_agrees_with_quadrature() {
    for (name, eta, masking) in
        [("ggx-glass", 1.5, "separable"), ("ggx-glass", 0.7, "sum"), ("beckmann-glass", 1.8, "beta")]
    {
        let model = build(name, &json!({ "alpha": 0.4, "eta": eta, "masking": masking }));
        let btdf = model.transmission().unwrap();
        for mu in [0.3, 0.9] {
            let wo = frame::from_mu(mu);
            let n = 1 << 16;
            // the flux along wo that crosses: light from wo, seen from the sampled side
            let sum: f64 = Sobol::new(5)
                .points(n)
                .filter_map(|u| btdf.sample(wo, u))
                .map(|s| btdf.eval(s.wi, wo) * s.wi.z.abs() / s.pdf)
                .sum();
            let (t, error) = transmitted(&*model, mu, 1e-7);
            let mean = sum / f64::from(n);
            near!(mean, t, DRAWN + error, "{name} {eta} {masking} {mu}: {mean} {t}");
            // and radiance, which is compressed: T (n_o / n_i)^2
            let sum: f64 = Sobol::new(6)
                .points(n)
                .filter_map(|u| btdf.sample(wo, u))
                .map(|s| btdf.eval(wo, s.wi) * s.wi.z.abs() / s.pdf)
                .sum();
            let mean = sum / f64::from(n) * eta * eta;
            near!(mean, t, DRAWN + error, "{name} {eta} {masking} {mu}: radiance {mean} {t}");
        }
    }
}

#[test]
fn reflection_from_below_is_that_of_the_inverse_index() {
    let (above, below) =
        (build("ggx-glass", &json!({ "eta": 1.5 })), build("ggx-glass", &json!({ "eta": 1.0 / 1.5 })));
    let (a, b) = (frame::spherical(0.4, 0.2), frame::spherical(1.1, 2.0));
    let down = |w: glam::DVec3| glam::DVec3::new(w.x, w.y, -w.z);
    let (x, y) = (above.eval(down(a), down(b)), below.eval(a, b));
    near!(x, y, DIGIT_LOST * y, "{x} {y}");
    assert_eq!(above.eval(a, glam::DVec3::X), 0.0);
}

#[test]
fn two_widths_turn_the_transmitted_part_and_the_sampler_agrees() {
    // from both sides, below and beyond the critical angle, along the tangents and between them
    for (name, eta, mu, phi) in [
        ("ggx-glass", 1.5, 0.4, 0.6),
        ("ggx-glass", 0.7, 0.9, 2.5),
        ("ggx-glass", 0.7, 0.5, 0.9),
        ("beckmann-glass", 0.8, 0.5, std::f64::consts::FRAC_PI_2),
        ("beckmann-glass", 1.3, 0.2, 0.0),
    ] {
        let model = build(name, &json!({ "alpha_x": 0.2, "alpha_y": 0.7, "eta": eta }));
        let btdf = model.transmission().unwrap();
        let view = View { mu, phi };
        let e = btdf.albedo(view, 1e-8);
        assert!(e.error[0] <= INTEGRAL_8, "{name} {eta} {view:?}: {:e}", e.error[0]);
        let n = 1 << 16;
        let wo = view.direction();
        let draws = Sobol::new(5).points(n).filter_map(|u| btdf.sample(wo, u));
        let sum: f64 = draws.map(|s| btdf.eval(s.wi, wo) * s.wi.z.abs() / s.pdf).sum();
        let mean = sum / f64::from(n);
        near!(mean, e.value[0], DRAWN, "{name} {eta} {view:?}: {mean} {}", e.value[0]);
        // the image in a tangent is the same, and widths that are nearly equal are nearly one
        let image = btdf.albedo(View { mu, phi: std::f64::consts::PI - phi }, 1e-8);
        near!(image.value[0], e.value[0], e.error[0] + image.error[0], "{name} {eta} {view:?}");
        let (one, two) = (
            json!({ "alpha": 0.3, "eta": eta }),
            json!({ "alpha_x": 0.3, "alpha_y": 0.300_000_001, "eta": eta }),
        );
        let [one, two] = [one, two].map(|p| build(name, &p).transmission().unwrap().albedo(view, 1e-8));
        near!(one.value[0], two.value[0], one.error[0] + two.error[0] + 1e-9, "{name} {eta} {view:?}");
    }
}
