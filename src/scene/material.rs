//! A material: the few factors that decide which tables it asks for, checked one by one.

use std::collections::BTreeSet;
use std::fmt;

use super::error::Fault;
use super::extension::{self, Asks, Lobe, Switch};
use super::json::{IOR, Node, UNIT};

/// What lets a factor take more than one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spread {
    /// Nothing: it is the same everywhere and always.
    Constant,
    /// A texture that multiplies the factor by something in [0, 1].
    Texture,
    /// An animation (`KHR_animation_pointer`).
    Animation,
}

/// The values that a factor can take over a surface and over time, in [0, 1].
///
/// Accuracy: `serde_json` reads a decimal to within 1 ulp, so 0.029999999329447746 may end in 3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Smallest value.
    pub lo: f64,
    /// Largest value.
    pub hi: f64,
    /// Why they differ.
    pub spread: Spread,
}

impl Interval {
    /// One value, everywhere and always.
    #[must_use]
    pub fn constant(x: f64) -> Self {
        Self { lo: x, hi: x, spread: Spread::Constant }
    }

    /// A factor in [0, 1]: a texture spreads it over [0, factor], an animation over [0, 1].
    fn new(factor: f64, textured: bool, animated: bool) -> Self {
        match (animated, textured) {
            (true, _) => Self { lo: 0.0, hi: 1.0, spread: Spread::Animation },
            (false, true) => Self { lo: 0.0, hi: factor, spread: Spread::Texture },
            (false, false) => Self::constant(factor),
        }
    }

    /// 1 − x: from glossiness to roughness.
    fn flipped(self) -> Self {
        Self { lo: 1.0 - self.hi, hi: 1.0 - self.lo, spread: self.spread }
    }
}

impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.spread {
            Spread::Constant => write!(f, "{}", self.lo),
            Spread::Texture => write!(f, "[{}, {}] (texture)", self.lo, self.hi),
            Spread::Animation => write!(f, "[{}, {}] (animation)", self.lo, self.hi),
        }
    }
}

/// Whether an extension of a material does anything there, with the factor that says so.
#[derive(Debug, Clone, PartialEq)]
pub enum State {
    /// It does: `clearcoatFactor = 1`, or only the extension's presence.
    On(String),
    /// It does not: `clearcoatFactor = 0`.
    Off(String),
}

/// An extension of a material.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialExtension {
    /// Its name, as in the file.
    pub name: String,
    /// Whether it does anything.
    pub state: State,
    /// Roughness of its own lobe, if it is a known one that has a lobe.
    pub roughness: Option<Interval>,
}

/// A material of the file. Every factor was checked against its range.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Position in the file.
    pub index: usize,
    /// Its name, as in the file: any text at all.
    pub name: Option<String>,
    /// True if a mesh primitive uses it, by itself, by a variant or as a level of detail.
    pub used: bool,
    /// True if it says `pbrMetallicRoughness`. Without that all factors have their defaults.
    pub metallic_roughness: bool,
    /// Roughness of the base layer, perceptual (alpha = roughness²).
    pub roughness: Interval,
    /// Metalness of the base layer.
    pub metallic: Interval,
    /// `specularFactor` of `KHR_materials_specular`: weight of the dielectric reflection.
    pub specular: Interval,
    /// Index of refraction of `KHR_materials_ior`; 0 means F0 = 1.
    pub ior: f64,
    /// Its extensions, in the file's order.
    pub extensions: Vec<MaterialExtension>,
    /// Materials that stand in for it at a distance (`MSFT_lod`).
    pub lods: Vec<usize>,
}

impl Material {
    /// True if the material is a constant colour (`KHR_materials_unlit`).
    #[must_use]
    pub fn unlit(&self) -> bool {
        self.extensions.iter().any(|e| matches!(extension::find(&e.name).map(|x| &x.asks), Some(Asks::Unlit)))
    }

    /// True if the base layer reflects nothing: no metal, and a dielectric with `specularFactor` 0.
    #[must_use]
    pub fn base_is_black(&self) -> bool {
        self.metallic.hi == 0.0 && self.specular.hi == 0.0
    }
}

/// The properties of one material that an animation changes, as JSON pointers below the material.
pub(super) type Animated = BTreeSet<String>;

/// How many things an index of a material may point at.
#[derive(Debug, Clone, Copy)]
pub(super) struct Counts {
    pub(super) materials: usize,
    pub(super) textures: usize,
}

/// Reads `materials[index]`. `used` is left false.
pub(super) fn read(
    node: &Node<'_>,
    index: usize,
    counts: Counts,
    animated: &Animated,
) -> Result<Material, Fault> {
    let name = node.get("name")?.map(|name| name.text().map(str::to_owned)).transpose()?;
    let mut material = Material {
        index,
        name,
        used: false,
        metallic_roughness: false,
        roughness: Interval::new(1.0, false, false),
        metallic: Interval::new(1.0, false, false),
        specular: Interval::new(1.0, false, false),
        ior: 1.5,
        extensions: Vec::new(),
        lods: Vec::new(),
    };
    // The two extensions that pack roughness into another texture replace the core texture.
    let mut packed = false;
    if let Some(extensions) = node.get("extensions")? {
        for (name, extension) in extensions.members()? {
            packed |= matches!(extension::find(name).map(|x| &x.asks), Some(Asks::RoughnessTexture));
            material.extensions.push(read_extension(name, &extension, counts, animated)?);
            read_base_extension(name, &extension, counts, animated, &mut material)?;
        }
    }
    read_core(node, counts, animated, packed, &mut material)?;
    Ok(material)
}

/// The base layer: glTF 2.0 §3.9.2, defaults metallic 1 and roughness 1.
fn read_core(
    node: &Node<'_>,
    counts: Counts,
    animated: &Animated,
    packed: bool,
    material: &mut Material,
) -> Result<(), Fault> {
    let Some(pbr) = node.get("pbrMetallicRoughness")? else {
        material.roughness = Interval::new(1.0, packed, false);
        material.metallic = Interval::new(1.0, packed, false);
        return Ok(());
    };
    material.metallic_roughness = true;
    let textured = has_texture(&pbr, "metallicRoughnessTexture", counts)? || packed;
    let moves = |key: &str| animated.contains(&format!("pbrMetallicRoughness/{key}"));
    let roughness = pbr.factor("roughnessFactor", 1.0, &UNIT)?;
    material.roughness = Interval::new(roughness, textured, moves("roughnessFactor"));
    let metallic = pbr.factor("metallicFactor", 1.0, &UNIT)?;
    material.metallic = Interval::new(metallic, textured, moves("metallicFactor"));
    Ok(())
}

/// The factors of extensions that change the base layer, and the list of `MSFT_lod`.
fn read_base_extension(
    name: &str,
    node: &Node<'_>,
    counts: Counts,
    animated: &Animated,
    material: &mut Material,
) -> Result<(), Fault> {
    match name {
        "KHR_materials_ior" => material.ior = node.factor("ior", 1.5, &IOR)?,
        "KHR_materials_specular" => {
            let factor = node.factor("specularFactor", 1.0, &UNIT)?;
            let moves = animated.contains("extensions/KHR_materials_specular/specularFactor");
            material.specular = Interval::new(factor, has_texture(node, "specularTexture", counts)?, moves);
        }
        "MSFT_lod" => {
            for id in node.need("ids", "an array of material indices")?.items()? {
                material.lods.push(id.index("materials", counts.materials)?);
            }
        }
        _ => {}
    }
    Ok(())
}

/// Any extension: its switch and the roughness of its lobe, by the registry.
fn read_extension(
    name: &str,
    node: &Node<'_>,
    counts: Counts,
    animated: &Animated,
) -> Result<MaterialExtension, Fault> {
    let moves = |key: &str| animated.contains(&format!("extensions/{name}/{key}"));
    let (state, roughness) = match extension::find(name).map(|x| &x.asks) {
        Some(Asks::Lobe(lobe)) => {
            (read_switch(&lobe.on, node, &moves)?, Some(read_lobe(lobe, node, counts, moves(lobe.factor))?))
        }
        Some(Asks::NotYet { on, .. }) => (read_switch(on, node, &moves)?, None),
        _ => (State::On("present".to_owned()), None),
    };
    Ok(MaterialExtension { name: name.to_owned(), state, roughness })
}

fn read_lobe(lobe: &Lobe, node: &Node<'_>, counts: Counts, moves: bool) -> Result<Interval, Fault> {
    let factor = node.factor(lobe.factor, lobe.default, &UNIT)?;
    let interval = Interval::new(factor, has_texture(node, lobe.texture, counts)?, moves);
    Ok(if lobe.glossiness { interval.flipped() } else { interval })
}

fn read_switch(switch: &Switch, node: &Node<'_>, moves: &dyn Fn(&str) -> bool) -> Result<State, Fault> {
    let (key, strength) = match switch {
        Switch::Always => return Ok(State::On("present".to_owned())),
        Switch::Factor(key, allowed) => (key, node.factor(key, 0.0, allowed)?),
        Switch::Colour(key, allowed) => (key, node.brightest(key, allowed)?),
    };
    let colour = matches!(switch, Switch::Colour(..));
    Ok(match (strength > 0.0, moves(key)) {
        (_, true) => State::On(format!("{key} is animated")),
        (true, false) if colour => State::On(format!("{key} is not black")),
        (true, false) => State::On(format!("{key} = {strength}")),
        (false, false) if colour => State::Off(format!("{key} is black")),
        (false, false) => State::Off(format!("{key} = 0")),
    })
}

/// True if a `textureInfo` is there. Its index is checked; the texture itself is not looked at.
fn has_texture(node: &Node<'_>, key: &str, counts: Counts) -> Result<bool, Fault> {
    let Some(info) = node.get(key)? else { return Ok(false) };
    info.need("index", "the index of a texture")?.index("textures", counts.textures)?;
    Ok(true)
}
