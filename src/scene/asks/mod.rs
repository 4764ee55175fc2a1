//! What layers of a material ask for: one file a layer, with the lines of its extensions for the registry.

pub(super) mod anisotropy;
pub(super) mod base;
pub(super) mod coats;
pub(super) mod diffuse;
pub(super) mod film;
pub(super) mod glass;
pub(super) mod scattering;
pub(super) mod sheen;
pub(super) mod spec_gloss;

use super::factor::{Interval, Spread};
use super::image::Look;
use super::material::Material;
use super::reader::Reader;

/// A lit material in use, as its layers see it.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a> {
    /// The material.
    pub material: &'a Material,
    /// What its textures hold.
    pub look: &'a Look,
    /// How shaders take its roughness.
    pub reader: &'a Reader,
}

/// What a layer asks for.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// Tables of a family.
    Ask {
        /// Id of the family.
        family: &'static str,
        /// Name of the layer, for reports.
        layer: &'static str,
        /// What its tables are functions of, by the id of the quantity.
        ranges: Vec<(&'static str, Interval)>,
    },
    /// No table: it has no effect, is a closed form, or is read from the tables of another layer.
    Nothing(String),
    /// Something that cannot be told from the file.
    Unknown(String),
}

impl Answer {
    fn nothing(why: &str) -> Vec<Answer> {
        vec![Answer::Nothing(why.to_owned())]
    }
}

impl Subject<'_> {
    /// The values of a number of an extension; its default where the extension is not there.
    #[must_use]
    pub fn range(&self, extension: &str, key: &str) -> Interval {
        self.material.range(extension, key, self.look)
    }

    /// Does an extension do anything here?
    #[must_use]
    pub fn has(&self, extension: &str) -> bool {
        self.material.has(extension, self.look)
    }

    /// Perceptual roughness of the base layer.
    #[must_use]
    pub fn roughness(&self) -> Interval {
        let own = self.reader.roughness(self.range("", "roughnessFactor"));
        if self.reader.maps && self.material.widens() {
            return Interval { hi: 1.0, spread: Spread::Maps, ..own };
        }
        own
    }

    /// Perceptual roughness of another lobe of the material.
    #[must_use]
    pub fn rough(&self, extension: &str, key: &str) -> Interval {
        self.reader.roughness(self.range(extension, key))
    }

    /// Metalness of the base layer.
    #[must_use]
    pub fn metallic(&self) -> Interval {
        self.range("", "metallicFactor")
    }

    /// Index of refraction; 0 stands for a dielectric with F0 = 1.
    #[must_use]
    pub fn ior(&self) -> Interval {
        self.range("KHR_materials_ior", "ior")
    }

    /// Reflectance of the base layer at normal incidence, all channels, where dielectric and metal are mixed by metalness
    /// (glTF 2.0 §3.9.2, `KHR_materials_specular`).
    #[must_use]
    pub fn f0(&self) -> Interval {
        const SPECULAR: &str = "KHR_materials_specular";
        let weight = self.range(SPECULAR, "specularFactor");
        let colour = self.range(SPECULAR, "specularColorFactor");
        let tinted = self.ior().map(dielectric_f0).rising(colour, |f0, c| (f0 * c).min(1.0));
        let below = tinted.rising(weight, |f0, w| f0 * w);
        let metal = self.range("", "baseColorFactor");
        let part = self.metallic();
        let mix = |m: f64, d: f64, c: f64| d + m * (c - d);
        let ends = [(part.lo, below.lo, metal.lo), (part.hi, below.lo, metal.lo)];
        let tops = [(part.lo, below.hi, metal.hi), (part.hi, below.hi, metal.hi)];
        let of = |(m, d, c): (f64, f64, f64)| mix(m, d, c);
        let spread = [part.spread, below.spread, metal.spread];
        let changes = spread.into_iter().find(|s| *s != Spread::Constant);
        Interval {
            lo: of(ends[0]).min(of(ends[1])),
            hi: of(tops[0]).max(of(tops[1])),
            spread: changes.unwrap_or(Spread::Constant),
        }
    }
}

/// Reflectance of a dielectric at normal incidence, ((n - 1) / (n + 1))²; 1 for the index 0 (`KHR_materials_ior`).
#[must_use]
pub fn dielectric_f0(ior: f64) -> f64 {
    let root = (ior - 1.0) / (ior + 1.0);
    if ior == 0.0 { 1.0 } else { root * root }
}

/// Is a lobe of this roughness a mirror everywhere? Its reflectance is Fresnel's formula.
fn mirror(roughness: Interval) -> bool {
    roughness.hi <= 0.0
}

const MIRROR: &str = "roughness 0: a mirror, whose reflectance is the Fresnel factor itself";
