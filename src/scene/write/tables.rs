//! The tables and maps of a bake in a scene: the root extension `BRDFBAKE_lookup_tables`, and which of them serve which material.
//!
//! The name is provisional: its prefix is not registered with Khronos. The extension is listed in `extensionsUsed` and never in
//! `extensionsRequired`: a reader that does not know it shows the scene as before. [`LOOKUP_TABLES_SCHEMA`] says what each member means.
//!
//! Everything stands in the one object of the root, also which tables serve which material: the validator counts extensions of a material,
//! and its verdict on the scene is to stay what it was.
//!
//! Source: [glTF extensions](https://github.com/KhronosGroup/glTF/blob/main/extensions/README.md), naming and declaration.

use std::collections::BTreeMap;

use serde_json::{Map as Object, Value, json};

use super::maps::{self, Map, Uses};
use super::{Draft, DraftError, Patch, Raw, Stored, raw};
use crate::grid::Provenance;
use crate::grid::provenance::{Encoding, Reconstruction, TexelRecord};

/// Name of the extension.
pub const NAME: &str = "BRDFBAKE_lookup_tables";

/// Version of the object.
pub const VERSION: u32 = 1;

/// The schema (JSON Schema 2020-12) of the object.
pub const LOOKUP_TABLES_SCHEMA: &str = include_str!("../brdfbake_lookup_tables.schema.json");

/// A table of a bake.
#[derive(Debug)]
pub struct Table<'a> {
    /// What it says of itself.
    pub provenance: &'a Provenance,
    /// Texels along each axis, fastest first.
    pub size: &'a [usize],
    /// Its files.
    pub files: Vec<File<'a>>,
}

/// A file that is put into a scene, or named by it.
#[derive(Debug)]
pub struct Blob<'a> {
    /// Path of the file relative to the scene, as it is or as it would be written.
    pub path: String,
    /// True if it is there already, and is only named.
    pub named: bool,
    /// Its bytes.
    pub bytes: &'a [u8],
    /// blake3 of the bytes.
    pub blake3: &'a str,
    /// Id of the container.
    pub container: &'a str,
    /// Its media type.
    pub media_type: &'a str,
}

/// A file of a table.
#[derive(Debug)]
pub struct File<'a> {
    /// Where it is, and its bytes.
    pub blob: Blob<'a>,
    /// How the values are stored.
    pub encoding: &'a Encoding,
    /// Errors of reading.
    pub reconstruction: Option<&'a Reconstruction>,
    /// What the texels hold, where they are fitted.
    pub texels: Option<&'a TexelRecord>,
    /// Errors of reading without the offset of an axis.
    pub as_read: Option<&'a Reconstruction>,
}

/// Where the object goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Place {
    /// Into `extensions`.
    #[default]
    Extension,
    /// Into `extensions`, and the same into `extras`.
    Both,
    /// Into `extras` alone: nothing is declared.
    Extras,
}

/// The tables that serve a material: its index (none for the default material) and their names.
pub type Serves = (Option<usize>, Vec<String>);

/// What a material reads: indices of tables, and the members that tell of its map.
type Reads = (Vec<usize>, Object<String, Value>);

/// What a bake puts into a scene.
#[derive(Debug, Default)]
pub struct Baked<'a> {
    /// The tables.
    pub tables: Vec<Table<'a>>,
    /// The maps.
    pub maps: Vec<Map<'a>>,
    /// The tables of each material.
    pub serves: &'a [Serves],
    /// The map of each material that has one.
    pub uses: &'a [Uses],
}

/// Puts tables and maps into a draft. What an earlier bake put there is replaced.
///
/// # Errors
/// [`DraftError::Table`] and [`DraftError::Map`] for a name that none has, and [`DraftError::Edit`] for a scene that is no JSON.
pub fn add(draft: &mut Draft, tool: &str, baked: &Baked<'_>, place: Place) -> Result<(), DraftError> {
    let Baked { tables, maps, serves, uses } = baked;
    let mut keeper = Keeper { kept: Kept::of(draft)?, stored: Vec::new() };
    let mut list = Vec::with_capacity(tables.len());
    for table in tables {
        let files = table.files.iter().map(|file| describe_file(file, keeper.describe(draft, &file.blob)));
        let files = files.collect();
        list.push(describe_table(table, files));
    }
    let mut object = json!({
        "version": VERSION,
        "generator": tool,
        "conventions": {
            "axes": "fastest first: x, y, z of the texture",
            "lookup": "linear between texels, clamped at the ends of each axis; `coordinate` of an axis is what a sampler takes",
            "values": "linear numbers; none is a colour in sRGB",
        },
        "tables": list,
    });
    let index = |name: &String| {
        let found = tables.iter().position(|t| t.provenance.name == *name);
        found.ok_or_else(|| DraftError::Table(name.clone()))
    };
    if !maps.is_empty() {
        object["maps"] = maps::describe(draft, &mut keeper, maps).into();
    }
    let mut materials: BTreeMap<Option<usize>, Reads> = BTreeMap::new();
    for (material, names) in serves.iter().filter(|(_, names)| !names.is_empty()) {
        let indices = names.iter().map(index).collect::<Result<Vec<_>, _>>()?;
        materials.entry(*material).or_default().0.extend(indices);
    }
    for (material, name) in *uses {
        materials.entry(Some(*material)).or_default().1 = maps::used(maps, name)?;
    }
    let entry = |(material, (mut tables, map)): (Option<usize>, Reads)| {
        tables.sort_unstable();
        tables.dedup();
        let mut entry = Object::new();
        entry.extend(material.map(|m| ("material".to_owned(), m.into())));
        if !tables.is_empty() {
            entry.insert("tables".to_owned(), json!(tables));
        }
        entry.extend(map);
        Value::Object(entry)
    };
    object["materials"] = materials.into_iter().map(entry).collect();
    // a scene that needs nothing is told of none
    let any = !tables.is_empty() || !maps.is_empty();
    declare(draft, any && place != Place::Extras)?;
    put(draft, "extensions", (any && place != Place::Extras).then_some(&object))?;
    put(draft, "extras", (any && place != Place::Extension).then_some(&object))
}

/// Puts the object into `extensions` or `extras` of the root, or takes an old one away.
fn put(draft: &mut Draft, key: &str, new: Option<&Value>) -> Result<(), DraftError> {
    let root = raw(&draft.parts)?;
    match new {
        Some(object) => draft.patch.member(key).member(NAME).set(object.clone()),
        None if root.find(&[key, NAME]).is_some() => forget(&mut draft.patch, root, key),
        None => {}
    }
    Ok(())
}

/// Takes a member of `extensions` or `extras` away, and these if nothing else is in them.
fn forget(patch: &mut Patch, raw: Raw<'_>, key: &str) {
    let alone = raw.get(key).and_then(Raw::members).is_some_and(|m| m.len() == 1);
    let patch = patch.member(key);
    if alone { patch.remove() } else { patch.member(NAME).remove() }
}

/// Lists the extension as used, or takes it off the list.
fn declare(draft: &mut Draft, used: bool) -> Result<(), DraftError> {
    let list = raw(&draft.parts)?.get("extensionsUsed").and_then(Raw::items).unwrap_or_default();
    let at = list.iter().position(|name| name.value() == NAME);
    match at {
        None if used => draft.patch.member("extensionsUsed").push(Value::from(NAME)),
        Some(index) if !used => {
            draft.patch.member("extensionsUsed").element(index).remove();
            draft.tidy = true;
        }
        _ => {}
    }
    Ok(())
}

/// Where the files of a bake are kept, each once.
pub(super) struct Keeper {
    kept: Kept,
    stored: Vec<(String, Stored)>,
}

impl Keeper {
    /// Keeps a file, and tells where it is and what it is.
    pub(super) fn describe(&mut self, draft: &mut Draft, blob: &Blob<'_>) -> Object<String, Value> {
        let known = self.stored.iter().find(|(path, _)| *path == blob.path).map(|(_, at)| at.clone());
        let at = known.unwrap_or_else(|| match self.kept.view(blob) {
            _ if blob.named => Stored::Beside(blob.path.clone()),
            Some(view) => Stored::View(view),
            None => draft.store(&blob.path, blob.bytes),
        });
        self.stored.push((blob.path.clone(), at.clone()));
        let mut out = Object::new();
        out.extend(at.members().into_iter().map(|(key, value)| (key.to_owned(), value)));
        out.insert("mimeType".to_owned(), blob.media_type.into());
        out.insert("container".to_owned(), blob.container.into());
        out.insert("byteLength".to_owned(), blob.bytes.len().into());
        out.insert("blake3".to_owned(), blob.blake3.into());
        out
    }
}

/// Files that an earlier bake put into the binary chunk.
struct Kept(Vec<(String, usize)>);

impl Kept {
    fn of(draft: &Draft) -> Result<Kept, DraftError> {
        let root = raw(&draft.parts)?;
        let mut kept = Vec::new();
        let (Some(bin), true) = (&draft.parts.bin, draft.embeds()) else { return Ok(Kept(kept)) };
        let views = root.get("bufferViews").and_then(Raw::items).unwrap_or_default();
        let lists = ["extensions", "extras"].map(|key| ["tables", "maps"].map(|list| [key, NAME, list]));
        for path in lists.into_iter().flatten() {
            let units = root.find(&path).map(Raw::value).unwrap_or_default();
            for file in units.as_array().into_iter().flatten().filter_map(|t| t["files"].as_array()).flatten()
            {
                let Some(index) = file["bufferView"].as_u64().and_then(|i| usize::try_from(i).ok()) else {
                    continue;
                };
                let Some(view) = views.get(index).map(|v| v.value()) else { continue };
                let number = |key: &str| view[key].as_u64().and_then(|n| usize::try_from(n).ok());
                let (start, length) = (number("byteOffset").unwrap_or(0), number("byteLength").unwrap_or(0));
                let bytes = bin.get(start..start.saturating_add(length));
                if let (Some(0), Some(bytes)) = (number("buffer"), bytes) {
                    kept.push((blake3::hash(bytes).to_hex().to_string(), index));
                }
            }
        }
        Ok(Kept(kept))
    }

    /// The view that holds the bytes of a file.
    fn view(&self, file: &Blob<'_>) -> Option<usize> {
        self.0.iter().find(|(hash, _)| hash == file.blake3).map(|(_, view)| *view)
    }
}

fn describe_table(table: &Table<'_>, files: Vec<Value>) -> Value {
    let told = table.provenance;
    let mut out = Object::new();
    let mut put = |key: &str, value: Value| {
        let nothing = ["residuals", "waived"].contains(&key) && value.as_array().is_some_and(Vec::is_empty);
        if !value.is_null() && !nothing {
            out.insert(key.to_owned(), value);
        }
    };
    put("name", told.name.as_str().into());
    put("identity", told.recipe.hash.as_str().into());
    put("kind", json!(told.table));
    put("model", json!(told.model));
    put("size", json!(table.size));
    put("axes", json!(told.axes));
    put("channels", json!(told.channels));
    put("integration", json!(told.integration));
    put("residuals", json!(told.residuals));
    put("verified", told.verified.into());
    put("toleranceMet", json!(told.tolerance_met));
    put("waived", json!(told.waived));
    put("files", files.into());
    Value::Object(out)
}

fn describe_file(file: &File<'_>, mut out: Object<String, Value>) -> Value {
    let more = [
        ("encoding", json!(file.encoding)),
        ("reconstruction", json!(file.reconstruction)),
        ("texels", json!(file.texels)),
        ("asRead", json!(file.as_read)),
    ];
    out.extend(more.into_iter().filter(|(_, v)| !v.is_null()).map(|(k, v)| (k.to_owned(), v)));
    Value::Object(out)
}
