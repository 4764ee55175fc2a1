//! Rows of `tests/values/integrals.csv` and single texels.

use crate::common::request;
use brdfbake::grid::{Axis, Quantity, Texel};
use brdfbake::integrate::Estimate;
use brdfbake::tables::Bound;
use serde_json::Value;

/// A high-precision reference value (mpmath, 50 digits) with its parameters.
pub(crate) struct Row {
    pub(crate) name: String,
    pub(crate) params: Value,
    pub(crate) angle: f64,
    pub(crate) value: f64,
}

impl Row {
    pub(crate) fn num(&self, key: &str) -> f64 {
        self.params[key].as_f64().unwrap_or_else(|| panic!("{}: no number {key}", self.name))
    }

    /// 0, 1, 2 for the channel R, G, B.
    pub(crate) fn channel(&self) -> usize {
        "RGB".find(self.params["channel"].as_str().unwrap()).unwrap()
    }
}

/// Rows of a file whose first column begins with `name`.
pub(crate) fn rows(file: &str, name: &str) -> Vec<Row> {
    let path = format!("{}/tests/values/{file}.csv", env!("CARGO_MANIFEST_DIR"));
    let points = file.starts_with("points");
    let rows: Vec<Row> = csv::Reader::from_path(path)
        .unwrap()
        .records()
        .map(|r| r.unwrap())
        .filter(|r| r[0].starts_with(name))
        .map(|r| Row {
            name: format!("{} {}", &r[0], &r[1]),
            params: serde_json::from_str(&r[1]).unwrap(),
            angle: if points { r[2].parse().unwrap_or(0.0) } else { 0.0 },
            value: r[if points { 6 } else { 2 }].parse().unwrap(),
        })
        .collect();
    assert!(!rows.is_empty(), "{file} has no row {name}");
    rows
}

/// A table of a kind over axes `(quantity, low, high)`.
pub(crate) fn table(kind: &str, layout: &str, params: &str, axes: &[(&str, f64, f64)]) -> Bound {
    let axes = axes
        .iter()
        .map(|(id, lo, hi)| Axis::new(Quantity::find(id).unwrap(), 8, Texel::Endpoint).over([*lo, *hi]))
        .collect();
    request(kind, layout, params, axes)
}

pub(crate) fn texel(bound: &Bound, at: &[f64], tolerance: f64) -> Estimate {
    bound.baker.texel(at, tolerance).unwrap()
}

#[track_caller]
pub(crate) fn close(what: &str, got: f64, expected: f64, bound: f64) {
    assert!((got - expected).abs() <= bound, "{what}: got {got:e}, expected {expected:e}, bound {bound:e}");
}
