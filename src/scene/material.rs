//! A material: the numbers that decide which tables it asks for, checked one by one.
//!
//! What is read of an extension is what its line in the [registry](super::EXTENSIONS) declares.

use std::collections::BTreeSet;

use super::embedded::Texture;
use super::error::Fault;
use super::extension::{self, Asks, Switch};
use super::factor::{Channel, Factor, Interval, Property, Sampled};
use super::geometry::Reading;
use super::image::Look;
use super::json::{Allowed, Node, UNIT};
use super::maps::{self, Maps, TRANSFORM};

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
    /// The numbers that its line in the registry declares; empty if it has none.
    pub properties: Vec<Property>,
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
    /// True if something that has normals uses it: points and lines without them are unlit (glTF 2.0 §3.9.1).
    pub lit: bool,
    /// True if it says `pbrMetallicRoughness`. Without that all factors have their defaults.
    pub metallic_roughness: bool,
    /// The numbers of `pbrMetallicRoughness`, by [`CORE`].
    pub core: Vec<Property>,
    /// Its extensions, in the file's order.
    pub extensions: Vec<MaterialExtension>,
    /// Materials that stand in for it at a distance (`MSFT_lod`).
    pub lods: Vec<usize>,
    /// The textures that filtered maps are made of.
    pub maps: Maps,
}

/// The base layer: glTF 2.0 §3.9.2. The texture has metalness in blue and roughness in green.
pub static CORE: &[Factor] = &[
    Factor::textured("roughnessFactor", 1.0, &UNIT, (CORE_TEXTURE, Channel::G)),
    Factor::textured("metallicFactor", 1.0, &UNIT, (CORE_TEXTURE, Channel::B)),
    Factor::colour("baseColorFactor", 1.0, &UNIT, "baseColorTexture", 4),
];

const CORE_TEXTURE: &str = "metallicRoughnessTexture";

/// Textures of `MSFT_packing_*` that hold roughness and metalness, with their channels.
const PACKED: [(&str, [Channel; 2]); 3] = [
    ("occlusionRoughnessMetallicTexture", [Channel::G, Channel::B]),
    ("roughnessMetallicOcclusionTexture", [Channel::R, Channel::G]),
    ("normalRoughnessMetallicTexture", [Channel::B, Channel::A]),
];

impl MaterialExtension {
    /// Whether it does anything, as far as its textures are known.
    #[must_use]
    pub fn state(&self, look: &Look) -> State {
        let on = extension::find(&self.name).map_or(&Switch::Always, |x| &x.on);
        let Switch::Factor(key) = on else { return State::On("present".to_owned()) };
        let Some(property) = self.properties.iter().find(|p| p.key == *key) else {
            return State::On("present".to_owned());
        };
        let [on, zero] = if property.colour { ["is not black", "is black"] } else { ["> 0", "= 0"] };
        if property.animated {
            return State::On(format!("{key} is animated"));
        }
        if property.factor[1] <= 0.0 {
            return State::Off(format!("{key} {zero}"));
        }
        if property.range(look).hi <= 0.0 {
            return State::Off(format!("the texture of {key} is black"));
        }
        if property.colour {
            State::On(format!("{key} {on}"))
        } else {
            State::On(format!("{key} = {}", property.factor[1]))
        }
    }
}

impl Material {
    /// An extension of this name.
    #[must_use]
    pub fn extension(&self, name: &str) -> Option<&MaterialExtension> {
        self.extensions.iter().find(|e| e.name == name)
    }

    /// A number as it was read, of an extension or, if `extension` is empty, of the base layer.
    #[must_use]
    pub fn property(&self, extension: &str, key: &str) -> Option<&Property> {
        let properties = match extension {
            "" => Some(&self.core),
            name => self.extension(name).map(|e| &e.properties),
        };
        properties?.iter().find(|p| p.key == key)
    }

    /// Is its colour constant, whatever lights it (`KHR_materials_unlit`)?
    #[must_use]
    pub fn is_unlit(&self) -> bool {
        self.asks(|asks| matches!(asks, Asks::Unlit))
    }

    /// Does another material model take the place of glTF's?
    #[must_use]
    pub fn is_replaced(&self) -> bool {
        self.asks(|asks| matches!(asks, Asks::Replaced(_)))
    }

    /// The values of a number of an extension, or of the base layer if `extension` is empty; the default where the extension is not there.
    #[must_use]
    pub fn range(&self, extension: &str, key: &str, look: &Look) -> Interval {
        let found = self.property(extension, key);
        let factors = if extension.is_empty() {
            CORE
        } else {
            extension::find(extension).map_or(&[][..], |x| x.factors)
        };
        let default = || factors.iter().find(|f| f.key == key).map_or(0.0, |f| f.default);
        found.map_or_else(|| Interval::constant(default()), |p| p.range(look))
    }

    /// Does an extension do anything here?
    #[must_use]
    pub fn has(&self, extension: &str, look: &Look) -> bool {
        self.extension(extension).is_some_and(|e| matches!(e.state(look), State::On(_)))
    }

    /// Does any of its extensions ask for this?
    pub(super) fn asks(&self, what: impl Fn(&Asks) -> bool) -> bool {
        self.extensions.iter().any(|e| extension::find(&e.name).is_some_and(|x| what(&x.asks)))
    }

    /// The textures that multiply its numbers, and those of its colours.
    pub(super) fn sampled(&self, colours: bool) -> impl Iterator<Item = Sampled> + '_ {
        let all = self.core.iter().chain(self.extensions.iter().flat_map(|e| &e.properties));
        all.filter(move |p| (colours || !p.colour) && !p.animated && p.factor[1] != 0.0)
            .filter_map(|p| p.texture)
    }
}

/// The properties of one material that an animation changes, as JSON pointers below the material.
pub(super) type Animated = BTreeSet<String>;

/// What an index of a material may point at.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tables<'a> {
    /// Number of materials.
    pub(super) materials: usize,
    /// The image of each texture.
    pub(super) textures: &'a [Texture],
    /// Is it asked which texels are read?
    pub(super) texels: bool,
}

/// The material whose textures are read.
#[derive(Clone, Copy)]
struct Owner<'a> {
    index: usize,
    tables: Tables<'a>,
    animated: &'a Animated,
}

/// Reads `materials[index]`. It is not marked as used.
pub(super) fn read(
    node: &Node<'_>,
    index: usize,
    tables: Tables<'_>,
    animated: &Animated,
) -> Result<Material, Fault> {
    let name = node.get("name")?.map(|name| name.text().map(str::to_owned)).transpose()?;
    let mut material = Material {
        index,
        name,
        used: false,
        lit: false,
        metallic_roughness: false,
        core: Vec::new(),
        extensions: Vec::new(),
        lods: Vec::new(),
        maps: maps::read(node, tables.textures, animated)?,
    };
    let owner = Owner { index, tables, animated };
    // The two extensions that pack roughness into another texture replace the core texture.
    let mut packed = None;
    if let Some(extensions) = node.get("extensions")? {
        for (name, extension) in extensions.members()? {
            let known = extension::find(name);
            let prefix = format!("extensions/{name}");
            if matches!(known.map(|x| &x.asks), Some(Asks::RoughnessTexture)) {
                packed = Some(read_packed(&extension, &prefix, owner)?);
            }
            let factors = known.map_or(&[][..], |x| x.factors);
            let properties = read_factors(&extension, factors, &prefix, owner)?;
            material.extensions.push(MaterialExtension { name: name.to_owned(), properties });
            if name == "MSFT_lod" {
                for id in extension.need("ids", "an array of material indices")?.items()? {
                    material.lods.push(id.index("materials", tables.materials)?);
                }
            }
        }
    }
    material.core = match node.get("pbrMetallicRoughness")? {
        Some(pbr) => {
            material.metallic_roughness = true;
            read_factors(&pbr, CORE, "pbrMetallicRoughness", owner)?
        }
        None => CORE.iter().map(default).collect(),
    };
    for (property, texture) in material.core.iter_mut().zip(packed.into_iter().flatten()) {
        property.texture = Some(texture);
    }
    Ok(material)
}

fn default(factor: &Factor) -> Property {
    Property {
        key: factor.key,
        factor: [factor.default; 2],
        values: [factor.default; 3],
        texture: None,
        animated: false,
        allowed: reach(factor.allowed),
        colour: factor.channels > 1,
    }
}

/// What an animation can make of a number: all that is allowed, where that is bounded.
fn reach(allowed: &Allowed) -> [f64; 2] {
    [allowed.lo, allowed.hi]
}

/// The textures of roughness and metalness of an `MSFT_packing_*` extension.
fn read_packed(node: &Node<'_>, prefix: &str, owner: Owner<'_>) -> Result<[Sampled; 2], Fault> {
    for (key, channels) in PACKED {
        if let Some((image, reading)) = texture(node, key, prefix, owner)? {
            return Ok(channels.map(|channel| Sampled { image, channel, reading }));
        }
    }
    Ok([Channel::G, Channel::B].map(|channel| Sampled { image: None, channel, reading: None }))
}

fn read_factors(
    node: &Node<'_>,
    factors: &'static [Factor],
    prefix: &str,
    owner: Owner<'_>,
) -> Result<Vec<Property>, Fault> {
    let mut all = Vec::with_capacity(factors.len());
    for factor in factors {
        let values = if factor.channels > 1 {
            node.channels(factor)?
        } else {
            [node.factor(factor.key, factor.default, factor.allowed)?; 3]
        };
        let ends = [
            values.iter().copied().fold(f64::INFINITY, f64::min),
            values.iter().copied().fold(0.0, f64::max),
        ];
        // a number may be negative; a colour is not
        let ends = if factor.channels > 1 { ends } else { [values[0]; 2] };
        let mut sampled = None;
        if let Some((key, channel)) = factor.texture {
            let found = texture(node, key, prefix, owner)?;
            sampled = found.map(|(image, reading)| Sampled { image, channel, reading });
        }
        let animated = owner.animated.contains(&format!("{prefix}/{}", factor.key));
        all.push(Property { factor: ends, values, texture: sampled, animated, ..default(factor) });
    }
    Ok(all)
}

/// An image, and how it is read.
type FoundTexture = (Option<usize>, Option<Reading>);

/// The image of a `textureInfo`, if that is there. Its index is checked.
fn texture(
    node: &Node<'_>,
    key: &str,
    prefix: &str,
    owner: Owner<'_>,
) -> Result<Option<FoundTexture>, Fault> {
    let Some(info) = node.get(key)? else { return Ok(None) };
    let textures = owner.tables.textures;
    let index = info.need("index", "the index of a texture")?.index("textures", textures.len())?;
    let texture = textures.get(index).copied().unwrap_or_default();
    let reading = match texture.image {
        Some(_) if owner.tables.texels => {
            let path = format!("{prefix}/{key}/extensions/{TRANSFORM}");
            let moves = owner.animated.iter().any(|p| p.starts_with(&path));
            Some(Reading::new(owner.index, &info, texture, moves)?)
        }
        _ => None,
    };
    Ok(Some((texture.image, reading)))
}
