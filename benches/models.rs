//! E to 1e-6 of every model: evaluations and time, over the parameters and view cosines of the survey of laws.
//!
//! `cargo bench --bench models` prints a table; nothing is asserted. One thread.
#![allow(clippy::print_stdout, missing_docs, reason = "a report")]

use brdfbake::models::{Brdf, MODELS, ModelInfo};
use brdfbake::tables::integral::{Functional, integrate};
use brdfbake::verify::survey::{COSINES, parameter_sets};
use std::time::Instant;

const TOLERANCE: f64 = 1e-6;

/// What E of one model costs.
struct Cost {
    model: &'static str,
    rule: &'static str,
    points: usize,
    mean: f64,
    most: u32,
    place: String,
    microseconds: f64,
    missed: usize,
}

fn rule(model: &dyn Brdf) -> &'static str {
    if model.mirror(0.5).is_some() {
        "delta: closed form"
    } else if model.parts().is_some() {
        "charts of its lobes"
    } else if model.reduced(0.5, &[Functional::One], TOLERANCE).is_some() {
        "reduction"
    } else {
        model.chart().map_or("adaptive subdivision", |c| c.name())
    }
}

fn cost(info: &'static ModelInfo) -> Cost {
    let mut cost = Cost {
        model: info.id,
        rule: "",
        points: 0,
        mean: 0.0,
        most: 0,
        place: String::new(),
        microseconds: 0.0,
        missed: 0,
    };
    for (label, params) in parameter_sets(info) {
        let Ok(model) = (info.build)(&params) else { continue };
        if cost.points == 0 {
            cost.rule = rule(&*model);
        }
        for mu in COSINES {
            let start = Instant::now();
            let Ok(e) = integrate(&*model, mu, &[Functional::One], TOLERANCE) else { continue };
            cost.microseconds += start.elapsed().as_secs_f64() * 1e6;
            cost.points += 1;
            cost.mean += f64::from(e.evaluations);
            cost.missed += usize::from(e.error[0] > TOLERANCE);
            if e.evaluations > cost.most {
                (cost.most, cost.place) = (e.evaluations, format!("{label}, mu {mu:.4}"));
            }
        }
    }
    let points = cost.points.max(1) as f64;
    cost.mean /= points;
    cost.microseconds /= points;
    cost
}

fn main() {
    let mut costs: Vec<Cost> = MODELS.iter().map(|m| cost(m)).collect();
    costs.sort_by(|a, b| b.microseconds.total_cmp(&a.microseconds));
    println!("\n### E to 1e-6 of every model, one thread, slowest first\n");
    println!("| model | rule | points | evaluations, mean | most | where | mean time | above 1e-6 |");
    println!("|---|---|---|---|---|---|---|---|");
    for c in costs {
        println!(
            "| {} | {} | {} | {:.0} | {} | {} | {:.1} us | {} |",
            c.model, c.rule, c.points, c.mean, c.most, c.place, c.microseconds, c.missed
        );
    }
}
