//! What can be wrong with a scene file: one enum, whose variants carry the place and the numbers.

use std::fmt;

use super::uri::UriError;
use crate::math::shown::show;

/// A scene file that was refused: which file, and the fault.
#[derive(Debug)]
pub struct SceneError {
    /// Name of the file, without its folder.
    pub file: String,
    /// What is wrong with it.
    pub fault: Fault,
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.fault, show(&self.file))
    }
}

impl std::error::Error for SceneError {
    /// The fault is part of the message already, so the chain goes on with the fault's own source.
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.fault.source()
    }
}

/// A fault of a scene file. Only [`Fault::Io`] is the machine's (exit code 5); all others are the file's (3).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// The file could not be opened or read.
    #[error("cannot read the file: {source}")]
    Io {
        /// The system's reason.
        #[source]
        source: std::io::Error,
    },
    /// A folder, a device or a pipe.
    #[error("not a regular file")]
    NotAFile,
    /// Larger than [`Limits::file_bytes`](super::Limits::file_bytes).
    #[error("file has {bytes} bytes, allowed {limit}")]
    FileTooLarge {
        /// Size of the file; for a file that grew while it was read, the size seen.
        bytes: u64,
        /// The limit.
        limit: u64,
    },
    /// The JSON text is larger than [`Limits::json_bytes`](super::Limits::json_bytes).
    #[error("JSON text has {bytes} bytes, allowed {limit}")]
    JsonTooLarge {
        /// Size of the JSON text.
        bytes: u64,
        /// The limit.
        limit: u64,
    },
    /// More JSON values than [`Limits::json_values`](super::Limits::json_values).
    #[error("too many JSON values: the one at {at} is one more than the {limit} allowed")]
    TooManyValues {
        /// Where the limit was passed.
        at: String,
        /// The limit.
        limit: usize,
    },
    /// Neither a GLB container nor JSON text.
    #[error("not a glTF file: it starts with {got}, expected the magic \"glTF\" or '{{'")]
    NotGltf {
        /// The first bytes, escaped.
        got: String,
    },
    /// The GLB ends inside its first 20 bytes.
    #[error("GLB of {got} bytes, expected at least 20 (header and first chunk header)")]
    GlbShort {
        /// Bytes in the file.
        got: usize,
    },
    /// The version of the container, not of the asset.
    #[error("GLB container version {got}, allowed 2")]
    GlbVersion {
        /// The version found.
        got: u32,
    },
    /// The header's length is impossible.
    #[error(
        "GLB header declares {declared} bytes, allowed 20 to {actual} (the file's size); the file is cut or forged"
    )]
    GlbLength {
        /// Length in the header.
        declared: u32,
        /// Bytes in the file.
        actual: usize,
    },
    /// A chunk is longer than what is left of the container.
    #[error("GLB chunk {chunk} declares {declared} bytes, allowed {left}; the file is cut or forged")]
    GlbChunk {
        /// `JSON` or `BIN`.
        chunk: &'static str,
        /// Length in the chunk's header.
        declared: u32,
        /// Bytes left.
        left: usize,
    },
    /// A chunk of the wrong type: the first must be `JSON`, the second `BIN`.
    #[error("GLB chunk of type {got}, expected {expected}")]
    GlbChunkType {
        /// The type found, escaped.
        got: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// The container ends inside the header of its second chunk.
    #[error("GLB ends inside the header of its second chunk")]
    GlbChunkHeader,
    /// No JSON text at all.
    #[error("the JSON text is empty")]
    EmptyJson,
    /// The JSON text is not UTF-8.
    #[error("the JSON text is not UTF-8: byte {offset} of it is the first bad one")]
    Utf8 {
        /// Offset in the JSON text.
        offset: usize,
    },
    /// A fault of JSON syntax, nesting deeper than 128, or a number beyond f64.
    #[error("bad JSON at {at}, line {line} column {column}: {detail}")]
    Json {
        /// JSON path of the value that was being read.
        at: String,
        /// Line, from 1.
        line: usize,
        /// Column in bytes, from 1.
        column: usize,
        /// What the parser says.
        detail: String,
    },
    /// The same key twice in one object: two readers would see two scenes.
    #[error("duplicate key: {at} is given twice")]
    DuplicateKey {
        /// JSON path of the second one.
        at: String,
    },
    /// A value of the wrong kind.
    #[error("wrong type: {at} is {got}, expected {expected}")]
    Type {
        /// JSON path.
        at: String,
        /// What was found, shortened.
        got: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// A required value is missing.
    #[error("missing: {at}, expected {expected}")]
    Missing {
        /// JSON path.
        at: String,
        /// What belongs there.
        expected: &'static str,
    },
    /// A number outside its range.
    #[error("out of range: {at} = {got:?}, allowed {allowed}")]
    Range {
        /// JSON path.
        at: String,
        /// The number.
        got: f64,
        /// The range, in words.
        allowed: &'static str,
    },
    /// An index that points at nothing.
    #[error("dangling index: {at} = {got}; {what} in the file: {len}")]
    Index {
        /// JSON path.
        at: String,
        /// The index.
        got: u64,
        /// What is counted: `materials`, `meshes`, `textures`.
        what: &'static str,
        /// How many there are.
        len: usize,
    },
    /// An asset of another major version.
    #[error("unsupported version: {at} = \"{got}\", allowed 2.x")]
    Version {
        /// JSON path.
        at: &'static str,
        /// The version found, escaped.
        got: String,
    },
    /// A URI that leaves the scene's folder or could be read in two ways.
    #[error("refused URI: {at} = \"{uri}\": {source}")]
    Uri {
        /// JSON path.
        at: String,
        /// The URI, escaped and shortened.
        uri: String,
        /// Why it was refused.
        #[source]
        source: UriError,
    },
}
