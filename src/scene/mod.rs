//! What a glTF scene needs: its materials, read without geometry and without trust.
//!
//! [`read`] takes a `.glb` or `.gltf` file and keeps the factors that decide which tables its materials ask for.
//! [`analyse`] and [`analyse_with`] turn them into [`Needs`]: the tables to bake, who asks and why, and all that was left out.
//! Geometry is never loaded and no URI of the file is opened here: [`Scene::images`] says where the images lie whose levels
//! matter, [`Scene::geometry`] where the texture coordinates are that read them, and whoever reads them tells what is in them by
//! a [`Look`].
//!
//! # Trust
//! The file may be hostile. Sizes are bounded before anything is allocated ([`Limits`]); JSON nests at most
//! 128 deep; every index, number and type that is looked at is checked; nodes are listed, never walked, so
//! cycles do no harm. Any fault refuses the file ([`SceneError`]) and names the JSON path, what was found and
//! what is allowed. So does a URI that leads out of the scene's folder, although it would not be opened: no
//! exporter writes one by accident, and the next tool might open it. What is merely odd is a [`Warning`].
//!
//! # Adding an extension
//! One line in [`EXTENSIONS`].
//!
//! Source: [glTF 2.0](https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html).

mod asks;
mod collect;
mod data;
mod document;
mod embedded;
mod error;
mod extension;
mod factor;
mod geometry;
mod glb;
mod image;
mod json;
mod maps;
mod material;
mod mesh;
mod needs;
mod parse;
mod reader;
mod uri;
#[cfg(feature = "unstable")]
pub mod write;
#[cfg(not(feature = "unstable"))]
pub(crate) mod write;

use crate::math::shown::show;
use std::fmt;
use std::fs::File;
use std::io::Read;
use std::path::Path;

pub use asks::{Answer, Subject, dielectric_f0};
pub use collect::{Joined, analyse, analyse_with};
pub use data::{DataError, decode as decode_data};
pub use embedded::image_source;
pub use error::{Fault, SceneError};
pub use extension::{
    ANISOTROPIC, AREA_LIGHT, Asks, COAT, EXTENSIONS, Extension, FILM, FUZZ, GGX, GLASS, PHASE, ROUGH_DIFFUSE,
    SHEEN, SUBSURFACE, Switch, find as find_extension,
};
pub use factor::{Channel, Factor, Interval, Property, Sampled, Spread};
pub use geometry::{Accessor, Component, Geometry, Primitive, Reading, Sparse, View};
pub use image::{Image, Look, Source};
pub use json::{ASYMMETRY, Allowed, IOR, NOT_NEGATIVE, UNIT};
pub use maps::{MapTexture, Maps};
pub use material::{CORE, Material, MaterialExtension, State};
pub use mesh::{Meshes, Shape};
pub use needs::{AskedBy, Id, LeftOut, LeftOutKind, MOST_VALUES, MaterialRef, Need, Needs, Range};
pub use reader::Reader;
pub use uri::{Checked, LONGEST_URI, Resolved, UriError, check_uri, resolve, resolve_uri};

/// How much of a file is looked at before it is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Size of the file, in bytes. Checked before it is read. Default 1 GiB.
    pub file_bytes: u64,
    /// Size of the JSON text, in bytes. Default 256 MiB: buffers may be embedded in it.
    pub json_bytes: u64,
    /// Number of JSON values that are kept, which bounds memory: at worst 0.5 kB each were measured.
    /// Default 2 million.
    pub json_values: usize,
    /// Size of one `data:` URI after decoding, in bytes. Default 128 MiB.
    pub data_uri_bytes: u64,
    /// Are images of colours in [`Scene::images`], too? They decide over no table. Default false.
    pub colours: bool,
    /// List the images of normals and roughness that filtered maps are made of, in place of those that factors are multiplied by.
    pub maps: bool,
    /// Keep in [`Scene::geometry`] where the texture coordinates lie, so that it can be told which texels the meshes cover. Default false.
    pub texels: bool,
    /// Keep in [`Scene::drawn`] the meshes as nodes place them. Default false.
    pub meshes: bool,
}

impl Default for Limits {
    fn default() -> Self {
        const MIB: u64 = 1 << 20;
        Self {
            file_bytes: 1024 * MIB,
            json_bytes: 256 * MIB,
            json_values: 2_000_000,
            data_uri_bytes: 128 * MIB,
            colours: false,
            maps: false,
            texels: false,
            meshes: false,
        }
    }
}

/// What is odd about a file that was read all the same.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Warning {
    /// A byte order mark before the JSON text. glTF forbids it.
    ByteOrderMark,
    /// A GLB that goes on after its declared length. The rest was not read.
    TrailingBytes {
        /// Length in the header.
        declared: u32,
        /// Bytes in the file.
        actual: usize,
    },
    /// A material has an extension that `extensionsUsed` does not list. It was read.
    NotDeclared {
        /// The extension.
        extension: String,
    },
    /// `extensionsRequired` lists an extension that `extensionsUsed` does not.
    RequiredNotUsed {
        /// The extension.
        extension: String,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ByteOrderMark => {
                f.write_str("the JSON text starts with a byte order mark, which glTF forbids")
            }
            Self::TrailingBytes { declared, actual } => {
                write!(
                    f,
                    "GLB header declares {declared} bytes, the file has {actual}; the rest was not read"
                )
            }
            Self::NotDeclared { extension } => {
                write!(f, "{} is on a material but not in extensionsUsed", show(extension))
            }
            Self::RequiredNotUsed { extension } => {
                write!(f, "{} is in extensionsRequired but not in extensionsUsed", show(extension))
            }
        }
    }
}

/// A file outside the scene that a buffer or an image names. It was not opened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExternalFile {
    /// JSON path of the URI.
    pub at: String,
    /// Path relative to the scene's folder, decoded, with `/` between names.
    pub path: String,
}

/// A scene, as far as tables are concerned.
#[derive(Debug)]
pub struct Scene {
    /// Name of the file, without its folder.
    pub file_name: String,
    /// The materials, in the file's order.
    pub materials: Vec<Material>,
    /// Number of meshes. A mesh counts whether or not a node places it: libraries place none.
    pub meshes: usize,
    /// Number of mesh primitives.
    pub primitives: usize,
    /// Number of mesh primitives that name no material.
    pub primitives_without_material: usize,
    /// True if glTF's default material is used.
    pub default_material_used: bool,
    /// `extensionsUsed`.
    pub extensions_used: Vec<String>,
    /// `extensionsRequired`. Unknown ones are no fault: only materials are read.
    pub extensions_required: Vec<String>,
    /// Files that buffers and images name.
    pub external_files: Vec<ExternalFile>,
    /// The images that numbers of used materials are multiplied by.
    pub images: Vec<Image>,
    /// Where texture coordinates lie, if [`Limits::texels`] asked for it.
    pub geometry: Geometry,
    /// The meshes as they stand, if [`Limits::meshes`] asked for it.
    pub drawn: Meshes,
    /// What is odd about the file.
    pub warnings: Vec<Warning>,
}

impl Scene {
    /// The textures that numbers of lit materials are multiplied by, each as its material reads it.
    pub fn readings(&self) -> impl Iterator<Item = Sampled> + '_ {
        self.materials.iter().filter(|m| m.used && m.lit).flat_map(|m| m.sampled(false))
    }
}

/// Reads a `.glb` or `.gltf` file. The content decides which, not the name.
///
/// # Errors
/// [`Fault::Io`] if the file cannot be read; any other [`Fault`] if it is refused.
pub fn read(path: &Path, limits: &Limits) -> Result<Scene, SceneError> {
    read_hashed(path, limits).map(|(scene, _)| scene)
}

/// As [`read`], with blake3 of the file in hex.
///
/// # Errors
/// As [`read`].
pub fn read_hashed(path: &Path, limits: &Limits) -> Result<(Scene, String), SceneError> {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
    let bytes =
        read_bytes(path, limits.file_bytes).map_err(|fault| SceneError { file: name.to_string(), fault })?;
    let scene = read_slice(&bytes, &name, limits)?;
    Ok((scene, blake3::hash(&bytes).to_hex().to_string()))
}

/// Reads a file that is in memory. `name` is for messages.
///
/// # Errors
/// The first [`Fault`] found; never [`Fault::Io`].
pub fn read_slice(bytes: &[u8], name: &str, limits: &Limits) -> Result<Scene, SceneError> {
    let scene = too_large(bytes.len(), limits.file_bytes).and_then(|()| read_bytes_of(bytes, name, limits));
    scene.map_err(|fault| SceneError { file: name.to_owned(), fault })
}

fn too_large(len: usize, limit: u64) -> Result<(), Fault> {
    let bytes = u64::try_from(len).unwrap_or(u64::MAX);
    if bytes > limit { Err(Fault::FileTooLarge { bytes, limit }) } else { Ok(()) }
}

/// The file's bytes, never more than `limit` of them.
fn read_bytes(path: &Path, limit: u64) -> Result<Vec<u8>, Fault> {
    let io = |source| Fault::Io { source };
    // Asked before opening: opening a pipe would wait for a writer.
    if !path.metadata().map_err(io)?.is_file() {
        return Err(Fault::NotAFile);
    }
    let file = File::open(path).map_err(io)?;
    let bytes = file.metadata().map_err(io)?.len();
    if bytes > limit {
        return Err(Fault::FileTooLarge { bytes, limit });
    }
    // The file may grow while it is read.
    let mut out = Vec::new();
    file.take(limit.saturating_add(1)).read_to_end(&mut out).map_err(io)?;
    too_large(out.len(), limit).map(|()| out)
}

/// Container, text, tree, scene.
fn read_bytes_of(bytes: &[u8], name: &str, limits: &Limits) -> Result<Scene, Fault> {
    const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
    let mut warnings = Vec::new();
    let is_glb = bytes.starts_with(glb::MAGIC);
    let (chunk, bin) = if is_glb { glb::chunks(bytes, &mut warnings)? } else { (bytes.into(), None) };
    let text = chunk.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&chunk);
    if text.len() < chunk.len() {
        warnings.push(Warning::ByteOrderMark);
    }
    let size = u64::try_from(text.len()).unwrap_or(u64::MAX);
    if size > limits.json_bytes {
        return Err(Fault::JsonTooLarge { bytes: size, limit: limits.json_bytes });
    }
    match text.trim_ascii_start().first() {
        None => return Err(Fault::EmptyJson),
        Some(b'{') => {}
        // Inside a container it can only be meant as JSON: let the parser say what is wrong.
        Some(_) if is_glb => {}
        Some(_) => return Err(Fault::NotGltf { got: first_bytes(text) }),
    }
    let text = std::str::from_utf8(text).map_err(|e| Fault::Utf8 { offset: e.valid_up_to() })?;
    let tree = parse::parse(text, limits.json_values, [limits.texels || limits.meshes, limits.meshes])?;
    let mut scene = document::scene(&tree, bin.as_deref(), limits)?;
    name.clone_into(&mut scene.file_name);
    scene.warnings.splice(0..0, warnings);
    Ok(scene)
}

/// The first bytes, for the message about a file that is something else.
fn first_bytes(bytes: &[u8]) -> String {
    let head = bytes.get(..8).unwrap_or(bytes);
    format!("\"{}\"", head.escape_ascii())
}
