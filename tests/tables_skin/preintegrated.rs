//! Pre-integrated skin: published limits, high-precision values, means, and Monte Carlo over the sphere.

use super::helpers::{close, rows, table, texel};
use crate::common::{bake, request};
use crate::tolerance::{DRAWN, FEW_ROUNDINGS, INTEGRAL_6_TWICE, LIMIT_NEAR};
use brdfbake::grid::{Axis, Quantity, Texel};
use brdfbake::integrate::gauss;
use brdfbake::tables::Bound;
use brdfbake::verify;
use std::f64::consts::{FRAC_1_PI, PI};

const AXES: &[(&str, f64, f64)] = &[("ndotl", -1.0, 1.0), ("curvature", 0.0, 10.0)];

fn skin(params: &str) -> Bound {
    table("preintegrated-skin", "rgb", params, AXES)
}

#[test]
fn the_ring_agrees_with_high_precision_values() {
    let bound = skin("{}");
    for row in rows("integrals", "penner_preintegrated_skin_D") {
        let at = [libm::cos(row.num("theta")), 1.0 / row.num("r_mm")];
        for tolerance in [1e-3, 2.4e-4, 1e-6, 1e-9, 1e-11] {
            let (e, c) = (texel(&bound, &at, tolerance), row.channel());
            let error = (e.value[c] - row.value).abs();
            assert!(
                error <= tolerance && error <= e.error[c] + FEW_ROUNDINGS,
                "{} {tolerance:e}: {error:e}",
                row.name
            );
            assert!(e.error[c] <= tolerance, "{}: estimate {:e}", row.name, e.error[c]);
        }
    }
}

#[test]
fn no_curvature_is_the_clamped_cosine_and_a_little_is_near_it() {
    for params in ["{}", r#"{"over": "sphere"}"#, r#"{"over": "sphere", "profile": "burley"}"#] {
        let bound = skin(params);
        for mu in [-1.0, -0.3, 0.0, 0.2, 0.7, 1.0] {
            let flat = texel(&bound, &[mu, 0.0], 1e-9);
            for v in &flat.value[..3] {
                close("flat", *v, mu.max(0.0), 0.0);
            }
            // away from the terminator what is missing is of second order: the cosine of a spread of a few mm
            let nearly = texel(&bound, &[mu, 1e-5], 1e-9);
            for v in &nearly.value[..3] {
                close(params, *v, mu.max(0.0), if mu == 0.0 { 1e-4 } else { 1e-8 });
            }
        }
    }
}

#[test]
fn a_tiny_ball_is_lit_evenly() {
    // ring: mean of the clamped cosine round the ring; sphere: over the sphere
    for (params, mean) in [
        ("{}", FRAC_1_PI),
        (r#"{"over": "sphere"}"#, 0.25),
        (r#"{"over": "sphere", "profile": "dipole"}"#, 0.25),
    ] {
        let bound = table("preintegrated-skin", "rgb", params, &[AXES[0], ("curvature", 0.0, 1e3)]);
        for mu in [-1.0, 0.0, 1.0] {
            // red light spreads over more than a millimetre
            close(params, texel(&bound, &[mu, 1e3], 1e-9).value[0], mean, LIMIT_NEAR);
        }
    }
}

/// Another rule: the mean over all angles, by Gauss rules between the kinks, is that of clamp(N.L).
#[test]
fn the_mean_light_is_kept() {
    for (params, sphere) in [
        ("{}", false),
        (r#"{"profile": "dipole"}"#, false),
        (r#"{"over": "sphere"}"#, true),
        (r#"{"over": "sphere", "profile": "burley"}"#, true),
        (r#"{"over": "sphere", "profile": "burley", "fit": "searchlight", "albedo_r": 0.9}"#, true),
        (r#"{"over": "sphere", "profile": "dipole", "sigma_a_r": 0.0}"#, true),
    ] {
        let bound = skin(params);
        for curvature in [0.05, 0.5, 3.0] {
            for c in 0..3 {
                let f = |theta: f64| {
                    let v = texel(&bound, &[libm::cos(theta), curvature], 1e-10).value[c];
                    if sphere { v * libm::sin(theta) } else { v }
                };
                let near = (curvature).min(0.5);
                let ends = [
                    0.0,
                    0.5 * PI - near,
                    0.5 * PI - 0.1 * near,
                    0.5 * PI,
                    0.5 * PI + 0.1 * near,
                    0.5 * PI + near,
                    PI,
                ];
                let sum: f64 = ends.windows(2).map(|w| gauss::rule(24).integrate(w[0], w[1], f)).sum();
                close(params, sum, if sphere { 0.5 } else { 1.0 }, INTEGRAL_6_TWICE);
            }
        }
    }
}

/// The sphere by another way: points drawn at random round the normal with the density of one Gaussian of the chord.
#[test]
fn the_sphere_is_what_random_points_on_it_say() {
    let bound = skin(r#"{"over": "sphere", "profile": "gaussians", "gaussians": [[1.0, 1, 1, 1]]}"#);
    let (theta, r) = (1.3, 2.0f64);
    let mut state = 1u64;
    let mut unit = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let light = [libm::sin(theta), libm::cos(theta)];
    let n = 400_000;
    let inside = -libm::expm1(-0.5 * 4.0 * r * r);
    let mut sum = 0.0;
    for _ in 0..n {
        // chord^2 = -2 ln(1 - u F), then uniform azimuth
        let chord2 = -2.0 * libm::log1p(-unit() * inside);
        let cos_b = 1.0 - 0.5 * chord2 / (r * r);
        let sin_b = (1.0 - cos_b * cos_b).max(0.0).sqrt();
        sum += (light[0] * sin_b * libm::cos(2.0 * PI * unit()) + light[1] * cos_b).max(0.0);
    }
    let got = texel(&bound, &[libm::cos(theta), 1.0 / r], 1e-9).value[0];
    close("sphere", got, sum / f64::from(n), DRAWN);
}

#[test]
fn a_profile_that_diverges_on_a_ring_is_refused() {
    let request = brdfbake::tables::spec::Request {
        kind: "preintegrated-skin".into(),
        params: serde_json::from_str(r#"{"profile": "burley"}"#).unwrap(),
        ..Default::default()
    };
    let error = request.bind().unwrap_err().to_string();
    assert!(error.contains("over = \"sphere\""), "{error}");
}

#[test]
fn laws_hold_and_see_a_wrong_table() {
    let axes = |id: &str, lo: f64, hi: f64| {
        Axis::new(Quantity::find(id).unwrap(), 9, Texel::Endpoint).over([lo, hi])
    };
    for params in ["{}", r#"{"over": "sphere", "profile": "burley"}"#] {
        let bound = request(
            "preintegrated-skin",
            "rgb",
            params,
            vec![axes("ndotl", -1.0, 1.0), axes("curvature", 0.0, 2.0)],
        );
        let mut table = bake(&bound, 1e-5).unwrap();
        assert!(verify::check(&bound, table.clone(), 1e-5, &[]).is_ok(), "{params}");
        table.values[7] = 1.1;
        assert!(verify::check(&bound, table, 1e-5, &[]).is_err());
    }
}
