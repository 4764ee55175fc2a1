//! What the textures of a material hold, texel by texel.

use crate::picture::{Picture, Space};
use crate::plan::scene::Pictures;
use crate::scene::{Channel, Look, Material, Property, Scene, dielectric_f0};
use std::path::Path;

/// The numbers of a material at a texel.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Texel {
    /// Base colour, linear.
    pub base: [f64; 3],
    /// Roughness of the base.
    pub roughness: f64,
    /// Metalness.
    pub metallic: f64,
    /// Reflectance of the dielectric at normal incidence, by channel, without its weight.
    pub f0: [f64; 3],
    /// Weight of what the dielectric reflects (`specularFactor`).
    pub specular: f64,
    /// Share of the diffuse light that goes through instead (`KHR_materials_transmission`, `KHR_materials_diffuse_transmission`).
    pub through: f64,
    /// Weight of the clear coat.
    pub coat: f64,
    /// Its roughness.
    pub coat_roughness: f64,
    /// Colour of the sheen, linear.
    pub sheen_colour: [f64; 3],
    /// Its largest channel.
    pub sheen: f64,
    /// Roughness of the sheen, as glTF has it.
    pub sheen_roughness: f64,
}

impl Texel {
    /// What decides over its values.
    pub(super) fn key(&self) -> [u64; 16] {
        let [a, b, c] = self.base;
        let [d, e, f] = self.sheen_colour;
        let [g, h, i] = self.f0;
        let lobes = [self.roughness, self.metallic, self.specular, self.through];
        let [j, k, l, m] = lobes;
        let [n, o, p] = [self.coat, self.coat_roughness, self.sheen_roughness];
        [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p].map(f64::to_bits)
    }

    /// Mean of what the dielectric reflects at normal incidence, with its weight.
    #[must_use]
    pub fn reflectance(&self) -> f64 {
        self.specular * self.f0.iter().sum::<f64>() / 3.0
    }
}

/// A number of a texel: a factor, and the plane that multiplies it.
struct Source {
    factor: f64,
    plane: Option<(usize, usize)>,
    space: Space,
}

/// The texels of a material. Textures of other sizes are read at the nearest texel.
#[derive(Debug)]
pub struct MaterialTexels {
    /// Width of the largest texture.
    pub width: usize,
    height: usize,
    pictures: Vec<Picture>,
    sources: Vec<Source>,
    /// F0 of the dielectric by its index alone.
    f0: f64,
    /// What is judged more simply than it is, and how.
    pub simplified: Vec<String>,
}

impl std::fmt::Debug for Source {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Source").field(&self.factor).field(&self.plane).finish()
    }
}

/// Extension, key, and which channel of a colour, in the order of [`MaterialTexels::get`].
const NUMBERS: [(&str, &str, Option<usize>); 17] = [
    ("", "baseColorFactor", Some(0)),
    ("", "baseColorFactor", Some(1)),
    ("", "baseColorFactor", Some(2)),
    ("", "roughnessFactor", None),
    ("", "metallicFactor", None),
    (COAT, "clearcoatFactor", None),
    (COAT, "clearcoatRoughnessFactor", None),
    (SHEEN, "sheenColorFactor", Some(0)),
    (SHEEN, "sheenColorFactor", Some(1)),
    (SHEEN, "sheenColorFactor", Some(2)),
    (SHEEN, "sheenRoughnessFactor", None),
    (SPECULAR, "specularFactor", None),
    (SPECULAR, "specularColorFactor", Some(0)),
    (SPECULAR, "specularColorFactor", Some(1)),
    (SPECULAR, "specularColorFactor", Some(2)),
    (TRANSMISSION, "transmissionFactor", None),
    (DIFFUSE_TRANSMISSION, "diffuseTransmissionFactor", None),
];
const COAT: &str = "KHR_materials_clearcoat";
const SHEEN: &str = "KHR_materials_sheen";
const SPECULAR: &str = "KHR_materials_specular";
const TRANSMISSION: &str = "KHR_materials_transmission";
const DIFFUSE_TRANSMISSION: &str = "KHR_materials_diffuse_transmission";

/// Layers that are not in the stack, by the factor that turns them on, and what stands for them.
const SIMPLER: [(&str, &str, &str); 2] = [
    ("KHR_materials_anisotropy", "anisotropyStrength", "its facets are judged with both widths alike"),
    ("KHR_materials_iridescence", "iridescenceFactor", "its film is left away"),
];

impl MaterialTexels {
    /// Reads the textures.
    ///
    /// # Errors
    /// Which picture cannot be read, and why.
    pub fn read(
        material: &Material,
        scene: &Scene,
        folder: &Path,
        maps: &Pictures,
    ) -> Result<MaterialTexels, String> {
        if material.extension(SPEC_GLOSS).is_some() && !material.metallic_roughness {
            return Err(format!("{SPEC_GLOSS}; `convert` makes metallic-roughness of it"));
        }
        let mut texels = MaterialTexels {
            width: 1,
            height: 1,
            pictures: Vec::new(),
            sources: Vec::new(),
            f0: dielectric_f0(material.range("KHR_materials_ior", "ior", &Look::none()).hi),
            simplified: simplified(material),
        };
        let mut read: Vec<usize> = Vec::new();
        for (extension, key, channel) in NUMBERS {
            let found = material.property(extension, key);
            let factor = found.map_or_else(
                || material.range(extension, key, &Look::none()).lo,
                |p| channel.map_or(p.factor[0], |c| p.values[c]),
            );
            let mut plane = None;
            if let Some(sampled) = found.and_then(|p| p.texture).filter(|_| factor != 0.0) {
                let image = sampled.image.ok_or_else(|| format!("{key}: its texture names no image"))?;
                let place = match read.iter().position(|i| *i == image) {
                    Some(place) => place,
                    None => {
                        texels.pictures.push(maps.picture(scene, image, folder)?);
                        read.push(image);
                        read.len() - 1
                    }
                };
                let wanted = channel.unwrap_or(match sampled.channel {
                    Channel::R => 0,
                    Channel::G => 1,
                    Channel::B => 2,
                    Channel::A => 3,
                });
                let names = ["R", "G", "B", "A"];
                let planes = &texels.pictures[place].planes;
                let at = planes.iter().position(|p| p.name == names[wanted]);
                // alpha is 1 where there is none
                plane = at
                    .or_else(|| planes.iter().position(|p| p.name == "Y" && wanted < 3))
                    .map(|p| (place, p));
            }
            let space = if channel.is_some() { Space::Srgb } else { Space::Linear };
            texels.sources.push(Source { factor, plane, space });
        }
        for picture in &texels.pictures {
            texels.width = texels.width.max(picture.width);
            texels.height = texels.height.max(picture.height);
        }
        Ok(texels)
    }

    /// Number of texels.
    #[must_use]
    pub fn len(&self) -> usize {
        self.width * self.height
    }

    /// Never: a material has a texel at least.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Texel number `i`, rows from the top.
    #[must_use]
    pub fn get(&self, i: usize) -> Texel {
        let (x, y) = (i % self.width, i / self.width);
        let number = |n: usize| {
            let source = &self.sources[n];
            source.plane.map_or(source.factor, |(picture, plane)| {
                let picture = &self.pictures[picture];
                let at = (y * picture.height / self.height) * picture.width + x * picture.width / self.width;
                source.factor * f64::from(source.space.decode(picture.planes[plane].values[at]))
            })
        };
        let sheen_colour = [number(7), number(8), number(9)];
        let specular = number(11);
        let [transmitted, scattered] = [number(15), number(16)];
        Texel {
            base: [number(0), number(1), number(2)],
            roughness: number(3),
            metallic: number(4),
            f0: [number(12), number(13), number(14)].map(|colour| (self.f0 * colour).min(1.0)),
            specular,
            through: 1.0 - (1.0 - transmitted) * (1.0 - scattered),
            coat: number(5),
            coat_roughness: number(6),
            sheen: sheen_colour.iter().copied().fold(0.0, f64::max),
            sheen_colour,
            sheen_roughness: number(10),
        }
    }
}

const SPEC_GLOSS: &str = "KHR_materials_pbrSpecularGlossiness";

/// What is judged more simply than the material is.
fn simplified(material: &Material) -> Vec<String> {
    let mut all = Vec::new();
    for (extension, key, instead) in SIMPLER {
        if material.property(extension, key).is_some_and(|p| p.animated || p.factor[1] > 0.0) {
            all.push(format!("{extension}: {instead}"));
        }
    }
    let found = || NUMBERS.iter().filter_map(|(extension, key, _)| material.property(extension, key));
    let mut moving: Vec<&str> = found().filter(|p| p.animated).map(|p| p.key).collect();
    moving.dedup();
    if !moving.is_empty() {
        all.push(format!("{} is animated, and judged as the file has it", moving.join(", ")));
    }
    // textures that are read in different ways meet in texels that nobody can pair
    let read = |p: &Property| p.texture.and_then(|t| t.reading).filter(|_| p.factor[1] != 0.0);
    let mut readings = found().filter_map(read);
    if let Some(first) = readings.next()
        && readings.any(|other| !other.meets(&first))
    {
        let why = "its textures are read by different UV sets, transforms or wrap modes, and paired as if they were not";
        all.push(why.to_owned());
    }
    all
}
