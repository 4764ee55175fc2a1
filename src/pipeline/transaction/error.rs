//! Why the outputs of a run could not be put in place.

use std::io;
use std::path::{Path, PathBuf};

/// Why the outputs of a run could not be put in place.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TransactionError {
    /// The caller asked to stop; nothing has changed.
    #[error("cancelled before any file was replaced")]
    Cancelled,
    /// Two outputs have the same name, or names that are the same on some systems.
    #[error("two outputs go to one file: {name} and {other}")]
    Twice {
        /// The name of one.
        name: String,
        /// The name of the other.
        other: String,
    },
    /// Something that is no file has the name of an output.
    #[error("{path} cannot be written: there is {what} of this name; move it away, or take another folder")]
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
    /// Another run holds the folder.
    #[error(
        "another run is writing into {path}, and did not end within {seconds} s; wait for it, or take another folder"
    )]
    Busy {
        /// The folder.
        path: PathBuf,
        /// How long this one waited.
        seconds: f64,
    },
    /// The folder cannot be locked.
    #[error(
        "cannot lock {path}: {source}; where a file system has no locks, bake into a folder on another one and copy the files"
    )]
    Lock {
        /// The file that is to be locked.
        path: PathBuf,
        /// The system's message.
        source: io::Error,
    },
    /// A new file could not be written; nothing has changed.
    #[error("cannot write {path}: {source}; no file was replaced")]
    Write {
        /// The target.
        path: PathBuf,
        /// The system's message.
        source: io::Error,
    },
    /// A file could not be replaced; those that were are put back.
    #[error("cannot replace {path}: {source}; every file is as it was")]
    Replace {
        /// The target.
        path: PathBuf,
        /// The system's message.
        source: io::Error,
    },
    /// A file could not be replaced, and those that were could not all be put back.
    #[error(
        "cannot replace {path}: {source}; nor can {back_path} be put back: {back}. The folder holds old and new files and no manifest; \
         mend the cause and bake into it again"
    )]
    Stuck {
        /// The target.
        path: PathBuf,
        /// The system's message.
        source: io::Error,
        /// The file that could not be put back.
        back_path: PathBuf,
        /// The system's message.
        back: io::Error,
    },
    /// What a killed run left is not understood.
    #[error(
        "{path} was left by a run that was killed, and cannot be read: {message}. Bake with the version that left it, or remove its folder and \
         check the files"
    )]
    Journal {
        /// The journal.
        path: PathBuf,
        /// Why.
        message: String,
    },
}

pub(super) fn folder(path: &Path, source: io::Error) -> TransactionError {
    TransactionError::Folder { path: path.to_owned(), source }
}

pub(super) fn write(path: &Path, source: io::Error) -> TransactionError {
    TransactionError::Write { path: path.to_owned(), source }
}
