//! One table: bake, verify, round, compare between texels, encode in memory.

use super::advice::advice;
use super::companion::Seen;
use super::event::{ChoiceEntry, ReconstructionEntry};
use super::fit::{self, Fitted};
use super::gather::{Part, Written};
use super::manifest::tool;
use super::texels::{Chosen, Source};
use super::{Event, Extremum, FileRecord, Phase, PipelineError, Progress, TableRecord, size};
use crate::cancel::{Cancel, Tell, untold};
use crate::encode::{EncodeInput, Label, Unstored};
use crate::grid::provenance::{AxisRecord, Encoding, Integration, RecipeId, SCHEMA, SizeRecord, Subject};
use crate::grid::{Provenance, Table};
use crate::plan::{Output, Plan, PlannedTable};
use crate::tables::driver::{self, Options};
use crate::tables::{Bound, Spec, source};
use crate::verify::{self, Finding, Verified, reconstruction::Probe};
use std::time::Instant;

/// Most points at which a table is compared with fresh integrals between its texels.
const COMPARED: usize = 1 << 16;

/// A table ready to be written.
pub(super) struct Made {
    pub(super) record: TableRecord,
    /// Its texels, for a companion that looks at them.
    pub(super) seen: Option<Seen>,
    /// What was found that does not stop a bake.
    pub(super) warnings: Vec<Finding>,
    pub(super) files: Vec<(String, Written)>,
}

/// Makes a table. `shared`: other tables of the plan are in its file, which is written when all are there.
pub(super) fn make(
    plan: &Plan,
    planned: &PlannedTable,
    index: usize,
    shared: bool,
    keep: bool,
    cancel: &Cancel,
    progress: &dyn Progress,
) -> Result<Made, PipelineError> {
    let name = planned.name();
    let start = Instant::now();
    let telling = |phase| {
        move |done, steps| progress.event(&Event::TableProgress { table: name, index, phase, done, steps })
    };
    if planned.asked.size.is_some() {
        telling(Phase::Size)(0, 0);
    }
    let sized = match &planned.asked.size {
        Some(sizing) => Some(size::resolve(planned, sizing, cancel)?),
        None => None,
    };
    if let Some((found, record)) = sized.as_ref().and_then(|s| Some((s, s.found.as_ref()?))) {
        progress.event(&size_found(found, record, index, start.elapsed().as_secs_f64()));
    }
    let planned = sized.as_ref().unwrap_or(planned);
    let spec = &planned.bound.spec;
    progress.event(&Event::TableStarted { table: name, index, texels: spec.grid.len() });
    let start = Instant::now();
    let (tick, texels) = (telling(Phase::Bake), spec.grid.len());
    let table = bake(planned, cancel, &|done| tick(done, texels))?;
    let bake_seconds = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let Checked { verified, warnings, provenance } =
        check(&plan.name, planned, table, cancel, &telling(Phase::Laws))?;
    for finding in &warnings {
        progress.event(&Event::Finding { table: name, finding });
    }
    let mut made = Made {
        record: TableRecord {
            provenance: provenance.clone(),
            size: spec.grid.axes().iter().map(|a| a.len).collect(),
            files: Vec::new(),
        },
        seen: None,
        warnings,
        files: Vec::new(),
    };
    let mut stored = None;
    let names = planned.files();
    let tell = [&telling(Phase::Fit) as &Tell<'_>, &telling(Phase::Between)];
    let readings = Readings::telling(planned, verified.table(), cancel, tell)?;
    for (output, file) in planned.outputs.iter().zip(names) {
        let source = readings.source(planned, verified.table(), cancel);
        let kept = if keep && stored.is_none() { Some(&mut stored) } else { None };
        let (record, bytes) = encode_output(planned, output, &source, &provenance, &file, shared, kept)?;
        made.record.files.push(record);
        made.files.push((file, bytes));
    }
    let check_seconds = start.elapsed().as_secs_f64();
    if let Some(stored) = stored {
        let table = verified.table().clone();
        made.seen = Some(Seen { table, stored, seconds: [bake_seconds, check_seconds] });
    }
    progress.event(&finished(planned, index, &made.record, bake_seconds, check_seconds));
    Ok(made)
}

/// The integrals of a table.
pub(super) fn bake(
    planned: &PlannedTable,
    cancel: &Cancel,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<Table, PipelineError> {
    let options = Options { tolerance: planned.tolerance, on_miss: planned.asked.on_miss, cancel, progress };
    driver::bake(&planned.bound, options)
        .map_err(|error| PipelineError::Bake { table: planned.name().to_owned(), error })
}

/// A table that keeps its laws, and what its files say of it.
#[derive(Debug)]
pub(super) struct Checked {
    pub(super) verified: Verified,
    pub(super) warnings: Vec<Finding>,
    pub(super) provenance: Provenance,
}

/// Looks at the laws of a table of the plan of this name.
pub(super) fn check(
    plan: &str,
    planned: &PlannedTable,
    table: Table,
    cancel: &Cancel,
    tell: &Tell<'_>,
) -> Result<Checked, PipelineError> {
    let checked = verify::check_telling(
        cancel,
        &planned.bound,
        table,
        planned.tolerance,
        &planned.asked.waivers,
        tell,
    )?;
    let (verified, warnings) = checked.map_err(PipelineError::Laws)?;
    let provenance = provenance(plan, planned, &verified);
    Ok(Checked { verified, warnings, provenance })
}

/// What is known of a table between its texels: values fitted to its reader, and fresh integrals to compare with.
pub(super) struct Readings<'a> {
    fitted: Option<Fitted>,
    probe: Option<Probe<'a>>,
}

impl<'a> Readings<'a> {
    pub(super) fn new(
        planned: &'a PlannedTable,
        table: &Table,
        cancel: &'a Cancel,
    ) -> Result<Readings<'a>, PipelineError> {
        Readings::telling(planned, table, cancel, [&untold; 2])
    }

    /// The same, telling of the points of the fit and of those between the texels.
    fn telling(
        planned: &'a PlannedTable,
        table: &Table,
        cancel: &'a Cancel,
        [fit, between]: [&Tell<'_>; 2],
    ) -> Result<Readings<'a>, PipelineError> {
        // the laws are those of the integrals; what is fitted to them is judged by how it reads
        let fitted = match planned.asked.texels.are_exact() {
            true => None,
            false => Some(fit::fit(planned, &planned.bound, table, planned.tolerance, false, cancel, fit)?),
        };
        let probe = planned
            .reconstruction
            .then(|| Probe::telling(cancel, &planned.bound, planned.tolerance, COMPARED, between));
        Ok(Readings { fitted, probe })
    }

    pub(super) fn source<'s>(
        &'s self,
        planned: &'s PlannedTable,
        table: &'s Table,
        cancel: &'s Cancel,
    ) -> Source<'s> {
        let (fitted, probe) = (self.fitted.as_ref(), self.probe.as_ref());
        Source { bound: &planned.bound, table, fitted, probe, cancel }
    }
}

fn size_found<'a>(found: &'a PlannedTable, record: &'a SizeRecord, index: usize, seconds: f64) -> Event<'a> {
    let axes = found.bound.spec.grid.axes();
    Event::SizeFound {
        table: found.name(),
        index,
        size: axes.iter().map(|a| a.len).collect(),
        coordinates: axes.iter().map(|a| a.coordinate_formula()).collect(),
        record,
        seconds,
    }
}

pub(super) fn encode_output(
    planned: &PlannedTable,
    output: &Output,
    source: &Source<'_>,
    provenance: &Provenance,
    file: &str,
    shared: bool,
    kept: Option<&mut Option<Vec<f64>>>,
) -> Result<(FileRecord, Written), PipelineError> {
    let table = source.table;
    let (name, label) = (planned.name().to_owned(), output.to_string());
    let (encoder, storage) = (output.encoder, output.storage);
    let Chosen { stored, reconstruction, texels } =
        source.choose(planned.asked.texels, storage).map_err(|error| match error {
            Unstored::Cancelled(stopped) => stopped.into(),
            Unstored::Range(error) => {
                PipelineError::Range { table: name.clone(), output: label.clone(), error }
            }
        })?;
    source.cancel.check()?;
    let shape = output.shape(&table.grid, table.channels.len());
    let encoding = Encoding {
        storage: storage.id().to_owned(),
        largest_error: stored.largest_error.value,
        fill: shape.fill(encoder.components(&shape)),
        names: encoder.names(&shape).iter().map(|n| (*n).to_owned()).collect(),
    };
    let provenance = Provenance {
        encoding: Some(encoding.clone()),
        reconstruction: reconstruction.clone(),
        texels: texels.clone(),
        ..provenance.clone()
    };
    let json = serde_json::to_string(&provenance)
        .map_err(|e| PipelineError::Metadata { table: name.clone(), message: e.to_string() })?;
    if let Some(kept) = kept {
        *kept = Some(stored.values.clone());
    }
    let as_read = source.probe.and_then(|p| p.measure_without_offset(&stored.values));
    let record = |bytes: &[u8]| FileRecord {
        file: file.to_owned(),
        container: encoder.id().to_owned(),
        bytes: bytes.len() as u64,
        blake3: blake3::hash(bytes).to_hex().to_string(),
        encoding,
        reconstruction,
        texels: texels.clone(),
        as_read,
    };
    if shared && !encoder.is_bare() {
        let part = Part {
            grid: table.grid.clone(),
            channels: table.channels.clone(),
            stored,
            provenance_json: json,
        };
        // size and hash are those of the whole file, which is not there yet
        return Ok((record(&[]), Written::Part(part)));
    }
    let input = EncodeInput {
        grid: &table.grid,
        channels: &table.channels,
        values: &stored.values,
        blocks: &stored.blocks,
        // the estimates are those of the integrals
        errors: if texels.as_ref().is_some_and(|t| t.held != "exact") { &[] } else { &table.errors },
        storage,
        options: &output.options,
        label: Label { name: planned.name(), identity: &planned.identity, provenance_json: &json },
        cancel: source.cancel,
    };
    let bytes = encoder.encode(&input);
    // a library that is stopped tells of a fault of its own
    source.cancel.check()?;
    let mut bytes = bytes.map_err(|error| PipelineError::Encode { table: name, output: label, error })?;
    if let Some(text) = &planned.asked.before {
        bytes.splice(0..0, text.bytes());
    }
    bytes.extend(planned.asked.after.iter().flat_map(|text| text.bytes()));
    Ok((record(&bytes), Written::File(bytes)))
}

/// What every file of a table says of itself.
fn provenance(plan: &str, planned: &PlannedTable, verified: &Verified) -> Provenance {
    let Bound { spec, baker } = &planned.bound;
    let table = verified.table();
    Provenance {
        schema: SCHEMA,
        tool: tool(),
        recipe: RecipeId { name: plan.to_owned(), hash: planned.identity.clone() },
        name: planned.name().to_owned(),
        table: Subject {
            id: spec.kind.id.to_owned(),
            title: format!("{}, {}", spec.kind.title, spec.layout.title()),
            formula: spec.kind.formula.to_owned(),
            params: spec.params.to_json(&spec.swept()),
            sources: source::lines(spec),
        },
        model: model_subject(spec),
        axes: spec.grid.axes().iter().map(AxisRecord::new).collect(),
        channels: table.channels.clone(),
        integration: Integration {
            rule: baker.rule(),
            tolerance: planned.tolerance,
            largest_error: table.largest_error(),
            evaluations: table.total_evaluations(),
            missed: verified.missed() as u64,
        },
        residuals: baker.residuals(table),
        encoding: None,
        reconstruction: None,
        texels: None,
        size: planned.found.clone(),
        laws: verified.laws().to_vec(),
        verified: verified.verified(),
        tolerance_met: Some(verified.tolerance_met()),
        waived: verified.waived().to_vec(),
    }
}

fn model_subject(spec: &Spec) -> Option<Subject> {
    let (info, params) = spec.model.as_ref()?;
    Some(Subject {
        id: info.id.to_owned(),
        title: info.title.to_owned(),
        formula: info.formula.to_owned(),
        params: params.to_json(&spec.swept()),
        sources: info.source_lines(),
    })
}

fn finished<'a>(
    planned: &'a PlannedTable,
    index: usize,
    record: &'a TableRecord,
    bake_seconds: f64,
    check_seconds: f64,
) -> Event<'a> {
    let integration = &record.provenance.integration;
    let reconstruction = planned.outputs.iter().zip(&record.files).filter_map(|(o, f)| {
        let r = f.reconstruction.as_ref()?;
        Some(ReconstructionEntry {
            output: o.to_string(),
            whole: r.whole.largest.value,
            whole_mean: r.whole.mean,
            practical: r.practical.as_ref().map(|p| p.largest.value),
            practical_mean: r.practical.as_ref().map(|p| p.mean),
            advice: advice(planned, &f.encoding, r),
            choices: f.texels.iter().flat_map(|t| &t.choices).map(ChoiceEntry::from).collect(),
        })
    });
    Event::TableFinished {
        table: planned.name(),
        index,
        tolerance: planned.tolerance,
        integration: Extremum::from(&integration.largest_error),
        encoding: planned
            .outputs
            .iter()
            .zip(&record.files)
            .map(|(o, f)| (o.to_string(), f.encoding.largest_error))
            .collect(),
        reconstruction: reconstruction.collect(),
        evaluations: integration.evaluations,
        missed: integration.missed,
        laws: &record.provenance.laws,
        tolerance_met: integration.missed == 0,
        verified: record.provenance.verified,
        bake_seconds,
        check_seconds,
    }
}
