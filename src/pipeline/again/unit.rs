//! Units of a plan, and their records in a manifest.

use super::super::Manifest;
use super::super::map::MapEntry;
use super::cache::{Entry, EntryFile};
use crate::plan::Plan;
use crate::plan::identity::Hasher;
use std::collections::BTreeMap;

/// A part of a unit, by its number in the plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    Table(usize),
    Map(usize),
}

/// What is baked or kept as one.
#[derive(Debug)]
pub(super) struct Unit {
    /// Hash of the identities of its parts, in their order.
    pub(super) key: String,
    pub(super) parts: Vec<Part>,
}

/// The units of a plan: tables that share a file are one.
pub(super) fn all(plan: &Plan) -> Vec<Unit> {
    let mut of_file: BTreeMap<&str, usize> = BTreeMap::new();
    let mut units: Vec<Vec<Part>> = Vec::new();
    for (i, table) in plan.tables.iter().enumerate() {
        let known = table.asked.file.as_deref().map(|file| *of_file.entry(file).or_insert(units.len()));
        match known.filter(|unit| *unit < units.len()) {
            Some(unit) => units[unit].push(Part::Table(i)),
            None => units.push(vec![Part::Table(i)]),
        }
    }
    units.extend((0..plan.maps.len()).map(|i| vec![Part::Map(i)]));
    units.into_iter().map(|parts| Unit { key: key(plan, &parts), parts }).collect()
}

fn key(plan: &Plan, parts: &[Part]) -> String {
    let identity = |part: &Part| match part {
        Part::Table(i) => &plan.tables[*i].identity,
        Part::Map(i) => &plan.maps[*i].identity,
    };
    parts.iter().map(identity).fold(Hasher::new("unit"), |h, id| h.part(id.as_bytes())).finish()
}

impl Unit {
    /// The unit as a manifest tells of it, with the names that the plan gives its files; none if the manifest is not of it.
    pub(super) fn of_manifest(&self, plan: &Plan, manifest: &Manifest) -> Option<Entry> {
        let mut entry = Entry { tables: Vec::new(), maps: Vec::new(), files: Vec::new() };
        let mut before = None;
        for part in &self.parts {
            match part {
                Part::Table(i) => {
                    let planned = &plan.tables[*i];
                    let at = manifest.tables.iter().position(|t| {
                        t.provenance.recipe.hash == planned.identity && t.provenance.name == planned.name()
                    })?;
                    // the order of tables in a file that they share
                    if before.is_some_and(|b| b >= at) {
                        return None;
                    }
                    before = Some(at);
                    entry.tables.push(manifest.tables[at].clone());
                }
                Part::Map(i) => {
                    let planned = &plan.maps[*i];
                    let is_it = |m: &&MapEntry| {
                        m.record.recipe.hash == planned.identity && m.record.name == planned.name()
                    };
                    entry.maps.push(manifest.maps.iter().find(is_it)?.clone());
                }
            }
        }
        entry.files = entry.listed();
        let named = entry.files.iter().map(|f| f.name.as_str());
        let others = manifest.tables.iter().flat_map(|t| &t.files).filter(|f| entry.has(&f.file)).count();
        let own = entry.tables.iter().map(|t| t.files.len()).sum::<usize>();
        (named.eq(self.names(plan).iter().map(String::as_str)) && others == own).then_some(entry)
    }

    /// Files of the unit, each once.
    fn names(&self, plan: &Plan) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for part in &self.parts {
            let files = match part {
                Part::Table(i) => plan.tables[*i].files(),
                Part::Map(i) => plan.maps[*i].files(),
            };
            for file in files {
                if !names.contains(&file) {
                    names.push(file);
                }
            }
        }
        names
    }

    /// An entry of a cache with the names of this plan; none if it does not fit.
    pub(super) fn named(&self, plan: &Plan, mut entry: Entry) -> Option<Entry> {
        let names = self.names(plan);
        let counts =
            [entry.files.len() == names.len(), entry.tables.len() + entry.maps.len() == self.parts.len()];
        if counts.contains(&false) {
            return None;
        }
        let new_name = |old: &str| {
            let at = entry.files.iter().position(|f| f.name == old)?;
            Some(names[at].clone())
        };
        let mut tables = entry.tables.clone();
        let mut maps = entry.maps.clone();
        for file in tables.iter_mut().flat_map(|t| &mut t.files) {
            file.file = new_name(&file.file)?;
        }
        for file in maps.iter_mut().flat_map(|m| &mut m.files) {
            file.file = new_name(&file.file)?;
        }
        let (mut t, mut m) = (tables.iter_mut(), maps.iter_mut());
        for part in &self.parts {
            match part {
                Part::Table(i) => {
                    let provenance = &mut t.next()?.provenance;
                    plan.name.clone_into(&mut provenance.recipe.name);
                    plan.tables[*i].name().clone_into(&mut provenance.name);
                }
                Part::Map(_) => {
                    m.next()?;
                }
            }
        }
        for (file, name) in entry.files.iter_mut().zip(names) {
            file.name = name;
        }
        (entry.tables, entry.maps) = (tables, maps);
        Some(entry)
    }
}

impl Entry {
    /// The files of its records, each once, in their order.
    fn listed(&self) -> Vec<EntryFile> {
        let tables = self.tables.iter().flat_map(|t| &t.files).map(|f| (&f.file, f.bytes, &f.blake3));
        let maps = self.maps.iter().flat_map(|m| &m.files).map(|f| (&f.file, f.bytes, &f.blake3));
        let mut files: Vec<EntryFile> = Vec::new();
        for (name, bytes, blake3) in tables.chain(maps) {
            if !files.iter().any(|f| f.name == *name) {
                files.push(EntryFile { name: name.clone(), bytes, blake3: blake3.clone() });
            }
        }
        files
    }

    fn has(&self, name: &str) -> bool {
        self.files.iter().any(|f| f.name == name)
    }
}
