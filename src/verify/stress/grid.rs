//! Extremes of declared domains: the ends, just inside them, decades, the neighbourhood of 1, and seeded points.

use crate::models::{DefaultValue, Kind, Param, Params};
use crate::verify::seeds::Seeds;

/// The smallest widths, and the largest exponents and indices, that are asked for where a range is open.
const DECADES: [f64; 14] = [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 10.0, 1e2, 1e3, 1e4, 1e6, 1e7];
/// The neighbourhood of an index of 1, and of a reflectance of 1.
const NEAR_ONE: [f64; 6] = [1.0 - 1e-12, 1.0 - 1e-6, 1.0 - 1e-3, 1.0, 1.0 + 1e-12, 1.0 + 1e-6];
/// Seeded sets of parameters.
const SEEDED: usize = 24;

/// Cosines of views and lights, down to the horizon.
pub(super) const COSINES: [f64; 8] = [1.0, 1.0 - 1e-12, 0.9, 0.5, 0.1, 1e-3, 1e-5, 1e-8];
/// Azimuths between them.
pub(super) const AZIMUTHS: [f64; 5] = [0.0, 1e-6, 0.7, 1.5, std::f64::consts::PI];

/// Extremes of a number.
pub(super) fn extremes(min: f64, max: f64) -> Vec<f64> {
    let inside = if min.is_finite() { min.abs().max(1.0) * 1e-12 } else { 0.0 };
    let ends = [min, min + inside, max - max.abs() * 1e-12, max];
    let mut all: Vec<f64> = ends.into_iter().chain(DECADES).chain(NEAR_ONE).collect();
    all.retain(|v| v.is_finite() && (min..=max).contains(v));
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

/// Sets of parameters with their words: the defaults, every number at its extremes, every word, all numbers at their ends, seeded ones.
pub(super) fn sets(model: &'static str, declared: &'static [Param]) -> Vec<(String, Params)> {
    let Ok(defaults) = Params::resolve(model, declared, []) else { return Vec::new() };
    let mut sets = vec![("defaults".to_owned(), defaults.clone())];
    let numbers: Vec<(&Param, Vec<f64>)> = declared
        .iter()
        .filter_map(|p| match p.kind {
            Kind::Number { min, max, .. } => Some((p, extremes(min, max))),
            _ => None,
        })
        .collect();
    for (param, values) in &numbers {
        for value in values {
            sets.push((format!("{} = {value:e}", param.id), with(&defaults, declared, param, *value)));
        }
    }
    for param in declared {
        let Kind::Choice(words) = param.kind else { continue };
        for word in words.iter().skip(1) {
            let given = [(param.id, &serde_json::Value::from(*word))];
            if let Ok(params) = Params::resolve(model, declared, given) {
                sets.push((format!("{} = {word}", param.id), params));
            }
        }
    }
    let mut seeds = Seeds::new(0x57e5);
    let draws = if numbers.is_empty() { 0 } else { SEEDED };
    for _ in 0..draws {
        let mut params = defaults.clone();
        let mut words = Vec::new();
        for (param, values) in &numbers {
            let value = values[seeds.index(values.len())];
            params.set(param.id, value);
            words.push(format!("{} = {value:e}", param.id));
        }
        sets.push((words.join(", "), params));
    }
    sets
}

/// One number changed; those that follow it by default go on following it.
fn with(defaults: &Params, declared: &'static [Param], param: &Param, value: f64) -> Params {
    let mut params = defaults.clone();
    params.set(param.id, value);
    for other in declared {
        if matches!(other.kind, Kind::Number { preset: DefaultValue::Of(of), .. } if of == param.id) {
            params.set(other.id, value);
        }
    }
    params
}
