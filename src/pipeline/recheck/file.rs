//! A file on disk: its bytes against the manifest beside it, then the tables in it.

use super::{Asked, Kind, Recheck, recheck};
use crate::encode::beside;
use crate::encode::read::{self, Claim, Image, ReadError};
use crate::grid::Provenance;
use crate::grid::provenance::LawResult;
use crate::pipeline::manifest::TableRecord;
use crate::plan::MANIFEST;
use serde::Serialize;
use serde_json::Value as Json;
use std::io::ErrorKind;
use std::path::Path;

/// What came of a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FileCheck {
    /// Its name.
    pub file: String,
    /// What it is, taken together.
    pub verdict: Verdict,
    /// Its tables.
    pub tables: Vec<Recheck>,
}

/// What a file is, taken together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Its numbers are those that it says, as far as they were looked at.
    Whole,
    /// It has the bytes that its manifest lists; its numbers were not looked at.
    BytesWhole,
    /// Something is wrong.
    Faulty,
    /// Nothing could be looked at.
    NotChecked,
}

/// What the manifest of a folder says of its files.
#[derive(Debug)]
pub struct Beside(Option<Json>);

struct Listed {
    bytes: u64,
    blake3: String,
    container: String,
    /// Several tables where they share the file.
    tables: Vec<Provenance>,
    is_map: bool,
}

impl Beside {
    /// Reads the manifest of a folder; one that cannot be read says nothing.
    #[must_use]
    pub fn load(folder: &Path) -> Beside {
        let text = std::fs::read(folder.join(MANIFEST)).ok();
        Beside(text.and_then(|t| serde_json::from_slice(&t).ok()))
    }

    fn find(&self, name: &str) -> Option<Listed> {
        let manifest = self.0.as_ref()?;
        let mut found: Option<Listed> = None;
        let units = |key: &str| manifest[key].as_array().into_iter().flatten();
        for (table, is_map) in units("tables").map(|t| (t, false)).chain(units("maps").map(|m| (m, true))) {
            let mut files = table["files"].as_array().into_iter().flatten();
            let Some(i) = files.position(|f| f["file"] == name) else { continue };
            let file = &table["files"][i];
            let listed = found.get_or_insert_with(|| Listed {
                bytes: file["bytes"].as_u64().unwrap_or_default(),
                blake3: file["blake3"].as_str().unwrap_or_default().to_owned(),
                container: file["container"].as_str().unwrap_or_default().to_owned(),
                tables: Vec::new(),
                is_map,
            });
            if let Ok(record) = serde_json::from_value::<TableRecord>(table.clone()) {
                let file = record.files[i].clone();
                listed.tables.push(Provenance {
                    encoding: Some(file.encoding),
                    reconstruction: file.reconstruction,
                    texels: file.texels,
                    ..record.provenance
                });
            }
        }
        found
    }
}

/// Checks a file. The result is of no use once the token is set.
///
/// # Errors
/// [`ReadError`] if it cannot be read at all, or is of no container that is known.
pub fn check(path: &Path, beside: &Beside, asked: Asked<'_>) -> Result<FileCheck, ReadError> {
    let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    let bytes = read::load_until(asked.cancel, path)?;
    let listed = beside.find(&name);
    let mut tables = match tables(&bytes, listed.as_ref(), asked) {
        Ok(tables) => tables,
        Err(ReadError::Unknown(_)) if listed.is_some() => {
            let container = listed.as_ref().map_or("", |l| l.container.as_str());
            vec![Recheck::unchecked("", &format!("files of container {container} are not read back"))]
        }
        Err(e @ (ReadError::Unknown(_) | ReadError::Io { .. } | ReadError::Cancelled(_))) => return Err(e),
        Err(e) => {
            let kind = if is_short(&e) { Kind::Truncated } else { Kind::Damaged };
            vec![Recheck::fault(kind, e.to_string())]
        }
    };
    let whole = hash(&bytes, listed.as_ref(), &mut tables);
    let verdict = match () {
        () if tables.iter().any(|t| !t.faults.is_empty()) => Verdict::Faulty,
        () if tables.iter().all(Recheck::is_checked) => Verdict::Whole,
        () if whole => Verdict::BytesWhole,
        () => Verdict::NotChecked,
    };
    Ok(FileCheck { file: name, verdict, tables })
}

fn tables(bytes: &[u8], listed: Option<&Listed>, asked: Asked<'_>) -> Result<Vec<Recheck>, ReadError> {
    if let Some(listed) = listed.filter(|l| l.is_map) {
        let why = format!(
            "a map ({}): its bytes are compared, its levels are not filtered again",
            listed.container
        );
        return Ok(vec![Recheck::unchecked("", &why)]);
    }
    let sole = listed.and_then(|l| (l.tables.len() == 1).then(|| &l.tables[0]));
    let mut image = match (listed.map_or("", |l| l.container.as_str()), sole) {
        ("raw", Some(p)) => beside::bare(bytes, p, asked.cancel)?,
        _ => read::read_bytes_until(asked.cancel, bytes)?,
    };
    if let Some(why) = map(&image) {
        return Ok(vec![Recheck::unchecked("", why)]);
    }
    if let Some(p) = sole {
        image = image.described(p.clone());
    }
    Ok(recheck(image, asked))
}

/// Is it a map?
fn map(image: &Image) -> Option<&'static str> {
    let Some(Claim::Unknown { text, .. }) = &image.provenance else { return None };
    let json: Json = serde_json::from_str(text).ok()?;
    json.get("map").map(|_| "a map, and no manifest beside it lists its bytes")
}

/// Compares the bytes with those of the manifest. True where they are the same.
fn hash(bytes: &[u8], listed: Option<&Listed>, tables: &mut [Recheck]) -> bool {
    let Some(first) = tables.first_mut() else { return false };
    let Some(listed) = listed else {
        first.note("hash", LawResult::NotChecked, format!("no {MANIFEST} beside it lists it"));
        return false;
    };
    let got = blake3::hash(bytes).to_hex().to_string();
    if got == listed.blake3 {
        first.note("hash", LawResult::Held, format!("blake3 {got}"));
        return true;
    }
    first.note("hash", LawResult::Broken, format!("blake3 {got}, the manifest lists {}", listed.blake3));
    let (size, told) = (bytes.len() as u64, listed.bytes);
    let message = format!("{size} bytes with another hash, the manifest lists {told}");
    let named = |k: Kind| first.faults.iter().any(|f| f.fault == k);
    if size < told && !named(Kind::Truncated) {
        first.blame(Kind::Truncated, message);
    } else if first.faults.is_empty() {
        first.blame(Kind::Changed, message);
    }
    false
}

/// Does a reader miss the end of the file?
fn is_short(error: &ReadError) -> bool {
    let mut source: Option<&dyn std::error::Error> = Some(error);
    while let Some(e) = source {
        let io = e.downcast_ref::<std::io::Error>();
        if io.is_some_and(|e| e.kind() == ErrorKind::UnexpectedEof) {
            return true;
        }
        source = e.source();
    }
    let text = error.to_string();
    ["cut short", "end of file", "end before", "tells of", "too short", "missing bytes"]
        .iter()
        .any(|words| text.contains(words))
}
