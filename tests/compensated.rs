//! Coupled and compensated models: the white furnace by the chart, laws, samplers.
#![allow(clippy::unwrap_used, clippy::float_cmp, reason = "test; exact values are asserted exactly")]

use crate::tolerance::{MANY_ROUNDINGS, near};
use brdfbake::math::frame;
use brdfbake::models::{self, Brdf, Params};
use brdfbake::tables::integral::{Functional, integrate};
use brdfbake::verify::cross_check;
use serde_json::{Value as Json, json};

fn build(name: &str, params: &Json) -> Box<dyn Brdf> {
    let (info, _) = models::find(name).unwrap();
    let given = params.as_object().unwrap();
    let all = given.iter().map(|(k, v)| (k.as_str(), v));
    (info.build)(&Params::resolve(info.id, info.params, all).unwrap()).unwrap()
}

/// By the chart, not by the model's own sum.
fn albedo(model: &dyn Brdf, mu: f64) -> (f64, f64) {
    let e = integrate(model, mu, &[Functional::One, Functional::One], 1e-9).unwrap();
    (e.value[0], e.error[0])
}

#[test]
fn white_surfaces_reflect_everything() {
    for method in ["kulla-conty", "turquin", "fdez-aguera"] {
        for base in ["ggx", "beckmann", "student-t"] {
            for alpha in [0.05, 0.3, 1.0] {
                let model = build(method, &json!({ "base": base, "alpha": alpha }));
                for mu in [0.02, 0.3, 1.0] {
                    let (e, error) = albedo(&*model, mu);
                    near!(
                        e,
                        1.0,
                        error + 2e-7,
                        "{method} {base} {alpha} mu {mu}: E - 1 = {:e}, estimate {error:e}",
                        e - 1.0
                    );
                }
            }
        }
    }
    for alpha in [0.05, 0.4, 1.0] {
        let model = build("kelemen-matte", &json!({ "alpha": alpha, "f0": 0.2, "rho": 1 }));
        for mu in [0.02, 0.3, 1.0] {
            let (e, error) = albedo(&*model, mu);
            near!(e, 1.0, error + 5e-7, "matte {alpha} mu {mu}: {:e} {error:e}", e - 1.0);
        }
    }
}

#[test]
fn coloured_surfaces_lose_what_the_colour_absorbs() {
    // single scattering < compensated < 1, and the slides' colour gives more than the series
    for mu in [0.1, 0.5, 1.0] {
        let single = albedo(&*build("ggx", &json!({ "alpha": 0.8, "f0": 0.6 })), mu).0;
        let with = |colour: &str| {
            albedo(&*build("kulla-conty", &json!({ "alpha": 0.8, "f0": 0.6, "colour": colour })), mu).0
        };
        let (series, slides) = (with("series"), with("slides"));
        assert!(single < series && series < slides && slides < 1.0, "{mu}: {single} {series} {slides}");
        for method in ["turquin", "fdez-aguera"] {
            let e = albedo(&*build(method, &json!({ "alpha": 0.8, "f0": 0.6 })), mu).0;
            assert!(single < e && e < 1.0, "{method} {mu}: {single} {e}");
        }
    }
}

#[test]
fn kulla_conty_is_reciprocal_and_a_mirror_is_left_alone() {
    let model = build("kulla-conty", &json!({ "alpha": 0.6, "f0": 0.5 }));
    let (a, b) = (frame::spherical(0.3, 0.1), frame::spherical(1.2, 2.0));
    let (x, y) = (model.eval(a, b), model.eval(b, a));
    near!(x, y, MANY_ROUNDINGS * x, "{x} {y}");
    assert_eq!(build("turquin", &json!({ "alpha": 0, "f0": 0.5, "f90": 0.5 })).mirror(0.3), Some(0.5));
}

#[test]
fn samplers_agree_with_quadrature() {
    for (name, params) in [
        ("kulla-conty", json!({ "alpha": 0.7, "f0": 0.8 })),
        ("turquin", json!({ "alpha": 0.7, "f0": 0.8 })),
        ("fdez-aguera", json!({ "alpha": 0.7, "f0": 0.8 })),
        ("kelemen-matte", json!({ "alpha": 0.3, "f0": 0.1, "rho": 0.6 })),
    ] {
        let model = build(name, &params);
        for mu in [0.2, 0.9] {
            let (e, error) = albedo(&*model, mu);
            let [s] = cross_check::estimate(&*model, mu, [Functional::One], 3, 16, 2048);
            near!(s.mean, e, 6.0 * s.standard_error + error + 1e-6, "{name} {mu}: {s:?} {e}");
        }
    }
}
