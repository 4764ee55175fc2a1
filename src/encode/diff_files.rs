//! Compares two files or two folders of outputs. Pictures are compared as values, JSON as JSON, anything else as bytes.

use super::Encoder;
use super::atomic::HIDDEN;
use super::beside;
use super::diff::{self, ImageDiff, Pairing, Tolerance};
use super::diff_json::{self, JsonDiff};
use super::layout::Layout;
use super::read::{self, ReadError};
use crate::cancel::{Cancel, Cancelled};
use serde::Serialize;
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Folders nested deeper than this are refused: a link that leads upwards would never end.
const MAX_DEPTH: usize = 64;

/// How files are compared.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Manner {
    /// How far apart values may be.
    pub tolerance: Tolerance,
    /// Which channels are compared.
    pub pairing: Pairing,
    /// How the numbers of bare files lie; without it the manifests beside them tell.
    pub layout: Option<Layout>,
}

impl From<Tolerance> for Manner {
    fn from(tolerance: Tolerance) -> Manner {
        Manner { tolerance, ..Manner::default() }
    }
}

/// How two files of the same name relate.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum FileDiff {
    /// The same bytes.
    Identical,
    /// Two pictures.
    Image(ImageDiff),
    /// Two JSON files; the difference is absent if only their layout differs.
    Json {
        /// The first difference.
        difference: Option<JsonDiff>,
    },
    /// Two other files with different bytes.
    Bytes {
        /// Offset of the first byte that differs.
        offset: usize,
        /// Sizes of the two files.
        sizes: [usize; 2],
    },
    /// Only the first folder has it.
    OnlyFirst,
    /// Only the second folder has it.
    OnlySecond,
}

/// How two folders relate: relative path (with `/`) and outcome of every file, sorted.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FolderDiff {
    /// One entry a file.
    pub files: Vec<(String, FileDiff)>,
}

/// Two files, or two folders.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum PathDiff {
    /// Two files.
    File(Box<FileDiff>),
    /// Two folders.
    Folder(FolderDiff),
}

/// Why a comparison could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DiffError {
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A file or folder cannot be read.
    #[error("{path}: {source}")]
    Io {
        /// The path.
        path: PathBuf,
        /// The system's message.
        source: io::Error,
    },
    /// A picture cannot be read.
    #[error("{path}: {source}")]
    Read {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: ReadError,
    },
    /// A JSON file cannot be parsed.
    #[error("{path}: {source}")]
    Json {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: serde_json::Error,
    },
    /// A file against a folder.
    #[error("cannot compare a file with a folder: {a} and {b}")]
    Kinds {
        /// The first path.
        a: PathBuf,
        /// The second path.
        b: PathBuf,
    },
    /// Folders nested too deeply.
    #[error("{0}: folders nested more than {MAX_DEPTH} deep")]
    Depth(
        /// The folder.
        PathBuf,
    ),
}

impl FileDiff {
    /// Two files that are different byte strings, and no more is known of them.
    #[must_use]
    pub fn of_bytes(a: &[u8], b: &[u8]) -> FileDiff {
        let same = a.iter().zip(b).take_while(|(x, y)| x == y).count();
        FileDiff::Bytes { offset: same, sizes: [a.len(), b.len()] }
    }

    /// True if nothing that counts differs.
    #[must_use]
    pub fn equal(&self) -> bool {
        match self {
            FileDiff::Identical | FileDiff::Json { difference: None } => true,
            FileDiff::Image(d) => d.equal(),
            _ => false,
        }
    }
}

impl FolderDiff {
    /// True if both have the same files and all of them are equal.
    #[must_use]
    pub fn equal(&self) -> bool {
        self.files.iter().all(|(_, d)| d.equal())
    }
}

impl PathDiff {
    /// True if nothing that counts differs.
    #[must_use]
    pub fn equal(&self) -> bool {
        match self {
            PathDiff::File(d) => d.equal(),
            PathDiff::Folder(d) => d.equal(),
        }
    }
}

/// Compares two files or two folders.
///
/// # Errors
/// [`DiffError`] if one cannot be read, or one is a file and the other a folder.
pub fn paths(a: &Path, b: &Path, tolerance: Tolerance) -> Result<PathDiff, DiffError> {
    paths_until(&Cancel::new(), a, b, &tolerance.into())
}

/// [`paths`], until it is stopped.
///
/// # Errors
/// As [`paths`]; [`DiffError::Cancelled`].
pub fn paths_until(cancel: &Cancel, a: &Path, b: &Path, manner: &Manner) -> Result<PathDiff, DiffError> {
    match (a.is_dir(), b.is_dir()) {
        (true, true) => folders_until(cancel, a, b, manner).map(PathDiff::Folder),
        (false, false) => files_until(cancel, a, b, manner).map(|d| PathDiff::File(Box::new(d))),
        _ => Err(DiffError::Kinds { a: a.to_owned(), b: b.to_owned() }),
    }
}

/// Compares two files. Pictures with the same bytes are compared too, so that the result lists their channels.
///
/// # Errors
/// [`DiffError`] if one cannot be read.
pub fn files(a: &Path, b: &Path, tolerance: Tolerance) -> Result<FileDiff, DiffError> {
    files_until(&Cancel::new(), a, b, &tolerance.into())
}

fn files_until(cancel: &Cancel, a: &Path, b: &Path, manner: &Manner) -> Result<FileDiff, DiffError> {
    let (x, y) = (load(cancel, a)?, load(cancel, b)?);
    compare(cancel, [a, b], [&x, &y], manner)
}

/// Compares the files of two folders, matched by relative path. What a killed run left (names with [`HIDDEN`]) is
/// left out.
///
/// # Errors
/// [`DiffError`] if a file that both folders have, with different bytes, cannot be read.
pub fn folders(a: &Path, b: &Path, tolerance: Tolerance) -> Result<FolderDiff, DiffError> {
    folders_until(&Cancel::new(), a, b, &tolerance.into())
}

fn folders_until(cancel: &Cancel, a: &Path, b: &Path, manner: &Manner) -> Result<FolderDiff, DiffError> {
    let (mut left, mut right) = (BTreeSet::new(), BTreeSet::new());
    list(a, "", 0, &mut left)?;
    list(b, "", 0, &mut right)?;
    let mut files = Vec::new();
    for name in left.union(&right) {
        let diff = match (left.contains(name), right.contains(name)) {
            (true, false) => FileDiff::OnlyFirst,
            (false, _) => FileDiff::OnlySecond,
            _ => {
                let (p, q) = (a.join(name), b.join(name));
                let (x, y) = (load(cancel, &p)?, load(cancel, &q)?);
                if x == y { FileDiff::Identical } else { compare(cancel, [&p, &q], [&x, &y], manner)? }
            }
        };
        files.push((name.clone(), diff));
    }
    Ok(FolderDiff { files })
}

fn load(cancel: &Cancel, path: &Path) -> Result<Vec<u8>, DiffError> {
    read::load_until(cancel, path).map_err(|e| match e {
        ReadError::Cancelled(stopped) => stopped.into(),
        ReadError::Io { path, source } => DiffError::Io { path, source },
        source => DiffError::Read { path: path.to_owned(), source },
    })
}

fn compare(
    cancel: &Cancel,
    paths: [&Path; 2],
    bytes: [&[u8]; 2],
    manner: &Manner,
) -> Result<FileDiff, DiffError> {
    let extension = |p: &Path| p.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let [a, b] = paths.map(|p| extension(p).unwrap_or_default());
    let told = |i: usize| manner.layout.is_some() || beside::entry(paths[i]).is_some();
    let picture = |i: usize, e: &str| {
        let of = |c: &&&dyn Encoder| c.extension() == e;
        super::ENCODERS.iter().find(of).is_some_and(|c| !c.magic().is_empty() || c.id() == "raw" && told(i))
    };
    if picture(0, &a) && picture(1, &b) {
        let image = |i: usize| {
            let layout = manner.layout.as_ref().filter(|_| Layout::is_of(paths[i]));
            beside::read(paths[i], bytes[i], layout, cancel).map_err(|e| match e {
                ReadError::Cancelled(stopped) => stopped.into(),
                source => DiffError::Read { path: paths[i].to_owned(), source },
            })
        };
        return Ok(FileDiff::Image(diff::images_by(
            &image(0)?,
            &image(1)?,
            manner.tolerance,
            &manner.pairing,
        )));
    }
    if bytes[0] == bytes[1] {
        return Ok(FileDiff::Identical);
    }
    if a == "json" && b == "json" {
        let value = |i: usize| {
            serde_json::from_slice(bytes[i])
                .map_err(|source| DiffError::Json { path: paths[i].to_owned(), source })
        };
        return Ok(FileDiff::Json { difference: diff_json::first_difference(&value(0)?, &value(1)?) });
    }
    Ok(FileDiff::of_bytes(bytes[0], bytes[1]))
}

/// Relative paths of all files below a folder.
fn list(root: &Path, below: &str, depth: usize, into: &mut BTreeSet<String>) -> Result<(), DiffError> {
    let folder = root.join(below);
    if depth > MAX_DEPTH {
        return Err(DiffError::Depth(folder));
    }
    let io = |source| DiffError::Io { path: folder.clone(), source };
    for entry in fs::read_dir(&folder).map_err(io)? {
        let entry = entry.map_err(io)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let relative = if below.is_empty() { name.clone() } else { format!("{below}/{name}") };
        if name.starts_with(HIDDEN) {
            continue;
        }
        if entry.file_type().map_err(io)?.is_dir() {
            list(root, &relative, depth + 1, into)?;
        } else {
            into.insert(relative);
        }
    }
    Ok(())
}
