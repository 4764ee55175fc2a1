//! Terms at the stiff ends of their ranges, in both precisions, against 60-digit values at exactly the same inputs.
//!
//! `cargo test --test numbers single -- --nocapture` prints the largest relative error of each term.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test")]

use brdfbake::terms::smith::Ndf;
use brdfbake::terms::{
    beckmann::Beckmann, blinn_phong, charlie, fresnel, ggx::Ggx, gtr, phase, schlick, single,
};
use glam::{DVec3, Vec3};
use std::collections::BTreeMap;

/// Half of the digits of each precision.
const HALF_F64: f64 = 1.0 / (1u64 << 26) as f64;
const HALF_F32: f64 = 1.0 / (1u64 << 12) as f64;

/// Below this a number of 32 bits is flushed on some processors.
const SMALLEST: f64 = 1.2e-38;

struct Row {
    term: String,
    x: Vec<f64>,
    value: f64,
}

fn rows() -> Vec<Row> {
    let text = include_str!("values/stiff.csv");
    let body = text.lines().filter(|l| !l.starts_with('#')).skip(1);
    body.map(|line| {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |c: &&str| c.parse::<f64>().unwrap();
        Row {
            term: cells[0].to_owned(),
            x: cells[1..9].iter().filter(|c| !c.is_empty()).map(number).collect(),
            value: number(&cells[9]),
        }
    })
    .collect()
}

fn double(row: &Row) -> f64 {
    let x = &row.x;
    let v = |i: usize| DVec3::new(x[i], x[i + 1], x[i + 2]);
    match row.term.as_str() {
        "ggx-d" => Ggx::new(x[0], x[1]).d(v(2)),
        "ggx-lambda" => Ggx::new(x[0], x[1]).lambda(v(2)),
        "ggx-visibility" => Ggx::new(x[0], x[1]).visibility(v(2), v(5)),
        "beckmann-d" => Beckmann::new(x[0], x[1]).d(v(2)),
        "beckmann-lambda" => Beckmann::new(x[0], x[1]).lambda(v(2)),
        "dielectric" => fresnel::dielectric(x[0], x[1]).unpolarised(),
        "conductor" => fresnel::conductor(x[0], x[1], x[2]).unpolarised(),
        "conductor-absorptance" => fresnel::conductor_absorptance(x[0], x[1], x[2]).unpolarised(),
        "blinn-phong-d" => blinn_phong::d(x[0], v(1)),
        "henyey-greenstein" => phase::henyey_greenstein_at(x[0], x[1]),
        "gtr-d" => gtr::d(x[0], x[1], v(2)),
        "charlie-d" => charlie::d(x[0], v(1)),
        "schlick" => schlick::schlick(x[0], 1.0, x[1]),
        other => panic!("no term {other}"),
    }
}

fn single_precision(row: &Row) -> Option<f32> {
    #[allow(clippy::cast_possible_truncation, reason = "the inputs are exact numbers of 32 bits")]
    let x: Vec<f32> = row.x.iter().map(|v| *v as f32).collect();
    assert!(x.iter().zip(&row.x).all(|(a, b)| f64::from(*a).to_bits() == b.to_bits()), "{}", row.term);
    let v = |i: usize| Vec3::new(x[i], x[i + 1], x[i + 2]);
    Some(match row.term.as_str() {
        "ggx-d" => single::ggx_d(x[0], x[1], v(2)),
        "ggx-lambda" => single::ggx_mu_lambda(x[0], x[1], v(2)) / x[4],
        "ggx-visibility" => single::ggx_visibility(x[0], x[1], v(2), v(5)),
        "beckmann-d" => single::beckmann_d(x[0], x[1], v(2)),
        "dielectric" => single::dielectric(x[0], x[1]),
        "conductor" => single::conductor(x[0], x[1], x[2])[0],
        "conductor-absorptance" => single::conductor(x[0], x[1], x[2])[1],
        "blinn-phong-d" => single::blinn_phong_d(x[0], v(1)),
        "henyey-greenstein" => single::henyey_greenstein_at(x[0], x[1]),
        "gtr-d" => single::gtr_d(x[0], x[1], v(2)),
        "charlie-d" => single::charlie_d(x[0], v(1)),
        "schlick" => single::schlick(x[0], x[1]),
        _ => return None,
    })
}

#[test]
fn half_of_the_digits_are_left_at_every_stiff_end() {
    let mut worst: BTreeMap<String, [f64; 2]> = BTreeMap::new();
    let mut wrong = Vec::new();
    for row in rows() {
        let scale = row.value.abs().max(SMALLEST);
        let got = double(&row);
        let f64_error = (got - row.value).abs() / scale;
        let single = single_precision(&row).map(f64::from);
        let f32_error = single.map_or(0.0, |s| (s - row.value).abs() / scale);
        if !(f64_error < HALF_F64 && f32_error < HALF_F32) {
            wrong.push(format!("{} {:?}: {} in 64 bits {got}, in 32 {single:?}", row.term, row.x, row.value));
        }
        let w = worst.entry(row.term).or_default();
        *w = [w[0].max(f64_error), w[1].max(f32_error)];
    }
    for (term, [d, s]) in &worst {
        println!("{term:24} f64 {d:.1e}   f32 {s:.1e}");
    }
    assert!(worst.len() == 13 && wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn textbook_forms_would_fail_here() {
    // the same rows by the usual formulas in 32 bits: what the rearrangements are for
    let mut lost = 0;
    for row in rows().iter().filter(|r| r.term == "ggx-d") {
        #[allow(clippy::cast_possible_truncation, reason = "the inputs are exact numbers of 32 bits")]
        let [a, b, z] = [row.x[0] as f32, row.x[1] as f32, row.x[4] as f32];
        if (a - b).abs() == 0.0 {
            let square = z * z * (a * a - 1.0) + 1.0;
            let naive = f64::from(a * a / (std::f32::consts::PI * square * square));
            let error = (naive - row.value).abs() / row.value;
            lost += usize::from(error.is_nan() || error > HALF_F32);
        }
    }
    assert!(lost > 20, "{lost}");
}
