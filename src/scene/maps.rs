//! The textures of a material's base layer that filtered maps are made of: which images, where they are read, and what keeps them from
//! being filtered together.

use super::embedded::Texture;
use super::error::Fault;
use super::json::{Allowed, Node, UNIT};
use super::material::{Animated, Material};
use crate::picture::Wrap;

/// A texture as a material reads it.
#[derive(Debug, Clone, PartialEq)]
pub struct MapTexture {
    /// Its image; none if it has none that is known.
    pub image: Option<usize>,
    /// The UV set.
    pub tex_coord: u64,
    /// `KHR_texture_transform`: offset, rotation, scale.
    pub transform: [f64; 5],
    /// What lies beyond the border.
    pub wrap: [Wrap; 2],
}

/// Normal and roughness of the base layer.
#[derive(Debug, Clone, PartialEq)]
pub struct Maps {
    /// `normalTexture`.
    pub normal: Option<MapTexture>,
    /// `metallicRoughnessTexture`.
    pub roughness: Option<MapTexture>,
    /// `anisotropyTexture` of `KHR_materials_anisotropy`.
    pub anisotropy: Option<MapTexture>,
    /// `anisotropyRotation`, in rad.
    pub rotation: f64,
    /// `normalTexture.scale`.
    pub scale: f64,
    /// Is that scale animated?
    pub moves: bool,
    /// Is that rotation animated?
    pub turns: bool,
}

impl Default for Maps {
    fn default() -> Maps {
        Maps {
            normal: None,
            roughness: None,
            anisotropy: None,
            rotation: 0.0,
            scale: 1.0,
            moves: false,
            turns: false,
        }
    }
}

/// A number of either sign.
const ANY: Allowed = Allowed { lo: f64::MIN, hi: f64::MAX, also: None, text: "any number" };

pub(super) const TRANSFORM: &str = "KHR_texture_transform";

const ANISOTROPY: &str = "KHR_materials_anisotropy";

/// Reads them.
pub(super) fn read(node: &Node<'_>, textures: &[Texture], animated: &Animated) -> Result<Maps, Fault> {
    let mut maps = Maps { moves: animated.contains("normalTexture/scale"), ..Maps::default() };
    if let Some(extensions) = node.get("extensions")?
        && let Some(own) = extensions.get(ANISOTROPY)?
    {
        maps.turns = animated.contains(&format!("extensions/{ANISOTROPY}/anisotropyRotation"));
        maps.rotation = own.factor("anisotropyRotation", 0.0, &ANY)?;
        maps.anisotropy = own.get("anisotropyTexture")?.map(|info| texture(&info, textures)).transpose()?;
    }
    if let Some(info) = node.get("normalTexture")? {
        maps.scale = info.factor("scale", 1.0, &ANY)?;
        maps.normal = Some(texture(&info, textures)?);
    }
    if let Some(pbr) = node.get("pbrMetallicRoughness")?
        && let Some(info) = pbr.get("metallicRoughnessTexture")?
    {
        maps.roughness = Some(texture(&info, textures)?);
    }
    Ok(maps)
}

fn texture(info: &Node<'_>, textures: &[Texture]) -> Result<MapTexture, Fault> {
    let index = info.need("index", "the index of a texture")?.index("textures", textures.len())?;
    let Texture { image, wrap, .. } = textures.get(index).copied().unwrap_or_default();
    let (tex_coord, transform) = placed(info)?;
    Ok(MapTexture { image, tex_coord, transform, wrap })
}

/// The UV set of a texture, and offset, rotation and scale of its `KHR_texture_transform`.
pub(super) fn placed(info: &Node<'_>) -> Result<(u64, [f64; 5]), Fault> {
    let mut tex_coord = info.get("texCoord")?.map_or(Ok(0), |set| set.whole())?;
    let mut transform = [0.0, 0.0, 0.0, 1.0, 1.0];
    if let Some(extensions) = info.get("extensions")?
        && let Some(own) = extensions.get(TRANSFORM)?
    {
        tex_coord = own.get("texCoord")?.map_or(Ok(tex_coord), |set| set.whole())?;
        transform[2] = own.factor("rotation", 0.0, &ANY)?;
        for (key, at) in [("offset", 0), ("scale", 3)] {
            let Some(pair) = own.get(key)? else { continue };
            for (to, number) in transform[at..at + 2].iter_mut().zip(pair.items()?) {
                *to = number.number(&ANY)?;
            }
        }
    }
    Ok((tex_coord, transform))
}

/// How two textures are read differently, in words.
fn differ((first, n): (&str, &MapTexture), (second, r): (&str, &MapTexture)) -> Option<String> {
    let told = |what: &str, a: String, b: String| Some(format!("{first} has {what} {a}, and {second} {b}"));
    if n.tex_coord != r.tex_coord {
        return told("UV set", n.tex_coord.to_string(), r.tex_coord.to_string());
    }
    if n.transform.map(f64::to_bits) != r.transform.map(f64::to_bits) {
        return told(TRANSFORM, format!("{:?}", n.transform), format!("{:?}", r.transform));
    }
    (n.wrap != r.wrap).then(|| told("wrap", format!("{:?}", n.wrap), format!("{:?}", r.wrap)))?
}

impl Material {
    /// Does the material have textures that filtered maps can be made of?
    #[must_use]
    pub fn has_maps(&self) -> bool {
        let Maps { normal, roughness, anisotropy, .. } = &self.maps;
        let stretched = anisotropy.is_some() && self.stretch() > 0.0;
        !self.is_unlit() && (normal.is_some() || roughness.is_some() || stretched)
    }

    /// What keeps its textures from being filtered, if anything.
    #[must_use]
    pub fn bars_maps(&self) -> Option<String> {
        let Maps { normal, roughness, anisotropy, moves, turns, .. } = &self.maps;
        let on = |name: &str| self.extension(name).is_some();
        let animated = self.property("", "roughnessFactor").is_some_and(|p| p.animated);
        if on("KHR_materials_pbrSpecularGlossiness") && !self.metallic_roughness {
            return Some(
                "its roughness is in a specular-glossiness texture; convert the scene first".to_owned(),
            );
        }
        if self.extensions.iter().any(|e| e.name.starts_with("MSFT_packing")) {
            return Some("its roughness is in a texture of another packing".to_owned());
        }
        let strength = self.property(ANISOTROPY, "anisotropyStrength");
        if strength.is_some_and(|p| p.animated) || (*turns && self.stretch() > 0.0) {
            let what = if *turns { "the rotation" } else { "the strength" };
            return Some(format!("{what} of its anisotropy is animated, and a map stands for one value"));
        }
        if animated || *moves {
            let what = if animated { "roughnessFactor" } else { "the scale of its normals" };
            return Some(format!("{what} is animated, and a map stands for one value"));
        }
        let stretched = anisotropy.as_ref().filter(|_| self.stretch() > 0.0);
        let all = [
            ("normalTexture", normal.as_ref()),
            ("metallicRoughnessTexture", roughness.as_ref()),
            ("anisotropyTexture", stretched),
        ];
        let mut read = all.into_iter().filter_map(|(name, texture)| Some((name, texture?)));
        let (first, n) = read.next()?;
        read.find_map(|(second, r)| differ((first, n), (second, r)))
    }

    /// The strength of its anisotropy, a factor of that of its texture; 0 without one.
    #[must_use]
    pub fn stretch(&self) -> f64 {
        self.property(ANISOTROPY, "anisotropyStrength").map_or(0.0, |p| p.factor[1].clamp(UNIT.lo, UNIT.hi))
    }

    /// Will filtered maps widen its roughness? Lobes stand for the normals of a footprint where there is a normal map.
    #[must_use]
    pub fn widens(&self) -> bool {
        self.has_maps() && self.maps.normal.is_some() && self.bars_maps().is_none()
    }

    /// The factor of its roughness.
    #[must_use]
    pub fn roughness_factor(&self) -> f64 {
        self.property("", "roughnessFactor").map_or(1.0, |p| p.factor[1].clamp(UNIT.lo, UNIT.hi))
    }
}
