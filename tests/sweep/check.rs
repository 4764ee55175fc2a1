//! What the product says of the rows of a table of truths, and whether it is honest.

use crate::sweep::rows::Row;
use brdfbake::integrate::View;
use brdfbake::models::{self, Params};
use brdfbake::tables::integral::{Functional, integrate};
use rayon::prelude::*;
use std::collections::BTreeMap;

pub(crate) const TOLERANCES: [f64; 3] = [1e-3, 1e-6, 1e-9];

/// One value of the product against its truth.
#[derive(Debug, Clone)]
pub(crate) struct Outcome {
    pub(crate) row: usize,
    pub(crate) tolerance: f64,
    /// Signed error; its part that counts is [`Outcome::counts`].
    pub(crate) error: f64,
    /// Errors below this say nothing.
    pub(crate) floor: f64,
    pub(crate) estimate: f64,
    pub(crate) evaluations: u32,
    /// The product gave an error in place of a value.
    pub(crate) refused: bool,
}

impl Outcome {
    /// The error beyond that of the truth; 0 if it is below the floor.
    pub(crate) fn counts(&self) -> f64 {
        if self.error.abs() <= self.floor { 0.0 } else { self.error.abs() - self.floor }
    }

    /// Error over estimate.
    pub(crate) fn ratio(&self) -> f64 {
        let counts = self.counts();
        if counts > 0.0 { counts / self.estimate.max(f64::MIN_POSITIVE) } else { 0.0 }
    }

    pub(crate) fn too_small(&self) -> bool {
        self.counts() > self.estimate
    }

    /// Beyond both the estimate and the tolerance.
    pub(crate) fn lies(&self) -> bool {
        self.counts() > self.estimate.max(self.tolerance)
    }
}

/// Values of the product for one row at each tolerance.
fn outcomes(number: usize, row: &Row, tolerances: &[f64]) -> Vec<Outcome> {
    let (id, crosses) = row.model.strip_suffix("/T").map_or((row.model.as_str(), false), |id| (id, true));
    let (info, _) = models::find(id).unwrap();
    let params = Params::resolve(info.id, info.params, row.params.iter().map(|(k, v)| (k.as_str(), v)));
    let model = (info.build)(&params.unwrap()).unwrap();
    let view = View { mu: row.mu, phi: row.phi };
    let at = |&tolerance: &f64| {
        let e = if crosses {
            model.transmission().map(|t| t.albedo(view, tolerance))
        } else {
            integrate(&*model, view, &[Functional::One], tolerance).ok()
        };
        let floor = row.error.max(1e-13 * row.truth.abs().max(1.0));
        let (error, estimate, evaluations) =
            e.as_ref().map_or((0.0, 0.0, 0), |e| (e.value[0] - row.truth, e.error[0], e.evaluations));
        // NaN would be neither honest nor not
        let error = if error.is_finite() { error } else { f64::INFINITY };
        Outcome { row: number, tolerance, error, floor, estimate, evaluations, refused: e.is_none() }
    };
    tolerances.iter().map(at).collect()
}

/// All rows at all tolerances, in order.
pub(crate) fn run(rows: &[Row], tolerances: &[f64]) -> Vec<Outcome> {
    (0..rows.len()).into_par_iter().flat_map_iter(|i| outcomes(i, &rows[i], tolerances)).collect()
}

/// What a model's values at one tolerance come to.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line {
    pub(crate) model: String,
    pub(crate) tolerance: f64,
    pub(crate) count: usize,
    pub(crate) lies: usize,
    pub(crate) too_small: usize,
    pub(crate) worst: f64,
    pub(crate) missed: usize,
    pub(crate) refused: usize,
    pub(crate) estimate: f64,
    pub(crate) evaluations: f64,
}

pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    if values.is_empty() { 0.0 } else { values[values.len() / 2] }
}

/// By the label of the row, in order, and tolerance.
pub(crate) fn lines(labels: &[String], outcomes: &[Outcome]) -> Vec<Line> {
    let mut order: Vec<&str> = Vec::new();
    let mut groups: BTreeMap<(usize, u64), Vec<&Outcome>> = BTreeMap::new();
    for o in outcomes {
        let id = labels[o.row].as_str();
        let place = order.iter().position(|m| *m == id).unwrap_or_else(|| {
            order.push(id);
            order.len() - 1
        });
        let step = o.tolerance.recip().to_bits();
        groups.entry((place, step)).or_default().push(o);
    }
    let line = |(place, _): &(usize, u64), group: &Vec<&Outcome>| Line {
        model: order[*place].to_owned(),
        tolerance: group[0].tolerance,
        count: group.len(),
        lies: group.iter().filter(|o| o.lies()).count(),
        too_small: group.iter().filter(|o| o.too_small()).count(),
        worst: group.iter().fold(0.0, |m, o| m.max(o.ratio())),
        missed: group.iter().filter(|o| o.estimate > o.tolerance).count(),
        refused: group.iter().filter(|o| o.refused).count(),
        estimate: median(group.iter().map(|o| o.estimate).collect()),
        evaluations: median(group.iter().map(|o| f64::from(o.evaluations)).collect()),
    };
    groups.iter().map(|(key, group)| line(key, group)).collect()
}

pub(crate) fn print(lines: &[Line]) {
    println!(
        "{:28} {:>6} {:>4} {:>5} {:>9} {:>9} {:>6} {:>7} {:>10} {:>10}",
        "model",
        "asked",
        "n",
        "lies",
        "too small",
        "worst x",
        "missed",
        "refused",
        "median est",
        "median evs"
    );
    for l in lines {
        println!(
            "{:28} {:>6.0e} {:>4} {:>5} {:>9} {:>9.2} {:>6} {:>7} {:>10.1e} {:>10}",
            l.model,
            l.tolerance,
            l.count,
            l.lies,
            l.too_small,
            l.worst,
            l.missed,
            l.refused,
            l.estimate,
            l.evaluations
        );
    }
    let sum = |f: &dyn Fn(&Line) -> usize| lines.iter().map(f).sum::<usize>();
    let worst = lines.iter().fold(0.0f64, |m, l| m.max(l.worst));
    let (all, small) = (sum(&|l| l.count), sum(&|l| l.too_small));
    println!(
        "{all} values: {} lies, {small} too small ({:.2} of 1000), worst {worst:.2} x, {} missed, {} refused",
        sum(&|l| l.lies),
        1e3 * small as f64 / all as f64,
        sum(&|l| l.missed),
        sum(&|l| l.refused)
    );
}

/// The worst values, one a line, `most` of each label.
pub(crate) fn worst(
    labels: &[String],
    outcomes: &[Outcome],
    most: usize,
    words: &dyn Fn(&Outcome) -> String,
) -> String {
    let mut bad: Vec<&Outcome> = outcomes.iter().filter(|o| o.too_small()).collect();
    bad.sort_by(|a, b| b.ratio().total_cmp(&a.ratio()));
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut text = String::new();
    for o in bad {
        let count = counts.entry(&labels[o.row]).or_default();
        *count += 1;
        if *count > most {
            continue;
        }
        text.push_str(&format!(
            "{:.1} x{}: error {:.1e}, estimate {:.1e}: {}\n",
            o.ratio(),
            if o.lies() { " LIE" } else { "" },
            o.error,
            o.estimate,
            words(o)
        ));
    }
    text
}

/// Labels of rows of albedos.
pub(crate) fn labels(rows: &[Row]) -> Vec<String> {
    rows.iter().map(|r| r.model.clone()).collect()
}

/// The value as the command that shows it.
pub(crate) fn command(row: &Row, o: &Outcome) -> String {
    let params: Vec<String> = row
        .params
        .iter()
        .map(|(k, v)| format!("-p {k}={}", v.as_str().map_or_else(|| v.to_string(), str::to_owned)))
        .collect();
    let (mu, phi, tolerance) = (row.mu, row.phi, o.tolerance);
    format!(
        "truth {}: albedo {} {} --mu {mu:e} --phi {phi} -t {tolerance:e}",
        row.truth,
        row.model,
        params.join(" ")
    )
}
