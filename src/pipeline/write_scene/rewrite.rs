//! The base level of maps as core textures: PNG pictures in `images`, with factors of 1.
//!
//! Core glTF has no levels of its own: readers make theirs by plain means. So this is no filtered scene; it is the base level with
//! its factors inside, as readers that do not know the extension can have it.

use super::files::Target;
use super::{Bake, Request, SceneWriteError};
use crate::encode::read;
use crate::picture::write_png;
use crate::pipeline::map::{MapEntry, MapFile};
use crate::plan::map::Kind;
use crate::scene::write::{Draft, DraftError, EditError, Json, Patch, Raw, edit};
use serde_json::{Value, json};

/// Rewrites the textures of materials that use maps; tells which.
pub(super) fn rewrite(
    draft: &mut Draft,
    request: &Request,
    target: &Target,
    bake: Bake<'_>,
) -> Result<Vec<usize>, SceneWriteError> {
    let text = draft.parts.text.clone();
    let failed = |e: EditError| SceneWriteError::Draft { file: target.name.clone(), source: e.into() };
    let root = Raw::new(&text).map_err(|e| failed(EditError::Json(e.to_string())))?;
    // pictures that a conversion put there come first
    let count = |key: &str| {
        let old = root.get(key).and_then(Raw::items).map_or(0, |items| items.len());
        old + draft.patch.member_ref(key).map_or(0, Patch::count_pushed)
    };
    let mut writer = Writer { images: count("images"), textures: count("textures"), made: Vec::new() };
    let mut done = Vec::new();
    let materials = root.get("materials").and_then(Raw::items).unwrap_or_default();
    for (index, name) in &request.uses {
        let Some(material) = materials.get(*index) else { continue };
        let Some(map) = bake.manifest.maps.iter().find(|m| m.record.name == *name) else {
            let source = DraftError::Map(name.clone());
            return Err(SceneWriteError::Draft { file: target.name.clone(), source });
        };
        let mut changed = false;
        for (kind, path, factor) in [
            (Kind::Roughness, &["pbrMetallicRoughness", "metallicRoughnessTexture"][..], "roughnessFactor"),
            (Kind::Normal, &["normalTexture"][..], "scale"),
        ] {
            let (Some(info), Some(file)) = (material.find(path), base(map, kind)) else { continue };
            let at = Place { folder: target, kind, name, bake };
            let texture = writer.texture(draft, root, info, &at, file)?;
            let mut own = Patch::default();
            own.member("index").set(Value::from(texture));
            if kind == Kind::Normal && info.get("scale").is_some() {
                own.member(factor).set(json!(1));
            }
            let info = Json::Text(edit(info.text(), &own).map_err(failed)?);
            let here = draft.patch.member("materials").element(*index);
            let here = path.iter().fold(&mut *here, |patch, key| patch.member(key));
            here.set(info);
            if kind == Kind::Roughness {
                let here = draft.patch.member("materials").element(*index);
                here.member("pbrMetallicRoughness").member(factor).set(json!(1));
            }
            changed = true;
        }
        done.extend(changed.then_some(*index));
    }
    Ok(done)
}

/// The file with the base level of a map.
fn base(map: &MapEntry, kind: Kind) -> Option<&MapFile> {
    map.files.iter().find(|f| f.map == kind.id() && f.level.unwrap_or(0) == 0)
}

/// Which texture is made.
struct Place<'a> {
    folder: &'a Target,
    kind: Kind,
    name: &'a str,
    bake: Bake<'a>,
}

struct Writer {
    images: usize,
    textures: usize,
    /// Names and samplers, and the texture of each.
    made: Vec<(String, Option<u64>, usize)>,
}

impl Writer {
    /// The texture with the base level of a map, sampled as the one that it takes the place of.
    fn texture(
        &mut self,
        draft: &mut Draft,
        root: Raw<'_>,
        info: Raw<'_>,
        at: &Place<'_>,
        file: &MapFile,
    ) -> Result<usize, SceneWriteError> {
        let index = |raw: Raw<'_>, key: &str| raw.get(key).and_then(|v| v.value().as_u64());
        let old = index(info, "index").and_then(|i| usize::try_from(i).ok());
        let textures = root.get("textures").and_then(Raw::items).unwrap_or_default();
        let sampler = old.and_then(|i| textures.get(i)).and_then(|t| index(*t, "sampler"));
        let path = format!("{}-maps/{}.{}.png", at.folder.stem(), at.name, at.kind.id());
        if let Some((.., texture)) = self.made.iter().find(|(p, s, _)| *p == path && *s == sampler) {
            return Ok(*texture);
        }
        let bytes = super::read_file(at.bake.folder, &file.file, &file.blake3)?;
        let png = picture(&bytes)
            .ok_or_else(|| SceneWriteError::Changed { path: at.bake.folder.join(&file.file) })?;
        let mut image = serde_json::Map::new();
        for (key, value) in draft.store(&path, &png).members() {
            image.insert(key.to_owned(), value);
        }
        image.insert("mimeType".to_owned(), "image/png".into());
        draft.patch.member("images").push(Value::Object(image));
        let mut texture = json!({ "source": self.images });
        if let Some(sampler) = sampler {
            texture["sampler"] = sampler.into();
        }
        draft.patch.member("textures").push(texture);
        self.made.push((path, sampler, self.textures));
        (self.images, self.textures) = (self.images + 1, self.textures + 1);
        Ok(self.textures - 1)
    }
}

/// The base level as a PNG of 8 bits.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "codes of 8 bits")]
fn picture(bytes: &[u8]) -> Option<Vec<u8>> {
    let image = read::read_bytes(bytes).ok()?;
    let planes = image.channels.get(..3)?;
    // the numbers of normals are read from their codes on [0, 1]
    let code = |v: f64| ((v * 255.0).round().clamp(0.0, 255.0)) as u8;
    let texels = 0..image.width * image.height;
    let codes: Vec<u8> = texels.flat_map(|i| planes.iter().map(move |p| code(p.values[i]))).collect();
    write_png([image.width, image.height], 3, &codes).ok()
}
