//! Against what two renderers compute: Mitsuba 3.9.1 point by point, Cycles (bpy 5.0.1) in white furnaces.
//!
//! The whole set is read from the folder that `BRDFBAKE_SHARED` names; `values/renderers.csv` has an excerpt that always runs.
#![allow(clippy::unwrap_used, reason = "test")]

use crate::common::shared;
use brdfbake::models::integral::directional_albedo;
use brdfbake::models::{self, Brdf, Params};
use glam::DVec3;
use serde_json::{Value as Json, json};
use std::collections::BTreeMap;
use std::path::Path;

fn build(name: &str, params: &Json) -> Box<dyn Brdf> {
    let (info, _) = models::find(name).unwrap();
    let all = params.as_object().unwrap().iter().map(|(k, v)| (k.as_str(), v));
    (info.build)(&Params::resolve(info.id, info.params, all).unwrap()).unwrap()
}

/// A direction printed with nine digits, made unit again.
fn direction(xyz: [f64; 3]) -> DVec3 {
    DVec3::from_array(xyz).normalize()
}

/// How far the renderer's number may be from f |cos|: single precision, and its rational Beckmann masking (up to 6.2e-3 in
/// each G1) where it has one.
fn bound(beckmann: bool, alpha: f64, transmits: bool) -> f64 {
    // the directions are rounded to 6e-8, which a lobe of width alpha amplifies
    let single = 3e-6 + 2e-6 / alpha;
    // near the critical angle 1 - F is a difference in single precision
    let through = if transmits { 6e-4 } else { 0.0 };
    if beckmann { 1.5e-2 } else { single + through }
}

#[test]
fn the_excerpt_agrees() {
    let path = format!("{}/tests/values/renderers.csv", env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for record in csv::Reader::from_path(path).unwrap().records() {
        let r = record.unwrap();
        let model = build(&r[1], &serde_json::from_str(&r[2]).unwrap());
        let inputs: Vec<f64> = r[4].split(' ').map(|v| v.parse().unwrap()).collect();
        let (expected, bound): (f64, f64) = (r[5].parse().unwrap(), r[6].parse().unwrap());
        let got = match &r[3] {
            "fcos" => {
                let view = direction([inputs[0], inputs[1], inputs[2]]);
                let light = direction([inputs[3], inputs[4], inputs[5]]);
                model.eval(view, light) * light.z.abs()
            }
            "albedo" => directional_albedo(&*model, inputs[0], 1e-6).value[0],
            "total" => {
                let t = model.transmission().unwrap().albedo(inputs[0].into(), 1e-6).value[0];
                directional_albedo(&*model, inputs[0], 1e-6).value[0] + t
            }
            other => panic!("{other}"),
        };
        assert!(
            (got - expected).abs() <= bound * expected.abs(),
            "{} {} {} {} {}: got {got}, {expected}",
            &r[0],
            &r[1],
            &r[2],
            &r[3],
            &r[4]
        );
        count += 1;
    }
    assert!(count >= 20, "{count}");
}

/// `ggx_Au_a0.3`, `beckmann_ior1.5_au0.1_av0.4` as (beckmann, rest, alphas).
fn parse(name: &str) -> (bool, String, [f64; 2]) {
    let mut parts = name.split('_');
    let beckmann = parts.next() == Some("beckmann");
    let material = parts.next().unwrap().to_owned();
    let alphas: Vec<f64> =
        parts.map(|p| p.trim_start_matches(|c: char| c.is_alphabetic()).parse().unwrap()).collect();
    (beckmann, material, [alphas[0], *alphas.last().unwrap()])
}

fn pointwise(shared: &Path, check: &mut dyn FnMut(&str, &str, &csv::StringRecord)) {
    let dir = shared.join("oracles/mitsuba/pointwise");
    for entry in std::fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
        let Some((_, bsdf)) = stem.split_once("__") else { continue };
        let Some((kind, rest)) = bsdf.split_once('_') else { continue };
        for record in csv::Reader::from_path(&path).unwrap().records() {
            check(kind, rest, &record.unwrap());
        }
    }
}

#[test]
fn mitsuba_agrees_point_by_point() {
    let Some(shared) = shared() else { return };
    let metals: BTreeMap<&str, [[f64; 2]; 3]> = [
        ("Au", [[0.143_119, 3.983_16], [0.374_957, 2.385_721], [1.442_479, 1.603_215]]),
        ("Cu", [[0.200_438, 3.912_949], [0.924_033, 2.452_848], [1.102_212, 2.142_188]]),
        ("Al", [[1.657_46, 9.223_869], [0.880_369, 6.269_523], [0.521_229, 4.837_001]]),
    ]
    .into();
    let mut cache: BTreeMap<String, Vec<Box<dyn Brdf>>> = BTreeMap::new();
    let mut worst: BTreeMap<String, f64> = BTreeMap::new();
    let mut count = 0;
    pointwise(&shared, &mut |kind, rest, r| {
        if kind != "roughconductor" && kind != "roughdielectric" {
            return;
        }
        let (beckmann, material, [x, y]) = parse(rest);
        let base = if beckmann { "beckmann" } else { "ggx" };
        let key = format!("{kind} {rest}");
        let models = cache.entry(key.clone()).or_insert_with(|| {
            let p = json!({ "alpha_x": x, "alpha_y": y, "masking": "separable" });
            let with = |more: Json| {
                let mut p = p.clone();
                p.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
                p
            };
            if kind == "roughdielectric" {
                let eta: f64 = material.trim_start_matches("ior").parse().unwrap();
                return vec![build(&format!("{base}-glass"), &with(json!({ "eta": eta })))];
            }
            match metals.get(material.as_str()) {
                Some(nk) => nk
                    .iter()
                    .map(|[n, k]| build(&format!("{base}-conductor"), &with(json!({ "eta": n, "k": k }))))
                    .collect(),
                None => vec![build(base, &p)],
            }
        });
        let number = |i: usize| -> f64 { r[i].parse().unwrap() };
        let view = direction([number(1), number(2), number(3)]);
        let light = direction([number(4), number(5), number(6)]);
        for (channel, model) in models.iter().enumerate() {
            let expected = number(7 + channel);
            // grazing directions and far tails: single precision has no digits left
            if expected.abs() < 1e-6 || view.z.abs() < 0.02 || light.z.abs() < 0.02 {
                continue;
            }
            let got = model.eval(view, light) * light.z.abs();
            let off = (got - expected).abs() / expected;
            let relative = off / bound(beckmann, x.min(y), kind == "roughdielectric");
            let entry = worst.entry(key.clone()).or_default();
            *entry = entry.max(relative);
            count += 1;
            assert!(
                relative <= 1.0,
                "{key} {}: got {got}, expected {expected}, off {off:e}",
                r.iter().collect::<Vec<_>>().join(",")
            );
        }
    });
    assert!(count > 1000, "{count}");
}

/// File, model of a roughness, bound.
type Furnace = (&'static str, &'static dyn Fn(f64) -> (&'static str, Json), f64);

#[test]
fn cycles_agrees_in_white_furnaces() {
    let Some(shared) = shared() else { return };
    let cases: [Furnace; 7] = [
        ("glossy_ggx", &|r| ("ggx", json!({ "alpha": r * r })), 3e-4),
        ("glossy_beckmann", &|r| ("beckmann", json!({ "alpha": r * r })), 5e-4),
        ("glossy_ggx_color0.5", &|r| ("ggx", json!({ "alpha": r * r, "f0": 0.5, "f90": 0.5 })), 3e-4),
        (
            "glass_ior1.5_ggx_total_R_plus_T",
            &|r| ("ggx-glass", json!({ "alpha": r * r, "eta": 1.5, "masking": "sum" })),
            3e-4,
        ),
        (
            "glass_ior1.5_beckmann_total_R_plus_T",
            &|r| ("beckmann-glass", json!({ "alpha": r * r, "eta": 1.5, "masking": "sum" })),
            // its Lambda is the rational fit
            2e-3,
        ),
        ("sheen_ashikhmin", &|r| ("velvet-ashikhmin", json!({ "sigma": r })), 1e-3),
        // its R is the authors' table, ours the fit of MaterialX
        ("sheen_microfiber", &|r| ("ltc-sheen", json!({ "roughness": r })), 0.055),
    ];
    let mut faults = Vec::new();
    for (file, model, bound) in cases {
        let path = shared.join(format!("oracles/blender/{file}.csv"));
        let mut count = 0;
        for record in csv::Reader::from_path(path).unwrap().records() {
            let record = record.unwrap();
            let v: Vec<f64> = record.iter().map(|v| v.parse().unwrap()).collect();
            let (name, params) = model(v[0]);
            let model = build(name, &params);
            let mut got = directional_albedo(&*model, v[1], 1e-6).value[0];
            if let Some(t) = model.transmission() {
                got += t.albedo(v[1].into(), 1e-6).value[0];
            }
            let off = (got - v[2]).abs();
            if off > bound + 6.0 * v[5] {
                faults.push(format!("{file} r {} mu {}: got {got}, {} +- {}", v[0], v[1], v[2], v[5]));
            }
            count += 1;
        }
        assert!(count >= 12, "{file}: {count}");
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
