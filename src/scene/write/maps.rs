//! The filtered maps of a bake in a scene: a list beside the tables in [`NAME`](super::tables::NAME), and which of them each material reads.
//!
//! Materials, textures and factors of the scene stay as they are. A reader that knows the extension takes the maps in place of the core
//! textures, with the factors that are named beside them, and samples them as it samples those: UV set, transform and wrap are theirs.

use super::tables::{Blob, Keeper};
use super::{Draft, DraftError};
use serde_json::{Map as Object, Value, json};

/// A map of a bake.
#[derive(Debug)]
pub struct Map<'a> {
    /// Its name.
    pub name: &'a str,
    /// Hash over all that its texels depend on.
    pub identity: &'a str,
    /// How it was made and how far its levels are from what they stand for, by the names of the schema.
    pub told: Object<String, Value>,
    /// Its files.
    pub files: Vec<File<'a>>,
}

/// A file of a map.
#[derive(Debug)]
pub struct File<'a> {
    /// Where it is, and its bytes.
    pub blob: Blob<'a>,
    /// `roughness`, `normal`, `anisotropy`.
    pub kind: &'a str,
    /// Its level, where each has a file.
    pub level: Option<usize>,
    /// Storage id.
    pub storage: &'a str,
    /// Its channels, in order.
    pub channels: &'a [String],
}

/// Indices of a material and of the name of its map.
pub type Uses = (usize, String);

/// The entries of maps, their files kept.
pub(super) fn describe(draft: &mut Draft, keeper: &mut Keeper, maps: &[Map<'_>]) -> Vec<Value> {
    let mut all = Vec::with_capacity(maps.len());
    for map in maps {
        let mut out = Object::new();
        out.insert("name".to_owned(), map.name.into());
        out.insert("identity".to_owned(), map.identity.into());
        out.extend(map.told.clone());
        let files = map.files.iter().map(|file| {
            let mut entry = Object::new();
            entry.insert("map".to_owned(), file.kind.into());
            entry.extend(file.level.map(|level| ("level".to_owned(), level.into())));
            entry.extend(keeper.describe(draft, &file.blob));
            entry.insert("storage".to_owned(), file.storage.into());
            entry.insert("channels".to_owned(), json!(file.channels));
            Value::Object(entry)
        });
        let files = files.collect();
        out.insert("files".to_owned(), files);
        all.push(Value::Object(out));
    }
    all
}

/// What a material reads: the index of its map, and the factors that hold with it.
pub(super) fn used(maps: &[Map<'_>], name: &str) -> Result<Object<String, Value>, DraftError> {
    let index = maps.iter().position(|m| m.name == name).ok_or_else(|| DraftError::Map(name.to_owned()))?;
    let mut out = Object::new();
    out.insert("map".to_owned(), index.into());
    out.insert("roughnessFactor".to_owned(), 1.into());
    if maps[index].files.iter().any(|f| f.kind == "normal") {
        out.insert("normalScale".to_owned(), 1.into());
    }
    Ok(out)
}
