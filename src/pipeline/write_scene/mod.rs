//! A scene with the tables that were baked for it, written as one transaction.
//!
//! What is read is the scene, the files that it names, and the tables of the manifest; what is written is the scene under its new name,
//! and beside it what it needs there. The scene itself is never written over.
//!
//! # Where things go
//! * Relative URIs stay as they are, and the files behind them are copied to the same place below the new scene's folder; where
//!   that is the old folder nothing is copied. What a URI may lead to is judged as when a scene is read. A URI that leads up, into
//!   `root`, gets the path below `root`, and the file is copied there.
//! * Tables go into a GLB, or beside a `.gltf` file: named where they are, if the folder of the bake lies in that of the scene,
//!   else copied into the folder `NAME-tables`.
//! * A `.gltf` file written as a GLB has its first buffer as binary chunk; a GLB written as `.gltf` has it in `NAME.bin`.

pub mod convert;
mod error;
mod files;
mod rewrite;

pub use error::SceneWriteError;
pub use files::{Note, Target};

use super::manifest::{Manifest, tool};
use super::map::{LevelRecord, MapEntry, MapFile};
use super::transaction::{Transaction, Waiting};
use super::{MANIFEST, Settings};
use crate::cancel::Cancel;
use crate::encode;
use crate::plan::map::Kind;
use crate::scene::write::maps::{self, Uses};
use crate::scene::write::tables::{self, Place, Serves};
use crate::scene::write::{self, Draft};
use crate::scene::{Limits, Scene};
use convert::{Converted, Mode};
use files::Copies;
use serde_json::json;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// What is asked for.
#[derive(Debug, Clone)]
pub struct Request {
    /// The scene.
    pub scene: PathBuf,
    /// Where it is written: a `.gltf` or `.glb` file, or a folder, in which it keeps its name.
    pub to: PathBuf,
    /// Where the object of the tables goes.
    pub place: Place,
    /// Leave what an earlier bake put into the scene, where there is no bake now.
    pub keep_tables: bool,
    /// The tables of each material.
    pub serves: Vec<Serves>,
    /// The map of each material that has one.
    pub uses: Vec<Uses>,
    /// Put the base level of these maps into the core textures, for readers that do not know the extension.
    pub rewrite: bool,
    /// How specular-glossiness materials are converted; they stay as they are if none.
    pub convert: Option<Mode>,
    /// Files below this folder may be read too; without it only those below the scene's own.
    pub root: Option<PathBuf>,
    /// Limits of what is read.
    pub limits: Limits,
}

impl Request {
    /// A scene to be written, with every default.
    #[must_use]
    pub fn new(scene: impl Into<PathBuf>, to: impl Into<PathBuf>) -> Request {
        Request {
            scene: scene.into(),
            to: to.into(),
            place: Place::default(),
            keep_tables: false,
            serves: Vec::new(),
            uses: Vec::new(),
            rewrite: false,
            convert: None,
            root: None,
            limits: Limits::default(),
        }
    }
}

/// What was written.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneOutcome {
    /// The scene.
    pub scene: PathBuf,
    /// Files below its folder, the scene first.
    pub files: Vec<String>,
    /// Files that are new or changed.
    pub written: usize,
    /// Files that had the same bytes already.
    pub unchanged: usize,
    /// What became of materials that were converted.
    pub converted: Vec<Converted>,
    /// Materials whose core textures are the base level of their map now.
    pub rewritten: Vec<usize>,
    /// What could not be taken along.
    pub notes: Vec<Note>,
}

/// The tables of a bake.
#[derive(Debug, Clone, Copy)]
pub struct Bake<'a> {
    /// What was baked.
    pub manifest: &'a Manifest,
    /// The folder of its files.
    pub folder: &'a Path,
}

/// Writes a scene with the tables of a bake; without one, what an earlier one put there is taken out. `settings` say how long to wait for the folder; its `out` is not used.
///
/// # Errors
/// [`SceneWriteError`]; the folder is then as it was.
pub fn write(
    request: &Request,
    bake: Option<Bake<'_>>,
    settings: &Settings,
    cancel: &Cancel,
) -> Result<SceneOutcome, SceneWriteError> {
    let target = Target::of(request)?;
    let (mut draft, scene) = open(request, &target)?;
    let converted = match request.convert {
        Some(mode) => convert::convert(&mut draft, request, target.stem(), mode)?,
        None => Vec::new(),
    };
    if bake.is_some() || !request.keep_tables {
        add_tables(&mut draft, request, &target, bake)?;
    }
    let rewritten = match bake.filter(|_| request.rewrite) {
        Some(bake) => rewrite::rewrite(&mut draft, request, &target, bake)?,
        None => Vec::new(),
    };
    let done = commit(draft, &scene, request, &target, settings, cancel)?;
    Ok(SceneOutcome { converted, rewritten, ..done })
}

/// What converting the specular-glossiness materials of a scene would cost; nothing is written.
///
/// # Errors
/// [`SceneWriteError`].
pub fn measure(scene: &Path, mode: Mode, limits: Limits) -> Result<Vec<Converted>, SceneWriteError> {
    let request = Request { limits, ..Request::new(scene, "") };
    let (parts, scene) = write::open(&request.scene, &request.limits)?;
    let mut draft =
        Draft::new(parts).map_err(|source| SceneWriteError::Draft { file: scene.file_name, source })?;
    convert::convert(&mut draft, &request, "scene", mode)
}

/// The draft of a scene, in the container that it is written in.
fn open(request: &Request, target: &Target) -> Result<(Draft, Scene), SceneWriteError> {
    let (parts, scene) = write::open(&request.scene, &request.limits)?;
    let failed = |source| SceneWriteError::Draft { file: scene.file_name.clone(), source };
    let mut draft = Draft::new(parts).map_err(failed)?;
    if target.binary && !draft.parts.binary {
        let first = files::first_buffer(&draft, request)?;
        draft.make_binary(first);
    } else if !target.binary {
        draft.make_text(&format!("{}.bin", target.stem()));
    }
    Ok((draft, scene))
}

/// The files of a bake, read and told to be what its manifest says.
struct Read<'a> {
    bytes: BTreeMap<&'a str, Vec<u8>>,
    /// What stands before their names in paths from the scene, if they stay where they are.
    inside: Option<String>,
    stem: &'a str,
}

impl<'a> Read<'a> {
    fn new(bake: Bake<'a>, draft: &Draft, target: &'a Target) -> Result<Read<'a>, SceneWriteError> {
        let Bake { manifest, folder } = bake;
        let inside = if draft.embeds() { None } else { target.path_of(folder) };
        let mut bytes: BTreeMap<&str, Vec<u8>> = BTreeMap::new();
        let tables = manifest.tables.iter().flat_map(|t| &t.files).map(|f| (&f.file, &f.blake3));
        let maps = manifest.maps.iter().flat_map(|m| &m.files).filter(|f| is_shown(f));
        for (file, blake3) in tables.chain(maps.map(|f| (&f.file, &f.blake3))) {
            if !bytes.contains_key(file.as_str()) {
                bytes.insert(file, read_file(folder, file, blake3)?);
            }
        }
        Ok(Read { bytes, inside, stem: target.stem() })
    }

    fn blob(&self, file: &str, blake3: &'a str, container: &'a str) -> tables::Blob<'_> {
        let (path, named) = match &self.inside {
            Some(prefix) => (format!("{prefix}{file}"), true),
            None => (format!("{}-tables/{file}", self.stem), false),
        };
        let media_type =
            encode::encoder(container).map_or("application/octet-stream", encode::Encoder::media_type);
        let bytes = self.bytes.get(file).map_or(&[][..], Vec::as_slice);
        tables::Blob { path, named, bytes, blake3, container, media_type }
    }
}

/// Is a file of a map one that is looked at? The map of errors is not.
fn is_shown(file: &MapFile) -> bool {
    file.map != Kind::Error.id()
}

/// Reads the tables and maps and puts them into the draft.
fn add_tables(
    draft: &mut Draft,
    request: &Request,
    target: &Target,
    bake: Option<Bake<'_>>,
) -> Result<(), SceneWriteError> {
    let failed = |source| SceneWriteError::Draft { file: target.name.clone(), source };
    let Some(bake) = bake else {
        return tables::add(draft, &tool(), &tables::Baked::default(), request.place).map_err(failed);
    };
    let read = Read::new(bake, draft, target)?;
    let tables = bake.manifest.tables.iter().map(|table| tables::Table {
        provenance: &table.provenance,
        size: &table.size,
        files: table
            .files
            .iter()
            .map(|record| tables::File {
                blob: read.blob(&record.file, &record.blake3, &record.container),
                encoding: &record.encoding,
                reconstruction: record.reconstruction.as_ref(),
                texels: record.texels.as_ref(),
                as_read: record.as_read.as_ref(),
            })
            .collect(),
    });
    let maps = bake.manifest.maps.iter().map(|map| maps::Map {
        name: &map.record.name,
        identity: &map.record.recipe.hash,
        told: told(map),
        files: map
            .files
            .iter()
            .filter(|f| is_shown(f))
            .map(|f| maps::File {
                blob: read.blob(&f.file, &f.blake3, &f.container),
                kind: &f.map,
                level: f.level,
                storage: &f.storage,
                channels: &f.channels,
            })
            .collect(),
    });
    let baked = tables::Baked {
        tables: tables.collect(),
        maps: maps.collect(),
        serves: &request.serves,
        uses: &request.uses,
    };
    tables::add(draft, &tool(), &baked, request.place).map_err(failed)
}

/// What a scene is told of a map.
fn told(map: &MapEntry) -> serde_json::Map<String, serde_json::Value> {
    let record = &map.record;
    let level = |l: &LevelRecord| {
        let largest = f64::from(l.largest);
        json!({ "size": l.size, "mean": l.mean, "largest": largest, "hopeless": l.hopeless })
    };
    let told = json!({
        "rule": record.rule,
        "normals": record.normals,
        "shape": record.shape,
        "objective": record.objective,
        "levels": record.levels.iter().map(level).collect::<Vec<_>>(),
    });
    told.as_object().cloned().unwrap_or_default()
}

/// A file of a bake, as the manifest says that it is.
fn read_file(folder: &Path, file: &str, blake3: &str) -> Result<Vec<u8>, SceneWriteError> {
    let path = folder.join(file);
    let bytes = fs::read(&path).map_err(|source| SceneWriteError::Read { path: path.clone(), source })?;
    if blake3::hash(&bytes).to_hex().as_str() == blake3 {
        Ok(bytes)
    } else {
        Err(SceneWriteError::Changed { path })
    }
}

/// Puts the scene and what is beside it in place.
fn commit(
    draft: Draft,
    scene: &Scene,
    request: &Request,
    target: &Target,
    settings: &Settings,
    cancel: &Cancel,
) -> Result<SceneOutcome, SceneWriteError> {
    let Copies { draft, inputs, files: copied, notes } = files::copies(draft, request, target)?;
    let failed = |source| SceneWriteError::Draft { file: scene.file_name.clone(), source };
    let (bytes, beside) = draft.finish().map_err(failed)?;
    let mut all: Vec<(String, Vec<u8>)> = vec![(target.name.clone(), bytes)];
    all.extend(beside);
    files::check(&all, &copied, &inputs, target)?;
    all.extend(copied);
    let names: Vec<String> = all.iter().map(|(name, _)| name.clone()).collect();
    let waiting = Waiting { timeout: settings.lock_timeout, told: &|| {} };
    if names.iter().any(|name| name == MANIFEST) {
        return Err(SceneWriteError::Twice { path: target.folder.join(MANIFEST) });
    }
    let (mut open, _) = Transaction::begin(&target.folder, &names, cancel, &waiting)?;
    for (name, bytes) in &all {
        open.stage(name, bytes)?;
    }
    let written = open.commit_files()?;
    Ok(SceneOutcome {
        scene: target.folder.join(&target.name),
        files: names,
        written: written.written,
        unchanged: written.unchanged,
        converted: Vec::new(),
        rewritten: Vec::new(),
        notes,
    })
}
