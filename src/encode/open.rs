//! Pictures from memory and from files, until a token is set.

use super::read::{Image, MAX_BYTES, ReadError};
use super::stoppable::Stoppable;
use crate::cancel::Cancel;
use std::path::Path;

/// Reads a picture from memory; the first bytes tell the container.
///
/// # Errors
/// [`ReadError`] for anything but a sound file of a container that is read, within the limits.
pub fn read_bytes(bytes: &[u8]) -> Result<Image, ReadError> {
    read_bytes_until(&Cancel::new(), bytes)
}

/// [`read_bytes`], until it is stopped.
///
/// # Errors
/// As [`read_bytes`]; [`ReadError::Cancelled`].
pub fn read_bytes_until(cancel: &Cancel, bytes: &[u8]) -> Result<Image, ReadError> {
    read_level_until(cancel, bytes, 0)
}

/// A level of a picture in memory, 0 the largest, until it is stopped. Containers with a file a level have one.
///
/// # Errors
/// As [`read_bytes_until`]; [`ReadError::Fault`] for a level that the file does not have.
pub fn read_level_until(cancel: &Cancel, bytes: &[u8], level: usize) -> Result<Image, ReadError> {
    let found = super::ENCODERS.iter().find(|e| e.magic().iter().any(|m| bytes.starts_with(m)));
    let read = match found {
        Some(encoder) => encoder.read_level(bytes, level, cancel),
        None => Err(ReadError::Unknown(bytes.iter().copied().take(8).collect())),
    };
    // a read that was stopped is incomplete, or failed because it was stopped
    cancel.check()?;
    read
}

/// Reads a picture from a file.
///
/// # Errors
/// As [`read_bytes`], and if the file cannot be read or is larger than [`MAX_BYTES`].
pub fn read_file(path: &Path) -> Result<Image, ReadError> {
    read_file_until(&Cancel::new(), path)
}

/// [`read_file`], until it is stopped.
///
/// # Errors
/// As [`read_file`]; [`ReadError::Cancelled`].
pub fn read_file_until(cancel: &Cancel, path: &Path) -> Result<Image, ReadError> {
    read_bytes_until(cancel, &load_until(cancel, path)?)
}

/// The bytes of a file, if there are not too many.
///
/// # Errors
/// [`ReadError::Io`] and [`ReadError::Bytes`].
pub fn load(path: &Path) -> Result<Vec<u8>, ReadError> {
    load_until(&Cancel::new(), path)
}

/// [`load`], until it is stopped.
///
/// # Errors
/// As [`load`]; [`ReadError::Cancelled`].
pub fn load_until(cancel: &Cancel, path: &Path) -> Result<Vec<u8>, ReadError> {
    use std::io::Read;
    let io = |source| ReadError::Io { path: path.to_owned(), source };
    let file = std::fs::File::open(path).map_err(io)?;
    let told = file.metadata().map_err(io)?.len();
    if told > MAX_BYTES {
        return Err(ReadError::Bytes { bytes: told });
    }
    let mut bytes = Vec::new();
    // A pipe tells no length: count while reading.
    let read = Stoppable::new(file.take(MAX_BYTES + 1), cancel).read_to_end(&mut bytes);
    cancel.check()?;
    read.map_err(io)?;
    let bytes_read = bytes.len() as u64;
    if bytes_read > MAX_BYTES { Err(ReadError::Bytes { bytes: bytes_read }) } else { Ok(bytes) }
}
