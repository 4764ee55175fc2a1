//! The files of a run on their way to the disk: each as soon as it is complete, so that no more than one table is in memory.

use super::PipelineError;
use super::transaction::Transaction;
use crate::cancel::Cancel;
use crate::encode::{EncodeInput, Label, Quantised};
use crate::grid::{Channel, Grid};
use crate::plan::{Plan, PlannedTable};
use std::collections::BTreeMap;

/// What a table makes of one of its outputs.
pub(super) enum Written {
    /// The bytes of a file, or of a run of bytes in one that is nothing but numbers.
    File(Vec<u8>),
    /// The numbers of a table in a file that is encoded when all its tables are there.
    Part(Part),
}

/// One table of a file, rounded.
pub(super) struct Part {
    pub(super) grid: Grid,
    pub(super) channels: Vec<Channel>,
    pub(super) stored: Quantised,
    pub(super) provenance_json: String,
}

/// Files that several tables share, until the last of them is there.
pub(super) struct Gathered<'a> {
    plan: &'a Plan,
    shared: BTreeMap<String, Shared>,
}

#[derive(Default)]
struct Shared {
    /// Tables that are still to come.
    left: usize,
    bytes: Vec<u8>,
    /// With the number of its table.
    parts: Vec<(usize, Part)>,
}

impl<'a> Gathered<'a> {
    pub(super) fn new(plan: &'a Plan) -> Gathered<'a> {
        let mut shared: BTreeMap<String, Shared> = BTreeMap::new();
        for file in plan.tables.iter().filter_map(|t| t.asked.file.as_ref()) {
            shared.entry(file.clone()).or_default().left += 1;
        }
        shared.retain(|_, s| s.left > 1);
        Gathered { plan, shared }
    }

    /// Are other tables in the file of this one?
    pub(super) fn is_shared(&self, planned: &PlannedTable) -> bool {
        planned.asked.file.as_ref().is_some_and(|file| self.shared.contains_key(file))
    }

    /// Takes the files of a table; those that are complete go to the disk.
    pub(super) fn take(
        &mut self,
        table: usize,
        files: Vec<(String, Written)>,
        cancel: &Cancel,
        disk: &mut Transaction<'_>,
    ) -> Result<(), PipelineError> {
        for (name, written) in files {
            let Some(shared) = self.shared.get_mut(&name) else {
                if let Written::File(bytes) = &written {
                    disk.stage(&name, bytes)?;
                }
                continue;
            };
            match written {
                Written::File(bytes) => shared.bytes.extend(bytes),
                Written::Part(part) => shared.parts.push((table, part)),
            }
            shared.left = shared.left.saturating_sub(1);
            if shared.left == 0 {
                let parts = std::mem::take(&mut shared.parts);
                let mut bytes = std::mem::take(&mut shared.bytes);
                if !parts.is_empty() {
                    bytes = together(self.plan, &parts, &name, cancel)?;
                }
                disk.stage(&name, &bytes)?;
            }
        }
        Ok(())
    }
}

/// One file of the tables that share it, in their order.
fn together(
    plan: &Plan,
    parts: &[(usize, Part)],
    file: &str,
    cancel: &Cancel,
) -> Result<Vec<u8>, PipelineError> {
    let mut inputs = Vec::new();
    let mut first = None;
    for (table, part) in parts {
        let planned = &plan.tables[*table];
        // a table that names its file has one output: the plan sees to that, and that all are alike
        let Some(output) = planned.outputs.first() else { continue };
        first = first.or(Some((planned.name(), output.encoder)));
        inputs.push(EncodeInput {
            grid: &part.grid,
            channels: &part.channels,
            values: &part.stored.values,
            blocks: &part.stored.blocks,
            errors: &[],
            storage: output.storage,
            options: &output.options,
            label: Label {
                name: planned.name(),
                identity: &planned.identity,
                provenance_json: &part.provenance_json,
            },
            cancel,
        });
    }
    let Some((table, encoder)) = first else { return Ok(Vec::new()) };
    let bytes = encoder.encode_together(&inputs);
    cancel.check()?;
    bytes.map_err(|error| PipelineError::Encode { table: table.to_owned(), output: file.to_owned(), error })
}
