//! Single texels against reference integrals (`values/integrals.csv`) and excerpts of other programs (`values/energy.csv`).

use crate::tables_energy::support::{table, texel};
use crate::tolerance::{INTEGRAL_9_TWICE, INTEGRAL_12};
use serde_json::Value as Json;
use std::collections::BTreeMap;

fn records(file: &str) -> Vec<csv::StringRecord> {
    let path = format!("{}/tests/values/{file}", env!("CARGO_MANIFEST_DIR"));
    csv::Reader::from_path(path).unwrap().records().map(Result::unwrap).collect()
}

#[test]
fn excerpts_of_other_programs_are_met() {
    let mut largest: BTreeMap<String, (f64, f64)> = BTreeMap::new();
    let rows = records("energy.csv");
    assert!(rows.len() >= 80, "{}", rows.len());
    let mut wrong = Vec::new();
    for r in &rows {
        let at: serde_json::Map<String, Json> = serde_json::from_str(&r[5]).unwrap();
        let axes: Vec<&str> = at.keys().map(String::as_str).collect();
        let point: Vec<f64> = at.values().map(|v| v.as_f64().unwrap()).collect();
        let (expected, bound): (f64, f64) = (r[6].parse().unwrap(), r[7].parse().unwrap());
        let tolerance = (0.1 * bound).clamp(1e-11, 1e-4);
        let bound_table = table(&r[1], &r[2], &r[3], &[&r[4]], &axes);
        let (got, error) = texel(&bound_table, &point, tolerance);
        let off = (got - expected).abs();
        let entry = largest.entry(format!("{}: {}", &r[0], &r[4])).or_default();
        *entry = (entry.0.max(off), entry.1.max(bound));
        if off > bound + error {
            wrong.push(format!(
                "{} {} {} {}: got {got}, {expected}, off by {off:e}",
                &r[0], &r[3], &r[4], &r[5]
            ));
        }
    }
    for (what, (off, bound)) in largest {
        println!("{what}: largest difference {off:.1e} (allowed {bound:.1e})");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Kind, model, channel, and the axes under their names in the reference file.
type Row = (&'static str, &'static str, &'static str, &'static str, &'static [(&'static str, &'static str)]);

const TABLES: &[Row] = &[
    ("E_ggx_correlated_white", "albedo", "ggx", "e", &[("alpha", "alpha")]),
    ("one_minus_E_ggx_correlated_white", "compensation", "ggx", "ms.missing", &[("alpha", "alpha")]),
    ("E_ggx_correlated_schlick", "albedo", "ggx", "e", &[("alpha", "alpha"), ("f0", "F0")]),
    (
        "E_ggx_correlated_dielectric_reflection",
        "albedo",
        "ggx-dielectric",
        "e",
        &[("alpha", "alpha"), ("eta", "eta")],
    ),
    (
        "E_ggx_correlated_white_aniso",
        "albedo",
        "ggx",
        "e",
        &[("phi", "phi"), ("alpha_x", "alpha_x"), ("alpha_y", "alpha_y")],
    ),
    ("E_glass_ggx_separable_R", "albedo", "ggx-glass", "r", &[("alpha", "alpha"), ("eta", "eta")]),
    ("E_glass_ggx_separable_T", "albedo", "ggx-glass", "t", &[("alpha", "alpha"), ("eta", "eta")]),
    ("E_charlie_conty_kulla_fitted_lambda", "albedo", "charlie", "e", &[("r", "r")]),
    ("E_charlie_conty_kulla_fitted_lambda", "sheen-scaling", "charlie", "sheen.e", &[("alpha", "r")]),
    ("E_charlie_neubelt_visibility", "albedo", "charlie-neubelt", "e", &[("r", "r")]),
    ("E_charlie_neubelt_visibility", "dfg", "ggx", "dfg.cloth", &[("alpha", "r")]),
    ("E_disney_diffuse_base1", "albedo", "burley-diffuse", "e", &[("r", "roughness")]),
    ("E_disney_diffuse_base1", "dfg", "ggx", "dfg.diffuse", &[("alpha", "roughness")]),
    ("E_eon", "albedo", "eon", "e", &[("r", "r"), ("rho", "rho")]),
    ("E_fon_rho1", "albedo", "fujii", "e", &[("r", "r")]),
    ("E_oren_nayar_qualitative_rho1", "albedo", "oren-nayar", "e", &[("sigma", "sigma")]),
    ("E_oren_nayar_full", "albedo", "oren-nayar-full", "e", &[("sigma", "sigma"), ("rho", "rho")]),
    ("Eavg_ggx_correlated_white", "average-albedo", "ggx", "e-avg", &[("alpha", "alpha")]),
    ("DFG_A_smith_correlated", "dfg", "ggx", "dfg.scale", &[("alpha", "alpha")]),
    ("DFG_B_smith_correlated", "dfg", "ggx", "dfg.bias", &[("alpha", "alpha")]),
    ("DFG_B_smith_correlated", "generalised-schlick", "ggx", "schlick.part", &[("alpha", "alpha")]),
];

#[test]
fn reference_integrals_are_met_through_tables() {
    let rows = records("integrals.csv");
    for (name, kind, model, channel, axes) in TABLES {
        let (mut count, mut largest) = (0, 0.0f64);
        for r in rows.iter().filter(|r| &r[0] == *name) {
            let p: Json = serde_json::from_str(&r[1]).unwrap();
            let mut ids = Vec::new();
            let mut point = Vec::new();
            if let Some(theta) = p["theta"].as_f64() {
                ids.push("mu");
                point.push(libm::cos(theta));
            }
            for (axis, key) in *axes {
                let value = p[*key].as_f64().unwrap_or_else(|| panic!("{name}: no {key} in {p}"));
                // the diffuse lobe of the split sum takes the roughness, whose square is alpha
                let diffuse = *channel == "dfg.diffuse";
                ids.push(*axis);
                point.push(if diffuse { value * value } else { value });
            }
            let params = if *name == "E_oren_nayar_qualitative_rho1" { r#"{"rho": 1}"# } else { "{}" };
            let bound = table(kind, model, params, &[channel], &ids);
            let (got, error) = texel(&bound, &point, 1e-10);
            let expected: f64 = r[2].parse().unwrap();
            let digits: i32 = r[3].parse().unwrap();
            let known = libm::pow(10.0, f64::from(1 - digits)) * expected.abs();
            let off = (got - expected).abs();
            assert!(
                off <= error + known + INTEGRAL_12,
                "{name} {kind} {}: off by {off:e}, estimate {error:e}",
                &r[1]
            );
            // total reflection and the corner of a grazing view limit what the rules reach
            assert!(error <= INTEGRAL_9_TWICE, "{name} {kind} {}: estimate {error:e}", &r[1]);
            largest = largest.max(off);
            count += 1;
        }
        assert!(count >= 4, "{name}: {count} values");
        println!("{name} through {kind} {channel}: {count} values, largest difference {largest:.1e}");
    }
}
