//! The lock of an output folder: an exclusive lock on a file in it, which the system gives back when its process dies.
//!
//! The file is removed by the run that held the lock, so that no folder of results has it. Who waited for the lock then holds that
//! of a file without a name, sees that, and begins anew.

use super::error::folder;
use super::{LOCK, TransactionError};
use crate::cancel::Cancel;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How often a lock that another run holds is asked for.
const PAUSE: Duration = Duration::from_millis(20);

/// Times that a file of the lock may be gone before it was locked.
const TRIES: usize = 1000;

/// How to wait for a folder that another run holds.
#[derive(Clone, Copy)]
pub struct Waiting<'a> {
    /// How long.
    pub timeout: Duration,
    /// Called once, if there is something to wait for.
    pub told: &'a dyn Fn(),
}

impl std::fmt::Debug for Waiting<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Waiting").field("timeout", &self.timeout).finish_non_exhaustive()
    }
}

/// A locked folder. Dropped, it removes the file of the lock, and the folders that it made if nothing is in them.
#[derive(Debug)]
pub(super) struct FolderLock {
    path: PathBuf,
    file: Option<File>,
    /// Folders that were made, the outermost first.
    made: Vec<PathBuf>,
}

impl FolderLock {
    pub(super) fn acquire(
        path: &Path,
        cancel: &Cancel,
        waiting: &Waiting<'_>,
    ) -> Result<FolderLock, TransactionError> {
        let start = Instant::now();
        let mut told = false;
        // an empty path is the current folder
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        let mut held = FolderLock { path: path.join(LOCK), file: None, made: Vec::new() };
        let failed = |source| TransactionError::Lock { path: path.join(LOCK), source };
        let mut tries = 0;
        loop {
            held.make(path).map_err(|source| folder(path, source))?;
            let file = match open(&held.path) {
                Ok(file) => file,
                // the run before removed the folder that it had made
                Err(e) if e.kind() == ErrorKind::NotFound && tries < TRIES => {
                    tries += 1;
                    continue;
                }
                Err(source) => return Err(folder(path, source)),
            };
            match file.try_lock() {
                Ok(()) if is_at(&file, &held.path).map_err(failed)? => {
                    held.file = Some(file);
                    return Ok(held);
                }
                Ok(()) if tries < TRIES => {
                    tries += 1;
                    continue;
                }
                Ok(()) => return Err(failed(io::Error::other("it vanishes whenever it is locked"))),
                Err(TryLockError::Error(source)) => return Err(failed(source)),
                Err(TryLockError::WouldBlock) => {}
            }
            if cancel.is_set() {
                return Err(TransactionError::Cancelled);
            }
            let left = waiting.timeout.saturating_sub(start.elapsed());
            if left.is_zero() {
                return Err(TransactionError::Busy {
                    path: path.to_owned(),
                    seconds: waiting.timeout.as_secs_f64(),
                });
            }
            if !told {
                (waiting.told)();
                told = true;
            }
            std::thread::sleep(PAUSE.min(left));
        }
    }

    /// What the drop does, for a process that is ended while it holds the lock.
    pub(super) fn ending(&self) -> impl FnOnce() + Send + 'static {
        let (path, made) = (self.path.clone(), self.made.clone());
        move || leave(&path, &made)
    }

    /// Makes the folder and those above it, and remembers which.
    fn make(&mut self, path: &Path) -> io::Result<()> {
        let missing = |p: &&Path| !p.as_os_str().is_empty() && fs::symlink_metadata(p).is_err();
        let mut new: Vec<PathBuf> = path.ancestors().take_while(missing).map(Path::to_owned).collect();
        new.reverse();
        new.retain(|p| !self.made.contains(p));
        self.made.extend(new);
        fs::create_dir_all(path)
    }
}

impl Drop for FolderLock {
    fn drop(&mut self) {
        if self.file.is_some() {
            leave(&self.path, &[]);
        }
        self.file = None;
        remove_empty(&self.made);
    }
}

/// Removes the file of a lock that is held, and folders that were made.
fn leave(path: &Path, made: &[PathBuf]) {
    // while it is locked: nobody else can have locked a file of this name
    let _ = fs::remove_file(path);
    remove_empty(made);
}

fn remove_empty(made: &[PathBuf]) {
    for folder in made.iter().rev() {
        // not if something is in it, such as the outputs
        let _ = fs::remove_dir(folder);
    }
}

/// Opens the file, for reading only if it was left by another user.
fn open(path: &Path) -> io::Result<File> {
    let made = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
    made.or_else(|e| match e.kind() {
        ErrorKind::PermissionDenied => File::open(path).map_err(|_| e),
        _ => Err(e),
    })
}

/// Is this the file of that name still?
fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    let named = match same_file::Handle::from_path(path) {
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(false),
        named => named?,
    };
    Ok(same_file::Handle::from_file(file.try_clone()?)? == named)
}
