//! What is to be done with the files of a transaction, and how to do the rest of it, or none of it.
//!
//! Between journal and end, a file that is to be replaced is in one of four states: new one staged, old one in place; the same with
//! a second name of the old one; the old one moved away; new one in place. Each tells from which names exist what
//! is left to do, forwards and backwards, so that every step can be repeated and nothing has to be noted in between.

use super::error::folder;
use super::{MANIFEST, Recovery, STAGING, TransactionError};
use crate::encode::atomic;
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Version of the journal.
const SCHEMA: u32 = 1;

/// A file of the transaction.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Entry {
    pub(super) name: String,
    bytes: u64,
    blake3: String,
    /// False if the folder had it already.
    pub(super) replace: bool,
}

impl Entry {
    pub(super) fn of(name: &str, bytes: &[u8]) -> Entry {
        let blake3 = blake3::hash(bytes).to_hex().to_string();
        Entry { name: name.to_owned(), bytes: bytes.len() as u64, blake3, replace: true }
    }

    /// One that the folder has already.
    pub(super) fn kept(name: &str, bytes: u64, blake3: &str) -> Entry {
        Entry { name: name.to_owned(), bytes, blake3: blake3.to_owned(), replace: false }
    }

    /// Size and hash.
    pub(super) fn facts(&self) -> (u64, &str) {
        (self.bytes, &self.blake3)
    }

    /// Are these the bytes of a file?
    pub(super) fn is_at(&self, path: &Path) -> bool {
        holds(path, self.bytes, &self.blake3)
    }
}

/// Is there a file of this size and hash?
pub(in crate::pipeline) fn holds(path: &Path, bytes: u64, blake3: &str) -> bool {
    let hash = || {
        let mut hasher = blake3::Hasher::new();
        hasher.update_reader(File::open(path).ok()?).ok()?;
        Some(hasher.finalize().to_hex().to_string())
    };
    fs::metadata(path).is_ok_and(|m| m.is_file() && m.len() == bytes) && hash().is_some_and(|h| h == blake3)
}

/// Where the files of a transaction are.
#[derive(Debug, Clone)]
pub(super) struct Paths {
    folder: PathBuf,
    staging: PathBuf,
}

impl Paths {
    pub(super) fn new(folder: &Path) -> Paths {
        Paths { folder: folder.to_owned(), staging: folder.join(STAGING) }
    }

    pub(super) fn staging(&self) -> &Path {
        &self.staging
    }

    pub(super) fn new_folder(&self) -> PathBuf {
        self.staging.join("new")
    }

    pub(super) fn old_folder(&self) -> PathBuf {
        self.staging.join("old")
    }

    pub(super) fn journal(&self) -> PathBuf {
        self.staging.join("journal.json")
    }

    /// Where a file ends up.
    pub(super) fn target(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Where it is until then.
    pub(super) fn new_file(&self, name: &str) -> PathBuf {
        self.new_folder().join(name)
    }

    /// Where the one that it replaces goes.
    fn old_file(&self, name: &str) -> PathBuf {
        self.old_folder().join(name)
    }
}

/// A step between two states of the folder. Each can be repeated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Step<'a> {
    /// Moves the old manifest away.
    TakeAway(&'a str),
    /// Keeps the old file.
    Save(&'a str),
    /// Puts the new file in its place.
    Place(&'a str),
    /// Takes the new file out of its place.
    Unplace(&'a str),
    /// Puts the old file back.
    Restore(&'a str),
    /// Waits until the disk has what was done.
    Sync,
}

impl Step<'_> {
    pub(super) fn run(self, paths: &Paths) -> io::Result<()> {
        let (new, old, target) = match self {
            Step::Sync => return sync(&paths.folder),
            Step::TakeAway(n) | Step::Save(n) | Step::Place(n) | Step::Unplace(n) | Step::Restore(n) => {
                (paths.new_file(n), paths.old_file(n), paths.target(n))
            }
        };
        fs::create_dir_all(old.parent().unwrap_or(&paths.staging))?;
        match self {
            Step::TakeAway(_) | Step::Save(_) if exists(&old)? || !exists(&new)? => Ok(()),
            Step::TakeAway(_) => none_is_fine(atomic::rename(&target, &old)),
            Step::Save(_) => none_is_fine(save(&target, &old)),
            Step::Place(_) if exists(&new)? => {
                fs::create_dir_all(target.parent().unwrap_or(&paths.folder))?;
                atomic::rename(&new, &target)
            }
            Step::Unplace(_) if !exists(&new)? => {
                none_is_fine(atomic::rename(&target, &new))?;
                leave(&target, &paths.folder);
                Ok(())
            }
            Step::Restore(_) if exists(&old)? => atomic::rename(&old, &target),
            _ => Ok(()),
        }
    }

    /// The file that it is about.
    fn path(self, paths: &Paths) -> PathBuf {
        match self {
            Step::TakeAway(n) | Step::Save(n) | Step::Place(n) | Step::Unplace(n) | Step::Restore(n) => {
                paths.target(n)
            }
            Step::Sync => paths.folder.clone(),
        }
    }
}

/// What a transaction puts in place.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Journal {
    schema: u32,
    /// All files of the manifest, and the manifest.
    files: Vec<Entry>,
}

impl Journal {
    pub(super) fn new(files: Vec<Entry>) -> Journal {
        Journal { schema: SCHEMA, files }
    }

    /// Puts it on the disk, after the new files.
    pub(super) fn write(&self, paths: &Paths) -> io::Result<()> {
        let text = serde_json::to_vec_pretty(self)?;
        let draft = paths.staging.join("journal.draft");
        let mut file = File::create(&draft)?;
        file.write_all(&text)?;
        file.sync_all()?;
        sync(&paths.new_folder())?;
        atomic::rename(&draft, &paths.journal())?;
        sync(&paths.staging)?;
        sync(&paths.folder)
    }

    fn read(paths: &Paths) -> Result<Option<Journal>, TransactionError> {
        let path = paths.journal();
        let text = match fs::read(&path) {
            Err(e) if e.kind() == ErrorKind::NotFound => return Ok(None),
            Err(source) => return Err(folder(&paths.folder, source)),
            Ok(text) => text,
        };
        let fault = |message: String| TransactionError::Journal { path: path.clone(), message };
        let journal: Journal = serde_json::from_slice(&text).map_err(|e| fault(e.to_string()))?;
        if journal.schema != SCHEMA {
            return Err(fault(format!("it is of schema {}, not {SCHEMA}", journal.schema)));
        }
        // a name that leads out of the folder was not written by this program
        match journal.files.iter().find(|e| !is_inside(&e.name)) {
            Some(entry) => Err(fault(format!("`{}` is no file name", entry.name))),
            None => Ok(Some(journal)),
        }
    }

    /// Names to be replaced, without the manifest.
    fn names(&self) -> impl DoubleEndedIterator<Item = &str> {
        let replaced = self.files.iter().filter(|e| e.replace && e.name != MANIFEST);
        replaced.map(|e| e.name.as_str())
    }

    /// From the old files to the new ones.
    pub(super) fn forwards(&self) -> Vec<Step<'_>> {
        let mut steps = vec![Step::TakeAway(MANIFEST), Step::Sync];
        steps.extend(self.names().flat_map(|n| [Step::Save(n), Step::Place(n)]));
        steps.extend([Step::Sync, Step::Place(MANIFEST), Step::Sync]);
        steps
    }

    /// From any state to the old files.
    pub(super) fn backwards(&self) -> Vec<Step<'_>> {
        let mut steps = vec![Step::Unplace(MANIFEST)];
        steps.extend(self.names().rev().flat_map(|n| [Step::Unplace(n), Step::Restore(n)]));
        steps.extend([Step::Sync, Step::Restore(MANIFEST), Step::Sync]);
        steps
    }

    /// Puts the new files in place, or the old ones if that fails.
    pub(super) fn carry_out(&self, paths: &Paths) -> Result<(), TransactionError> {
        let Err((path, source)) = run(&self.forwards(), paths) else { return Ok(()) };
        match run(&self.backwards(), paths) {
            Ok(()) => Err(TransactionError::Replace { path, source }),
            Err((back_path, back)) => Err(TransactionError::Stuck { path, source, back_path, back }),
        }
    }

    /// Is the manifest in place, and so all that comes before it?
    fn is_done(&self, paths: &Paths) -> bool {
        let manifest = self.files.iter().find(|e| e.name == MANIFEST);
        manifest.is_some_and(|e| !paths.new_file(&e.name).exists() && e.is_at(&paths.target(&e.name)))
    }

    /// Are all new files there, staged or in place?
    fn is_complete(&self, paths: &Paths) -> bool {
        self.files.iter().all(|e| {
            let staged = paths.new_file(&e.name);
            e.is_at(&if e.replace && staged.exists() { staged } else { paths.target(&e.name) })
        })
    }
}

fn run(steps: &[Step<'_>], paths: &Paths) -> Result<(), (PathBuf, io::Error)> {
    steps.iter().try_for_each(|step| step.run(paths).map_err(|e| (step.path(paths), e)))
}

/// Finishes what a killed run had begun, or puts the old files back; removes what it left.
pub(super) fn recover(paths: &Paths) -> Result<Option<Recovery>, TransactionError> {
    match fs::symlink_metadata(&paths.staging) {
        Err(e) if e.kind() == ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(folder(&paths.folder, source)),
        Ok(_) => {}
    }
    let done = match Journal::read(paths)? {
        None => Recovery::Discarded,
        Some(journal) if journal.is_done(paths) => Recovery::Finished,
        Some(journal) if journal.is_complete(paths) => match journal.carry_out(paths) {
            Ok(()) => Recovery::Finished,
            Err(TransactionError::Replace { .. }) => Recovery::RolledBack,
            Err(e) => return Err(e),
        },
        Some(journal) => {
            run(&journal.backwards(), paths).map_err(|(back_path, back)| TransactionError::Stuck {
                path: paths.folder.clone(),
                source: io::Error::other("a new file of the run that was killed is missing or was changed"),
                back_path,
                back,
            })?;
            Recovery::RolledBack
        }
    };
    clear(paths).map_err(|source| folder(&paths.folder, source))?;
    Ok(Some(done))
}

/// Removes the staging folder, the journal first: without it the rest is rubbish.
pub(super) fn clear(paths: &Paths) -> io::Result<()> {
    none_is_fine(fs::remove_file(paths.journal()))?;
    match fs::symlink_metadata(&paths.staging) {
        Ok(found) if !found.is_dir() => fs::remove_file(&paths.staging),
        Ok(_) => fs::remove_dir_all(&paths.staging),
        Err(e) => none_is_fine(Err(e)),
    }
}

/// A second name for the old file, so that its own name is never free. Without hard links, and for symbolic links, the file is renamed.
fn save(target: &Path, old: &Path) -> io::Result<()> {
    let found = fs::symlink_metadata(target)?;
    if found.is_dir() {
        // it came while the tables were baked
        return Err(ErrorKind::IsADirectory.into());
    }
    if found.is_file() && fs::hard_link(target, old).is_ok() {
        return Ok(());
    }
    atomic::rename(target, old)
}

fn none_is_fine(done: io::Result<()>) -> io::Result<()> {
    match done {
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(()),
        done => done,
    }
}

fn exists(path: &Path) -> io::Result<bool> {
    match fs::symlink_metadata(path) {
        Ok(_) => Ok(true),
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(false),
        Err(e) => Err(e),
    }
}

/// One name, and not that of a folder.
pub(in crate::pipeline) fn is_plain(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    matches!((parts.next(), parts.next()), (Some(std::path::Component::Normal(n)), None) if n == name)
}

/// Names of folders and a file, with `/` between them; none leads up or elsewhere.
pub(in crate::pipeline) fn is_inside(name: &str) -> bool {
    name.split('/').all(is_plain)
}

/// Removes the folders above a file that is gone, if nothing is in them.
fn leave(file: &Path, folder: &Path) {
    let above = file.ancestors().skip(1).take_while(|p| *p != folder && p.starts_with(folder));
    for path in above {
        if fs::remove_dir(path).is_err() {
            return;
        }
    }
}

/// The names in a folder must survive a power cut. Some file systems cannot do that; the files are whole anyway.
fn sync(folder: &Path) -> io::Result<()> {
    if cfg!(unix) {
        let _ = File::open(folder).and_then(|f| f.sync_all());
    }
    Ok(())
}
