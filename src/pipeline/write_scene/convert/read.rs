//! What a specular-glossiness material says, and its pictures.

use super::ConvertError;
use crate::picture::{self, Picture, Wrap};
use crate::pipeline::write_scene::{Request, SceneWriteError, files};
use crate::scene::write::Raw;
use crate::scene::{Source, image_source};
use serde_json::Value;

/// The textures of a scene.
pub(super) struct Images<'a> {
    textures: Vec<Raw<'a>>,
    samplers: Vec<Raw<'a>>,
    tree: Value,
    bin: Option<&'a [u8]>,
    request: &'a Request,
}

/// A texture of a material: the text of its `textureInfo`, its picture, and how it is sampled.
pub(super) struct Texture<'a> {
    pub(super) info: Raw<'a>,
    pub(super) picture: Picture,
    /// Index of the sampler, if there is one.
    pub(super) sampler: Option<usize>,
    pub(super) wrap: [Wrap; 2],
}

/// A specular-glossiness material.
pub(super) struct SpecGloss<'a> {
    pub(super) material: usize,
    pub(super) own: Raw<'a>,
    pub(super) diffuse: [f64; 4],
    pub(super) specular: [f64; 3],
    pub(super) gloss: f64,
    pub(super) diffuse_texture: Option<Texture<'a>>,
    pub(super) specular_texture: Option<Texture<'a>>,
}

impl<'a> SpecGloss<'a> {
    pub(super) fn of(
        own: Raw<'a>,
        material: usize,
        images: &Images<'a>,
    ) -> Result<SpecGloss<'a>, SceneWriteError> {
        let at = |key: &str| format!("materials[{material}].extensions.{}.{key}", super::NAME);
        let texture = |key: &str| own.get(key).map(|info| images.texture(info, &at(key))).transpose();
        let gloss = match own.get("glossinessFactor") {
            None => 1.0,
            Some(raw) => number(raw, &at("glossinessFactor"))?,
        };
        Ok(SpecGloss {
            material,
            own,
            diffuse: numbers(own.get("diffuseFactor"), &at("diffuseFactor"))?,
            specular: numbers(own.get("specularFactor"), &at("specularFactor"))?,
            gloss,
            diffuse_texture: texture("diffuseTexture")?,
            specular_texture: texture("specularGlossinessTexture")?,
        })
    }

    /// Refuses textures that one picture cannot replace.
    pub(super) fn check_alike(&self) -> Result<(), ConvertError> {
        let (Some(a), Some(b)) = (&self.diffuse_texture, &self.specular_texture) else { return Ok(()) };
        let set = |t: &Texture<'_>| t.info.get("texCoord").map_or(0, |c| c.value().as_u64().unwrap_or(0));
        let moved = |t: &Texture<'_>| t.info.find(&["extensions", "KHR_texture_transform"]).map(Raw::value);
        let what = if set(a) != set(b) {
            "UV set"
        } else if moved(a) != moved(b) {
            "KHR_texture_transform"
        } else if a.wrap != b.wrap {
            "wrap mode"
        } else {
            return Ok(());
        };
        Err(ConvertError::Coordinates { material: self.material, what })
    }
}

fn number(raw: Raw<'_>, at: &str) -> Result<f64, ConvertError> {
    let value = raw.value().as_f64().filter(|x| (0.0..=1.0).contains(x));
    value.ok_or_else(|| ConvertError::Value {
        at: at.to_owned(),
        got: raw.text().chars().take(40).collect(),
        allowed: "a number in [0, 1]",
    })
}

/// Numbers in [0, 1]; ones if there are none.
fn numbers<const N: usize>(raw: Option<Raw<'_>>, at: &str) -> Result<[f64; N], ConvertError> {
    let Some(raw) = raw else { return Ok([1.0; N]) };
    let items = raw.items().unwrap_or_default();
    let mut out = [0.0; N];
    if items.len() != N {
        let got = raw.text().chars().take(40).collect();
        let allowed = if N == 4 { "an array of 4 numbers" } else { "an array of 3 numbers" };
        return Err(ConvertError::Value { at: at.to_owned(), got, allowed });
    }
    for (i, item) in items.into_iter().enumerate() {
        out[i] = number(item, &format!("{at}[{i}]"))?;
    }
    Ok(out)
}

impl<'a> Images<'a> {
    pub(super) fn new(root: Raw<'a>, bin: Option<&'a [u8]>, request: &'a Request) -> Images<'a> {
        let list = |key: &str| root.get(key).and_then(Raw::items).unwrap_or_default();
        Images { textures: list("textures"), samplers: list("samplers"), tree: root.value(), bin, request }
    }

    fn texture(&self, info: Raw<'a>, at: &str) -> Result<Texture<'a>, SceneWriteError> {
        let wrong = |why: &str| ConvertError::Image { at: at.to_owned(), why: why.to_owned() };
        let texture = index(info, "index").and_then(|i| self.textures.get(i).copied());
        let texture = texture.ok_or_else(|| wrong("it names no texture"))?;
        let image = index(texture, "source").ok_or_else(|| {
            wrong("its texture has no core image (PNG or JPEG), and others are not decoded here")
        })?;
        let picture = self.picture(image)?;
        let sampler = index(texture, "sampler");
        let mode = |key: &str| {
            let mode = sampler.and_then(|s| self.samplers.get(s)?.get(key)).and_then(|m| m.value().as_u64());
            match mode {
                Some(33071) => Wrap::Clamp,
                Some(33648) => Wrap::Mirror,
                _ => Wrap::Repeat,
            }
        };
        Ok(Texture { info, picture, sampler, wrap: [mode("wrapS"), mode("wrapT")] })
    }

    fn picture(&self, image: usize) -> Result<Picture, SceneWriteError> {
        let at = format!("images[{image}]");
        let wrong = |why: String| SceneWriteError::from(ConvertError::Image { at: at.clone(), why });
        let found = image_source(&self.tree, image, self.bin, &self.request.limits);
        let bytes = match found.map_err(|fault| wrong(fault.to_string()))? {
            Source::Missing(why) => return Err(wrong(why)),
            Source::Embedded(bytes) => bytes,
            Source::File { names, part } => {
                let file = files::read(self.request, &at, &names)?;
                let file = file.ok_or_else(|| wrong("its file is not there".to_owned()))?;
                let [from, length] = part.unwrap_or([0, file.len() as u64]);
                let from = usize::try_from(from).unwrap_or(usize::MAX);
                let end = from.saturating_add(usize::try_from(length).unwrap_or(usize::MAX));
                let beyond =
                    || wrong(format!("its buffer view ends beyond the {} bytes of its file", file.len()));
                file.get(from..end).map(<[u8]>::to_vec).ok_or_else(beyond)?
            }
        };
        picture::read_bytes(&bytes).map_err(|e| wrong(e.to_string()))
    }
}

/// A member that is an index or a length.
fn index(raw: Raw<'_>, key: &str) -> Option<usize> {
    usize::try_from(raw.get(key)?.value().as_u64()?).ok()
}
