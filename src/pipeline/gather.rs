//! The files of a run on their way to the disk: each as soon as it is complete, so that no more than one table is in memory.

use super::PipelineError;
use super::transaction::Transaction;
use crate::plan::Plan;
use std::collections::BTreeMap;

/// Files that several tables share, until the last of them is there.
pub(super) struct Gathered<'a> {
    plan: &'a Plan,
    shared: BTreeMap<String, Shared>,
}

struct Shared {
    /// Parts that are still to come.
    left: usize,
    parts: Vec<Vec<u8>>,
}

impl<'a> Gathered<'a> {
    pub(super) fn new(plan: &'a Plan) -> Gathered<'a> {
        let mut shared: BTreeMap<String, Shared> = BTreeMap::new();
        for file in plan.tables.iter().filter_map(|t| t.asked.file.as_ref()) {
            shared.entry(file.clone()).or_insert(Shared { left: 0, parts: Vec::new() }).left += 1;
        }
        shared.retain(|_, s| s.left > 1);
        Gathered { plan, shared }
    }

    /// Takes the files of a table; those that are complete go to the disk.
    pub(super) fn take(
        &mut self,
        table: usize,
        files: Vec<(String, Vec<u8>)>,
        disk: &mut Transaction<'_>,
    ) -> Result<(), PipelineError> {
        for (name, bytes) in files {
            let Some(shared) = self.shared.get_mut(&name) else {
                disk.stage(&name, &bytes)?;
                continue;
            };
            shared.parts.push(bytes);
            shared.left = shared.left.saturating_sub(1);
            if shared.left == 0 {
                let parts = std::mem::take(&mut shared.parts);
                disk.stage(&name, &self.join(table, &name, &parts)?)?;
            }
        }
        Ok(())
    }

    /// One file of the parts that the tables wrote, in their order.
    fn join(&self, table: usize, name: &str, parts: &[Vec<u8>]) -> Result<Vec<u8>, PipelineError> {
        let table = &self.plan.tables[table];
        // tables of one file have one output, and the same
        let Some(output) = table.outputs.first() else { return Ok(parts.concat()) };
        output.encoder.join(parts).map_err(|error| PipelineError::Encode {
            table: table.name().to_owned(),
            output: name.to_owned(),
            error,
        })
    }
}
