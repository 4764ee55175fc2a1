//! One table, resolved: bound to its baker, with everything that was left to a default filled in.

use super::fault::{Fault, unknown_word};
use super::faults::Faults;
use super::identity::{self, Input};
use super::output::{self, Output};
use super::place::Path;
use super::request::{Draft, TableRequest};
use super::sizing::PROVISIONAL;
use super::{LONGEST_REASON, TOLERANCE, bind, canonical, name, probe, sizing};
use crate::grid::provenance::{SizeRecord, Waiver};
use crate::tables::{Bound, TableInfo};
use crate::verify;
use serde_json::{Map, Value as Json};

/// A table of a [`Plan`](super::Plan): every name is known, every number in its range.
#[derive(Debug)]
pub struct PlannedTable {
    /// What was asked for, with every default filled in: as a recipe it reads back to this table.
    pub asked: TableRequest,
    /// Kind, layout, model, parameters, axes and baker.
    pub bound: Bound,
    /// Absolute tolerance of each channel, within [`TOLERANCE`].
    pub tolerance: f64,
    /// Files to write: at least one, none twice.
    pub outputs: Vec<Output>,
    /// Measure the error of a reader between texels?
    pub reconstruction: bool,
    /// How its size was found, once it is. Until then axes that are searched have lengths that stand in.
    pub found: Option<SizeRecord>,
    /// Files that its numbers depend on.
    pub inputs: Vec<Input>,
    /// Hash over everything that the bytes of its files depend on; see [`identity`](super::identity).
    pub identity: String,
}

impl PlannedTable {
    /// The same table on a grid of the size that was found. What was asked for, and so the identity, remain what they were.
    #[must_use]
    pub fn sized(&self, bound: Bound, found: SizeRecord) -> PlannedTable {
        PlannedTable {
            asked: self.asked.clone(),
            bound,
            tolerance: self.tolerance,
            outputs: self.outputs.clone(),
            reconstruction: self.reconstruction,
            found: Some(found),
            inputs: self.inputs.clone(),
            identity: self.identity.clone(),
        }
    }

    /// Stem of its file names.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.asked.name
    }

    /// Names of its files, one an output: `name.exr`, or `name.float.exr` where a container is used twice; or the one that it
    /// gives itself.
    #[must_use]
    pub fn files(&self) -> Vec<String> {
        name::of_outputs(&self.asked, &self.outputs)
    }

    /// Everything that was asked for under the keys of a recipe, in fixed order; outputs sorted, for their order means nothing.
    #[must_use]
    pub fn canonical(&self) -> Json {
        Json::Object(self.keys())
    }

    /// The keys of the canonical form.
    pub(super) fn keys(&self) -> Map<String, Json> {
        let mut map = canonical::table(&self.asked);
        let mut outputs: Vec<String> = self.outputs.iter().map(ToString::to_string).collect();
        outputs.sort();
        map.insert("outputs".to_owned(), outputs.into());
        map
    }

    /// The table as a part of the plan of this name.
    pub(super) fn identified(mut self, plan: &str) -> PlannedTable {
        self.identity = identity::of_table(plan, &self);
        self
    }
}

/// Resolves a table. None if it has a fault, or a part of it could not be read.
pub(super) fn resolve(
    draft: Draft,
    path: &Path,
    tolerance: Option<f64>,
    faults: &mut Faults,
) -> Option<PlannedTable> {
    let before = faults.len();
    check_tolerance(draft.request.tolerance, path.key("tolerance"), faults);
    output::check_list(&draft, path, faults);
    sizing::check(&draft.request, path, faults);
    let bound = bind::bind(&draft, path, faults);
    let Draft { request: asked, holes } = draft;
    let kind = if holes.kind { None } else { crate::tables::find(&asked.request.kind) };
    let waivers = kind.map(|kind| waivers(&asked, path, kind, faults));
    output::check_file(&asked, path, faults);
    let (asked, bound) = open(asked, bound?);
    output::check(&asked, &bound, path, faults);
    if faults.len() > before || holes.name || holes.outputs {
        return None;
    }
    let given = [asked.outputs.is_some(), asked.request.axes.is_none()];
    let planned = fill(asked, bound, tolerance, waivers?);
    probe::look(path, given, &planned, faults);
    (faults.len() == before).then_some(planned)
}

/// Where the size is to be found, all axes are searched if none is given; until it is found one length stands in on every axis that
/// is searched, however it was asked for.
fn open(mut asked: TableRequest, bound: Bound) -> (TableRequest, Bound) {
    let given = asked.request.axes.is_some();
    let Some(size) = asked.size.as_mut() else { return (asked, bound) };
    let mut axes = bound.spec.grid.axes().to_vec();
    if !given {
        size.axes = (0..axes.len()).collect();
    }
    for (i, axis) in axes.iter_mut().enumerate() {
        if size.axes.contains(&i) {
            axis.len = PROVISIONAL;
        }
    }
    asked.request.axes = Some(axes);
    // shorter axes of the same maps bind where longer ones do
    let bound = asked.request.bind().unwrap_or(bound);
    (asked, bound)
}

/// Fills every default in.
fn fill(asked: TableRequest, bound: Bound, tolerance: Option<f64>, waivers: Vec<Waiver>) -> PlannedTable {
    let outputs = output::listed(&asked);
    let finest = outputs.iter().map(|o| o.storage.default_tolerance()).fold(f64::INFINITY, f64::min);
    let spec = &bound.spec;
    let least = (spec.kind.least_tolerance)(&spec.setting());
    let tolerance = asked.tolerance.or(tolerance).unwrap_or(finest.max(least));
    let reconstruction = asked.reconstruction.unwrap_or(spec.kind.blended);
    let asked = TableRequest {
        request: spec.request(),
        tolerance: Some(tolerance),
        outputs: Some(outputs.clone()),
        reconstruction: Some(reconstruction),
        waivers,
        ..asked
    };
    PlannedTable {
        asked,
        bound,
        tolerance,
        outputs,
        reconstruction,
        found: None,
        inputs: Vec::new(),
        identity: String::new(),
    }
}

/// A tolerance must be one that can be asked for.
pub(super) fn check_tolerance(tolerance: Option<f64>, path: Path, faults: &mut Faults) {
    let [min, max] = TOLERANCE;
    if let Some(got) = tolerance.filter(|t| !(min..=max).contains(t)) {
        faults.value(path, Fault::Range { key: "tolerance".to_owned(), got, min, max });
    }
}

/// The waivers in the order of the laws.
fn waivers(asked: &TableRequest, path: &Path, kind: &'static TableInfo, faults: &mut Faults) -> Vec<Waiver> {
    let mut known: Vec<Waiver> = Vec::new();
    for (i, waiver) in asked.waivers.iter().enumerate() {
        let path = path.key("waive").index(i);
        let law = waiver.law.as_str();
        let fault = if verify::find(law).is_none() {
            unknown_word("law", law, verify::LAWS.iter().map(|l| l.id))
        } else if !kind.laws.contains(&law) {
            Fault::IdleWaiver { kind: kind.id, law: law.to_owned(), allowed: kind.laws.join(", ") }
        } else if known.iter().any(|w| w.law == law) {
            let why = "one waiver a law is enough".to_owned();
            Fault::Twice { what: "waiver of law", got: law.to_owned(), why }
        } else if waiver.reason.trim().is_empty() {
            let fault = Fault::TextLength { key: "reason".to_owned(), got: 0, limit: LONGEST_REASON };
            faults.value(path.key("reason"), fault);
            continue;
        } else {
            known.push(Waiver { law: law.to_owned(), reason: waiver.reason.trim().to_owned() });
            continue;
        };
        faults.value(path.key("law"), fault);
    }
    known.sort_by_key(|w| verify::LAWS.iter().position(|l| l.id == w.law));
    known
}
