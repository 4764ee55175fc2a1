//! Filtered maps of the materials of scenes: a request for each pair of textures with the factors that they have there.
//!
//! Two materials that share textures and factors share a map; with other factors, or other normals, each gets its own.

use super::survey::{SurveyOptions, names};
use super::{PIXELS, Pictures};
use crate::cancel::Cancel;
use crate::maps::{Centre, Shape};
use crate::picture::Wrap;
use crate::plan::map::{AnisotropyInput, Input, Kind, MapRequest, Packing, RoughnessInput, Source};
use crate::scene::{
    self, LeftOut, LeftOutKind, Limits, MapTexture, Material, MaterialRef, Scene, SceneError,
};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// A map that materials ask for.
#[derive(Debug, Clone)]
pub struct AskedMap {
    /// What is asked for.
    pub request: MapRequest,
    /// Who asks, and what of.
    pub asked_by: Vec<MapAsker>,
}

/// A material that asks for a map.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MapAsker {
    /// The material.
    pub material: MaterialRef,
    /// What the map is made of.
    pub why: String,
}

/// The maps of scenes.
#[derive(Debug, Clone, Default)]
pub struct SceneMaps {
    /// What is asked for.
    pub maps: Vec<AskedMap>,
    /// Materials with textures that cannot be filtered, and why.
    pub left_out: Vec<LeftOut>,
}

/// The kinds of map that can be asked for with `--maps`: the roughness is in all of them.
pub const KINDS: [Kind; 3] = [Kind::Roughness, Kind::Normal, Kind::Anisotropy];

/// The maps that the materials of scenes ask for.
///
/// # Errors
/// Every scene that is refused, in order.
pub fn maps(
    files: &[PathBuf],
    kinds: &[Kind],
    options: &SurveyOptions,
) -> Result<SceneMaps, Vec<SceneError>> {
    let pictures = Pictures::new(options.root.clone(), options.pixels.max(PIXELS));
    let mut found = Found { kinds, keys: Vec::new(), all: SceneMaps::default() };
    let mut faults = Vec::new();
    let several = files.len() > 1;
    for (number, (path, file)) in files.iter().zip(names(files)).enumerate() {
        let scene = match scene::read(path, &Limits { maps: true, ..Limits::default() }) {
            Ok(scene) => scene,
            Err(fault) => {
                faults.push(fault);
                continue;
            }
        };
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let at = Place { scene: &scene, folder, pictures: &pictures, file };
        for material in scene.materials.iter().filter(|m| m.used && m.lit && m.has_maps()) {
            let prefix = if several { format!("scene{}-", number + 1) } else { String::new() };
            found.add(&at, material, &format!("{prefix}material{}", material.index));
        }
    }
    if faults.is_empty() { Ok(found.all) } else { Err(faults) }
}

/// A scene that is read.
struct Place<'a> {
    scene: &'a Scene,
    folder: &'a Path,
    pictures: &'a Pictures,
    file: String,
}

struct Found<'a> {
    kinds: &'a [Kind],
    /// What tells the maps apart: what is asked, and what is in their images.
    keys: Vec<String>,
    all: SceneMaps,
}

impl Found<'_> {
    fn add(&mut self, at: &Place<'_>, material: &Material, name: &str) {
        let told =
            MaterialRef { file: at.file.clone(), index: Some(material.index), name: material.name.clone() };
        if let Some(why) = material.bars_maps() {
            return self.leave(LeftOutKind::NotSupported, why, told);
        }
        match self.request(at, material, name) {
            Ok((request, key)) => {
                let asker = MapAsker { material: told, why: why(material) };
                match self.keys.iter().position(|k| *k == key) {
                    Some(known) => self.all.maps[known].asked_by.push(asker),
                    None => {
                        self.keys.push(key);
                        self.all.maps.push(AskedMap { request, asked_by: vec![asker] });
                    }
                }
            }
            Err(why) => self.leave(LeftOutKind::Unknown, why, told),
        }
    }

    fn leave(&mut self, kind: LeftOutKind, why: String, material: MaterialRef) {
        let what = "filtered maps".to_owned();
        let same = |l: &&mut LeftOut| l.kind == kind && l.why == why;
        match self.all.left_out.iter_mut().find(same) {
            Some(known) => known.materials.push(material),
            None => self.all.left_out.push(LeftOut { kind, what, why, materials: vec![material] }),
        }
    }

    /// The request of a material, and what tells it from others.
    fn request(
        &self,
        at: &Place<'_>,
        material: &Material,
        name: &str,
    ) -> Result<(MapRequest, String), String> {
        let mut hashes = Vec::new();
        let mut image = |texture: &MapTexture| -> Result<Source, String> {
            let index = texture.image.ok_or("a texture names no image that is known")?;
            let source = at.pictures.source(at.scene, index, at.folder)?;
            let bytes = source.bytes(&Cancel::new()).map_err(|e| format!("{}: {e}", source.name()))?;
            hashes.push(blake3::hash(&bytes).to_hex().to_string());
            Ok(source)
        };
        let normal = material.maps.normal.as_ref().map(|t| Ok::<_, String>((t, image(t)?))).transpose()?;
        let normal = normal.map(|(texture, image)| {
            let mut input = Input::new(image);
            input.convention.scale = material.maps.scale;
            (input.wrap, input.resample) = (texture.wrap, true);
            input
        });
        let factor = material.roughness_factor();
        let (roughness, factor) = match &material.maps.roughness {
            Some(texture) => (RoughnessInput::new(image(texture)?), factor),
            None => (RoughnessInput::Constant(factor), 1.0),
        };
        let own = material.maps.anisotropy.as_ref().filter(|_| material.stretch() > 0.0);
        let stretched = own.map(&mut image).transpose()?;
        let mut request = MapRequest::new(name, normal, roughness);
        (request.factor, request.packing) = (factor, Packing::Gltf);
        if self.kinds.contains(&Kind::Normal) {
            request.filter.centre = Centre::Free;
        }
        if material.stretch() > 0.0 {
            let texture = material.maps.anisotropy.as_ref();
            request.anisotropy = Some(AnisotropyInput {
                image: stretched,
                strength: material.stretch(),
                rotation: material.maps.rotation,
                wrap: texture.map_or([Wrap::Repeat; 2], |t| t.wrap),
                resample: true,
            });
        }
        // facets of two widths are no lobe of one
        if self.kinds.contains(&Kind::Anisotropy) || request.anisotropy.is_some() {
            request.filter.shape = Shape::Anisotropic;
        }
        request.possible().map_err(|faults| faults.join("; "))?;
        let key = format!("{}{hashes:?}", request.canonical());
        Ok((request, key))
    }
}

/// What the map of a material is made of.
fn why(material: &Material) -> String {
    let maps = &material.maps;
    let factor = material.roughness_factor();
    let roughness = match &maps.roughness {
        Some(_) => format!("metallicRoughnessTexture, roughnessFactor {factor}"),
        None => format!("roughness {factor}"),
    };
    let stretched = match (&maps.anisotropy, material.stretch()) {
        (_, s) if s <= 0.0 => String::new(),
        (Some(_), s) => format!(", anisotropyTexture, anisotropyStrength {s}"),
        (None, s) => format!(", anisotropyStrength {s}"),
    };
    match &maps.normal {
        Some(_) => format!("normalTexture, scale {}, and {roughness}{stretched}", maps.scale),
        None => format!("{roughness}{stretched}"),
    }
}
