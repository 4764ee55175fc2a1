//! Albedos of every model at seeded draws of the ranges that its parameters declare, against an independent rule.
#![allow(
    clippy::all,
    clippy::cast_possible_truncation,
    clippy::disallowed_methods,
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::float_cmp,
    reason = "test"
)]

mod baseline;
mod check;
mod closed;
mod curve;
mod draw;
mod facets;
mod fits;
mod fog;
mod glass;
mod kinds;
mod known;
mod lines;
mod lobe;
mod lobes;
mod quad;
mod rows;
mod texel;
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
/// `HONESTY_DRAWS` draws a model (100) that have a truth, of `HONESTY_MODELS` only if given (ids, by commas), of `HONESTY_SET` only.
/// With `HONESTY_SEED`, a number, they are other draws, for `truth_fresh.csv`: `HONESTY_FILE` of the test below reads it.
#[test]
#[ignore = "long: an hour on two cores; writes tests/honesty/truth_*.csv"]
fn compute_truths() {
    let draws: usize = variable("HONESTY_DRAWS").map_or(100, |n| n.parse().unwrap());
    let only = variable("HONESTY_MODELS");
    let set = variable("HONESTY_SET");
    let fresh = variable("HONESTY_SEED").map(|seed| ("fresh", seed.parse().unwrap()));
    let kept = [("calibration", draw::CALIBRATION), ("test", draw::TEST)];
    for (name, seed) in fresh.map_or(kept.to_vec(), |f| vec![f]) {
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
            let mut rows: Vec<Row> = Vec::new();
            let mut next = 0;
            // draws without a truth are replaced by others
            while rows.iter().filter(|r| r.model == info.id).count() < draws {
                let missing = draws - rows.iter().filter(|r| r.model == info.id).count();
                let fresh: Vec<Vec<Row>> = (next..next + missing as u64)
                    .into_par_iter()
                    .map(|number| of_draw(&draw(info, seed, number), number, &known))
                    .collect();
                next += missing as u64;
                rows.extend(fresh.into_iter().flatten());
            }
            let worst = rows.iter().fold(0.0f64, |m, r| m.max(r.error / r.truth.abs().max(1.0)));
            println!(
                "{name} {:28} {:4} rows of {next} draws {:6.1} s, worst error {worst:.1e}",
                info.id,
                rows.len(),
                start.elapsed().as_secs_f64()
            );
            known.retain(|r| r.model.split('/').next() != Some(info.id));
            known.extend(rows);
            rows::write(&path, &known);
        }
    }
}

/// E and T of a draw, from what is known if it is there.
fn of_draw(d: &draw::Draw, number: u64, known: &[Row]) -> Vec<Row> {
    let id = d.model.id;
    let same = |r: &&Row| {
        r.model.split('/').next() == Some(id) && r.params == d.given && r.mu == d.mu && r.phi == d.phi
    };
    let held: Vec<Row> = known.iter().filter(same).cloned().collect();
    if !held.is_empty() {
        return held;
    }
    let mut all = Vec::new();
    for (id, truth) in [(id.to_owned(), Some(truth::albedo(d))), (format!("{id}/T"), truth::transmitted(d))] {
        match truth {
            Some(Ok((truth, error))) if truth.is_finite() && error.is_finite() => {
                let (params, mu, phi) = (d.given.clone(), d.mu, d.phi);
                all.push(Row { model: id, params, mu, phi, truth, error });
            }
            Some(Ok(v)) => eprintln!("DROPPED {id} {number}: {v:?} {:?} mu {:e}", d.given, d.mu),
            Some(Err(why)) => eprintln!("DROPPED {id} {number}: {why}"),
            None => {}
        }
    }
    all
}

#[test]
fn masking_of_gtr_at_gamma_2_is_that_of_ggx() {
    use brdfbake::terms::smith::Ndf;
    for alpha in [1e-6, 1e-3, 0.2, 1.0, 1.7] {
        let curve = curve::Curve::new(curve::split(&[-34.0, 34.0], 2.0), 24, &|mu| {
            lobe::gtr_mu_lambda(alpha, 2.0, mu, &quad::SECOND)
        });
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

fn worst(rows: &[Row], outcomes: &[check::Outcome]) -> String {
    check::worst(&check::labels(rows), outcomes, 3, &|o| check::command(&rows[o.row], o))
}

/// Every row at every tolerance: prints the table, the worst values as commands, what the promise is broken by, and the
/// medians that grew since `baseline_*.csv`.
///
/// `HONESTY_SET` is `test` or `calibration`, or `HONESTY_FILE` names another table of truths; `HONESTY_MODELS` picks models.
#[test]
#[ignore = "long: minutes; run by `cargo long`"]
fn estimates_are_honest_at_every_draw() {
    let set = variable("HONESTY_SET").unwrap_or_else(|| "test".to_owned());
    let file = variable("HONESTY_FILE");
    let rows = file.as_ref().map_or_else(|| truths(&set), |f| rows::read(f.as_ref()));
    let outcomes = check::run(&rows, &check::TOLERANCES);
    let lines = check::lines(&check::labels(&rows), &outcomes);
    check::print(&lines);
    println!("{}", worst(&rows, &outcomes));
    let mut broken = baseline::broken(&lines);
    let recorded = folder().join(format!("baseline_{set}.csv"));
    if file.is_none() && recorded.exists() {
        broken.extend(baseline::grown(&recorded, &rows, &outcomes));
    }
    assert!(broken.is_empty(), "{} faults:\n{}", broken.len(), broken.join("\n"));
}

/// One draw in twenty of each model: none beyond estimate and tolerance, none beyond three estimates.
#[test]
fn estimates_are_honest_at_a_few_draws_of_each_model() {
    let rows: Vec<Row> =
        truths("test").into_iter().enumerate().filter(|(i, _)| i % 20 == 7).map(|r| r.1).collect();
    let outcomes = check::run(&rows, &check::TOLERANCES[..2]);
    let lines = check::lines(&check::labels(&rows), &outcomes);
    let bad: Vec<_> = lines.iter().filter(|l| l.lies > 0 || l.worst > 3.0 || l.refused > 0).collect();
    assert!(bad.is_empty(), "{bad:#?}\n{}", worst(&rows, &outcomes));
}

/// Tails longer than GGX's, whose D has no bound at the horizon.
#[test]
fn estimates_are_honest_for_the_longest_tails() {
    let mut rows = rows::read(&folder().join("truth_test.csv"));
    rows.retain(|r| r.model == "student-t" && r.params["gamma"].as_f64().unwrap() < 2.0);
    let outcomes = check::run(&rows, &check::TOLERANCES);
    let bad: Vec<_> = outcomes.iter().filter(|o| o.lies() || o.ratio() > 3.0 || o.refused).collect();
    assert!(bad.is_empty() && rows.len() >= 5, "{} rows, {bad:#?}\n{}", rows.len(), worst(&rows, &outcomes));
}

/// Writes `baseline_*.csv` from the product as it is.
#[test]
#[ignore = "writes tests/honesty/baseline_*.csv"]
fn record_baseline() {
    for set in ["calibration", "test"] {
        let rows = truths(set);
        let outcomes = check::run(&rows, &check::TOLERANCES);
        baseline::write(&folder().join(format!("baseline_{set}.csv")), &rows, &outcomes);
    }
}

/// The cases of the issue: their truths were made elsewhere, by other rules.
#[test]
fn estimates_are_honest_at_the_cases_seen_from_outside() {
    let text = std::fs::read_to_string(folder().join("seen.csv")).unwrap();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let asked: Vec<f64> = reader.records().map(|r| r.unwrap()[6].parse().unwrap()).collect();
    let rows = rows::read(&folder().join("seen.csv"));
    let outcomes = check::run(&rows, &[1e-3, 1e-6]);
    let bad: Vec<_> =
        outcomes.iter().filter(|o| asked[o.row] == o.tolerance && (o.too_small() || o.refused)).collect();
    assert!(bad.is_empty(), "{bad:#?}\n{}", worst(&rows, &outcomes));
}

/// The cases of the issue by the rules of this file.
#[test]
#[ignore = "long: half a minute"]
fn truths_made_elsewhere_are_met() {
    for row in rows::read(&folder().join("seen.csv")) {
        let (info, _) = brdfbake::models::find(&row.model).unwrap();
        let given = row.params.iter().map(|(k, v)| (k.as_str(), v));
        let params = brdfbake::models::Params::resolve(info.id, info.params, given).unwrap();
        let draw = draw::Draw { model: info, params, given: row.params.clone(), mu: row.mu, phi: row.phi };
        let (e, error) = truth::albedo(&draw).unwrap();
        // the table has 12 decimals
        let slack = row.error + error + 1e-12;
        assert!((e - row.truth).abs() <= slack, "{} {:?}: {e} for {}", row.model, row.params, row.truth);
    }
}

#[test]
fn truths_meet_a_known_value_of_each_table() {
    known::check(false);
}

#[test]
#[ignore = "long: a minute"]
fn truths_meet_all_known_values() {
    known::check(true);
}

/// Computes `truth_texels.csv`; rows that it holds already are kept. `HONESTY_KINDS` picks kinds, `HONESTY_DRAWS` is a percentage
/// of the counts in `kinds.rs`.
#[test]
#[ignore = "long: a quarter of an hour on two cores; writes tests/honesty/truth_texels.csv"]
fn compute_truths_of_texels() {
    let part: u64 = variable("HONESTY_DRAWS").map_or(100, |n| n.parse().unwrap());
    let only = variable("HONESTY_KINDS");
    let path = folder().join("truth_texels.csv");
    let mut known = if path.exists() { texel::read(&path) } else { Vec::new() };
    for &(kind, count) in kinds::KINDS {
        if only.as_deref().is_some_and(|o| !o.split(',').any(|id| id == kind)) {
            continue;
        }
        let start = Instant::now();
        let fresh: Vec<texel::Row> = (0..(count * part).div_ceil(100))
            .into_par_iter()
            .filter_map(|number| {
                let texel = kinds::draw(kind, draw::TEST, number);
                if known.iter().any(|r| r.texel == texel) {
                    return None;
                }
                let truths = kinds::truths(&texel);
                let row = texel::Row { texel, truths };
                if row.truths.iter().any(|t| !(t.0.is_finite() && t.1.is_finite())) {
                    eprintln!("DROPPED {:?}: {}", row.truths, texel::words(&row));
                }
                Some(row)
            })
            .collect();
        let finite = fresh.iter().flat_map(|r| &r.truths).filter(|t| t.1.is_finite());
        let worst = finite.fold(0.0f64, |m, t| m.max(t.1 / t.0.abs().max(1.0)));
        println!(
            "{kind:24} {:4} texels {:6.1} s, worst error {worst:.1e}",
            fresh.len(),
            start.elapsed().as_secs_f64()
        );
        known.extend(fresh);
        texel::write(&path, &known);
    }
}

/// Every layout of every kind of table has truths of an independent rule, or is in `kinds::WITHOUT` with the reason.
#[test]
fn every_kind_of_table_has_truths() {
    let rows = texel::read(&folder().join("truth_texels.csv"));
    let has = |kind: &str, layout: &str| {
        rows.iter().any(|r| {
            r.texel.kind == kind && r.texel.layout == layout && r.truths.iter().all(|t| t.1.is_finite())
        })
    };
    let mut faults = Vec::new();
    let mut used = std::collections::BTreeSet::new();
    for kind in brdfbake::tables::TABLES {
        for layout in kind.layouts {
            let listed =
                kinds::WITHOUT.iter().position(|w| w.0 == kind.id && (w.1 == "*" || w.1 == layout.id));
            used.extend(listed);
            match (listed, has(kind.id, layout.id)) {
                (Some(_), true) => {
                    faults.push(format!("{} {} has truths: take it off WITHOUT", kind.id, layout.id))
                }
                (None, false) => faults.push(format!(
                    "{id} {}: add a rule to tests/sweep/kinds.rs and its draws to KINDS, then `HONESTY_KINDS={id} cargo test --release \
                        --test baked -- --ignored --exact sweep::compute_truths_of_texels`; or say in WITHOUT why there is none",
                    layout.id,
                    id = kind.id
                )),
                _ => {}
            }
        }
    }
    let idle = (0..kinds::WITHOUT.len()).filter(|i| !used.contains(i)).map(|i| kinds::WITHOUT[i]);
    faults.extend(idle.map(|w| format!("WITHOUT: there is no {} {}", w.0, w.1)));
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Every model has truths of an independent rule, or is in `truth::WITHOUT` with the reason.
#[test]
fn every_model_has_truths() {
    let rows = rows::read(&folder().join("truth_test.csv"));
    let mut faults = Vec::new();
    for info in MODELS {
        let count = rows.iter().filter(|r| r.model == info.id).count();
        match (truth::WITHOUT.iter().any(|w| w.0 == info.id), count) {
            (false, count) if count < 20 => faults.push(format!(
                "{}: {count} draws; add a rule to tests/sweep/truth.rs and run `HONESTY_SET=test HONESTY_MODELS={} cargo test --release \
                    --test baked -- --ignored compute_truths`, or say in WITHOUT why there is none",
                info.id, info.id
            )),
            (true, 1..) => faults.push(format!("{} has truths: take it off WITHOUT", info.id)),
            _ => {}
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// One texel in ten of each kind: none beyond estimate and tolerance, none beyond three estimates.
#[test]
fn estimates_of_a_few_texels_of_each_kind_are_honest() {
    let rows = texel::read(&folder().join("truth_texels.csv"));
    let mut seen = std::collections::BTreeMap::new();
    let mut every_tenth = |r: &texel::Row| {
        let n = seen.entry(texel::label(r)).or_insert(0);
        *n += 1;
        *n % 10 == 1
    };
    let rows: Vec<texel::Row> = rows.into_iter().filter(|r| every_tenth(r)).collect();
    let outcomes = texel::run(&rows, &check::TOLERANCES[..2]);
    let labels: Vec<String> = rows.iter().map(texel::label).collect();
    let lines = check::lines(&labels, &outcomes);
    let bad: Vec<_> = lines.iter().filter(|l| l.lies > 0 || l.worst > 3.0 || l.refused > 0).collect();
    let worst = check::worst(&labels, &outcomes, 3, &|o| texel::words(&rows[o.row]));
    assert!(bad.is_empty(), "{bad:#?}\n{worst}");
}

/// Every texel at every tolerance, by kind and layout.
#[test]
#[ignore = "long: minutes; run by `cargo long`"]
fn estimates_of_texels_are_honest() {
    let mut rows = texel::read(&folder().join("truth_texels.csv"));
    if let Some(only) = variable("HONESTY_KINDS") {
        rows.retain(|r| only.split(',').any(|id| id == r.texel.kind));
    }
    let outcomes = texel::run(&rows, &check::TOLERANCES);
    let labels: Vec<String> = rows.iter().map(texel::label).collect();
    let lines = check::lines(&labels, &outcomes);
    check::print(&lines);
    println!("{}", check::worst(&labels, &outcomes, 3, &|o| texel::words(&rows[o.row])));
    let broken = baseline::broken(&lines);
    assert!(broken.is_empty(), "{} faults:\n{}", broken.len(), broken.join("\n"));
}

/// Residuals of fits, integrated for the parameters that the product found; with `HONESTY_SEED`, a number, of other draws, as many as
/// `HONESTY_DRAWS` says.
#[test]
#[ignore = "long: minutes; run by `cargo long`"]
fn residuals_of_fits_are_honest() {
    let seed = variable("HONESTY_SEED").map_or(draw::TEST, |seed| seed.parse().unwrap());
    let draws = variable("HONESTY_DRAWS").map_or(40, |n| n.parse().unwrap());
    let (labels, outcomes) = fits::run(seed, draws);
    let lines = check::lines(&labels, &outcomes);
    check::print(&lines);
    println!("{}", check::worst(&labels, &outcomes, 3, &|o| labels[o.row].clone()));
    let broken = baseline::broken(&lines);
    assert!(broken.is_empty(), "{} faults:\n{}", broken.len(), broken.join("\n"));
}
