//! `manifest.json`: what a run wrote, table by table, with the facts that the files carry themselves.

use super::map::MapEntry;
use crate::grid::Provenance;
use crate::grid::provenance::{Encoding, Reconstruction, SCHEMA, TexelRecord};
use crate::plan::Plan;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The manifest of an output folder. No clock, host or path: the same recipe gives the same bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of this layout.
    pub schema: u32,
    /// Program and version.
    pub tool: String,
    /// Recipe name.
    pub recipe: String,
    /// Hash over the hashes of the tables.
    pub hash: String,
    /// Tables in the order of the recipe.
    pub tables: Vec<TableRecord>,
    /// Maps in the order of the recipe.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub maps: Vec<MapEntry>,
    /// Why they were asked for, where scenes asked: files, materials, reasons, and what was left out.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub scenes: Option<serde_json::Value>,
    /// Files of an earlier bake that are still in the folder and belong to none of these tables.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub stale: Vec<String>,
}

/// One table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TableRecord {
    /// What every file of the table says of itself, but for what depends on the storage.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Texels along each axis, fastest first.
    pub size: Vec<usize>,
    /// The files.
    pub files: Vec<FileRecord>,
}

/// One file of a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FileRecord {
    /// Name, relative to the manifest.
    pub file: String,
    /// Container id.
    pub container: String,
    /// Size in bytes.
    pub bytes: u64,
    /// blake3 of the bytes.
    pub blake3: String,
    /// How the values are stored and what the rounding costs.
    pub encoding: Encoding,
    /// Errors of the reader's reconstruction from this file.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub reconstruction: Option<Reconstruction>,
    /// What the texels of this file hold, where they are fitted.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub texels: Option<TexelRecord>,
    /// The same for a reader that knows nothing of the `offset` of an axis, where one has it: how engines read.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub as_read: Option<Reconstruction>,
}

impl Manifest {
    pub(super) fn new(
        plan: &Plan,
        tables: Vec<TableRecord>,
        maps: Vec<MapEntry>,
        stale: Vec<String>,
    ) -> Manifest {
        Manifest {
            schema: SCHEMA,
            tool: tool(),
            recipe: plan.name.clone(),
            hash: plan.units_hash(),
            tables,
            maps,
            scenes: plan.reasons.clone(),
            stale,
        }
    }

    /// Files of the manifest that lies in a folder, and those that it calls stale, which are still there and are not among `names`.
    pub(super) fn stale(folder: &Path, names: &[String]) -> Vec<String> {
        let old = std::fs::read(folder.join(super::MANIFEST)).ok();
        let Some(old) = old.and_then(|bytes| serde_json::from_slice::<Listed>(&bytes).ok()) else {
            return Vec::new();
        };
        let listed = old.tables.into_iter().chain(old.maps).flat_map(|t| t.files).map(|f| f.file);
        let is_left = |name: &String| {
            super::transaction::is_plain(name) && !names.contains(name) && folder.join(name).is_file()
        };
        let pages = super::companion::pages(folder);
        let mut all: Vec<String> = listed.chain(old.stale).chain(pages).filter(is_left).collect();
        all.sort();
        all.dedup();
        all
    }

    /// Sizes and hashes of the files as they are written: one may hold several tables.
    pub(super) fn set_sizes<'a>(&mut self, staged: impl Fn(&str) -> Option<(u64, &'a str)>) {
        for record in self.tables.iter_mut().flat_map(|t| &mut t.files) {
            if let Some((bytes, blake3)) = staged(&record.file) {
                record.bytes = bytes;
                blake3.clone_into(&mut record.blake3);
            }
        }
    }

    /// The file's bytes: indented JSON with a final newline.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = serde_json::to_vec_pretty(self).unwrap_or_default();
        bytes.push(b'\n');
        bytes
    }
}

/// What of a manifest of any version tells which files are its own.
#[derive(Deserialize)]
struct Listed {
    #[serde(default)]
    tables: Vec<ListedUnit>,
    #[serde(default)]
    maps: Vec<ListedUnit>,
    #[serde(default)]
    stale: Vec<String>,
}

#[derive(Deserialize)]
struct ListedUnit {
    files: Vec<ListedFile>,
}

#[derive(Deserialize)]
struct ListedFile {
    file: String,
}

/// Program and version, as files name it.
pub(super) fn tool() -> String {
    format!("brdfbake {}", env!("CARGO_PKG_VERSION"))
}
