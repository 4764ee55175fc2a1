//! What the textures of a material hold, texel by texel.

use crate::picture::{Picture, Space};
use crate::plan::scene::Pictures;
use crate::scene::{Channel, Look, Material, Scene, dielectric_f0};
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
    /// Reflectance of the dielectric at normal incidence.
    pub f0: f64,
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
    pub(super) fn key(&self) -> [u64; 12] {
        let [a, b, c] = self.base;
        let [d, e, f] = self.sheen_colour;
        [
            a,
            b,
            c,
            d,
            e,
            f,
            self.roughness,
            self.metallic,
            self.f0,
            self.coat,
            self.coat_roughness,
            self.sheen_roughness,
        ]
        .map(f64::to_bits)
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
    f0: f64,
}

impl std::fmt::Debug for Source {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Source").field(&self.factor).field(&self.plane).finish()
    }
}

/// Extension, key, and which channel of a colour, in the order of [`MaterialTexels::get`].
const NUMBERS: [(&str, &str, Option<usize>); 11] = [
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
];
const COAT: &str = "KHR_materials_clearcoat";
const SHEEN: &str = "KHR_materials_sheen";

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
        let mut texels = MaterialTexels {
            width: 1,
            height: 1,
            pictures: Vec::new(),
            sources: Vec::new(),
            f0: dielectric(material),
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
        Texel {
            base: [number(0), number(1), number(2)],
            roughness: number(3),
            metallic: number(4),
            f0: self.f0,
            coat: number(5),
            coat_roughness: number(6),
            sheen: sheen_colour.iter().copied().fold(0.0, f64::max),
            sheen_colour,
            sheen_roughness: number(10),
        }
    }
}

/// F0 of the dielectric, its colour and weight by their factors.
fn dielectric(material: &Material) -> f64 {
    const SPECULAR: &str = "KHR_materials_specular";
    let value = |extension: &str, key: &str| material.range(extension, key, &Look::none()).hi;
    let ior = value("KHR_materials_ior", "ior");
    (dielectric_f0(ior) * value(SPECULAR, "specularColorFactor")).min(1.0) * value(SPECULAR, "specularFactor")
}
