//! Puts a set of files on disk so that a reader never sees half of one, and an interrupted run leaves the old ones.
//!
//! Every file is first written in full under a temporary name next to its target and flushed to the disk. Only when all
//! are there are they renamed, one by one. Until the first rename nothing that existed has changed; a system that dies
//! between two renames leaves some new and some old files, each of them whole.
//!
//! The temporary files are opened with the usual permissions (0666 less the umask), because `tempfile` would leave the
//! results readable for their owner only.

use crate::cancel::Cancel;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// How the names of temporary files begin; a file of this name is rubbish of a run that was killed.
pub const TEMPORARY: &str = ".brdfbake-tmp-";

/// What [`write_all`] did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Written {
    /// Files that are new or changed.
    pub written: usize,
    /// Files that had the same bytes already; they were not touched, so that build systems see no change.
    pub unchanged: usize,
}

/// Why files could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The caller asked to stop; nothing has changed.
    #[error("cancelled before any file was replaced")]
    Cancelled,
    /// Two outputs have the same path.
    #[error("two outputs go to {0}")]
    Twice(
        /// The path.
        PathBuf,
    ),
    /// The target is a folder, or has no file name.
    #[error("{0} cannot be written: it is not the path of a file")]
    NotAFile(
        /// The path.
        PathBuf,
    ),
    /// A folder could not be made, or nothing can be written into it.
    #[error("cannot write into folder {path}: {source}")]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The system's message.
        source: io::Error,
    },
    /// A temporary file could not be written; nothing has changed.
    #[error("cannot write {path}: {source}; no file was replaced")]
    Write {
        /// The target.
        path: PathBuf,
        /// The system's message.
        source: io::Error,
    },
    /// A finished file could not be moved to its name.
    #[error("cannot replace {path}: {source}; {done} of {all} files were replaced before")]
    Rename {
        /// The target.
        path: PathBuf,
        /// The system's message.
        source: io::Error,
        /// Files that were already in place.
        done: usize,
        /// Files that were to be replaced.
        all: usize,
    },
}

/// Temporary files that are removed unless they reached their names.
#[derive(Default)]
struct Pending<'a>(Vec<(PathBuf, &'a Path)>);

impl Drop for Pending<'_> {
    fn drop(&mut self) {
        for (temporary, _) in &self.0 {
            // Nothing can be done about a temporary file that cannot be removed, and the first error is the one to tell.
            let _ = fs::remove_file(temporary);
        }
    }
}

/// Writes all files or none; see the module. `cancel` is looked at between files, up to the first rename.
///
/// # Errors
/// [`WriteError`]; all but [`WriteError::Rename`] leave every file as it was.
pub fn write_all(files: &[(PathBuf, Vec<u8>)], cancel: &Cancel) -> Result<Written, WriteError> {
    check_targets(files)?;
    let mut pending = Pending::default();
    let mut result = Written::default();
    for (path, bytes) in files {
        if cancel.is_set() {
            return Err(WriteError::Cancelled);
        }
        if holds(path, bytes) {
            result.unchanged += 1;
            continue;
        }
        let folder = folder(path);
        fs::create_dir_all(folder)
            .map_err(|source| WriteError::Folder { path: folder.to_owned(), source })?;
        let failed = |source| WriteError::Write { path: path.clone(), source };
        let (temporary, mut file) = create(folder).map_err(failed)?;
        pending.0.push((temporary, path));
        file.write_all(bytes).and_then(|()| file.sync_all()).map_err(failed)?;
    }
    if cancel.is_set() {
        return Err(WriteError::Cancelled);
    }
    result.written = pending.0.len();
    rename_all(pending)?;
    Ok(result)
}

/// Tells before hours of work whether a folder, which need not exist yet, can be written into.
///
/// # Errors
/// [`WriteError::Folder`] with the system's message.
pub fn check_writable(folder: &Path) -> Result<(), WriteError> {
    let failed = |source| WriteError::Folder { path: folder.to_owned(), source };
    let mut there = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    while let Err(e) = fs::metadata(there) {
        match there.parent() {
            Some(up) if e.kind() == ErrorKind::NotFound => {
                there = if up.as_os_str().is_empty() { Path::new(".") } else { up };
            }
            _ => return Err(failed(e)),
        }
    }
    let (temporary, _) = create(there).map_err(failed)?;
    fs::remove_file(temporary).map_err(failed)
}

fn check_targets(files: &[(PathBuf, Vec<u8>)]) -> Result<(), WriteError> {
    let mut paths: Vec<&Path> = files.iter().map(|(p, _)| p.as_path()).collect();
    paths.sort_unstable();
    if let Some(pair) = paths.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(WriteError::Twice(pair[0].to_owned()));
    }
    match paths.iter().find(|p| p.file_name().is_none() || p.is_dir()) {
        Some(path) => Err(WriteError::NotAFile((*path).to_owned())),
        None => Ok(()),
    }
}

/// The folder of a file; the current one for a bare name.
fn folder(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// True if the file exists with just these bytes.
fn holds(path: &Path, bytes: &[u8]) -> bool {
    fs::metadata(path).is_ok_and(|m| m.is_file() && m.len() == bytes.len() as u64)
        && fs::read(path).is_ok_and(|old| old == bytes)
}

/// Opens a new file under a name that no other process and no other call of this one has.
fn create(folder: &Path) -> io::Result<(PathBuf, File)> {
    static COUNTER: AtomicU64 = AtomicU64::new(0);
    for _ in 0..1000 {
        let n = COUNTER.fetch_add(1, Ordering::Relaxed);
        let path = folder.join(format!("{TEMPORARY}{}-{n}", std::process::id()));
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            // A killed process of the same id left its rubbish: try the next number.
            Err(e) if e.kind() == ErrorKind::AlreadyExists => {}
            Ok(file) => return Ok((path, file)),
            Err(e) => return Err(e),
        }
    }
    Err(io::Error::new(ErrorKind::AlreadyExists, "a thousand temporary names are taken"))
}

fn rename_all(mut pending: Pending<'_>) -> Result<(), WriteError> {
    let all = pending.0.len();
    let mut folders = Vec::new();
    while let Some((temporary, path)) = pending.0.first() {
        let path = *path;
        if let Err(source) = rename(temporary, path) {
            let done = all - pending.0.len();
            return Err(WriteError::Rename { path: path.to_owned(), source, done, all });
        }
        if !folders.contains(&folder(path)) {
            folders.push(folder(path));
        }
        pending.0.remove(0);
    }
    if cfg!(unix) {
        // The names themselves must survive a power cut too. Some file systems cannot do that; the files are whole anyway.
        for folder in folders {
            let _ = File::open(folder).and_then(|f| f.sync_all());
        }
    }
    Ok(())
}

/// Renames; on Windows a scanner or indexer may hold the target for a moment, so try for half a second.
fn rename(from: &Path, to: &Path) -> io::Result<()> {
    let mut tries = if cfg!(windows) { 10 } else { 0 };
    loop {
        match fs::rename(from, to) {
            Err(e) if tries > 0 && e.kind() == ErrorKind::PermissionDenied => {
                tries -= 1;
                std::thread::sleep(std::time::Duration::from_millis(50));
            }
            done => return done,
        }
    }
}
