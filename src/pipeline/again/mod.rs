//! What is not baked again: units of a plan whose files the output folder or a cache holds already.
//!
//! A unit is what stands or falls together: a table, the tables of one file, a map. It is known by the identities of its parts
//! (`plan::identity`), so that only what decides its bytes decides whether it is kept: no time stamp, no name of an input. A file is
//! taken if its bytes have the hash that was written down when it was baked; one that was edited or damaged is baked again. Laws,
//! errors and verdicts are those of the record that was kept, which are those of a fresh bake.

mod cache;
mod unit;

pub use cache::{CACHE_LIMIT, Cache, CacheSize};

use super::map::MapEntry;
use super::transaction::Transaction;
use super::{Event, MANIFEST, Manifest, PipelineError, Progress, Settings, TableRecord, manifest};
use crate::grid::provenance::SCHEMA;
use crate::plan::Plan;
use cache::Entry;
use std::fs;
use std::path::Path;
use unit::{Part, Unit};

/// Where a unit was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum KeptIn {
    /// In the output folder.
    Folder,
    /// In the cache.
    Cache,
}

/// Units that need not be baked, with their records, and those that must.
pub(super) struct Again<'a> {
    plan: &'a Plan,
    cache: Option<&'a Cache>,
    baked: Vec<Unit>,
    tables: Vec<Option<(TableRecord, KeptIn)>>,
    maps: Vec<Option<(MapEntry, KeptIn)>>,
}

impl<'a> Again<'a> {
    /// Looks for every unit of a plan; `files` of those that were found become part of the transaction.
    pub(super) fn look(
        plan: &'a Plan,
        settings: &'a Settings,
        wanted: bool,
        files: &mut Transaction<'_>,
    ) -> Result<Again<'a>, PipelineError> {
        let mut again = Again {
            plan,
            cache: settings.cache.as_ref(),
            baked: Vec::new(),
            tables: plan.tables.iter().map(|_| None).collect(),
            maps: plan.maps.iter().map(|_| None).collect(),
        };
        let wanted = wanted && !settings.force;
        let held = wanted.then(|| read_manifest(&settings.out)).flatten();
        for unit in unit::all(plan) {
            let good = |entry: &Entry| !settings.strict || entry.tables.iter().all(is_clean);
            let there = held.as_ref().and_then(|m| unit.of_manifest(plan, m)).filter(good);
            if let Some(entry) = there.filter(|entry| entry.is_in(&settings.out)) {
                for file in &entry.files {
                    files.keep(&file.name, file.bytes, &file.blake3)?;
                }
                again.take(&unit, entry, KeptIn::Folder);
                continue;
            }
            let cached = again.cache.filter(|_| wanted).and_then(|c| c.read(&unit.key));
            match cached.and_then(|(entry, blobs)| Some((unit.named(plan, entry)?, blobs))) {
                Some((entry, blobs)) if good(&entry) => {
                    for (file, bytes) in entry.files.iter().zip(&blobs) {
                        files.stage(&file.name, bytes)?;
                    }
                    again.take(&unit, entry, KeptIn::Cache);
                }
                _ => again.baked.push(unit),
            }
        }
        Ok(again)
    }

    fn take(&mut self, unit: &Unit, entry: Entry, from: KeptIn) {
        let (mut tables, mut maps) = (entry.tables.into_iter(), entry.maps.into_iter());
        for part in &unit.parts {
            match part {
                Part::Table(i) => self.tables[*i] = tables.next().map(|t| (t, from)),
                Part::Map(i) => self.maps[*i] = maps.next().map(|m| (m, from)),
            }
        }
    }

    /// The record of a table that is kept.
    pub(super) fn table(&mut self, index: usize, progress: &dyn Progress) -> Option<TableRecord> {
        let (record, from) = self.tables[index].take()?;
        let provenance = &record.provenance;
        progress.event(&Event::TableKept {
            table: self.plan.tables[index].name(),
            index,
            from,
            missed: provenance.integration.missed,
            laws: &provenance.laws,
            verified: provenance.verified,
        });
        Some(record)
    }

    /// The record of a map that is kept.
    pub(super) fn map(&mut self, index: usize, progress: &dyn Progress) -> Option<MapEntry> {
        let (entry, from) = self.maps[index].take()?;
        progress.event(&Event::MapKept { map: self.plan.maps[index].name(), index, from });
        Some(entry)
    }

    /// Gives what was baked to the cache. A cache that cannot be written stops nothing: it is told of.
    pub(super) fn give(&self, manifest: &Manifest, files: &Transaction<'_>, progress: &dyn Progress) {
        let Some(cache) = self.cache else { return };
        for unit in &self.baked {
            let Some(entry) = unit.of_manifest(self.plan, manifest) else { continue };
            let blobs: std::io::Result<Vec<Vec<u8>>> =
                entry.files.iter().map(|f| files.read_staged(&f.name)).collect();
            if let Err(e) = blobs.and_then(|blobs| cache.write(&unit.key, &entry, &blobs)) {
                progress.event(&Event::CacheFault { folder: cache.folder(), message: e.to_string() });
                return;
            }
        }
    }
}

/// Nothing in doubt: `strict` would let it through.
fn is_clean(record: &TableRecord) -> bool {
    let p = &record.provenance;
    p.integration.missed == 0 && p.waived.is_empty() && p.laws.iter().all(|l| l.held())
}

/// The manifest of a folder, if it is one of this very program.
fn read_manifest(folder: &Path) -> Option<Manifest> {
    let manifest: Manifest = serde_json::from_slice(&fs::read(folder.join(MANIFEST)).ok()?).ok()?;
    (manifest.tool == manifest::tool() && manifest.schema == SCHEMA).then_some(manifest)
}
