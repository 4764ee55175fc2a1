//! What the estimates and the costs of a model were before its stopping rule was one: medians that must not grow.

use crate::sweep::check::{Line, Outcome, TOLERANCES, median};
use crate::sweep::rows::Row;
use std::collections::BTreeMap;
use std::path::Path;

/// Medians of a model at a tolerance, over the rows where it was honest; the others are named by their place among its rows.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Before {
    dishonest: Vec<usize>,
    estimate: f64,
    evaluations: f64,
}

type Key = (String, usize);

/// Outcomes by model and tolerance, each in the order of the rows.
fn groups<'a>(rows: &[Row], outcomes: &'a [Outcome]) -> BTreeMap<Key, Vec<&'a Outcome>> {
    let mut groups: BTreeMap<Key, Vec<&Outcome>> = BTreeMap::new();
    for o in outcomes {
        let step = TOLERANCES.iter().position(|t| *t == o.tolerance).unwrap();
        groups.entry((rows[o.row].model.clone(), step)).or_default().push(o);
    }
    groups
}

/// Estimates below this part of 1 are all as good.
const ROUNDING: f64 = 1e-13;

pub(crate) fn write(path: &Path, rows: &[Row], outcomes: &[Outcome]) {
    let mut writer = csv::Writer::from_path(path).unwrap();
    writer.write_record(["model", "tolerance", "n", "estimate", "evaluations", "dishonest"]).unwrap();
    for ((model, step), group) in groups(rows, outcomes) {
        let (bad, good): (Vec<_>, Vec<_>) = group.iter().enumerate().partition(|(_, o)| o.too_small());
        let estimate = median(good.iter().map(|(_, o)| o.estimate).collect());
        let evaluations = median(good.iter().map(|(_, o)| f64::from(o.evaluations)).collect());
        let bad: Vec<String> = bad.iter().map(|(i, _)| i.to_string()).collect();
        writer
            .write_record([
                model,
                format!("{:e}", TOLERANCES[step]),
                group.len().to_string(),
                format!("{estimate:.3e}"),
                evaluations.to_string(),
                bad.join(" "),
            ])
            .unwrap();
    }
    writer.flush().unwrap();
}

fn read(path: &Path) -> BTreeMap<Key, Before> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let row = |record: csv::StringRecord| {
        let tolerance: f64 = record[1].parse().unwrap();
        let step = TOLERANCES.iter().position(|t| *t == tolerance).unwrap();
        let before = Before {
            dishonest: record[5].split_whitespace().map(|i| i.parse().unwrap()).collect(),
            estimate: record[3].parse().unwrap(),
            evaluations: record[4].parse().unwrap(),
        };
        ((record[0].to_owned(), step), before)
    };
    reader.records().map(|r| row(r.unwrap())).collect()
}

/// Models whose median estimate grew, or whose median number of evaluations grew by more than a quarter.
pub(crate) fn grown(path: &Path, rows: &[Row], outcomes: &[Outcome]) -> Vec<String> {
    let all = read(path);
    let mut grown = Vec::new();
    for (key, group) in groups(rows, outcomes) {
        let Some(before) = all.get(&key) else { continue };
        let good: Vec<&Outcome> = group
            .iter()
            .enumerate()
            .filter(|(i, _)| !before.dishonest.contains(i))
            .map(|(_, o)| *o)
            .collect();
        let estimate = median(good.iter().map(|o| o.estimate).collect());
        let evaluations = median(good.iter().map(|o| f64::from(o.evaluations)).collect());
        let (wide, dear) =
            (estimate > before.estimate.max(ROUNDING) * 1.001, evaluations > 1.25 * before.evaluations);
        if wide || dear {
            grown.push(format!(
                "{:28} {:.0e}: estimate {:.1e} -> {estimate:.1e}{}, evaluations {} -> {evaluations}{}",
                key.0,
                TOLERANCES[key.1],
                before.estimate,
                if wide { " GREW" } else { "" },
                before.evaluations,
                if dear { " GREW" } else { "" }
            ));
        }
    }
    grown
}

/// What the promise of the estimates is broken by.
pub(crate) fn broken(lines: &[Line]) -> Vec<String> {
    let mut all = Vec::new();
    let mut per_model: BTreeMap<&str, usize> = BTreeMap::new();
    for l in lines {
        *per_model.entry(&l.model).or_default() += l.too_small;
        if l.lies > 0 {
            all.push(format!(
                "{} {:.0e}: {} values beyond estimate and tolerance",
                l.model, l.tolerance, l.lies
            ));
        }
        if l.worst > 3.0 {
            all.push(format!("{} {:.0e}: an error of {:.1} estimates", l.model, l.tolerance, l.worst));
        }
        if l.refused > 0 {
            all.push(format!("{} {:.0e}: {} finite values refused", l.model, l.tolerance, l.refused));
        }
    }
    for (model, count) in per_model.into_iter().filter(|(_, count)| *count > 2) {
        all.push(format!("{model}: {count} estimates too small"));
    }
    let (count, small) = lines.iter().fold((0, 0), |s, l| (s.0 + l.count, s.1 + l.too_small));
    if 1000 * small > count {
        all.push(format!("{small} estimates of {count} too small"));
    }
    all
}
