//! The units of a plan that are not kept: baked one after the other, each staged as soon as it is complete.

use super::again::Again;
use super::transaction::Transaction;
use super::{Companion, PipelineError, Progress, Settings, TableRecord, gather, map, table};
use crate::cancel::Cancel;
use crate::plan::Plan;
use crate::verify::Finding;

/// What the parts of a run share.
pub(super) struct Work<'a> {
    pub(super) plan: &'a Plan,
    pub(super) settings: &'a Settings,
    pub(super) pool: &'a rayon::ThreadPool,
    pub(super) cancel: &'a Cancel,
    pub(super) progress: &'a dyn Progress,
    /// Tables and maps that were not baked.
    pub(super) kept: usize,
}

impl Work<'_> {
    /// Tables that are not kept, one after the other; their files are staged.
    pub(super) fn tables(
        &mut self,
        again: &mut Again<'_>,
        files: &mut Transaction<'_>,
        mut companion: Option<&mut (dyn Companion + '_)>,
    ) -> Result<Vec<TableRecord>, PipelineError> {
        let (plan, cancel, progress) = (self.plan, self.cancel, self.progress);
        let mut gathered = gather::Gathered::new(plan);
        let (mut tables, mut findings) = (Vec::new(), Vec::new());
        let mut doubts: Vec<Finding> = Vec::new();
        for (index, planned) in plan.tables.iter().enumerate() {
            if let Some(record) = again.table(index, progress) {
                self.kept += 1;
                tables.push(record);
                continue;
            }
            let (shared, keep) = (gathered.is_shared(planned), companion.is_some());
            match self.pool.install(|| table::make(plan, planned, index, shared, keep, cancel, progress)) {
                Ok(made) if findings.is_empty() => {
                    if let Some((companion, seen)) = companion.as_mut().zip(made.seen) {
                        self.pool.install(|| companion.table(&made.record, seen, cancel))?;
                    }
                    let doubtful = |f: &&Finding| self.settings.strict && f.result.is_doubt();
                    doubts.extend(made.warnings.iter().filter(doubtful).cloned());
                    gathered.take(index, made.files, cancel, files)?;
                    tables.push(made.record);
                }
                Ok(_) => {}
                // the other tables are still checked, so that one run shows every broken law
                Err(PipelineError::Laws(broken)) => findings.extend(broken),
                Err(e) => return Err(e),
            }
        }
        match (findings.is_empty(), doubts.is_empty()) {
            (false, _) => Err(PipelineError::Laws(findings)),
            (true, false) => Err(PipelineError::Doubt(doubts)),
            (true, true) => Ok(tables),
        }
    }

    /// The same of maps.
    pub(super) fn maps(
        &mut self,
        again: &mut Again<'_>,
        files: &mut Transaction<'_>,
        mut companion: Option<&mut (dyn Companion + '_)>,
    ) -> Result<Vec<map::MapEntry>, PipelineError> {
        let mut maps = Vec::new();
        for (index, planned) in self.plan.maps.iter().enumerate() {
            if let Some(entry) = again.map(index, self.progress) {
                self.kept += 1;
                maps.push(entry);
                continue;
            }
            let make = || map::make(&self.plan.name, planned, index, self.cancel, self.progress);
            let made = self.pool.install(make).map_err(|error| of_map(planned.name(), error))?;
            if let Some(companion) = companion.as_mut() {
                self.pool.install(|| companion.map(&made.entry, &made.files, self.cancel))?;
            }
            for (name, bytes) in &made.files {
                files.stage(name, bytes)?;
            }
            maps.push(made.entry);
        }
        Ok(maps)
    }
}

fn of_map(map: &str, error: map::MapError) -> PipelineError {
    match error {
        map::MapError::Run(e) => e,
        error => PipelineError::Map { map: map.to_owned(), error: Box::new(error) },
    }
}
