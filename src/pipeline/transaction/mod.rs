//! The outputs of a run as one transaction: a folder holds those of one bake under its manifest, or has no manifest.
//!
//! # What is promised
//! * **One bake at a time.** A run holds the lock of its output folder from before it bakes until its files are in place; the
//!   system gives the lock back when a process dies. A second run waits, and gives up after a time that is asked for. The
//!   lock is one between programs that take it: an editor or a copy does not.
//! * **The manifest never lies.** It is taken away before the first file is replaced, and the new one is put in place after the
//!   last. Whoever finds a manifest finds the files whose hashes it lists ([`audit`](super::audit) checks that); whoever finds none
//!   looks at a folder in which files are being replaced, or a run was killed while it replaced them.
//! * **Each file is whole at any time.** A file is replaced by a rename. Where the file system has no hard links its name is
//!   free for a moment before.
//! * **An error changes nothing.** Until the first rename nothing that existed is touched. An error behind it puts back what
//!   was replaced, the old manifest last.
//! * **A killed run is finished.** Before the first rename the new files are on the disk, and so is a journal of what is to be
//!   done. The next run that holds the lock does the rest of it before it bakes, or puts the old files back where that
//!   cannot be done; what a run left that had not come so far is removed.
//!
//! Names of files may lead into folders inside the output folder (`textures/wood.png`). A transaction without a manifest
//! ([`Transaction::commit_files`]) keeps the other promises.
//!
//! Not promised: that files which another bake wrote into the folder, and this one does not write, are removed; that a
//! power cut spares a file system which loses what was synchronised; anything on a file system without locks, where the
//! run is refused.
//!
//! # How
//! Finished files are written into the folder [`STAGING`] inside the output folder, table by table, so that they are not held in
//! memory. There the journal and the replaced files are too. It is gone when the run ends, and so is the file of the lock.

mod error;
mod journal;
mod lock;
mod targets;
#[cfg(test)]
mod tests;

pub use error::TransactionError;
pub(super) use journal::{holds, is_inside, is_plain};
pub use lock::Waiting;
pub use targets::check;

use super::MANIFEST;
use crate::cancel::{AtEnd, Cancel};
use crate::encode::atomic;
use journal::{Entry, Journal, Paths};
use lock::FolderLock;
use serde::Serialize;
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;

/// The folder of new files, replaced files and journal, inside the output folder.
pub const STAGING: &str = ".brdfbake-tmp-bake";

/// The file that is locked, inside the output folder.
pub const LOCK: &str = ".brdfbake-lock";

/// What was done about a run that was killed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Recovery {
    /// It had begun to replace files: the rest of them are in place now, and so is its manifest.
    Finished,
    /// It had begun to replace files, which could not be finished: the old ones are back.
    RolledBack,
    /// It had replaced nothing: its files are removed.
    Discarded,
}

/// What a transaction did.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Written {
    /// Files that are new or changed.
    pub written: usize,
    /// Files that had the same bytes already; they were not touched, so that build systems see no change.
    pub unchanged: usize,
}

/// The outputs of one run; see the module. Dropped without [`Transaction::commit`], it leaves the folder as it was.
#[derive(Debug)]
pub struct Transaction<'a> {
    paths: Paths,
    staged: Vec<Entry>,
    /// Released last, when the staging folder is gone.
    lock: Option<FolderLock>,
    cancel: &'a Cancel,
    /// False if what is in the staging folder is needed by the next run.
    clear: bool,
    /// What is to be done if the process is ended before this is dropped.
    _word: AtEnd<'a>,
}

impl<'a> Transaction<'a> {
    /// Locks a folder, makes it if need be, finishes or removes what a killed run left, and checks that files of these names can be
    /// written there. `cancel` is looked at while it waits for the lock and until the first file is replaced.
    ///
    /// # Errors
    /// [`TransactionError`]; nothing of the folder has changed then, but for what a killed run left.
    pub fn begin(
        folder: &Path,
        names: &[String],
        cancel: &'a Cancel,
        waiting: &Waiting<'_>,
    ) -> Result<(Transaction<'a>, Option<Recovery>), TransactionError> {
        let lock = FolderLock::acquire(folder, cancel, waiting)?;
        let _hold = cancel.hold();
        let paths = Paths::new(folder);
        let recovered = journal::recover(&paths)?;
        let swept = atomic::sweep(folder).map_err(|source| error::folder(folder, source))?;
        check(folder, names)?;
        let recovered = recovered.or((swept > 0).then_some(Recovery::Discarded));
        let (rest, unlock) = (paths.clone(), lock.ending());
        let word = cancel.at_end(move || {
            // with a journal it is for the next run to say what becomes of it
            if !rest.journal().exists() {
                let _ = journal::clear(&rest);
            }
            unlock();
        });
        let lock = Some(lock);
        let begun = Transaction { paths, staged: Vec::new(), lock, cancel, clear: true, _word: word };
        for part in [begun.paths.staging(), &begun.paths.new_folder(), &begun.paths.old_folder()] {
            fs::create_dir(part).map_err(|source| error::folder(folder, source))?;
        }
        Ok((begun, recovered))
    }

    /// Takes a finished file. Nothing that existed changes.
    ///
    /// # Errors
    /// [`TransactionError::Write`], such as for a full disk.
    pub fn stage(&mut self, name: &str, bytes: &[u8]) -> Result<(), TransactionError> {
        self.is_new(name)?;
        let _hold = self.cancel.hold();
        let path = self.paths.new_file(name);
        let write = || {
            fs::create_dir_all(path.parent().unwrap_or(&self.paths.new_folder()))?;
            File::create(&path)?.write_all(bytes)
        };
        write().map_err(|source| error::write(&self.paths.target(name), source))?;
        self.staged.push(Entry::of(name, bytes));
        Ok(())
    }

    /// A file that the folder has already, with this size and hash: whoever calls has looked at its bytes.
    ///
    /// # Errors
    /// [`TransactionError::Twice`].
    pub fn keep(&mut self, name: &str, bytes: u64, blake3: &str) -> Result<(), TransactionError> {
        self.is_new(name)?;
        self.staged.push(Entry::kept(name, bytes, blake3));
        Ok(())
    }

    fn is_new(&self, name: &str) -> Result<(), TransactionError> {
        match self.staged.iter().any(|e| e.name == name) {
            true => Err(TransactionError::Twice { name: name.to_owned(), other: name.to_owned() }),
            false => Ok(()),
        }
    }

    /// The bytes of a file that was taken.
    ///
    /// # Errors
    /// Where it cannot be read, or is kept in its place.
    pub fn read_staged(&self, name: &str) -> std::io::Result<Vec<u8>> {
        fs::read(self.paths.new_file(name))
    }

    /// Size and hash (blake3) of a file that was taken.
    #[must_use]
    pub fn staged(&self, name: &str) -> Option<(u64, &str)> {
        self.staged.iter().find(|e| e.name == name).map(Entry::facts)
    }

    /// Puts all files in place, and the manifest last.
    ///
    /// # Errors
    /// [`TransactionError`]; but for [`TransactionError::Stuck`] every file is as it was.
    pub fn commit(mut self, manifest: &[u8]) -> Result<Written, TransactionError> {
        self.stage(MANIFEST, manifest)?;
        self.commit_files()
    }

    /// Puts all files in place, and no manifest: for files that are no bake of their own, such as a scene. A manifest that the folder
    /// has stays.
    ///
    /// # Errors
    /// As [`Transaction::commit`].
    pub fn commit_files(mut self) -> Result<Written, TransactionError> {
        let mut result = Written::default();
        for entry in &mut self.staged {
            entry.replace = entry.replace && !entry.is_at(&self.paths.target(&entry.name));
            *(if entry.replace { &mut result.written } else { &mut result.unchanged }) += 1;
        }
        if result.written == 0 {
            return Ok(result);
        }
        // it is taken away while others are replaced, even if it will be the same
        self.staged.iter_mut().filter(|e| e.name == MANIFEST).for_each(|e| e.replace = true);
        for entry in self.staged.iter().filter(|e| e.replace) {
            if self.cancel.is_set() {
                return Err(TransactionError::Cancelled);
            }
            let synced = File::options().write(true).open(self.paths.new_file(&entry.name));
            synced
                .and_then(|f| f.sync_all())
                .map_err(|source| error::write(&self.paths.target(&entry.name), source))?;
        }
        let _hold = self.cancel.hold();
        let journal = Journal::new(std::mem::take(&mut self.staged));
        journal.write(&self.paths).map_err(|source| error::write(&self.paths.journal(), source))?;
        if self.cancel.is_set() {
            return Err(TransactionError::Cancelled);
        }
        let done = journal.carry_out(&self.paths);
        self.clear = !matches!(done, Err(TransactionError::Stuck { .. }));
        done.map(|()| result)
    }
}

impl Drop for Transaction<'_> {
    fn drop(&mut self) {
        let _hold = self.cancel.hold();
        if self.clear {
            // Nothing can be done about what cannot be removed, and it does no harm: the next run removes it.
            let _ = journal::clear(&self.paths);
        }
        self.lock = None;
    }
}
