//! Files that are made of the tables of a run beside those of its outputs, such as its report.

use super::map::MapEntry;
use super::{Manifest, TableRecord};
use crate::cancel::{Cancel, Cancelled};
use crate::grid::Table;
use crate::plan::Plan;
use std::path::Path;

/// What a [`Companion`] sees of a table.
#[derive(Debug)]
pub struct Seen {
    /// Integrals, their estimated errors, evaluations.
    pub table: Table,
    /// The numbers of its first output, `[texel][channel]`.
    pub stored: Vec<f64>,
    /// Seconds of integration and of checks.
    pub seconds: [f64; 2],
}

/// Makes files of the tables of a run. It must not hold the tables themselves: they are large.
pub trait Companion: Send {
    /// All names that its files may have.
    fn names(&self, plan: &Plan) -> Vec<String>;
    /// A table is baked, verified and encoded.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn table(&mut self, record: &TableRecord, seen: Seen, cancel: &Cancel) -> Result<(), Cancelled>;
    /// A map is made; names and bytes of its files.
    ///
    /// # Errors
    /// [`Cancelled`].
    fn map(
        &mut self,
        entry: &MapEntry,
        files: &[(String, Vec<u8>)],
        cancel: &Cancel,
    ) -> Result<(), Cancelled>;
    /// All tables are there; the stale files of the manifest are not known yet. Gives the files.
    fn finish(&mut self, manifest: &Manifest) -> Vec<(String, Vec<u8>)>;
}

/// Is this the name of a page of a report? Such pages belong to a folder and are no outputs.
pub(super) fn is_page(name: &str) -> bool {
    let middle = name.strip_prefix("report").and_then(|n| n.strip_suffix(".html"));
    let numbered = |n: &str| n.strip_prefix('-').is_some_and(|n| n.bytes().all(|b| b.is_ascii_digit()));
    middle.is_some_and(|m| m.is_empty() || numbered(m))
}

/// Pages that are in a folder.
pub(super) fn pages(folder: &Path) -> Vec<String> {
    let names = std::fs::read_dir(folder).into_iter().flatten().flatten();
    names.map(|e| e.file_name().to_string_lossy().into_owned()).filter(|n| is_page(n)).collect()
}
