//! Why a scene was not written.

use super::convert::ConvertError;
use crate::pipeline::transaction::TransactionError;
use crate::scene::DataError;
use crate::scene::SceneError;
use crate::scene::UriError;
use crate::scene::write::DraftError;
use std::io;
use std::path::PathBuf;

/// Why a scene was not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SceneWriteError {
    /// The scene cannot be read, or was refused.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A path without a file name, or one that is no text.
    #[error("{path} is no place for a scene: it is a .gltf file, a .glb file or a folder")]
    Place {
        /// The path.
        path: PathBuf,
    },
    /// The scene would be written over itself.
    #[error("{path} is the scene that is read, which is never written over; give another name or folder")]
    Itself {
        /// The path.
        path: PathBuf,
    },
    /// A file that is read would be written over.
    #[error("{path} is read, and would be written over; give another name or folder")]
    Overwrites {
        /// The path.
        path: PathBuf,
    },
    /// Two files with one name.
    #[error("two files go to {path}; give the scene another name or folder")]
    Twice {
        /// The path.
        path: PathBuf,
    },
    /// A file cannot be read.
    #[error("cannot read {path}: {source}")]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's message.
        source: io::Error,
    },
    /// A table is not what the manifest says.
    #[error("{path} is not what was baked: its hash is another one; bake again")]
    Changed {
        /// The file.
        path: PathBuf,
    },
    /// A URI that may not be followed.
    #[error("{at}: {source}")]
    Uri {
        /// JSON path.
        at: String,
        /// Why not.
        source: UriError,
    },
    /// A `data:` URI that cannot be decoded.
    #[error("{at}: {source}")]
    Data {
        /// JSON path.
        at: String,
        /// Why not.
        source: DataError,
    },
    /// The scene does not take what is to be written into it.
    #[error("{source} ({file})")]
    Draft {
        /// Name of the scene.
        file: String,
        /// Why not.
        source: DraftError,
    },
    /// A material cannot be converted.
    #[error(transparent)]
    Convert(#[from] ConvertError),
    /// The files could not be put in place.
    #[error(transparent)]
    Files(#[from] TransactionError),
}
