//! Recipes from disk.

use super::{MAX_BYTES, RecipeError, parse_in};
use crate::plan::Plan;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Why a recipe file gives no plan.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The system cannot read it (exit code 5).
    #[error("cannot read the recipe {file}: {source}")]
    Io {
        /// The file.
        file: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A folder, a device or a pipe (exit code 5).
    #[error("cannot read the recipe {file}: it is not a regular file")]
    NotAFile {
        /// The file.
        file: String,
    },
    /// It was read and is at fault (exit code 3).
    #[error(transparent)]
    Recipe(#[from] RecipeError),
}

/// Reads a recipe file.
///
/// # Errors
/// [`LoadError::Recipe`] with every fault of the text; the other variants if there is no text.
pub fn load(path: &Path) -> Result<Plan, LoadError> {
    let file = path.display().to_string();
    let io = |source| LoadError::Io { file: file.clone(), source };
    if !std::fs::metadata(path).map_err(io)?.is_file() {
        return Err(LoadError::NotAFile { file });
    }
    let mut bytes = Vec::new();
    // one byte more than allowed, so that a file that is too long is seen as such
    let limit = MAX_BYTES as u64 + 1;
    File::open(path).map_err(io)?.take(limit).read_to_end(&mut bytes).map_err(io)?;
    match std::str::from_utf8(&bytes) {
        Ok(text) => Ok(parse_in(text, &file, path.parent().unwrap_or(Path::new("")))?),
        Err(e) => {
            let valid = bytes.get(..e.valid_up_to()).and_then(|b| std::str::from_utf8(b).ok());
            Err(RecipeError::not_utf8(&file, valid.unwrap_or_default()).into())
        }
    }
}
