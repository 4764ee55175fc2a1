//! Puts files on disk so that a reader never sees half of one.
//!
//! Every file is first written in full under a temporary name next to its target and flushed to the disk. Only when all
//! are there are they renamed, one by one. Until the first rename nothing that existed has changed; a system that dies
//! between two renames leaves some new and some old files, each of them whole. The outputs of a bake are held together by more:
//! [`transaction`](crate::pipeline::transaction).
//!
//! A temporary file is locked while it is written, so that [`sweep`] can tell one of a killed process.

use crate::cancel::Cancel;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// How names begin in folders of results that are no results: locks, temporary files.
pub const HIDDEN: &str = ".brdfbake-";

/// How the names of temporary files begin; a file of this name that nobody has locked is rubbish of a run that was killed.
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
    /// Something that is no file has the name, or the path has none.
    #[error("{path} cannot be written: there is {what} of this name")]
    InTheWay {
        /// The path.
        path: PathBuf,
        /// What is there: `a folder`.
        what: &'static str,
    },
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

/// Writes all files or none; see the module. `cancel` is looked at between files, up to the first rename.
///
/// # Errors
/// [`WriteError`]; all but [`WriteError::Rename`] leave every file as it was.
pub fn write_all(files: &[(PathBuf, Vec<u8>)], cancel: &Cancel) -> Result<Written, WriteError> {
    check_targets(files)?;
    // temporary files are removed when they are dropped
    let mut pending: Vec<(NamedTempFile, &Path)> = Vec::new();
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
        let mut file = create(folder).map_err(failed)?;
        file.write_all(bytes).and_then(|()| file.as_file().sync_all()).map_err(failed)?;
        pending.push((file, path));
    }
    if cancel.is_set() {
        return Err(WriteError::Cancelled);
    }
    result.written = pending.len();
    rename_all(pending)?;
    Ok(result)
}

fn check_targets(files: &[(PathBuf, Vec<u8>)]) -> Result<(), WriteError> {
    let mut paths: Vec<&Path> = files.iter().map(|(p, _)| p.as_path()).collect();
    paths.sort_unstable();
    if let Some(pair) = paths.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(WriteError::Twice(pair[0].to_owned()));
    }
    for path in paths {
        let found = match path.file_name() {
            // what cannot be looked at is told when it is written
            Some(_) => obstacle(path).unwrap_or_default(),
            None => Some("no file"),
        };
        if let Some(what) = found {
            return Err(WriteError::InTheWay { path: path.to_owned(), what });
        }
    }
    Ok(())
}

/// What keeps a file from being put under a name, if anything does. A link to a file does not: it is replaced, and what it leads to is
/// left alone.
///
/// # Errors
/// If the system does not tell what is there.
pub fn obstacle(path: &Path) -> io::Result<Option<&'static str>> {
    let found = match fs::symlink_metadata(path) {
        Err(e) if [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&e.kind()) => return Ok(None),
        found => found?,
    };
    Ok(match (found.is_symlink(), fs::metadata(path)) {
        (true, Err(_)) => Some("a link that leads nowhere"),
        (_, Ok(end)) if end.is_file() => None,
        (true, Ok(end)) if end.is_dir() => Some("a link to a folder"),
        (true, Ok(_)) => Some("a link to what is no file"),
        (false, _) if found.is_dir() => Some("a folder"),
        (false, _) => Some("a device, pipe or socket"),
    })
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

/// A new file under a name of its own, with the usual permissions (0666 less the umask), and locked.
fn create(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(TEMPORARY);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    loop {
        let file = builder.tempfile_in(folder)?;
        // where there are no locks, nobody sweeps either
        let _ = file.as_file().try_lock();
        // a run that sweeps may have seen it before it was locked
        if fs::symlink_metadata(file.path()).is_ok() {
            return Ok(file);
        }
    }
}

/// Removes the temporary files in a folder that no process is writing; returns how many.
///
/// # Errors
/// If the folder cannot be read. What cannot be removed is left.
pub fn sweep(folder: &Path) -> io::Result<usize> {
    let mut removed = 0;
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let ours = entry.file_name().to_str().is_some_and(|name| name.starts_with(TEMPORARY));
        if !ours || !entry.file_type()?.is_file() {
            continue;
        }
        let path = entry.path();
        let idle = File::open(&path).is_ok_and(|file| file.try_lock().is_ok());
        removed += usize::from(idle && fs::remove_file(&path).is_ok());
    }
    Ok(removed)
}

fn rename_all(pending: Vec<(NamedTempFile, &Path)>) -> Result<(), WriteError> {
    let all = pending.len();
    let mut folders = Vec::new();
    for (done, (file, path)) in pending.into_iter().enumerate() {
        // open, and so locked, until it has its name
        let (_open, temporary) = file.into_parts();
        rename(&temporary, path).map_err(|source| WriteError::Rename {
            path: path.to_owned(),
            source,
            done,
            all,
        })?;
        // there is nothing left to remove
        let _ = temporary.keep();
        if !folders.contains(&folder(path)) {
            folders.push(folder(path));
        }
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
pub(crate) fn rename(from: &Path, to: &Path) -> io::Result<()> {
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
