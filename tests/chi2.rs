//! Every sampler draws from the density that it states: a chi-square test over all models, and the mass of the density.
//!
//! The hemisphere is cut into cells of equal steps in theta and phi. Expected counts are the density integrated over
//! the cells; draws below the horizon are one more cell, which expects what is left of the mass. Seeds are fixed.
#![allow(clippy::unwrap_used, reason = "a test may fail by panicking")]
#![allow(clippy::print_stdout, reason = "figures for --nocapture")]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "cell numbers are small and not negative"
)]

use crate::tolerance::{DIGITS_LOST, FEW_ROUNDINGS, near};
use brdfbake::integrate::gauss;
use brdfbake::math::frame;
use brdfbake::models::{Brdf, MODELS, ModelInfo, Params};
use brdfbake::verify::seeds::Seeds;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

/// View angles from the normal and azimuths: normal incidence, and nearly grazing.
const VIEWS: [[f64; 2]; 5] = [[0.0, 0.0], [0.5, 0.3], [1.0, 2.0], [1.4, 4.0], [1.5533, 5.5]];

/// Chance that the whole suite fails by bad luck.
const SIGNIFICANCE: f64 = 0.01;

struct Grid {
    theta: usize,
    phi: usize,
    draws: u32,
}

/// What a run found.
struct Outcome {
    p: f64,
    mass: f64,
}

/// Parameter sets that bring out what a model can do; the defaults for one that is not listed.
fn cases(info: &ModelInfo) -> Vec<&'static str> {
    let own: &[&str] = match info.id {
        id if id.starts_with("ward") => &[
            r#"{"rho_d": 0, "rho_s": 1, "alpha": 0.2}"#,
            r#"{"rho_d": 0.3, "rho_s": 0.6, "alpha_x": 0.1, "alpha_y": 0.5}"#,
            r#"{"rho_d": 0, "rho_s": 1, "alpha": 1}"#,
        ],
        id if id.contains("phong") && info.params.iter().any(|p| p.id == "kd") => &[
            r#"{"kd": 0, "ks": 1, "n": 0}"#,
            r#"{"kd": 0.4, "ks": 0.5, "n": 8}"#,
            r#"{"kd": 0, "ks": 1, "n": 300}"#,
        ],
        "ashikhmin-shirley" | "ashikhmin-shirley-specular" => &[
            r#"{"rs": 0.5, "nu": 10, "nv": 10}"#,
            r#"{"rs": 0.05, "nu": 200, "nv": 5}"#,
            r#"{"rs": 1, "nu": 0, "nv": 3}"#,
        ],
        "lafortune-lobe" => &[
            r#"{"rho_d": 0, "cx": -0.5, "cy": -0.75, "cz": 0.875, "n": 12}"#,
            r#"{"rho_d": 0.2, "cx": 0.875, "cy": 0.875, "cz": 0.78, "n": 20}"#,
            r#"{"rho_d": 0, "cx": 0, "cy": 0, "cz": 0.5, "n": 2}"#,
            r#"{"rho_d": 0, "cx": -1, "cy": -1, "cz": -0.5, "n": 2}"#,
        ],
        "lafortune" => &[r#"{"rho_d": 0.3, "lobes": [[-1, -1, 0.7, 30, 1], [0.9, 0.9, 0.8, 10, 0.3]]}"#],
        // at its default gloss the lobe is narrower than a cell: a broad one tells more
        "disney-clearcoat" => &[r#"{"gloss": 0}"#],
        "minnaert" => &[r#"{"k": 0}"#, r#"{"k": 0.5}"#, r#"{"k": 3}"#],
        _ if info.params.iter().any(|p| p.id == "alpha_x") => {
            &[r#"{"alpha": 0.1}"#, r#"{"alpha": 0.7}"#, r#"{"alpha_x": 0.1, "alpha_y": 0.6}"#]
        }
        _ if info.params.iter().any(|p| p.id == "alpha") => &[r#"{"alpha": 0.1}"#, r#"{"alpha": 0.7}"#],
        _ => &["{}"],
    };
    own.to_vec()
}

fn build(info: &'static ModelInfo, params: &str) -> Box<dyn Brdf> {
    let given: serde_json::Map<String, serde_json::Value> = serde_json::from_str(params).unwrap();
    let given = given.iter().map(|(k, v)| (k.as_str(), v));
    (info.build)(&Params::resolve(info.id, info.params, given).unwrap()).unwrap()
}

/// The integral of the density over a cell: 3 x 3 Gauss points, halved until two levels agree.
fn cell(pdf: &dyn Fn(DVec3) -> f64, from: [f64; 2], length: [f64; 2], depth: u32) -> f64 {
    let rule = gauss::rule(3);
    let sum = |from: [f64; 2], length: [f64; 2]| {
        rule.integrate(from[0], from[0] + length[0], |theta| {
            libm::sin(theta)
                * rule.integrate(from[1], from[1] + length[1], |phi| pdf(frame::spherical(theta, phi)))
        })
    };
    let half = length.map(|l| 0.5 * l);
    let corners = [[0.0, 0.0], [half[0], 0.0], [0.0, half[1]], half];
    let quarters = corners.map(|c| [from[0] + c[0], from[1] + c[1]]);
    let (whole, fine) = (sum(from, length), quarters.iter().map(|q| sum(*q, half)).sum::<f64>());
    if depth == 0 || (whole - fine).abs() <= 1e-8 + 1e-4 * fine {
        fine
    } else {
        quarters.iter().map(|q| cell(pdf, *q, half, depth - 1)).sum()
    }
}

/// Draws from one model against the density of another (its own, but for the test of the test).
fn run(model: &dyn Brdf, density: &dyn Brdf, view: [f64; 2], grid: &Grid, seed: u64) -> Outcome {
    let wo = frame::spherical(view[0], view[1]);
    let step = [FRAC_PI_2 / grid.theta as f64, TAU / grid.phi as f64];
    let count = grid.theta * grid.phi;
    let mut observed = vec![0u32; count + 1];
    let mut seeds = Seeds::new(seed);
    for _ in 0..grid.draws {
        let u = DVec2::new(seeds.unit(), seeds.unit());
        let Some(s) = model.sample(wo, u) else {
            observed[count] += 1;
            continue;
        };
        assert!(s.wi.z > 0.0 && (s.wi.length() - 1.0).abs() < DIGITS_LOST, "{:?}", s.wi);
        let pdf = model.pdf(wo, s.wi);
        assert!(s.pdf > 0.0 && (s.pdf - pdf).abs() <= 1e-9 * pdf, "states {} and {pdf}", s.pdf);
        let i = ((frame::theta(s.wi) / step[0]) as usize).min(grid.theta - 1);
        let j = ((frame::phi(s.wi).rem_euclid(TAU) / step[1]) as usize).min(grid.phi - 1);
        observed[i * grid.phi + j] += 1;
    }
    let pdf = |wi: DVec3| density.pdf(wo, wi);
    let mut expected: Vec<f64> = (0..count)
        .map(|k| cell(&pdf, [step[0] * (k / grid.phi) as f64, step[1] * (k % grid.phi) as f64], step, 5))
        .collect();
    let mass: f64 = expected.iter().sum();
    expected.push((1.0 - mass).max(0.0));
    Outcome { p: p_value(&observed, &expected, f64::from(grid.draws)), mass }
}

/// Cells with fewer than 5 expected draws are pooled.
fn p_value(observed: &[u32], expected: &[f64], draws: f64) -> f64 {
    let mut order: Vec<usize> = (0..expected.len()).collect();
    order.sort_by(|a, b| expected[*a].total_cmp(&expected[*b]));
    let (mut chi2, mut cells) = (0.0, 0.0);
    let (mut pool_o, mut pool_e) = (0.0, 0.0);
    for k in order {
        pool_o += f64::from(observed[k]);
        pool_e += expected[k] * draws;
        if pool_e >= 5.0 {
            chi2 += (pool_o - pool_e) * (pool_o - pool_e) / pool_e;
            cells += 1.0;
            (pool_o, pool_e) = (0.0, 0.0);
        }
    }
    // what is left holds fewer than 5: it must not hold many draws
    if pool_o > 40.0 {
        return 0.0;
    }
    if cells < 2.0 { 1.0 } else { upper_gamma(0.5 * (cells - 1.0), 0.5 * chi2) }
}

/// The regularised incomplete gamma function Q(a, x), by its series or continued fraction (DLMF 8.7.1, 8.9.2).
fn upper_gamma(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    let front = libm::exp(a * libm::log(x) - x - libm::lgamma(a));
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-15 {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        return 1.0 - front * sum;
    }
    // modified Lentz
    let mut b = x + 1.0 - a;
    let mut c = 1e300;
    let mut d = 1.0 / b;
    let mut h = d;
    for i in 1..100_000 {
        let n = f64::from(i);
        let an = -n * (n - a);
        b += 2.0;
        d = 1.0 / (an * d + b);
        c = b + an / c;
        h *= d * c;
        if (d * c - 1.0).abs() < 1e-14 {
            break;
        }
    }
    front * h
}

fn suite(grid: &Grid, seed: u64) {
    let runs: Vec<_> = MODELS
        .iter()
        .flat_map(|info| cases(info).into_iter().map(move |params| (*info, params)))
        .flat_map(|(info, params)| VIEWS.into_iter().map(move |view| (info, params, view)))
        .collect();
    // Sidak: the chance that any of n true samplers falls below this is SIGNIFICANCE
    let threshold = -libm::expm1(libm::log1p(-SIGNIFICANCE) / runs.len() as f64);
    let results: Vec<(String, Outcome)> = runs
        .par_iter()
        .enumerate()
        .map(|(i, (info, params, view))| {
            let model = build(info, params);
            let outcome = run(&*model, &*model, *view, grid, seed + i as u64);
            (format!("{} {params} view {view:?}", info.id), outcome)
        })
        .collect();
    let least = results.iter().map(|r| r.1.p).fold(1.0, f64::min);
    println!("{} runs, smallest p {least:.2e}, threshold {threshold:.2e}", results.len());
    for (what, outcome) in &results {
        assert!(outcome.p >= threshold, "{what}: p = {:e} < {threshold:e}", outcome.p);
        assert!(outcome.mass <= 1.0 + 1e-4, "{what}: the density integrates to {}", outcome.mass);
    }
}

#[test]
fn incomplete_gamma() {
    // chi-square tables: 5 % points for 1, 10 and 100 degrees of freedom
    for (dof, chi2) in
        [(1.0, 3.841_458_820_694_124), (10.0, 18.307_038_053_275_14), (100.0, 124.342_113_404_004_1)]
    {
        near!(upper_gamma(0.5 * dof, 0.5 * chi2), 0.05, DIGITS_LOST, "{dof}");
    }
    near!(upper_gamma(1.0, 2.0), libm::exp(-2.0), FEW_ROUNDINGS);
    near!(upper_gamma(1.0, 0.5), libm::exp(-0.5), FEW_ROUNDINGS);
}

#[test]
fn the_test_finds_a_wrong_density() {
    // draws of a lobe with n = 8 against the density of n = 9
    let info = MODELS.iter().find(|m| m.id == "phong").unwrap();
    let [draws, density] = [8, 9].map(|n| build(info, &format!(r#"{{"kd": 0, "ks": 1, "n": {n}}}"#)));
    let grid = Grid { theta: 20, phi: 40, draws: 100_000 };
    assert!(run(&*draws, &*density, [0.5, 0.3], &grid, 11).p < 1e-6);
    assert!(run(&*draws, &*draws, [0.5, 0.3], &grid, 11).p > 1e-3);
}

#[test]
fn samplers_draw_from_their_densities() {
    suite(&Grid { theta: 30, phi: 60, draws: 40_000 }, 1);
}

#[test]
#[ignore = "a million draws a case: minutes"]
fn samplers_draw_from_their_densities_long() {
    suite(&Grid { theta: 80, phi: 160, draws: 1_000_000 }, 1000);
}
