//! Functions by name: every row of the reference values, every value that an entry claims to be known, the registry.
#![allow(clippy::unwrap_used, reason = "test")]
#![allow(clippy::print_stderr, reason = "what was skipped is said")]

use crate::tolerance::DIGITS_LOST;
use brdfbake::functions::{self, Angles, EvalError, FunctionError, Subject};
use brdfbake::models::{KnownValue, MODELS};
use brdfbake::verify::tolerance;
use serde_json::{Map, Value as Json};
use std::collections::BTreeSet;

const FILES: &[&str] = &[
    "basics",
    "filtering",
    "fresnel",
    "microfacet",
    "sampling",
    "sheen",
    "skin",
    "techniques",
    "terms",
    "transmission",
    "volume",
];

struct Row {
    name: String,
    params: String,
    angles: [Option<f64>; 4],
    value: f64,
}

fn rows(file: &str) -> Vec<Row> {
    let path = format!("{}/tests/values/points_{file}.csv", env!("CARGO_MANIFEST_DIR"));
    let mut reader = csv::Reader::from_path(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    reader
        .records()
        .map(|record| {
            let r = record.unwrap();
            let angles = [2, 3, 4, 5].map(|i| r[i].parse().ok());
            Row { name: r[0].to_owned(), params: r[1].to_owned(), angles, value: r[6].parse().unwrap() }
        })
        .collect()
}

fn json(text: &str) -> Map<String, Json> {
    serde_json::from_str(text).unwrap()
}

fn evaluate(name: &str, params: &Map<String, Json>, angles: [Option<f64>; 4]) -> Result<f64, EvalError> {
    let [wi_theta, wi_phi, wo_theta, wo_phi] = angles;
    Subject::new(name, params)?.value(&Angles { wi_theta, wi_phi, wo_theta, wo_phi })
}

/// Looser tolerances, by the first word of the name. Their reasons are in `verify::tolerance`.
fn tolerance(row: &Row) -> tolerance::Tolerance {
    let narrow =
        |key: &str| json(&row.params).get(key).and_then(Json::as_f64).is_some_and(|alpha| alpha < 0.01);
    let quantity = match row.name.split(' ').next().unwrap() {
        n if n.contains("smith") && narrow("alpha_x") => "near-mirror value",
        _ => "closed form value",
    };
    tolerance::of_quantity(quantity)
}

#[test]
fn every_reference_row_is_reached_by_its_name() {
    let mut faults = Vec::new();
    for file in FILES {
        for row in rows(file) {
            let what = format!("{file}: {} {} {:?}", row.name, row.params, row.angles);
            match evaluate(&row.name, &json(&row.params), row.angles) {
                Ok(got) if tolerance(&row).accepts(got, row.value) => {}
                Ok(got) => faults.push(format!(
                    "{what}: got {got:e}, expected {:e}, off by {:e}",
                    row.value,
                    (got - row.value).abs() / row.value.abs()
                )),
                Err(e) => faults.push(format!("{what}: {e}")),
            }
        }
    }
    assert!(faults.is_empty(), "{} rows\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn integrals_that_are_functions_match_reference_values() {
    const TABLES: &[&str] = &[
        "Favg_dielectric",
        "Favg_conductor",
        "Favg_f82_tint_unclamped",
        "dipole_total_diffuse_albedo",
        "burley2015_irradiance_disk_fraction",
        "draine_mean_cos",
        "blackbody_linear_srgb",
    ];
    let path = format!("{}/tests/values/integrals.csv", env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for record in csv::Reader::from_path(path).unwrap().records() {
        let r = record.unwrap();
        let name = r[0].split(' ').next().unwrap();
        if TABLES.contains(&name) {
            let got = evaluate(name, &json(&r[1]), [None; 4]).unwrap();
            let expected: f64 = r[2].parse().unwrap();
            let off = (got - expected).abs() / expected.abs();
            assert!(
                off <= DIGITS_LOST,
                "{name} {}: got {got:e}, expected {expected:e}, off by {off:e}",
                &r[1]
            );
            count += 1;
        }
    }
    assert_eq!(count, 7 * TABLES.len());
}

#[test]
fn known_values_are_reproduced() {
    for info in functions::all() {
        for known in info.known {
            let params: Map<String, Json> = known
                .params
                .iter()
                .map(|(k, v)| ((*k).to_owned(), serde_json::from_str(v).unwrap()))
                .collect();
            let KnownValue::Value(angles) = known.what else { panic!("{}: not a value", info.id) };
            let got = Subject::new(info.id, &params).unwrap().value(&Angles::all(angles)).unwrap();
            let error = (got - known.value).abs() / known.value.abs();
            assert!(
                error <= known.relative,
                "{} {:?}: got {got:.17}, off by {error:e}",
                info.id,
                known.params
            );
            assert!(info.range[0] <= got && got <= info.range[1], "{}: {got} out of range", info.id);
        }
    }
}

#[test]
fn blanks_and_mistakes_are_named() {
    let empty = Map::new();
    let blank = evaluate("d-ggx", &empty, [Some(0.5), None, None, None]).unwrap_err();
    let EvalError::Function(FunctionError::Blank { column, .. }) = &blank else { panic!("{blank}") };
    assert_eq!(*column, "wi_phi");
    assert_eq!(blank.to_string(), "d-ggx: wi_phi is blank; it holds the facet normal");

    let blank = evaluate("lambert", &empty, [Some(0.5), Some(0.0), None, None]).unwrap_err();
    assert_eq!(blank.to_string(), "lambert: wo_theta is blank; a model needs both directions");

    let unknown = evaluate("d-gxx", &empty, [None; 4]).unwrap_err();
    let EvalError::Unknown { nearest, .. } = &unknown else { panic!("{unknown}") };
    assert!(nearest.contains(&"d-ggx"), "{nearest:?}");

    let mirror = evaluate("ggx", &json(r#"{"alpha": 0}"#), [Some(0.1); 4]).unwrap_err();
    assert!(matches!(mirror, EvalError::Delta { model: "ggx" }), "{mirror}");

    let total = evaluate("refract", &json(r#"{"eta": 0.5}"#), [Some(1.5), Some(0.0), Some(0.0), Some(0.0)]);
    assert!(total.unwrap_err().to_string().contains("total internal reflection"));

    let infinite = evaluate("lambda-ggx", &empty, [Some(std::f64::consts::FRAC_PI_2), Some(0.0), None, None]);
    // the cosine of the nearest number to a right angle is 6e-17, not 0
    assert!(infinite.unwrap() > 1e14);

    let range = evaluate("phase-fog", &json(r#"{"d_um": 1}"#), [Some(0.1), None, None, None]).unwrap_err();
    assert_eq!(range.to_string(), "phase-fog: d_um = 1 outside [5, 50]");
}

#[test]
fn values_are_finite_at_the_ends_of_every_parameter() {
    use brdfbake::models::Kind;
    let angles = [0.0, 1e-9, 0.5, 1.5, std::f64::consts::FRAC_PI_2, 2.0, std::f64::consts::PI];
    for info in functions::all() {
        for param in info.params {
            let Kind::Number { min, max, .. } = param.kind else { continue };
            for value in [min, max] {
                let params: Map<String, Json> =
                    [(param.id.to_owned(), Json::from(value))].into_iter().collect();
                let subject = Subject::new(info.id, &params).unwrap();
                for theta in angles {
                    match subject.value(&Angles::all([theta, 0.3, 0.7, 2.0])) {
                        Ok(v) => {
                            assert!(v.is_finite(), "{} {} = {value}, theta {theta}: {v}", info.id, param.id)
                        }
                        Err(EvalError::Function(FunctionError::Undefined { .. })) => {}
                        // tan of a normal in the horizon
                        Err(EvalError::Function(FunctionError::NotFinite {
                            value: f64::INFINITY, ..
                        })) => {}
                        Err(e) => panic!("{} {} = {value}, theta {theta}: {e}", info.id, param.id),
                    }
                }
            }
        }
    }
}

#[test]
fn names_are_unique() {
    let mut names = BTreeSet::new();
    let models = MODELS.iter().flat_map(|m| std::iter::once(m.id).chain(m.also.iter().map(|a| a.name)));
    let all = functions::all().flat_map(|f| std::iter::once(f.id).chain(f.also.iter().map(|a| a.name)));
    for name in models.chain(all) {
        assert!(names.insert(name), "{name} twice");
    }
}
