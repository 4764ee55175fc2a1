//! Microfacet models beyond Smith's GGX and Beckmann, and cloth: albedos against reference values, identities between
//! models, limits, samplers against quadrature.
#![allow(clippy::unwrap_used, reason = "test")]

use crate::tolerance::{
    DIGIT_LOST, INTEGRAL_7, INTEGRAL_8, INTEGRAL_10, INTEGRAL_11, INTEGRAL_12, LIMIT_FAR, MANY_ROUNDINGS,
    near,
};
use brdfbake::integrate::Estimate;
use brdfbake::math::frame;
use brdfbake::models::{self, Brdf, Params};
use brdfbake::tables::integral::{Functional, integrate};
use brdfbake::verify::cross_check;
use serde_json::{Map, Value as Json, json};

fn build(name: &str, params: &Json) -> Box<dyn Brdf> {
    let (info, implied) = models::find(name).unwrap_or_else(|| panic!("{name}"));
    let implied = models::implied_values(implied);
    let all = implied.iter().chain(params.as_object().unwrap()).map(|(k, v)| (k.as_str(), v));
    (info.build)(&Params::resolve(info.id, info.params, all).unwrap()).unwrap()
}

/// E by the chart, even where there is a reduction.
fn albedo(model: &dyn Brdf, mu: f64, tolerance: f64) -> Estimate {
    integrate(model, mu, &[Functional::One, Functional::One], tolerance).unwrap()
}

struct Row {
    params: Map<String, Json>,
    value: f64,
    digits: i32,
}

fn rows(table: &str) -> Vec<Row> {
    let path = format!("{}/tests/values/integrals.csv", env!("CARGO_MANIFEST_DIR"));
    let rows: Vec<Row> = csv::Reader::from_path(path)
        .unwrap()
        .records()
        .map(|r| r.unwrap())
        .filter(|r| r[0].split(' ').next() == Some(table))
        .map(|r| Row {
            params: serde_json::from_str(&r[1]).unwrap(),
            value: r[2].parse().unwrap(),
            digits: r[3].parse().unwrap(),
        })
        .collect();
    assert!(!rows.is_empty(), "{table}");
    rows
}

/// Compares a channel with the rows of a table: the error must be below its own estimate, and the estimate below `want`.
fn compare(table: &str, name: &str, functionals: &[Functional], scale: f64, want: f64) {
    for mut row in rows(table) {
        let theta = row.params.remove("theta").unwrap().as_f64().unwrap();
        let what = format!("{table} {:?} theta {theta}", row.params);
        let model = build(name, &Json::Object(row.params));
        let mu = libm::cos(theta);
        let e = integrate(&*model, mu, functionals, 1e-12).unwrap();
        let off = (scale * e.value[0] - row.value).abs();
        let digits = libm::pow(10.0, f64::from(1 - row.digits)) * row.value;
        assert!(
            off <= scale * e.error[0] + digits + DIGIT_LOST,
            "{what}: off by {off:e}, estimate {:e}, value {:.17}",
            e.error[0],
            row.value
        );
        assert!(e.error[0] <= want, "{what}: estimate {:e} > {want:e}", e.error[0]);
    }
}

/// One functional alone allows a reduction; the same twice asks for the chart.
const REDUCED: &[Functional] = &[Functional::One];
const E: &[Functional] = &[Functional::One, Functional::One];

#[test]
fn albedos_match_reference_values() {
    compare("E_kelemen_normalised_beckmann_white", "kelemen", E, 1.0, 1e-9);
    compare("E_charlie_conty_kulla_fitted_lambda", "charlie", E, 1.0, 1e-10);
    compare("E_charlie_neubelt_visibility", "charlie-neubelt", E, 1.0, 1e-10);
    compare("E_velvet07_neubelt", "velvet-neubelt", E, 1.0, 1e-10);
    compare("E_cook_torrance_vcavity_beckmann_over4_white", "torrance-sparrow", REDUCED, 1.0, 1e-10);
    compare("E_cook_torrance_vcavity_beckmann_over4_white", "cook-torrance-1982", REDUCED, 0.25, 1e-10);
}

#[test]
fn split_sums_with_schlicks_masking_match_reference_values() {
    let scale = &[Functional::SchlickComplement, Functional::Schlick];
    let bias = &[Functional::Schlick, Functional::SchlickComplement];
    compare("DFG_A_karis_k_alpha_over_2", "ggx-schlick-masking", scale, 1.0, 1e-11);
    compare("DFG_B_karis_k_alpha_over_2", "ggx-schlick-masking", bias, 1.0, 1e-11);
}

fn same(a: &dyn Brdf, b: &dyn Brdf, factor: f64, bound: f64, what: &str) {
    for i in 0..8 {
        for j in 0..8 {
            let wo = frame::spherical(0.19 * f64::from(i), 0.3);
            let wi = frame::spherical(0.21 * f64::from(j), 0.3 + 0.9 * f64::from(i + j));
            let (x, y) = (a.eval(wo, wi), factor * b.eval(wo, wi));
            near!(x, y, bound * y.abs().max(INTEGRAL_10), "{what}: {i} {j}: {x:e} {y:e}");
        }
    }
}

#[test]
fn models_that_are_the_same_have_the_same_values() {
    for alpha in [0.05, 0.3, 1.0] {
        let p = json!({ "alpha": alpha, "f0": 0.1 });
        same(
            &*build("torrance-sparrow", &p),
            &*build("cook-torrance-1982", &p),
            0.25,
            MANY_ROUNDINGS,
            "a quarter",
        );
        let t = json!({ "alpha": alpha, "f0": 0.1, "gamma": 2 });
        same(&*build("student-t", &t), &*build("ggx", &p), 1.0, INTEGRAL_11, "gamma = 2");
        same(&*build("gtr", &t), &*build("ggx", &p), 1.0, INTEGRAL_12, "gamma = 2");
        let t = json!({ "alpha": alpha, "f0": 0.1, "gamma": 1e8 });
        same(&*build("student-t", &t), &*build("beckmann", &p), 1.0, LIMIT_FAR, "gamma = 1e8");
        // k = 1/2 is Smith's masking at alpha = 1, and nowhere else
    }
    let one = json!({ "alpha": 1 });
    same(
        &*build("ggx-schlick-masking", &one),
        &*build("ggx_smith_separable", &one),
        1.0,
        MANY_ROUNDINGS,
        "k = 1/2",
    );
    let skin = json!({ "m": 0.3, "rho_s": 0.5, "f0": 0.028 });
    let kelemen = json!({ "alpha": 0.3, "f0": 0.028 });
    same(&*build("kelemen-skin", &skin), &*build("kelemen", &kelemen), 0.5, DIGIT_LOST, "skin");
    let punctual = json!({ "m": 0.3, "rho_s": 0.5, "f0": 0.028, "units": "punctual" });
    same(
        &*build("kelemen-skin", &punctual),
        &*build("kelemen-skin", &skin),
        std::f64::consts::PI,
        MANY_ROUNDINGS,
        "pi",
    );
    // Blinn-Phong approaches Beckmann of equal peak
    let n = 1e6;
    let alpha = (2.0_f64 / (n + 2.0)).sqrt();
    let (a, b) = (
        build("blinn-phong-microfacet", &json!({ "n": n })),
        build("torrance-sparrow", &json!({ "alpha": alpha })),
    );
    for t in [0.0, 0.5, 1.0, 2.0] {
        let (wo, wi) = (frame::spherical(0.4, 0.0), frame::spherical(0.4 + t * alpha, std::f64::consts::PI));
        let (x, y) = (a.eval(wo, wi), b.eval(wo, wi));
        near!(x, y, LIMIT_FAR * y, "Blinn {t}: {x} {y}");
    }
}

#[test]
fn closed_forms_of_albedos() {
    // Kelemen with Beckmann facets at normal incidence: 1 - m^2 (1 - exp(-1/m^2))
    for m in [0.05, 0.3, 1.0] {
        let e = albedo(&*build("kelemen", &json!({ "alpha": m })), 1.0, 1e-12);
        let expected = 1.0 + m * m * libm::expm1(-1.0 / (m * m));
        near!(e.value[0], expected, INTEGRAL_11, "{m}: {} {expected}", e.value[0]);
    }
    // the transformed cosine keeps its albedo
    for roughness in [0.05, 0.3, 1.0] {
        let model = build("ltc-sheen", &json!({ "roughness": roughness }));
        for mu in [0.02, 0.3, 1.0] {
            let chart = albedo(&*model, mu, 1e-10);
            let exact = integrate(&*model, mu, &[Functional::One], 1e-10).unwrap().value[0];
            near!(chart.value[0], exact, chart.error[0] + DIGIT_LOST, "{roughness} {mu}");
            assert!(chart.error[0] <= INTEGRAL_8, "{roughness} {mu}: {:e}", chart.error[0]);
        }
    }
}

#[test]
fn samplers_agree_with_quadrature() {
    let cases = [
        ("torrance-sparrow", json!({ "alpha": 0.4 })),
        ("blinn-phong-microfacet", json!({ "n": 20 })),
        ("student-t", json!({ "alpha": 0.4, "gamma": 1.8 })),
        ("student-t", json!({ "alpha": 0.4, "gamma": 30 })),
        ("gtr", json!({ "alpha": 0.4, "gamma": 1 })),
        ("ggx-schlick-masking", json!({ "alpha": 0.4, "k": "analytic" })),
        ("ggx-schlick-masking", json!({ "alpha": 0.4, "k": "schlick" })),
        ("kelemen", json!({ "alpha": 0.4 })),
        ("kelemen-skin", json!({ "m": 0.4, "rho_s": 1, "f0": 0.5 })),
        ("disney-clearcoat", json!({ "gloss": 0.2 })),
        ("charlie", json!({ "roughness": 0.4 })),
        ("charlie-neubelt", json!({ "roughness": 0.4 })),
        ("velvet-ashikhmin", json!({ "sigma": 0.6 })),
        ("velvet-neubelt", json!({ "alpha": 0.4 })),
        ("ltc-sheen", json!({ "roughness": 0.4 })),
        ("sggx-fiber", json!({ "sigma": 0.4 })),
    ];
    for (name, params) in cases {
        let model = build(name, &params);
        for mu in [0.15, 0.6, 1.0] {
            let e = albedo(&*model, mu, 1e-6);
            let [s] = cross_check::estimate(&*model, mu, [Functional::One], 11, 16, 2048);
            let off = (s.mean - e.value[0]).abs();
            assert!(
                off <= 6.0 * s.standard_error + e.error[0] + INTEGRAL_7,
                "{name} {params} mu {mu}: sampled {} +- {}, quadrature {} +- {}",
                s.mean,
                s.standard_error,
                e.value[0],
                e.error[0]
            );
        }
    }
}

#[test]
fn claims_of_energy_hold_over_the_parameters() {
    let grid = [1e-3_f64, 0.02, 0.1, 0.5, 1.0];
    let mut cases = Vec::new();
    for a in grid {
        for k in ["ibl", "analytic", "schlick"] {
            cases.push(("ggx-schlick-masking", json!({ "alpha": a, "k": k })));
        }
        cases.push(("torrance-sparrow", json!({ "alpha": a })));
        cases.push(("kelemen", json!({ "alpha": a })));
        cases.push(("gtr", json!({ "alpha": a, "gamma": 0.5 })));
        cases.push(("gtr", json!({ "alpha": a, "gamma": 5 })));
        cases.push(("student-t", json!({ "alpha": a, "gamma": 1.6 })));
        cases.push(("student-t", json!({ "alpha": a, "gamma": 1000 })));
        cases.push(("blinn-phong-microfacet", json!({ "n": 2.0 / (a * a) - 2.0 })));
        cases.push(("velvet-neubelt", json!({ "alpha": a })));
        cases.push(("velvet-ashikhmin", json!({ "sigma": a })));
        cases.push(("sggx-fiber", json!({ "sigma": a })));
        cases.push(("charlie", json!({ "roughness": a.max(0.07) })));
        cases.push(("ltc-sheen", json!({ "roughness": a.max(0.01) })));
        cases.push(("disney-clearcoat", json!({ "gloss": a })));
    }
    for (name, params) in cases {
        let model = build(name, &params);
        for mu in [1e-4, 0.01, 0.1, 0.5, 1.0] {
            let e = albedo(&*model, mu, 1e-4);
            assert!(
                e.value[0] <= 1.0 + e.error[0],
                "{name} {params} mu {mu}: E = {} +- {:e}",
                e.value[0],
                e.error[0]
            );
        }
    }
    // and those that are not passive are not
    let thin = albedo(&*build("charlie", &json!({ "roughness": 0.02 })), 1e-3, 1e-6);
    assert!(thin.value[0] > 1.3, "{}", thin.value[0]);
    let rim = albedo(
        &*build("charlie-neubelt", &json!({ "roughness": 0.07 })),
        libm::cos(89.95_f64.to_radians()),
        1e-6,
    );
    assert!(rim.value[0] > 1.5, "{}", rim.value[0]);
}
