//! A folder of baked units by the hash of what decides their bytes, which many bakes share.
//!
//! An entry is one file, `KEY.unit`: a line with the blake3 of all that follows; a line of JSON, [`Entry`]; the bytes of its files.
//! It is written beside its name and renamed, so that no process reads a half one. An entry whose hash is another one is removed and
//! counts as none. When the folder grows beyond its limit, entries that were not used for longest are removed.

use super::super::TableRecord;
use super::super::map::MapEntry;
use super::super::transaction::{holds, is_inside};
use crate::encode::atomic;
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Bytes that a cache holds at most, if nothing else is said.
pub const CACHE_LIMIT: u64 = 1 << 30;

/// Of the limit, what is left when old entries are removed, in parts of 8: the next entries have room.
const KEPT: u64 = 7;

/// Ending of entries.
const ENDING: &str = "unit";

/// A cache of baked units.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cache {
    folder: PathBuf,
    limit: u64,
}

/// What a cache holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct CacheSize {
    /// Number of units.
    pub units: usize,
    /// Their bytes.
    pub bytes: u64,
}

/// A unit: records, and facts of the files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Entry {
    #[serde(default)]
    pub(super) tables: Vec<TableRecord>,
    #[serde(default)]
    pub(super) maps: Vec<MapEntry>,
    pub(super) files: Vec<EntryFile>,
}

#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct EntryFile {
    pub(super) name: String,
    pub(super) bytes: u64,
    pub(super) blake3: String,
}

impl Entry {
    /// Has the folder these files, with these bytes?
    pub(super) fn is_in(&self, folder: &Path) -> bool {
        self.files.iter().all(|f| {
            let path = folder.join(&f.name);
            // a link leads to a file that is not the folder's own
            is_inside(&f.name) && !path.is_symlink() && holds(&path, f.bytes, &f.blake3)
        })
    }
}

impl Cache {
    /// A cache in a folder, which is made when something is given to it, of at most so many bytes.
    #[must_use]
    pub fn new(folder: impl Into<PathBuf>, limit: u64) -> Cache {
        Cache { folder: folder.into(), limit }
    }

    /// Its folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// What it holds.
    ///
    /// # Errors
    /// Where the folder is there and cannot be read.
    pub fn size(&self) -> io::Result<CacheSize> {
        let entries = self.entries()?;
        Ok(CacheSize { units: entries.len(), bytes: entries.iter().map(|e| e.bytes).sum() })
    }

    /// Removes its entries, and nothing else that is in the folder; what it held is returned.
    ///
    /// # Errors
    /// Where an entry cannot be removed.
    pub fn clear(&self) -> io::Result<CacheSize> {
        let mut removed = CacheSize::default();
        for entry in self.entries()? {
            remove(&entry.path)?;
            removed.units += 1;
            removed.bytes += entry.bytes;
        }
        Ok(removed)
    }

    /// A unit with the bytes of its files; none if it is not there or not whole.
    pub(super) fn read(&self, key: &str) -> Option<(Entry, Vec<Vec<u8>>)> {
        let path = self.path(key);
        let bytes = fs::read(&path).ok()?;
        let Some(found) = parse(&bytes) else {
            // Nothing can be done about one that cannot be removed: it is baked anew every time.
            let _ = remove(&path);
            return None;
        };
        // used now: a cache that is full forgets others first; a file system without times forgets by the time of writing
        let _ = File::options().append(true).open(&path).and_then(|f| f.set_modified(SystemTime::now()));
        Some(found)
    }

    /// Takes a unit, and removes old ones where there is no room.
    pub(super) fn write(&self, key: &str, entry: &Entry, blobs: &[Vec<u8>]) -> io::Result<()> {
        let length = blobs.iter().map(|b| b.len() as u64).sum::<u64>();
        // one that would push out most others is baked as quickly as it is kept
        if length > self.limit / 4 {
            return Ok(());
        }
        fs::create_dir_all(&self.folder)?;
        let mut body = serde_json::to_vec(entry)?;
        body.push(b'\n');
        body.extend(blobs.iter().flatten());
        let mut file = tempfile::Builder::new().prefix(atomic::TEMPORARY).tempfile_in(&self.folder)?;
        writeln!(file, "{}", blake3::hash(&body).to_hex())?;
        file.write_all(&body)?;
        file.persist(self.path(key)).map_err(|e| e.error)?;
        self.trim()
    }

    fn path(&self, key: &str) -> PathBuf {
        self.folder.join(key).with_extension(ENDING)
    }

    fn trim(&self) -> io::Result<()> {
        let mut entries = self.entries()?;
        let mut bytes: u64 = entries.iter().map(|e| e.bytes).sum();
        if bytes <= self.limit {
            return Ok(());
        }
        entries.sort_by(|a, b| (a.used, &a.path).cmp(&(b.used, &b.path)));
        for entry in entries {
            if bytes <= self.limit / 8 * KEPT {
                break;
            }
            remove(&entry.path)?;
            bytes = bytes.saturating_sub(entry.bytes);
        }
        Ok(())
    }

    fn entries(&self) -> io::Result<Vec<OnDisk>> {
        let listed = match fs::read_dir(&self.folder) {
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
            listed => listed?,
        };
        let mut entries = Vec::new();
        for entry in listed {
            let path = entry?.path();
            // another process may have removed it since
            let Some(facts) = fs::metadata(&path).ok().filter(|_| is_entry(&path)) else { continue };
            let used = facts.modified().unwrap_or(SystemTime::UNIX_EPOCH);
            entries.push(OnDisk { path, bytes: facts.len(), used });
        }
        Ok(entries)
    }
}

struct OnDisk {
    path: PathBuf,
    bytes: u64,
    used: SystemTime,
}

/// Sixty-four digits of a hash and the ending.
fn is_entry(path: &Path) -> bool {
    let stem = path.file_stem().and_then(|s| s.to_str()).unwrap_or_default();
    path.extension().is_some_and(|e| e == ENDING)
        && stem.len() == 64
        && stem.bytes().all(|b| b.is_ascii_hexdigit())
}

/// One that is gone already is fine.
fn remove(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(e),
        _ => Ok(()),
    }
}

fn parse(bytes: &[u8]) -> Option<(Entry, Vec<Vec<u8>>)> {
    let (hash, body) = line(bytes)?;
    if blake3::hash(body).to_hex().as_bytes() != hash {
        return None;
    }
    let (entry, mut rest) = line(body)?;
    let entry: Entry = serde_json::from_slice(entry).ok()?;
    let mut blobs = Vec::new();
    for file in &entry.files {
        let (blob, after) = rest.split_at_checked(usize::try_from(file.bytes).ok()?)?;
        blobs.push(blob.to_vec());
        rest = after;
    }
    rest.is_empty().then_some((entry, blobs))
}

/// A line, and what follows.
fn line(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let end = bytes.iter().position(|b| *b == b'\n')?;
    Some((&bytes[..end], &bytes[end + 1..]))
}
