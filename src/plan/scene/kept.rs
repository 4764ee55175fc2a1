//! What earlier runs found in scenes, kept by what the files are: a second run reads only what changed.
//!
//! One JSON file in a folder that the user names. An entry counts while the scene, and every picture that was looked at for it, has
//! the size and the time of change that it had, and the options are the same; what it holds is bound to the hash of the scene.

use super::survey::{SurveyOptions, Surveyed};
use crate::scene::Needs;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

/// Name of the file in the folder.
const FILE: &str = "brdfbake-scenes.json";

/// Version of its layout, and of what is found in scenes: it grows when either changes.
const VERSION: u32 = 1;

/// Size in bytes, and time of change in nanoseconds.
pub(super) type Stamp = (u64, u64);

/// What was found in a scene.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Entry {
    stamp: Stamp,
    /// Pictures that were looked at; none for one that could not be found.
    pictures: Vec<(PathBuf, Option<Stamp>)>,
    pub(super) scene: Surveyed,
    pub(super) needs: Needs,
}

/// All that is kept.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Kept {
    version: u32,
    tool: String,
    options: String,
    entries: BTreeMap<PathBuf, Entry>,
}

impl Kept {
    /// What a folder holds for these options; nothing if that is damaged, of another version or of other options.
    #[must_use]
    pub fn read(folder: &Path, options: &SurveyOptions) -> Kept {
        let new = Kept {
            version: VERSION,
            tool: env!("CARGO_PKG_VERSION").to_owned(),
            options: format!("{options:?}"),
            entries: BTreeMap::new(),
        };
        let old = std::fs::read(folder.join(FILE)).ok().and_then(|b| serde_json::from_slice::<Kept>(&b).ok());
        let same = |k: &Kept| (k.version, &k.tool, &k.options) == (new.version, &new.tool, &new.options);
        old.filter(same).unwrap_or(new)
    }

    /// Puts it into a folder, whole or not at all.
    ///
    /// # Errors
    /// The system's, for a folder that cannot be written.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        std::fs::create_dir_all(folder)?;
        let file = tempfile::NamedTempFile::new_in(folder)?;
        serde_json::to_writer(io::BufWriter::new(file.as_file()), self)?;
        file.persist(folder.join(FILE)).map(|_| ()).map_err(|e| e.error)
    }

    /// What is known of a scene, if it is still true.
    pub(super) fn find(&self, path: &Path) -> Option<&Entry> {
        let entry = self.entries.get(path)?;
        let same = stamp(path) == Some(entry.stamp) && entry.pictures.iter().all(|(p, s)| stamp(p) == *s);
        same.then_some(entry)
    }

    /// Keeps what was found; a file that changed while it was read is not kept.
    pub(super) fn keep(
        &mut self,
        path: &Path,
        before: Option<Stamp>,
        pictures: Vec<PathBuf>,
        found: &(Surveyed, Needs),
    ) {
        let Some(stamp_now) = stamp(path).filter(|now| Some(*now) == before) else { return };
        let pictures = pictures
            .into_iter()
            .map(|p| {
                let s = stamp(&p);
                (p, s)
            })
            .collect();
        let (scene, needs) = found.clone();
        self.entries.insert(path.to_owned(), Entry { stamp: stamp_now, pictures, scene, needs });
    }
}

/// Size and time of change of a file.
pub(super) fn stamp(path: &Path) -> Option<Stamp> {
    let facts = path.metadata().ok()?;
    let changed = facts.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
    Some((facts.len(), u64::try_from(changed.as_nanos()).ok()?))
}
