//! Error and time together: the baker against the estimators that others ship, in one process.
//!
//! `cargo bench` prints a table; nothing is asserted. One thread throughout.
#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    missing_docs,
    reason = "a report"
)]

#[path = "../tests/common.rs"]
mod common;

use brdfbake::grid::{Table, Texel};
use brdfbake::tables::Bound;
use brdfbake::tables::integral::Functional;
use brdfbake::tables::sweep::Sweep;
use brdfbake::verify::baseline::{hammersley_f32, hammersley_f64};
use brdfbake::verify::cross_check::estimate;
use common::{axis, bake, request};
use std::time::Instant;

/// Best of a few runs, in seconds.
fn time<T>(runs: usize, mut f: impl FnMut() -> T) -> (f64, T) {
    let mut best = f64::INFINITY;
    let mut last = None;
    for _ in 0..runs {
        let start = Instant::now();
        let value = f();
        best = best.min(start.elapsed().as_secs_f64());
        last = Some(value);
    }
    (best, last.unwrap())
}

fn dfg(len: usize) -> Bound {
    request(
        "dfg",
        "scale-bias",
        "{}",
        vec![axis("mu", len, Texel::Center), axis("roughness", len, Texel::Center)],
    )
}

fn largest(reference: &Table, values: impl Fn(usize) -> f64) -> f64 {
    reference.values.iter().enumerate().map(|(i, r)| (values(i) - r).abs()).fold(0.0, f64::max)
}

fn row(name: &str, seconds: f64, error: f64, evaluations: f64) {
    println!("| {name} | {:.2} ms | {error:.1e} | {evaluations:.0} |", seconds * 1e3);
}

fn split_sum(len: usize) {
    let bound = dfg(len);
    let reference = bake(&bound, 1e-11).unwrap();
    println!("\n### DFG {len} x {len}, scale and bias, one thread\n");
    println!("| method | time | largest error | evaluations a texel |\n|---|---|---|---|");
    let texels = (len * len) as f64;
    for tolerance in [1e-2, 1.0 / 4096.0, 1e-6, 1e-9] {
        let (seconds, table) = time(5, || bake(&bound, tolerance).unwrap());
        let error = largest(&reference, |i| table.values[i]);
        row(&format!("tolerance {tolerance:.1e}"), seconds, error, table.total_evaluations() as f64 / texels);
    }
    let points: Vec<[f64; 2]> = (0..len * len)
        .map(|t| {
            let p = bound.spec.grid.texel(t);
            [p.values()[0], p.values()[1]]
        })
        .collect();
    for samples in [1024u32, 4096] {
        let (seconds, v) = time(3, || {
            points
                .iter()
                .flat_map(|p| hammersley_f32(p[0] as f32, p[1] as f32, samples))
                .collect::<Vec<f32>>()
        });
        row(
            &format!("{samples} Hammersley points, f32"),
            seconds,
            largest(&reference, |i| f64::from(v[i])),
            samples.into(),
        );
    }
    let (seconds, v) =
        time(1, || points.iter().flat_map(|p| hammersley_f64(p[0], p[1], 1024)).collect::<Vec<f64>>());
    sampled(&reference, &bound);
    row("1024 Hammersley points, f64", seconds, largest(&reference, |i| v[i]), 1024.0);
}

/// The independent integrator of the cross-check: visible normals at scrambled Sobol points.
fn sampled(reference: &Table, bound: &Bound) {
    let sweep = Sweep::new(&bound.spec, true).unwrap();
    for points in [64u32, 1024] {
        let (seconds, values) = time(1, || {
            let texel = |t| {
                let p = bound.spec.grid.texel(t);
                let model = sweep.model(p.values()).unwrap();
                let weights = [Functional::SchlickComplement, Functional::Schlick];
                estimate(&*model, p.values()[0], weights, t as u64, 1, points).map(|e| e.mean)
            };
            (0..bound.spec.grid.len()).flat_map(texel).collect::<Vec<f64>>()
        });
        let name = format!("{points} visible normals, scrambled Sobol, f64");
        row(&name, seconds, largest(reference, |i| values[i]), points.into());
    }
}

fn albedo() {
    let axes = || vec![axis("mu", 32, Texel::Center), axis("roughness", 32, Texel::Center)];
    println!("\n### E(mu, alpha) 32 x 32, white GGX, one thread\n");
    println!("| method | time | largest error | evaluations a texel |\n|---|---|---|---|");
    let reduced = request("albedo", "e", "{}", axes());
    let chart = request("dfg", "multiscatter", "{}", axes());
    let reference = bake(&reduced, 1e-12).unwrap();
    for tolerance in [1e-4, 1e-6, 1e-9] {
        let (seconds, table) = time(5, || bake(&reduced, tolerance).unwrap());
        let error = largest(&reference, |i| table.values[i]);
        row(
            &format!("one-dimensional reduction, {tolerance:.0e}"),
            seconds,
            error,
            table.total_evaluations() as f64 / 1024.0,
        );
        let (seconds, table) = time(5, || bake(&chart, tolerance).unwrap());
        let error = largest(&reference, |i| table.values[2 * i + 1]);
        row(
            &format!("half-vector chart (with Fc), {tolerance:.0e}"),
            seconds,
            error,
            table.total_evaluations() as f64 / 1024.0,
        );
    }
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        split_sum(32);
        split_sum(128);
        albedo();
    });
}
