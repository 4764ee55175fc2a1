//! Tables of every distribution of normals: D, masking, and masking and shadowing.
#![allow(clippy::unwrap_used, reason = "a test may fail by panicking")]

use crate::common::{axis, bake};
use crate::tolerance::{DIGIT_LOST, DIGITS_LOST, INTEGRAL_9, MIDPOINT_SUM, near};
use brdfbake::functions::{self, Angles};
use brdfbake::grid::{Axis, Texel, Warp};
use brdfbake::models::normals::{IDS, NORMALS};
use brdfbake::models::{Kind, Params};
use brdfbake::tables::spec::{BindError, Bound, Request};
use brdfbake::{tables, verify};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::f64::consts::PI;

fn bind(kind: &str, layout: &str, params: Value, axes: Vec<Axis>) -> Result<Bound, BindError> {
    let params = params.as_object().unwrap().clone();
    let layout = Some(layout.to_owned());
    Request { kind: kind.to_owned(), layout, params, axes: Some(axes), ..Request::default() }.bind()
}

/// The value of a function.
fn function(id: &str, params: &Value, [wi_theta, wi_phi, wo_theta, wo_phi]: [f64; 4]) -> f64 {
    let (info, _) = functions::find(id).unwrap_or_else(|| panic!("no function `{id}`"));
    let params =
        Params::resolve_over(info.id, info.params, &Map::new(), params.as_object().unwrap()).unwrap();
    info.value(&params, &Angles::all([wi_theta, wi_phi, wo_theta, wo_phi])).unwrap()
}

/// Numbers for each: those of tables, and those of the function.
fn numbers(id: &str) -> (Value, Value) {
    match id {
        "blinn-phong" => (json!({ "n": 12.0 }), json!({ "n": 12.0 })),
        "charlie" => (json!({ "alpha": 0.4 }), json!({ "roughness": 0.4 })),
        "velvet-2000" | "sggx" => (json!({ "alpha": 0.4 }), json!({ "sigma": 0.4 })),
        "student-t" | "gtr" => (json!({ "alpha": 0.4, "gamma": 2.5 }), json!({ "alpha": 0.4, "gamma": 2.5 })),
        _ => (json!({ "alpha": 0.4 }), json!({ "alpha": 0.4 })),
    }
}

fn of(id: &str) -> Value {
    let mut params = numbers(id).0;
    params["distribution"] = json!(id);
    params
}

/// The words of tables are the functions: whoever adds `d-NAME` adds a line of `models::normals::NORMALS`.
#[test]
fn tables_know_every_distribution_that_is_a_function() {
    let functions: BTreeSet<&str> =
        functions::ndf::ALL.iter().filter_map(|f| f.id.strip_prefix("d-")).collect();
    assert_eq!(functions, IDS.into_iter().collect(), "functions `d-...` and models::normals::NORMALS differ");
    for kind in ["ndf", "masking", "visibility"] {
        let info = tables::find(kind).unwrap();
        let choice = info.params.iter().find(|p| p.id == "distribution").unwrap();
        let Kind::Choice(words) = choice.kind else { panic!("{kind}") };
        assert!(IDS.iter().all(|id| words.contains(id)), "{kind}: {words:?}");
        for word in words {
            let params = json!({ "distribution": word }).as_object().unwrap().clone();
            let request = Request { kind: kind.to_owned(), params, ..Request::default() };
            let bound = request.bind().unwrap_or_else(|e| panic!("{kind}, {word}, default axes: {e}"));
            assert!(!tables::source::lines(&bound.spec).is_empty(), "{kind}, {word}: no source");
        }
    }
}

#[test]
fn d_is_that_of_the_functions_and_relative_to_what_the_notes_say() {
    for normals in NORMALS {
        let id = normals.id;
        let d = bind("ndf", "absolute", of(id), vec![axis("mu_m", 8, Texel::Endpoint)]).unwrap();
        let relative = bind("ndf", "relative", of(id), vec![axis("mu_m", 8, Texel::Endpoint)]).unwrap();
        let value = |bound: &Bound, mu: f64| bound.baker.texel(&[mu], 1e-6).unwrap().value[0];
        for theta in [0.1, 0.4, 1.1, 1.5] {
            let expected = function(&format!("d-{id}"), &numbers(id).1, [theta, 0.3, 0.0, 0.0]);
            let got = value(&d, libm::cos(theta));
            // a tail of e^-600 has as many digits as its exponent
            let least = if expected < 1e-100 { 1e-100 } else { expected };
            assert!((got - expected).abs() <= DIGITS_LOST * least, "{id} at {theta}: {got} {expected}");
        }
        // 1 at the normal, or of cloth at the horizon
        let at = if ["charlie", "velvet-2000", "velvet-2007", "sggx"].contains(&id) { 0.0 } else { 1.0 };
        near!(value(&relative, at), 1.0, DIGIT_LOST, "{id}");
    }
}

/// `mu Lambda` by a sum over facets of equal solid angle.
fn hidden(id: &str, mu: f64) -> f64 {
    const N: u32 = 300;
    let (mut turned, mut area) = (0.0, 0.0);
    let sin = (1.0 - mu * mu).sqrt();
    for i in 0..N {
        let cos_m = (f64::from(i) + 0.5) / f64::from(N);
        let d = function(&format!("d-{id}"), &numbers(id).1, [libm::acos(cos_m), 0.0, 0.0, 0.0]);
        let sin_m = (1.0 - cos_m * cos_m).sqrt();
        area += 2.0 * PI * d * cos_m / f64::from(N);
        for j in 0..N {
            let phi = PI * (f64::from(j) + 0.5) / f64::from(N);
            let cosine = mu * cos_m + sin * sin_m * libm::cos(phi);
            turned += 2.0 * PI * d * (-cosine).max(0.0) / f64::from(N * N);
        }
    }
    turned / area
}

#[test]
fn masking_hides_what_a_sum_over_facets_says() {
    for id in IDS {
        let g1 = bind("masking", "g1", of(id), vec![axis("mu", 8, Texel::Endpoint)]).unwrap();
        let pair = |masking: &str| {
            let mut params = of(id);
            params["masking"] = json!(masking);
            let axes = vec![axis("mu", 4, Texel::Endpoint), axis("mu_i", 4, Texel::Endpoint)];
            let bound = bind("visibility", "g2", params, axes).unwrap();
            bound.baker.texel(&[0.15, 0.6], 1e-9).unwrap().value[0]
        };
        let (low, high) = (hidden(id, 0.15), hidden(id, 0.6));
        let e = g1.baker.texel(&[0.15], 1e-9).unwrap();
        near!(e.value[0], 0.15 / (0.15 + low), MIDPOINT_SUM, "{id}");
        assert!(e.error[0] <= INTEGRAL_9, "{id}: {:e}", e.error[0]);
        let separable = 0.15 / (0.15 + low) * (0.6 / (0.6 + high));
        near!(pair("separable"), separable, MIDPOINT_SUM, "{id}");
        let correlated = 1.0 / (1.0 + low / 0.15 + high / 0.6);
        near!(pair("correlated"), correlated, MIDPOINT_SUM, "{id}");
    }
}

#[test]
fn grooves_and_the_fit_of_charlie_are_those_of_the_functions() {
    let both = vec![
        axis("mu", 4, Texel::Endpoint),
        axis("mu_i", 4, Texel::Endpoint),
        axis("phi", 3, Texel::Endpoint).over([0.0, PI]),
    ];
    let grooves = bind("visibility", "g2", json!({ "distribution": "vcavity" }), both.clone()).unwrap();
    let visible = bind("visibility", "visibility", json!({ "distribution": "vcavity" }), both).unwrap();
    for [o, i, phi] in [[1.25, 0.2, 3.0], [1.4, 1.3, 0.5], [0.3, 1.5, 2.0]] {
        let expected = function("g2-vcavity", &json!({}), [i, phi, o, 0.0]);
        let at = [libm::cos(o), libm::cos(i), phi];
        near!(grooves.baker.texel(&at, 1e-6).unwrap().value[0], expected, DIGIT_LOST, "{o} {i} {phi}");
        let over = expected / (4.0 * at[0] * at[1]);
        let got = visible.baker.texel(&at, 1e-6).unwrap().value[0];
        assert!((got - over).abs() <= DIGIT_LOST * over, "{o} {i} {phi}: {got} {over}");
    }
    let fit = json!({ "distribution": "charlie-fit", "alpha": 0.3 });
    let g1 = bind("masking", "g1", fit, vec![axis("mu", 4, Texel::Endpoint)]).unwrap();
    let lambda = function("lambda-charlie", &json!({ "roughness": 0.3 }), [1.2, 0.0, 0.0, 0.0]);
    near!(g1.baker.texel(&[libm::cos(1.2)], 1e-6).unwrap().value[0], 1.0 / (1.0 + lambda), DIGIT_LOST, "fit");
}

/// Laws, the independent rule among them, on a small table of each.
#[test]
fn laws_hold_for_every_distribution() {
    let small = |id: &str, [lo, hi]: [f64; 2]| axis(id, 3, Texel::Endpoint).over([lo, hi]);
    for normals in NORMALS {
        let id = normals.id;
        let width = || match normals.width {
            "n" => small("n", [2.0, 50.0]),
            _ => small("alpha", [0.2, 0.9]),
        };
        let mut params = of(id);
        params.as_object_mut().unwrap().remove(normals.width);
        let mu = |name: &str| axis(name, 5, Texel::Center).warped(Warp::Power(0.5));
        for (kind, layout, axes) in [
            ("ndf", "absolute", vec![mu("mu_m"), width()]),
            ("ndf", "relative", vec![mu("mu_m"), width()]),
            ("masking", "g1", vec![mu("mu"), width()]),
            ("visibility", "visibility", vec![mu("mu"), mu("mu_i"), width()]),
        ] {
            let bound = bind(kind, layout, params.clone(), axes).unwrap();
            let table = bake(&bound, 1e-6).unwrap();
            let (verified, _) = verify::check(&bound, table, 1e-6, &[]).unwrap_or_else(|f| {
                panic!("{id}, {kind}: {}", f.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
            });
            for law in ["normalised", "honest"].iter().filter(|law| kind == "ndf" || **law == "honest") {
                assert!(verified.laws().iter().any(|l| l.law == *law && l.held()), "{id}, {kind}: {law}");
            }
        }
    }
}

#[test]
fn numbers_of_other_distributions_are_refused_on_axes() {
    let with = |kind: &str, word: &str, id: &str| {
        let mu = if kind == "ndf" { "mu_m" } else { "mu" };
        let axes = vec![axis(mu, 4, Texel::Endpoint), axis(id, 3, Texel::Endpoint).over([0.1, 0.9])];
        bind(kind, if kind == "ndf" { "absolute" } else { "g1" }, json!({ "distribution": word }), axes)
    };
    for (kind, word, id) in [
        ("ndf", "ggx", "n"),
        ("ndf", "blinn-phong", "alpha"),
        ("masking", "vcavity", "alpha"),
        ("masking", "schlick", "n"),
        ("masking", "ggx", "mu_m"),
    ] {
        let Err(e) = with(kind, word, id) else { panic!("{kind} {word} over {id}") };
        assert!(matches!(e, BindError::IdleAxis { axis, .. } if axis == id), "{kind} {word} {id}: {e}");
    }
    let Err(e) = bind(
        "ndf",
        "absolute",
        json!({ "distribution": "student-t", "gamma": 1.0 }),
        vec![axis("mu_m", 4, Texel::Endpoint)],
    ) else {
        panic!("gamma 1")
    };
    assert!(e.to_string().contains("student-t") && e.to_string().contains("gamma"), "{e}");
}
