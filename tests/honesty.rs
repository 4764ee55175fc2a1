//! Error estimates over the whole domain of white GGX and Beckmann, corners included: a long test.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test")]

use brdfbake::models::{self, Brdf, Params};
use brdfbake::tables::integral::{Functional, integrate};
use brdfbake::verify::seeds::Seeds;

const TOLERANCES: [f64; 5] = [1e-2, 2.4e-4, 1e-5, 1e-6, 1e-9];

fn model(id: &str, alpha: f64) -> Box<dyn Brdf> {
    let (info, _) = models::find(id).unwrap();
    let mut params = Params::resolve(info.id, info.params, []).unwrap();
    for key in ["alpha", "alpha_x", "alpha_y"] {
        params.set(key, alpha);
    }
    (info.build)(&params).unwrap()
}

/// Pairs of mu and alpha: uniform, and logarithmic towards each corner.
fn points(count: usize) -> Vec<(f64, f64)> {
    let mut seeds = Seeds::new(0x4057);
    let log = |seeds: &mut Seeds| libm::pow(10.0, -4.5 * seeds.unit());
    (0..count)
        .map(|i| match i % 4 {
            0 => (seeds.unit(), seeds.unit()),
            1 => (log(&mut seeds), log(&mut seeds)),
            2 => (1.0 - log(&mut seeds), log(&mut seeds)),
            _ => (seeds.unit(), log(&mut seeds)),
        })
        .collect()
}

/// Share of estimates that are too small, and the worst ratio of an error to its estimate.
fn honesty(
    id: &'static str,
    functionals: &[Functional],
    tolerance: f64,
    points: &[(f64, f64)],
) -> (f64, f64) {
    let both = [Functional::One, Functional::Schlick];
    let (mut low, mut worst) = (0.0, 0.0f64);
    for &(mu, alpha) in points {
        let m = model(id, alpha);
        let reference = integrate(&*m, mu, &both, 1e-13).unwrap();
        let e = integrate(&*m, mu, functionals, tolerance).unwrap();
        let mut ok = true;
        for c in 0..functionals.len() {
            let error = (e.value[c] - reference.value[c]).abs();
            let ratio = (error - 1e-13).max(0.0) / e.error[c];
            worst = worst.max(ratio);
            ok &= ratio <= 1.0;
        }
        low += f64::from(u8::from(!ok));
    }
    (low / points.len() as f64, worst)
}

fn check(id: &'static str, functionals: &[Functional], count: usize) {
    let points = points(count);
    for tolerance in TOLERANCES {
        let (low, worst) = honesty(id, functionals, tolerance, &points);
        println!("{id} {functionals:?} {tolerance:.0e}: {:.3} % too small, worst {worst:.2} x", 100.0 * low);
        assert!(low <= 0.01, "{id} {tolerance:e}: {low} of the estimates are too small");
        assert!(worst <= 10.0, "{id} {tolerance:e}: an error is {worst} times its estimate");
    }
}

#[test]
fn estimates_of_the_chart_and_of_the_reduction_are_honest() {
    check("ggx", &[Functional::One, Functional::Schlick], 400);
    check("ggx", &[Functional::One], 400);
    check("beckmann", &[Functional::One, Functional::Schlick], 100);
}

#[test]
#[ignore = "long: a minute; run by `cargo long`"]
fn estimates_are_honest_on_many_points() {
    check("ggx", &[Functional::One, Functional::Schlick], 20_000);
    check("ggx", &[Functional::One], 20_000);
    check("beckmann", &[Functional::One, Functional::Schlick], 2_000);
}
