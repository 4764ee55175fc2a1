//! Tables of truths: the columns are those of the shared cases.

use serde_json::{Map, Value};
use std::path::Path;

/// A line of a table of truths.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    /// Id of the model; `id/T` is the part that crosses the surface.
    pub(crate) model: String,
    pub(crate) params: Map<String, Value>,
    pub(crate) mu: f64,
    pub(crate) phi: f64,
    pub(crate) truth: f64,
    pub(crate) error: f64,
}

pub(crate) fn read(path: &Path) -> Vec<Row> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader
        .records()
        .map(|record| {
            let record = record.unwrap();
            let number = |i: usize| record[i].parse().unwrap();
            Row {
                model: record[0].to_owned(),
                params: serde_json::from_str(&record[1]).unwrap(),
                mu: number(2),
                phi: number(3),
                truth: number(4),
                error: number(5),
            }
        })
        .collect()
}

pub(crate) fn write(path: &Path, rows: &[Row]) {
    let mut writer = csv::Writer::from_path(path).unwrap();
    writer.write_record(["model", "params_json", "mu", "phi", "truth", "truth_error"]).unwrap();
    for row in rows {
        writer
            .write_record([
                row.model.clone(),
                serde_json::to_string(&row.params).unwrap(),
                format!("{:e}", row.mu),
                format!("{}", row.phi),
                format!("{:e}", row.truth),
                format!("{:.1e}", row.error),
            ])
            .unwrap();
    }
    writer.flush().unwrap();
}
