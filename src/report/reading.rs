//! Bytes against the error that a shader reads: tables of falling size by axes and storage, and formulas by their operations.

use super::analytic;
use super::chart::{Chart, Curve};
use crate::cancel::{Cancel, Cancelled};
use crate::encode::{Storage, quantise_table_until, texel_size};
use crate::grid::{Axis, Texel, Warp};
use crate::tables::driver::{self, OnMiss, Options};
use crate::tables::spec::{Bound, Request};
use crate::verify::reconstruction::Probe;
use serde::Serialize;

/// Lengths of the axes.
const LENGTHS: [usize; 4] = [8, 16, 32, 64];
/// Storages.
const STORAGES: [Storage; 4] = [Storage::Half, Storage::Unorm8, Storage::Unorm16, Storage::Float];
/// Degrees of formulas.
const DEGREES: [usize; 3] = [2, 3, 4];
/// Tolerance of texels and of what they are compared with.
const TOLERANCE: f64 = 1e-6;
/// Points that a table is compared at.
const POINTS: usize = 4096;

/// What a shader can read, and what it costs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reading {
    /// Axes, or form of the formula.
    pub form: String,
    /// Storage id; empty for a formula.
    pub storage: &'static str,
    /// Texels along each axis; 0 for a formula.
    pub length: usize,
    /// Bytes of the texels; 0 for a formula.
    pub bytes: usize,
    /// Operations of a formula; 0 for a table.
    pub operations: usize,
    /// Largest error over the whole domain.
    pub whole: f64,
    /// Largest error over mu >= 0.05, roughness >= 0.09.
    pub practical: Option<f64>,
}

/// Tables and formulas of what `bound` holds.
///
/// # Errors
/// [`Cancelled`].
pub fn readings(bound: &Bound, cancel: &Cancel) -> Result<Vec<Reading>, Cancelled> {
    let mut all = Vec::new();
    let own: Vec<Axis> = bound.spec.grid.axes().to_vec();
    let linear = |texel: Texel| -> Vec<Axis> {
        own.iter().map(|a| Axis { warp: Warp::Linear, texel, ..a.clone() }).collect()
    };
    let forms = [
        ("own axes", own.clone()),
        ("linear, centres", linear(Texel::Center)),
        ("linear, ends", linear(Texel::Endpoint)),
    ];
    for (form, axes) in forms {
        for length in LENGTHS {
            let axes = axes.iter().map(|a| Axis { len: length, ..a.clone() }).collect();
            let Ok(bound) = (Request { axes: Some(axes), ..bound.spec.request() }).bind() else { continue };
            table(&bound, form, length, cancel, &mut all)?;
        }
    }
    for degree in DEGREES.into_iter().filter(|_| analytic::splits(bound)) {
        cancel.check()?;
        if let Ok(fit) = analytic::split_sum_until(cancel, bound, degree) {
            all.push(Reading {
                form: format!("formula of degree {degree}"),
                storage: "",
                length: 0,
                bytes: 0,
                operations: fit.operations(),
                whole: fit.whole.largest,
                practical: fit.practical.as_ref().map(|p| p.largest),
            });
        }
    }
    cancel.check()?;
    Ok(all)
}

fn table(
    bound: &Bound,
    form: &str,
    length: usize,
    cancel: &Cancel,
    all: &mut Vec<Reading>,
) -> Result<(), Cancelled> {
    let options = Options { tolerance: TOLERANCE, on_miss: OnMiss::Report, cancel, progress: &|_| {} };
    let baked = driver::bake(bound, options);
    cancel.check()?;
    let Ok(table) = baked else { return Ok(()) };
    let probe = Probe::until(cancel, bound, TOLERANCE, POINTS);
    for storage in STORAGES {
        let stored = quantise_table_until(cancel, &table, storage);
        cancel.check()?;
        // numbers that the storage does not hold are no choice
        let Ok(stored) = stored else { continue };
        let read = probe.measure(&stored.values);
        all.push(Reading {
            form: form.to_owned(),
            storage: storage.id(),
            length,
            bytes: table.grid.len() * texel_size(storage, table.channels.len()),
            operations: 0,
            whole: read.whole.largest.value,
            practical: read.practical.map(|p| p.largest.value),
        });
    }
    cancel.check()
}

/// One row for each table and formula.
#[must_use]
pub fn csv(readings: &[Reading]) -> String {
    let mut lines = vec!["form,storage,length,bytes,operations,whole,practical".to_owned()];
    for r in readings {
        let practical = r.practical.map_or_else(String::new, |p| format!("{p:e}"));
        let Reading { form, storage, length, bytes, operations, whole, .. } = r;
        lines.push(format!("\"{form}\",{storage},{length},{bytes},{operations},{whole:e},{practical}"));
    }
    lines.join("\n") + "\n"
}

/// Error of reading over bytes; formulas are levels.
#[must_use]
pub fn chart(subject: &str, readings: &[Reading]) -> Chart {
    let error = |r: &Reading| r.practical.unwrap_or(r.whole);
    let mut curves: Vec<Curve> = Vec::new();
    for r in readings.iter().filter(|r| r.bytes > 0) {
        let name = format!("{}, {}", r.form, r.storage);
        let point = [r.bytes as f64, error(r)];
        match curves.iter_mut().find(|c| c.name == name) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve { name, points: vec![point] }),
        }
    }
    let level = |r: &Reading| (error(r), format!("{}, {} operations", r.form, r.operations));
    let practical = readings.iter().any(|r| r.practical.is_some());
    let where_ = if practical { " (mu >= 0.05, roughness >= 0.09)" } else { "" };
    Chart {
        title: subject.to_owned(),
        axes: ["bytes of the texels".to_owned(), format!("largest error as read{where_}")],
        curves,
        levels: readings.iter().filter(|r| r.operations > 0).map(level).collect(),
    }
}
