//! Error estimates over the whole domain of white GGX and Beckmann, corners included: a long test.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test")]

use brdfbake::models::integral::integrate_four;
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

/// Four views that a table may hold beside each other: of one row, or anywhere.
fn groups(count: usize) -> Vec<[(f64, f64); 4]> {
    let points = points(4 * count);
    let group = |(i, p): (usize, &[(f64, f64)])| {
        let (mu, alpha) = p[0];
        let row = [1.0, 0.98, 0.95, 0.9].map(|f| (mu * f, alpha));
        if i % 4 == 3 { [p[0], p[1], p[2], p[3]] } else { row }
    };
    points.chunks_exact(4).enumerate().map(group).collect()
}

/// The kernel of four views, in both maskings, against the chart: estimates as honest, values within them.
fn check_four(masking: &str, count: usize) {
    let functionals = [Functional::SchlickComplement, Functional::Schlick];
    let groups = groups(count);
    let build = |alpha: f64| {
        let (info, _) = models::find("ggx").unwrap();
        let (alpha, masking) = (alpha.into(), masking.into());
        let given = [("alpha", &alpha), ("masking", &masking)];
        (info.build)(&Params::resolve(info.id, info.params, given).unwrap()).unwrap()
    };
    for tolerance in TOLERANCES {
        let (mut low, mut worst) = (0.0, 0.0f64);
        for group in &groups {
            let models = group.map(|(_, alpha)| build(alpha));
            let mu = group.map(|(mu, _)| mu);
            let refs = [0, 1, 2, 3].map(|i| &*models[i] as &dyn Brdf);
            let four = integrate_four(refs, mu, &functionals, tolerance).unwrap();
            for (lane, e) in four.iter().enumerate() {
                let reference = integrate(refs[lane], mu[lane], &functionals, 1e-13).unwrap();
                let ratio =
                    |c: usize| ((e.value[c] - reference.value[c]).abs() - 1e-13).max(0.0) / e.error[c];
                let ratio = ratio(0).max(ratio(1));
                worst = worst.max(ratio);
                low += f64::from(u8::from(ratio > 1.0));
            }
        }
        let low = low / (4 * groups.len()) as f64;
        println!("four ggx, {masking}, {tolerance:.0e}: {:.3} % too small, worst {worst:.2} x", 100.0 * low);
        assert!(low <= 0.01, "{masking} {tolerance:e}: {low} of the estimates are too small");
        assert!(worst <= 10.0, "{masking} {tolerance:e}: an error is {worst} times its estimate");
    }
}

#[test]
fn four_views_at_a_time_are_as_honest_as_one() {
    check_four("correlated", 100);
    check_four("separable", 40);
}

#[test]
#[ignore = "long: a minute; run by `cargo long`"]
fn four_views_at_a_time_are_honest_on_many_points() {
    check_four("correlated", 5_000);
    check_four("separable", 2_000);
}

#[test]
#[ignore = "long: a minute; run by `cargo long`"]
fn estimates_are_honest_on_many_points() {
    check("ggx", &[Functional::One, Functional::Schlick], 20_000);
    check("ggx", &[Functional::One], 20_000);
    check("beckmann", &[Functional::One, Functional::Schlick], 2_000);
}
