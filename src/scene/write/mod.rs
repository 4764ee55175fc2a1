//! Scenes that are written: the tables of a bake go in, and nothing else changes.
//!
//! A [`Draft`] holds a scene file taken apart ([`Parts`]), the changes of its JSON ([`Patch`]) and the files beside it. Every number
//! keeps its text, every member that nobody knows and the order of members stay, and of a GLB the old binary chunk is a prefix of
//! the new one. No file is read or written here.
//!
//! # Where bytes go
//! In a GLB they become buffer views behind the old data, so that the scene stays one file. Beside a `.gltf` file they become files of
//! their own, and so they do beside a GLB whose first buffer is not its binary chunk. KTX2, EXR and their like are never put into
//! `images`, where glTF does not allow them: the extension has a `uri` or a `bufferView` of its own.

pub mod edit;
pub mod glb;
pub mod maps;
pub mod raw;
mod references;
pub mod tables;

pub use edit::{EditError, Json, Patch, edit};
pub use glb::{Parts, TooLarge};
pub use raw::Raw;
pub use references::{Reference, escape, references};

use std::path::Path;

use serde_json::{Value, json};

use super::{Limits, Scene, SceneError};

/// Why a scene cannot be written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DraftError {
    /// Its text does not have the form that is needed.
    #[error(transparent)]
    Edit(#[from] EditError),
    /// It does not fit into its container.
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    /// A map that there is not.
    #[error("a material uses map `{0}`, which was not made")]
    Map(
        /// The name.
        String,
    ),
    /// Tables that there are not.
    #[error("a material is served by table `{0}`, which was not baked")]
    Table(
        /// The name.
        String,
    ),
}

/// Reads a scene file, judges it as [`read`](crate::scene::read) does, and takes it apart.
///
/// # Errors
/// As [`read`](crate::scene::read).
pub fn open(path: &Path, limits: &Limits) -> Result<(Parts, Scene), SceneError> {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    let failed = |fault| SceneError { file: name.to_string(), fault };
    let bytes = super::read_bytes(path, limits.file_bytes).map_err(failed)?;
    let scene = super::read_slice(&bytes, &name, limits)?;
    Ok((Parts::open(&bytes).map_err(failed)?, scene))
}

/// Where bytes of a draft are.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stored {
    /// In a file, by its path relative to the scene.
    Beside(String),
    /// In a buffer view.
    View(usize),
}

impl Stored {
    /// The members that tell of it.
    #[must_use]
    pub fn members(&self) -> Vec<(&'static str, Value)> {
        match self {
            Stored::Beside(path) => vec![("uri", escape(path).into())],
            Stored::View(index) => vec![("bufferView", (*index).into())],
        }
    }
}

/// A file: its path relative to the scene, with `/` between names, and its bytes.
pub type Named = (String, Vec<u8>);

/// A scene that is to be written.
#[derive(Debug)]
pub struct Draft {
    /// The file as it was read.
    pub parts: Parts,
    /// What is to change in its JSON.
    pub patch: Patch,
    /// Files beside it: path relative to the scene with `/` between names, and bytes.
    pub files: Vec<Named>,
    /// True if something was taken away, and what has nothing left goes too.
    pub tidy: bool,
    /// The new binary chunk, if bytes may be put into it.
    bin: Option<Vec<u8>>,
    /// Buffer views that there are, old and new.
    views: usize,
    /// True if something was put into the chunk.
    grown: bool,
}

impl Draft {
    /// A draft in the container of its file.
    ///
    /// # Errors
    /// [`EditError::Json`] for a text that is no JSON.
    pub fn new(parts: Parts) -> Result<Draft, DraftError> {
        let root = raw(&parts)?;
        let views = root.get("bufferViews").and_then(Raw::items).map_or(0, |v| v.len());
        let first = first_buffer(root);
        let own = match (first, &parts.bin) {
            // the chunk is the first buffer, if that has no URI
            (Some(buffer), Some(bin)) if buffer.get("uri").is_none() => Some(bin.clone()),
            (None, None) if parts.binary => Some(Vec::new()),
            _ => None,
        };
        Ok(Draft {
            parts,
            patch: Patch::default(),
            files: Vec::new(),
            tidy: false,
            bin: own,
            views,
            grown: false,
        })
    }

    /// Makes a GLB of a `.gltf` file. `first` are the bytes of its first buffer, if it has one with a URI: they become the binary
    /// chunk. Other buffers and images stay where they are.
    pub fn make_binary(&mut self, first: Option<Vec<u8>>) {
        if self.parts.binary {
            return;
        }
        self.parts.binary = true;
        let none = raw(&self.parts).is_ok_and(|root| first_buffer(root).is_none());
        if let Some(mut bytes) = first {
            let length = raw(&self.parts).ok().and_then(first_buffer).and_then(|b| b.get("byteLength"));
            if let Some(length) =
                length.and_then(|l| l.value().as_u64()).and_then(|l| usize::try_from(l).ok())
            {
                bytes.truncate(length);
            }
            self.patch.member("buffers").element(0).member("uri").remove();
            glb::pad(&mut bytes, 0);
            self.parts.bin = Some(bytes.clone());
            self.bin = Some(bytes);
        } else if none {
            self.bin = Some(Vec::new());
        }
    }

    /// Makes a `.gltf` file of a GLB, its binary chunk a file of this name beside it.
    pub fn make_text(&mut self, name: &str) {
        if !self.parts.binary {
            return;
        }
        self.parts.binary = false;
        self.bin = None;
        if let Some(bin) = self.parts.bin.take()
            && raw(&self.parts).ok().and_then(first_buffer).is_some_and(|b| b.get("uri").is_none())
        {
            self.patch.member("buffers").element(0).member("uri").set(Value::from(escape(name)));
            self.files.push((name.to_owned(), bin));
        }
    }

    /// Keeps bytes: in the scene's own file if that is a GLB with room for them, or in a file of this path beside it.
    pub fn store(&mut self, path: &str, bytes: &[u8]) -> Stored {
        let Some(bin) = &mut self.bin else {
            if !self.files.iter().any(|(p, b)| p == path && b == bytes) {
                self.files.push((path.to_owned(), bytes.to_vec()));
            }
            return Stored::Beside(path.to_owned());
        };
        glb::pad(bin, 0);
        let name = path.rsplit('/').next().unwrap_or(path);
        let view = json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len(), "name": name });
        bin.extend_from_slice(bytes);
        self.patch.member("bufferViews").push(view);
        self.grown = true;
        self.views += 1;
        Stored::View(self.views - 1)
    }

    /// Would bytes be kept in the scene's own file?
    #[must_use]
    pub fn embeds(&self) -> bool {
        self.bin.is_some()
    }

    /// The file's bytes, and the files beside it.
    ///
    /// # Errors
    /// [`DraftError::Edit`] and [`DraftError::TooLarge`].
    pub fn finish(mut self) -> Result<(Vec<u8>, Vec<Named>), DraftError> {
        if let Some(bin) = self.bin.filter(|_| self.grown) {
            let any = first_buffer(raw(&self.parts)?).is_some();
            let buffers = self.patch.member("buffers");
            if any {
                buffers.element(0).member("byteLength").set(Value::from(bin.len()));
            } else {
                buffers.push(json!({ "byteLength": bin.len() }));
            }
            self.parts.bin = Some(bin);
        }
        self.parts.text = edit(&self.parts.text, &self.patch)?;
        if self.tidy {
            self.parts.text = edit(&self.parts.text, &emptied(raw(&self.parts)?))?;
        }
        Ok((self.parts.to_bytes()?, self.files))
    }
}

/// Takes away lists of extensions and `extensions` that have nothing left: glTF allows none that are empty.
fn emptied(root: Raw<'_>) -> Patch {
    let mut patch = Patch::default();
    for list in ["extensionsUsed", "extensionsRequired"] {
        if root.get(list).and_then(Raw::items).is_some_and(|names| names.is_empty()) {
            patch.member(list).remove();
        }
    }
    let none = |raw: Raw<'_>| raw.get("extensions").and_then(Raw::members).is_some_and(|m| m.is_empty());
    for (index, material) in
        root.get("materials").and_then(Raw::items).unwrap_or_default().into_iter().enumerate()
    {
        if none(material) {
            patch.member("materials").element(index).member("extensions").remove();
        }
    }
    patch
}

/// The JSON of a file.
pub(super) fn raw(parts: &Parts) -> Result<Raw<'_>, EditError> {
    Raw::new(&parts.text).map_err(|e| EditError::Json(e.to_string()))
}

fn first_buffer(root: Raw<'_>) -> Option<Raw<'_>> {
    root.get("buffers").and_then(Raw::items)?.into_iter().next()
}
