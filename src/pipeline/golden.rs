//! Golden-image tests: a folder with a recipe and the outputs that were committed for it.
//!
//! `golden.toml` in the folder is optional:
//! ```toml
//! recipe = "recipe.toml"        # in the folder; or the name of a preset
//! ulps = 1                      # steps of the stored precision that count as equal; default 0
//! absolute = 0.0                # and an absolute difference; default 0
//!
//! [channel."dfg.scale"]         # a channel with tolerances of its own
//! absolute = 1e-4
//! ```
//! Pictures are compared number by number, other files byte by byte. The manifest is not compared: it holds hashes of
//! bytes, and times of nothing.

use super::MANIFEST;
use crate::encode::atomic::HIDDEN;
use crate::encode::diff::{self, ImageDiff, Tolerance};
use crate::encode::diff_files::{FileDiff, FolderDiff};
use crate::encode::{Image, read};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Name of the settings in the folder.
pub const SETTINGS: &str = "golden.toml";

/// Files of the folder that are not outputs.
pub(super) const OWN: [&str; 5] = [SETTINGS, MANIFEST, "recipe.toml", "README.md", "command.txt"];

/// Settings of a golden folder.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Golden {
    /// Recipe file in the folder, or a preset.
    #[serde(default = "default_recipe")]
    pub recipe: String,
    /// Steps of the stored precision that count as equal.
    #[serde(default)]
    pub ulps: f64,
    /// Absolute difference that counts as equal.
    #[serde(default)]
    pub absolute: f64,
    /// Channels with tolerances of their own.
    #[serde(default)]
    pub channel: BTreeMap<String, Allowed>,
}

/// Tolerances of one channel.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Allowed {
    /// Steps of the stored precision.
    #[serde(default)]
    pub ulps: f64,
    /// Absolute difference.
    #[serde(default)]
    pub absolute: f64,
}

fn default_recipe() -> String {
    "recipe.toml".to_owned()
}

/// Why a folder cannot be compared.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GoldenError {
    /// A file cannot be read.
    #[error("{path}: {source}")]
    Io {
        /// The path.
        path: PathBuf,
        /// The system's message.
        #[source]
        source: std::io::Error,
    },
    /// The settings are not what they should be.
    #[error("{path}: {message}")]
    Settings {
        /// The path.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
}

impl Golden {
    /// Reads `golden.toml` of a folder; the defaults if there is none.
    ///
    /// # Errors
    /// [`GoldenError`] with the file, and the place in it.
    pub fn load(folder: &Path) -> Result<Golden, GoldenError> {
        let path = folder.join(SETTINGS);
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(source) => return Err(GoldenError::Io { path, source }),
        };
        let golden: Golden = toml::from_str(&text)
            .map_err(|e| GoldenError::Settings { path: path.clone(), message: e.to_string() })?;
        let pairs = golden.channel.values().map(|a| (a.ulps, a.absolute));
        for (ulps, absolute) in pairs.chain([(golden.ulps, golden.absolute)]) {
            if !(ulps >= 0.0 && absolute >= 0.0) {
                let message = format!("ulps = {ulps} and absolute = {absolute} must not be negative");
                return Err(GoldenError::Settings { path, message });
            }
        }
        Ok(golden)
    }

    /// Compares the committed outputs of a folder with fresh ones.
    ///
    /// # Errors
    /// [`GoldenError::Io`].
    pub fn compare(&self, committed: &Path, fresh: &Path) -> Result<FolderDiff, GoldenError> {
        let (left, right) = (names(committed)?, names(fresh)?);
        let mut files = Vec::new();
        for name in left.union(&right) {
            let diff = match (left.contains(name), right.contains(name)) {
                (true, false) => FileDiff::OnlyFirst,
                (false, true) => FileDiff::OnlySecond,
                _ => self.file(&committed.join(name), &fresh.join(name))?,
            };
            files.push((name.clone(), diff));
        }
        Ok(FolderDiff { files })
    }

    fn file(&self, a: &Path, b: &Path) -> Result<FileDiff, GoldenError> {
        let load = |path: &Path| {
            std::fs::read(path).map_err(|source| GoldenError::Io { path: path.to_owned(), source })
        };
        let (x, y) = (load(a)?, load(b)?);
        if x == y {
            return Ok(FileDiff::Identical);
        }
        if let (Ok(p), Ok(q)) = (read::read_bytes(&x), read::read_bytes(&y)) {
            return Ok(FileDiff::Image(self.images(&p, &q)));
        }
        Ok(FileDiff::of_bytes(&x, &y))
    }

    fn images(&self, a: &Image, b: &Image) -> ImageDiff {
        let mut all = diff::images(a, b, Tolerance { absolute: self.absolute, ulps: self.ulps });
        for (name, allowed) in &self.channel {
            let own = Tolerance { absolute: allowed.absolute, ulps: allowed.ulps };
            if let Some(slot) = all.channels.iter_mut().find(|c| c.name == *name)
                && let Some(judged) = diff::images(a, b, own).channels.into_iter().find(|c| c.name == *name)
            {
                *slot = judged;
            }
        }
        all
    }
}

/// Outputs in a folder.
fn names(folder: &Path) -> Result<BTreeSet<String>, GoldenError> {
    let io = |source| GoldenError::Io { path: folder.to_owned(), source };
    let mut names = BTreeSet::new();
    for entry in std::fs::read_dir(folder).map_err(io)? {
        let entry = entry.map_err(io)?;
        let name = entry.file_name().to_string_lossy().into_owned();
        // what a killed run left is no output
        if entry.path().is_file() && !OWN.contains(&name.as_str()) && !name.starts_with(HIDDEN) {
            names.insert(name);
        }
    }
    Ok(names)
}
