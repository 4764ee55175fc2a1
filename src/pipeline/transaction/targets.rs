//! Whether files of these names can be written into a folder, found before anything is baked.

use super::TransactionError;
use super::error::folder as cannot;
use crate::encode::atomic;
use std::collections::HashMap;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// Checks the names of outputs among each other, and what has these names in the folder now. The folder need not exist.
///
/// # Errors
/// [`TransactionError::Twice`], [`TransactionError::InTheWay`] and [`TransactionError::Folder`].
pub fn check(folder: &Path, names: &[String]) -> Result<(), TransactionError> {
    let mut taken = HashMap::new();
    for name in names {
        if let Some(other) = taken.insert(name.to_ascii_lowercase(), name) {
            return Err(TransactionError::Twice { name: other.clone(), other: name.clone() });
        }
    }
    check_folder(folder)?;
    for name in names {
        let path = folder.join(name);
        check_folder(path.parent().unwrap_or(folder))?;
        match atomic::obstacle(&path) {
            Ok(None) => {}
            Ok(Some(what)) => return Err(TransactionError::InTheWay { path, what }),
            Err(source) => return Err(cannot(folder, source)),
        }
    }
    Ok(())
}

/// The folder, or the nearest of those above it that exists, must be one.
fn check_folder(folder: &Path) -> Result<(), TransactionError> {
    for path in folder.ancestors().filter(|p| !p.as_os_str().is_empty()) {
        let what = match (fs::symlink_metadata(path), fs::metadata(path)) {
            (_, Ok(found)) if found.is_dir() => return Ok(()),
            (_, Ok(_)) => "a file",
            (Ok(_), Err(_)) => "a link that leads nowhere",
            (Err(e), _) if [ErrorKind::NotFound, ErrorKind::NotADirectory].contains(&e.kind()) => continue,
            (Err(source), _) => return Err(cannot(folder, source)),
        };
        return Err(TransactionError::InTheWay { path: path.to_owned(), what });
    }
    Ok(())
}
