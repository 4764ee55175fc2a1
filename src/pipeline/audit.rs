//! Whether a folder holds what its manifest says: every file, with the bytes that were written.
//!
//! Nothing is baked and nothing is written. A file that is not as the manifest says is asked for its own metadata, so that a mixture of
//! two bakes is told from a damaged file. Manifests of every version are read: only names, sizes and hashes are looked at.

use super::transaction::{LOCK, STAGING, is_plain};
use super::{MANIFEST, companion, golden};
use crate::encode::atomic::HIDDEN;
use crate::encode::read::{self, Claim};
use crate::grid::Provenance;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// How often a folder is looked at that changes meanwhile.
const TRIES: usize = 3;

/// What was found in a folder.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Audit {
    /// Name of the recipe, from the manifest.
    pub recipe: String,
    /// Hash over the tables, from the manifest.
    pub hash: String,
    /// Program that wrote the manifest.
    pub tool: String,
    /// The files of the manifest, in its order.
    pub files: Vec<Checked>,
    /// Files that are in the folder and not in the manifest, sorted. Settings and texts of a golden folder do not count.
    pub foreign: Vec<Foreign>,
    /// Whether a run is at work in the folder, or was killed there.
    pub activity: Activity,
}

/// A file of the manifest.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Checked {
    /// Its name.
    pub file: String,
    /// What was found.
    #[serde(flatten)]
    pub state: State,
}

/// What became of a file of the manifest.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "state", rename_all = "kebab-case")]
pub enum State {
    /// It has the bytes that were written.
    Whole,
    /// It is not there.
    Missing,
    /// It has other bytes.
    Changed {
        /// Its size, and that in the manifest.
        bytes: [u64; 2],
        /// Its hash, and that in the manifest.
        blake3: [String; 2],
        /// The bake that it says it is of, if it says so and that is another one.
        origin: Option<Origin>,
    },
}

/// A file that the manifest does not name.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Foreign {
    /// Its name.
    pub file: String,
    /// The bake that it says it is of.
    pub origin: Option<Origin>,
}

/// Where a file says that it is from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Origin {
    /// Name of the recipe.
    pub recipe: String,
    /// Name of the table.
    pub table: String,
    /// Hash of the table's recipe.
    pub hash: String,
    /// Program and version.
    pub tool: String,
}

/// What goes on in a folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Activity {
    /// Nothing.
    Idle,
    /// A run holds its lock.
    Running,
    /// A run was killed in it; the next bake into the folder finishes or removes what it left.
    Killed,
}

/// What the files of a folder are, taken together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Those of the manifest.
    Whole,
    /// Some are of another bake.
    Mixture,
    /// Some are missing, or have other bytes and do not say why.
    Damaged,
}

/// Why a folder cannot be checked.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AuditError {
    /// A folder or file cannot be read.
    #[error("{path}: {source}")]
    Io {
        /// The path.
        path: PathBuf,
        /// The system's message.
        #[source]
        source: io::Error,
    },
    /// There is no manifest.
    #[error("{path} has no {MANIFEST}: {}", why_none(*.activity))]
    NoManifest {
        /// The folder.
        path: PathBuf,
        /// What goes on in it.
        activity: Activity,
    },
    /// The manifest cannot be read as one.
    #[error("{path}: {message}")]
    Manifest {
        /// The manifest.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// Other files whenever it is looked at.
    #[error("{0} is being written: its {MANIFEST} changed while its files were read")]
    Changing(
        /// The folder.
        PathBuf,
    ),
}

fn why_none(activity: Activity) -> &'static str {
    match activity {
        Activity::Idle => "nothing was baked into it, or a file of it was removed",
        Activity::Running => "a bake is at work in it",
        Activity::Killed => {
            "a bake was killed while it replaced files, so that old and new ones may be mixed; bake into it again"
        }
    }
}

/// What is read of a manifest.
#[derive(Debug, Deserialize)]
struct Listed {
    #[serde(default)]
    recipe: String,
    #[serde(default)]
    hash: String,
    #[serde(default)]
    tool: String,
    tables: Vec<ListedTable>,
    #[serde(default)]
    maps: Vec<ListedTable>,
}

#[derive(Debug, Deserialize)]
struct ListedTable {
    #[serde(default)]
    recipe: ListedRecipe,
    files: Vec<ListedFile>,
}

#[derive(Debug, Default, Deserialize)]
struct ListedRecipe {
    #[serde(default)]
    hash: String,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
struct ListedFile {
    file: String,
    bytes: u64,
    blake3: String,
}

impl Audit {
    /// What the files are, taken together. Foreign files do not count.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let foreign = |f: &Checked| matches!(f.state, State::Changed { origin: Some(_), .. });
        match () {
            () if self.files.iter().any(foreign) => Verdict::Mixture,
            () if self.files.iter().all(|f| f.state == State::Whole) => Verdict::Whole,
            () => Verdict::Damaged,
        }
    }
}

/// Compares the files of a folder with its manifest.
///
/// # Errors
/// [`AuditError`] if there is no manifest, or it or a file cannot be read.
pub fn audit(folder: &Path) -> Result<Audit, AuditError> {
    look(folder, foreign)
}

/// [`audit`] of the files of the manifest alone: others, of which there may be thousands, are not opened.
pub(super) fn of_listed(folder: &Path) -> Result<Audit, AuditError> {
    look(folder, |_, _| Ok(Vec::new()))
}

/// Finds the files of a folder that are not among those known.
type Others = fn(&Path, &[&str]) -> Result<Vec<Foreign>, AuditError>;

fn look(folder: &Path, others: Others) -> Result<Audit, AuditError> {
    for _ in 0..TRIES {
        let text = manifest(folder)?;
        let audit = compare(folder, &text, others)?;
        // the files of a bake that ended meanwhile are not those of the manifest that was read
        if manifest(folder)? == text {
            return Ok(audit);
        }
    }
    Err(AuditError::Changing(folder.to_owned()))
}

fn manifest(folder: &Path) -> Result<Vec<u8>, AuditError> {
    let path = folder.join(MANIFEST);
    match fs::read(&path) {
        Ok(text) => Ok(text),
        Err(e) if e.kind() == ErrorKind::NotFound && folder.is_dir() => {
            Err(AuditError::NoManifest { path: folder.to_owned(), activity: activity(folder) })
        }
        Err(source) => Err(AuditError::Io { path, source }),
    }
}

fn compare(folder: &Path, text: &[u8], others: Others) -> Result<Audit, AuditError> {
    let fault = |message: String| AuditError::Manifest { path: folder.join(MANIFEST), message };
    let listed: Listed = serde_json::from_slice(text).map_err(|e| fault(e.to_string()))?;
    // a file that several tables share is listed by each of them
    let mut seen: BTreeMap<&str, (&ListedFile, Vec<&str>)> = BTreeMap::new();
    let mut order = Vec::new();
    let units = listed.tables.iter().chain(&listed.maps);
    for (table, file) in units.flat_map(|t| t.files.iter().map(move |f| (t, f))) {
        if !is_plain(&file.file) {
            return Err(fault(format!("`{}` is not the name of a file in its folder", file.file)));
        }
        let (first, hashes) = seen.entry(&file.file).or_insert_with(|| {
            order.push(file.file.as_str());
            (file, Vec::new())
        });
        if *first != file {
            return Err(fault(format!("it lists {} twice, with other bytes", file.file)));
        }
        hashes.push(&table.recipe.hash);
    }
    let mut files = Vec::new();
    for name in order {
        let (file, hashes) = &seen[name];
        files.push(Checked { file: name.to_owned(), state: state(folder, file, hashes)? });
    }
    let foreign = others(folder, &seen.keys().copied().collect::<Vec<_>>())?;
    let Listed { recipe, hash, tool, .. } = listed;
    Ok(Audit { recipe, hash, tool, files, foreign, activity: activity(folder) })
}

fn state(folder: &Path, listed: &ListedFile, hashes: &[&str]) -> Result<State, AuditError> {
    let path = folder.join(&listed.file);
    let io = |source| AuditError::Io { path: path.clone(), source };
    let mut hasher = blake3::Hasher::new();
    let bytes = match File::open(&path) {
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(State::Missing),
        Err(e) => return Err(io(e)),
        Ok(file) => {
            hasher.update_reader(file).map_err(io)?;
            hasher.count()
        }
    };
    let hash = hasher.finalize().to_hex().to_string();
    if hash == listed.blake3 && bytes == listed.bytes {
        return Ok(State::Whole);
    }
    Ok(State::Changed {
        bytes: [bytes, listed.bytes],
        blake3: [hash, listed.blake3.clone()],
        origin: origin(&path).filter(|o| !hashes.contains(&o.hash.as_str())),
    })
}

/// Files beside those of the manifest.
fn foreign(folder: &Path, known: &[&str]) -> Result<Vec<Foreign>, AuditError> {
    let io = |source| AuditError::Io { path: folder.to_owned(), source };
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(io)? {
        let entry = entry.map_err(io)?;
        let file = entry.file_name().to_string_lossy().into_owned();
        let ours =
            golden::OWN.contains(&file.as_str()) || companion::is_page(&file) || file.starts_with(HIDDEN);
        if !ours && !known.contains(&file.as_str()) && entry.path().is_file() {
            found.push(Foreign { origin: origin(&entry.path()), file });
        }
    }
    found.sort_by(|a, b| a.file.cmp(&b.file));
    Ok(found)
}

/// Largest file that is unpacked for what it says of itself.
const MOST_READ: u64 = 1 << 26;

/// What a file says of itself.
fn origin(path: &Path) -> Option<Origin> {
    if fs::metadata(path).ok()?.len() > MOST_READ {
        return None;
    }
    let of = |p: &Provenance| Origin {
        recipe: p.recipe.name.clone(),
        table: p.name.clone(),
        hash: p.recipe.hash.clone(),
        tool: p.tool.clone(),
    };
    match read::read_file(path).ok()?.provenance? {
        Claim::Known(p) => Some(of(&p)),
        Claim::Several(all) => all.first().map(of),
        Claim::Unknown { .. } => None,
    }
}

/// Whether a run is at work in a folder, or left something there.
fn activity(folder: &Path) -> Activity {
    let left = folder.join(STAGING).exists();
    let held = match File::open(folder.join(LOCK)) {
        Ok(file) => matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)),
        Err(_) => false,
    };
    match (held, left) {
        (true, _) => Activity::Running,
        (false, true) => Activity::Killed,
        (false, false) => Activity::Idle,
    }
}
