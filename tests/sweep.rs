//! Albedos of every model at seeded draws of the ranges that its parameters declare, against an independent rule.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::print_stderr, clippy::float_cmp, reason = "test")]

#[path = "sweep/check.rs"]
mod check;
#[path = "sweep/curve.rs"]
mod curve;
#[path = "sweep/draw.rs"]
mod draw;
#[path = "sweep/facets.rs"]
mod facets;
#[path = "sweep/glass.rs"]
mod glass;
#[path = "sweep/lobe.rs"]
mod lobe;
#[path = "sweep/lobes.rs"]
mod lobes;
#[path = "sweep/quad.rs"]
mod quad;
#[path = "sweep/rows.rs"]
mod rows;
#[path = "sweep/truth.rs"]
mod truth;

use brdfbake::models::MODELS;
use draw::draw;
use rayon::prelude::*;
use rows::Row;
use std::path::PathBuf;
use std::time::Instant;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/honesty")
}

fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok()
}

/// Computes `truth_calibration.csv` and `truth_test.csv`; rows that they hold already are kept.
///
/// `HONESTY_DRAWS` draws a model (100), of `HONESTY_MODELS` only if given (ids, by commas), of `HONESTY_SET` only.
#[test]
#[ignore = "long: half an hour on two cores; writes tests/honesty/truth_*.csv"]
fn compute_truths() {
    let draws: u64 = variable("HONESTY_DRAWS").map_or(100, |n| n.parse().unwrap());
    let only = variable("HONESTY_MODELS");
    let set = variable("HONESTY_SET");
    for (name, seed) in [("calibration", draw::CALIBRATION), ("test", draw::TEST)] {
        if set.as_deref().is_some_and(|s| s != name) {
            continue;
        }
        let path = folder().join(format!("truth_{name}.csv"));
        let mut known = if path.exists() { rows::read(&path) } else { Vec::new() };
        for info in MODELS {
            if only.as_deref().is_some_and(|o| !o.split(',').any(|id| id == info.id)) {
                continue;
            }
            let start = Instant::now();
            let mut fresh: Vec<(u64, Vec<Row>, f64)> = (0..draws)
                .into_par_iter()
                .filter_map(|number| {
                    let d = draw(info, seed, number);
                    let held = known
                        .iter()
                        .any(|r| r.model == info.id && r.params == d.given && r.mu == d.mu && r.phi == d.phi);
                    if held {
                        return None;
                    }
                    let start = Instant::now();
                    if variable("HONESTY_SHOW").is_some() {
                        eprintln!("{} {number}: {:?} mu {:e} phi {}", info.id, d.given, d.mu, d.phi);
                    }
                    let mut all = Vec::new();
                    let (e, t) = (truth::albedo(&d), truth::transmitted(&d));
                    for (id, truth) in [(info.id.to_owned(), Some(e)), (format!("{}/T", info.id), t)] {
                        match truth {
                            Some(Ok((truth, error))) if truth.is_finite() && error.is_finite() => {
                                let (params, mu, phi) = (d.given.clone(), d.mu, d.phi);
                                all.push(Row { model: id, params, mu, phi, truth, error });
                            }
                            Some(Ok(v)) => {
                                eprintln!("DROPPED {id} {number}: {v:?} {:?} mu {:e}", d.given, d.mu)
                            }
                            Some(Err(why)) => eprintln!("DROPPED {id} {number}: {why}"),
                            None => {}
                        }
                    }
                    if start.elapsed().as_secs_f64() > 3.0 {
                        eprintln!(
                            "SLOW {} {number} {:.1} s: {:?} mu {:e} phi {}",
                            info.id,
                            start.elapsed().as_secs_f64(),
                            d.given,
                            d.mu,
                            d.phi
                        );
                    }
                    Some((number, all, start.elapsed().as_secs_f64()))
                })
                .collect();
            fresh.sort_by_key(|f| f.0);
            let slowest = fresh.iter().fold(0.0f64, |m, f| m.max(f.2));
            let worst =
                fresh.iter().flat_map(|f| &f.1).fold(0.0f64, |m, r| m.max(r.error / r.truth.abs().max(1.0)));
            println!(
                "{name} {:28} {:4} rows {:6.1} s, slowest {slowest:.2} s, worst error {worst:.1e}",
                info.id,
                fresh.len(),
                start.elapsed().as_secs_f64()
            );
            known.extend(fresh.into_iter().flat_map(|f| f.1));
            rows::write(&path, &known);
        }
    }
}

#[test]
fn masking_of_gtr_at_gamma_2_is_that_of_ggx() {
    use brdfbake::terms::smith::Ndf;
    for alpha in [1e-6, 1e-3, 0.2, 1.0, 1.7] {
        let curve = curve::Curve::new(&|mu| lobe::gtr_mu_lambda(alpha, 2.0, mu, &quad::SECOND));
        println!("{alpha} {:e}", curve.error());
        let ggx = brdfbake::terms::ggx::Ggx::isotropic(alpha);
        for mu in [0.0, 1e-9, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999_999, 1.0] {
            let expected = ggx.mu_lambda(brdfbake::math::frame::from_mu(mu));
            let off = (curve.at(mu) - expected).abs();
            println!(
                "   {mu} {off:e} {expected:e} {:e}",
                lobe::gtr_mu_lambda(alpha, 2.0, mu, &quad::SECOND) - expected
            );
            //assert!(off <= 1e-13 * (mu + expected), "{alpha} {mu}: {off:e}");
        }
    }
}

fn truths(name: &str) -> Vec<Row> {
    let mut rows = rows::read(&folder().join(format!("truth_{name}.csv")));
    if let Some(only) = variable("HONESTY_MODELS") {
        rows.retain(|r| only.split(',').any(|id| id == r.model));
    }
    rows
}

/// Every row at every tolerance: prints the table, and the worst values as commands.
#[test]
#[ignore = "long: minutes"]
fn sweep() {
    let set = variable("HONESTY_SET").unwrap_or_else(|| "test".to_owned());
    let rows = variable("HONESTY_FILE").map_or_else(|| truths(&set), |f| rows::read(f.as_ref()));
    let outcomes = check::run(&rows, &check::TOLERANCES);
    let lines = check::lines(&rows, &outcomes);
    check::print(&lines);
    println!("{}", check::worst(&rows, &outcomes, 3));
}

/// The rows of a table of truths that was made elsewhere, by the rules of this one.
#[test]
#[ignore = "needs HONESTY_FILE"]
fn other_truths_are_met() {
    let rows = rows::read(variable("HONESTY_FILE").unwrap().as_ref());
    for row in rows {
        let (info, _) = brdfbake::models::find(&row.model).unwrap();
        let params = brdfbake::models::Params::resolve(
            info.id,
            info.params,
            row.params.iter().map(|(k, v)| (k.as_str(), v)),
        )
        .unwrap();
        let d = draw::Draw { model: info, params, given: row.params.clone(), mu: row.mu, phi: row.phi };
        let (e, error) = truth::albedo(&d).unwrap();
        println!(
            "{:30} {:.12} {:+.1e} own {:.1e}, its {:.1e}",
            row.model,
            e,
            e - row.truth,
            error,
            row.error
        );
    }
}
