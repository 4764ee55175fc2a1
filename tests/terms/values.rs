//! Rows of `tests/values/*.csv`, and the comparison that every test uses.

pub(crate) use crate::tolerance::assert_relative;
use brdfbake::math::frame;
use glam::DVec3;
use serde_json::Value;

/// One reference value with its inputs.
pub(crate) struct Row {
    /// `model` and parameters, for messages.
    pub(crate) name: String,
    params: Value,
    wi: Option<(f64, f64)>,
    wo: Option<(f64, f64)>,
    pub(crate) value: f64,
}

impl Row {
    /// A parameter by its name in `params_json`.
    pub(crate) fn num(&self, key: &str) -> f64 {
        self.params[key].as_f64().unwrap_or_else(|| panic!("{}: no number {key}", self.name))
    }

    pub(crate) fn wi_theta(&self) -> f64 {
        self.wi.unwrap_or_else(|| panic!("{}: no wi", self.name)).0
    }

    pub(crate) fn wi(&self) -> DVec3 {
        let (theta, phi) = self.wi.unwrap_or_else(|| panic!("{}: no wi", self.name));
        frame::spherical(theta, phi)
    }

    pub(crate) fn wo(&self) -> DVec3 {
        let (theta, phi) = self.wo.unwrap_or_else(|| panic!("{}: no wo", self.name));
        frame::spherical(theta, phi)
    }

    /// Fails unless `got` is within `bound` of the value, relative; exact zero for a zero.
    pub(crate) fn check(&self, got: f64, bound: f64) {
        assert_relative(&self.name, got, self.value, bound);
    }
}

/// All rows of `file` whose model is `model` (its first word).
pub(crate) fn rows(file: &str, model: &str) -> Vec<Row> {
    let path = format!("{}/tests/values/{file}.csv", env!("CARGO_MANIFEST_DIR"));
    let mut reader = csv::Reader::from_path(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    let pair = |theta: &str, phi: &str| {
        let phi = if phi.is_empty() { "0" } else { phi };
        (!theta.is_empty()).then(|| (theta.parse().unwrap(), phi.parse().unwrap()))
    };
    let rows: Vec<Row> = reader
        .records()
        .map(|record| record.unwrap())
        .filter(|record| record[0].split(' ').next() == Some(model))
        .map(|record| Row {
            name: format!(
                "{} {} wi {} {} wo {} {}",
                model, &record[1], &record[2], &record[3], &record[4], &record[5]
            ),
            params: serde_json::from_str(&record[1]).unwrap(),
            wi: pair(&record[2], &record[3]),
            wo: pair(&record[4], &record[5]),
            value: record[6].parse().unwrap(),
        })
        .collect();
    assert!(!rows.is_empty(), "{path} has no row for {model}");
    rows
}

/// Fails with the inputs unless |got − expected| ≤ bound·|expected|.
#[track_caller]
/// Cosines from 1e-8 to 1, dense at both ends.
pub(crate) fn cosines() -> Vec<f64> {
    let mut cosines = vec![1e-8, 1e-6, 1e-4, 1e-3, 0.01, 1.0 - 1e-12, 1.0 - 1e-6, 1.0];
    cosines.extend((1..64).map(|i| f64::from(i) / 64.0));
    cosines
}
