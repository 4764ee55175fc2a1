//! Metallic-roughness in place of specular-glossiness: the JSON of a material, and its pictures.

use super::read::{SpecGloss, Texture};
use super::{Converted, Mode, NAME, diffuse_ratios};
use crate::maps::spec_gloss::{Solved, solve};
use crate::picture::{Picture, Plane, Space, write_png};
use crate::pipeline::write_scene::SceneWriteError;
use crate::scene::write::{Draft, Json, Patch, Raw, edit};
use serde_json::{Value, json};

/// The extensions that an exact conversion needs.
const EXACT: [&str; 2] = ["KHR_materials_specular", "KHR_materials_ior"];

/// Puts pictures and materials into a draft.
pub(super) struct Writer<'a> {
    stem: &'a str,
    images: usize,
    textures: usize,
    /// Pictures that were made: hash and sampler, and the texture of each.
    made: Vec<(blake3::Hash, Option<usize>, usize)>,
}

/// One texel of both textures, linear, factors included.
struct Texel {
    diffuse: [f64; 3],
    specular: [f64; 3],
    roughness: f64,
}

impl<'a> Writer<'a> {
    pub(super) fn new(root: Raw<'_>, stem: &'a str) -> Writer<'a> {
        let count = |key: &str| root.get(key).and_then(Raw::items).map_or(0, |list| list.len());
        Writer { stem, images: count("images"), textures: count("textures"), made: Vec::new() }
    }

    /// Colours keep their textures and factors; only roughness, which is 1 − glossiness, gets a picture of its own.
    pub(super) fn exact(
        &mut self,
        draft: &mut Draft,
        source: &SpecGloss<'_>,
        name: Option<String>,
    ) -> Result<Converted, SceneWriteError> {
        let mut pbr = Patch::default();
        copy(source.own, "diffuseFactor", &mut pbr, "baseColorFactor");
        copy(source.own, "diffuseTexture", &mut pbr, "baseColorTexture");
        pbr.member("metallicFactor").set(json!(0));
        let (mut size, mut off) = ([1, 1], 0.0_f64);
        let glossy = source.specular_texture.as_ref().and_then(|t| Some((t, t.picture.plane("A").ok()?)));
        match glossy {
            None => pbr.member("roughnessFactor").set(json!(1.0 - source.gloss)),
            Some((texture, plane)) => {
                size = [texture.picture.width, texture.picture.height];
                let mut codes = Vec::with_capacity(3 * plane.values.len());
                for alpha in &plane.values {
                    let roughness = 1.0 - exactly(*alpha) * source.gloss;
                    let stored = code(roughness);
                    off = off.max((f64::from(stored) / 255.0 - roughness).abs());
                    codes.extend([255, stored, 0]);
                }
                let png = png(size, 3, &codes)?;
                let info = self.texture(draft, source, "roughness", &png, texture)?;
                pbr.member("roughnessFactor").set(json!(1));
                pbr.member("metallicRoughnessTexture").set(info);
            }
        }
        let mut specular = Patch::default();
        copy(source.own, "specularFactor", &mut specular, "specularColorFactor");
        copy(source.own, "specularGlossinessTexture", &mut specular, "specularColorTexture");
        let here = draft.patch.member("materials").element(source.material);
        here.member("pbrMetallicRoughness").set(object(&pbr)?);
        let extensions = here.member("extensions");
        extensions.member(NAME).remove();
        extensions.member(EXACT[0]).set(object(&specular)?);
        extensions.member(EXACT[1]).set(json!({ "ior": 0 }));
        Ok(Converted {
            material: source.material,
            name,
            mode: Mode::Exact,
            size,
            f0_error: 0.0,
            at: [0, 0],
            f0_error_mean: 0.0,
            f0_error_stored: 0.0,
            roughness_error_stored: off,
            diffuse_ratio: diffuse_ratios(),
            errors: vec![0.0; size[0] * size[1]],
        })
    }

    /// Base colour, metallic and roughness texel by texel.
    pub(super) fn solve(
        &mut self,
        draft: &mut Draft,
        material: Raw<'_>,
        source: &SpecGloss<'_>,
        name: Option<String>,
    ) -> Result<Converted, SceneWriteError> {
        source.check_alike()?;
        let (size, texels, alpha) = texels(source)?;
        let solved: Vec<Solved> = texels.iter().map(|t| solve(t.diffuse, t.specular)).collect();
        let mut out = judged(&texels, &solved, size);
        (out.material, out.name) = (source.material, name);
        let mut pbr = Patch::default();
        let texture = source.diffuse_texture.as_ref().or(source.specular_texture.as_ref());
        match (texture, solved.first(), texels.first()) {
            (Some(texture), ..) => {
                let channels = if alpha.is_some() { 4 } else { 3 };
                let base: Vec<u8> = solved
                    .iter()
                    .enumerate()
                    .flat_map(|(i, s)| {
                        let [r, g, b] = s.base.map(|c| code(Space::Srgb.encode(c)));
                        [r, g, b, alpha.as_ref().map_or(255, |a| a[i])].into_iter().take(channels)
                    })
                    .collect();
                let rest: Vec<u8> = solved
                    .iter()
                    .zip(&texels)
                    .flat_map(|(s, t)| [255, code(t.roughness), code(s.metallic)])
                    .collect();
                let base = self.texture(draft, source, "base", &png(size, channels, &base)?, texture)?;
                let rest =
                    self.texture(draft, source, "metallic-roughness", &png(size, 3, &rest)?, texture)?;
                if source.diffuse[3] < 1.0 {
                    pbr.member("baseColorFactor").set(json!([1, 1, 1, source.diffuse[3]]));
                }
                pbr.member("baseColorTexture").set(base);
                pbr.member("metallicRoughnessTexture").set(rest);
            }
            (None, Some(solved), Some(texel)) => {
                let [r, g, b] = solved.base;
                pbr.member("baseColorFactor").set(json!([r, g, b, source.diffuse[3]]));
                pbr.member("metallicFactor").set(json!(solved.metallic));
                pbr.member("roughnessFactor").set(json!(texel.roughness));
                out.f0_error_stored = out.f0_error;
                out.roughness_error_stored = 0.0;
            }
            _ => {}
        }
        let here = draft.patch.member("materials").element(source.material);
        here.member("pbrMetallicRoughness").set(object(&pbr)?);
        for gone in [&[NAME], EXACT.as_slice()].concat() {
            if material.find(&["extensions", gone]).is_some() {
                here.member("extensions").member(gone).remove();
            }
        }
        Ok(out)
    }

    /// Puts a picture into the draft, and tells the `textureInfo` that samples it as `like` is sampled.
    fn texture(
        &mut self,
        draft: &mut Draft,
        source: &SpecGloss<'_>,
        what: &str,
        png: &[u8],
        like: &Texture<'_>,
    ) -> Result<Json, SceneWriteError> {
        let hash = blake3::hash(png);
        let known = self.made.iter().find(|(h, s, _)| *h == hash && *s == like.sampler).map(|(.., t)| *t);
        let index = known.unwrap_or_else(|| {
            let path = format!("{}-maps/material{}.{what}.png", self.stem, source.material);
            let mut image = serde_json::Map::new();
            for (key, value) in draft.store(&path, png).members() {
                image.insert(key.to_owned(), value);
            }
            image.insert("mimeType".to_owned(), "image/png".into());
            draft.patch.member("images").push(Value::Object(image));
            let mut texture = json!({ "source": self.images });
            if let Some(sampler) = like.sampler {
                texture["sampler"] = sampler.into();
            }
            draft.patch.member("textures").push(texture);
            self.made.push((hash, like.sampler, self.textures));
            (self.images, self.textures) = (self.images + 1, self.textures + 1);
            self.textures - 1
        });
        let mut patch = Patch::default();
        patch.member("index").set(Value::from(index));
        Ok(Json::Text(edit(like.info.text(), &patch).map_err(draft_error)?))
    }
}

fn draft_error(error: crate::scene::write::EditError) -> SceneWriteError {
    SceneWriteError::Draft { file: "material".to_owned(), source: error.into() }
}

/// A new object.
fn object(patch: &Patch) -> Result<Json, SceneWriteError> {
    edit("{}", patch).map(Json::Text).map_err(draft_error)
}

/// A member under another name, with its text.
fn copy(from: Raw<'_>, key: &str, to: &mut Patch, name: &str) {
    if let Some(raw) = from.get(key) {
        to.member(name).set(Json::Text(raw.text().to_owned()));
    }
}

fn png(size: [usize; 2], channels: usize, codes: &[u8]) -> Result<Vec<u8>, SceneWriteError> {
    write_png(size, channels, codes).map_err(|e| {
        super::ConvertError::Image { at: "a picture that is made".to_owned(), why: e.to_string() }.into()
    })
}

/// A code of 8 or 16 bits, which f32 has to seven digits only.
fn exactly(code: f32) -> f64 {
    (f64::from(code) * 65535.0).round() / 65535.0
}

/// The nearest code of 8 bits.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rounded and clamped before")]
fn code(x: f64) -> u8 {
    (x.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// Errors of all texels, by the formula and as stored.
#[allow(clippy::cast_possible_truncation, reason = "an error needs no more than f32")]
fn judged(texels: &[Texel], solved: &[Solved], size: [usize; 2]) -> Converted {
    let mut out = Converted {
        material: 0,
        name: None,
        mode: Mode::Solve,
        size,
        f0_error: 0.0,
        at: [0, 0],
        f0_error_mean: 0.0,
        f0_error_stored: 0.0,
        roughness_error_stored: 0.0,
        diffuse_ratio: Vec::new(),
        errors: Vec::with_capacity(texels.len()),
    };
    let stored = |x: f64| f64::from(code(x)) / 255.0;
    for (i, (texel, solved)) in texels.iter().zip(solved).enumerate() {
        let error = solved.f0_error(texel.specular);
        if error > out.f0_error {
            (out.f0_error, out.at) = (error, [i % size[0], i / size[0]]);
        }
        let read = Solved {
            base: solved.base.map(|b| f64::from(Space::Srgb.decode(stored(Space::Srgb.encode(b)) as f32))),
            metallic: stored(solved.metallic),
        };
        out.f0_error_stored = out.f0_error_stored.max(read.f0_error(texel.specular));
        out.roughness_error_stored =
            out.roughness_error_stored.max((stored(texel.roughness) - texel.roughness).abs());
        out.f0_error_mean += error;
        out.errors.push(error as f32);
    }
    out.f0_error_mean /= texels.len().max(1) as f64;
    out
}

/// Size, texels, and the codes of opacity if the diffuse texture has any.
type Texels = ([usize; 2], Vec<Texel>, Option<Vec<u8>>);

fn texels(source: &SpecGloss<'_>) -> Result<Texels, SceneWriteError> {
    let sizes = [&source.diffuse_texture, &source.specular_texture]
        .map(|t| t.as_ref().map_or([1, 1], |t| size(&t.picture)));
    let size = [sizes[0][0].max(sizes[1][0]), sizes[0][1].max(sizes[1][1])];
    let planes = |texture: &Option<Texture<'_>>| -> Result<[Option<Vec<f32>>; 4], SceneWriteError> {
        let Some(texture) = texture else { return Ok([None, None, None, None]) };
        let plane = |name: &str| -> Result<Option<Vec<f32>>, SceneWriteError> {
            let found = match texture.picture.plane(name) {
                Ok(plane) => plane,
                Err(_) if name == "A" => return Ok(None),
                Err(e) => {
                    let at = format!("materials[{}]", source.material);
                    return Err(super::ConvertError::Image { at, why: e.to_string() }.into());
                }
            };
            let space = if name == "A" { Space::Linear } else { Space::Srgb };
            let values = found.values.iter().map(|v| space.decode(*v)).collect();
            let linear = Plane { name: name.to_owned(), values };
            let own = [texture.picture.width, texture.picture.height];
            Ok(Some(if own == size {
                linear.values
            } else {
                linear.resampled(own, size, texture.wrap).values
            }))
        };
        Ok([plane("R")?, plane("G")?, plane("B")?, plane("A")?])
    };
    let (diffuse, specular) = (planes(&source.diffuse_texture)?, planes(&source.specular_texture)?);
    let gloss = |i: usize| specular[3].as_ref().map_or(1.0, |p| exactly(p[i]));
    let at = |plane: &Option<Vec<f32>>, i: usize| plane.as_ref().map_or(1.0, |p| f64::from(p[i]));
    let texel = |i: usize| Texel {
        diffuse: [0, 1, 2].map(|c| at(&diffuse[c], i) * source.diffuse[c]),
        specular: [0, 1, 2].map(|c| at(&specular[c], i) * source.specular[c]),
        roughness: 1.0 - gloss(i) * source.gloss,
    };
    let texels = (0..size[0] * size[1]).map(texel).collect();
    let alpha =
        diffuse[3].as_ref().map(|plane| plane.iter().map(|a| code(f64::from(*a))).collect::<Vec<u8>>());
    Ok((size, texels, alpha.filter(|codes| codes.iter().any(|a| *a < 255))))
}

fn size(picture: &Picture) -> [usize; 2] {
    [picture.width, picture.height]
}

/// Takes the archived extension off the lists, and puts on them what takes its place.
pub(super) fn declare(draft: &mut Draft, root: Raw<'_>, mode: Mode, any: bool) {
    for list in ["extensionsUsed", "extensionsRequired"] {
        let names = root.get(list).and_then(Raw::items).unwrap_or_default();
        let at = |name: &str| names.iter().position(|n| n.value() == name);
        if let Some(index) = at(NAME) {
            draft.patch.member(list).element(index).remove();
            draft.tidy = true;
        }
        if list == "extensionsUsed" && mode == Mode::Exact && any {
            for name in EXACT.into_iter().filter(|name| at(name).is_none()) {
                draft.patch.member(list).push(Value::from(name));
            }
        }
    }
}
