//! Recipes that come with the program: the files of `presets/`.

use super::{RecipeError, parse};
use crate::plan::Plan;

/// A recipe that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Preset {
    /// Id: the file name without `.toml`, and the name in the file.
    pub id: &'static str,
    /// Who needs it.
    pub doc: &'static str,
    /// The text of the file.
    pub source: &'static str,
}

macro_rules! preset {
    ($id:literal, $doc:literal) => {
        Preset { id: $id, doc: $doc, source: include_str!(concat!("../../presets/", $id, ".toml")) }
    };
}

/// Every preset; the first is what `bake` takes if no recipe is given.
pub static PRESETS: &[Preset] = &[
    preset!("default", "a first look: the tables of a glossy surface, on the axes that converge best"),
    preset!(
        "split-sum",
        "image-based lighting with the axes that most engines read: 128 x 128, linear, texel centres"
    ),
    preset!(
        "split-sum-compact",
        "the same integrals in 32 x 32 texels, for a shader that can take a square root"
    ),
    preset!(
        "split-sum-factored",
        "64 x 64 texels that read to within 4.5e-4 everywhere, for a shader that can take a power and a product"
    ),
    preset!(
        "energy-compensation",
        "directional and average albedo of white GGX and Beckmann, for multiple scattering"
    ),
    preset!("energy", "albedos of reflecting lobes, what they lose, and factors and lobes that give it back"),
    preset!("glass", "rough glass from both sides: reflection, transmission, averages, compensation"),
    preset!("layers", "split sums with F82, cloth and diffuse channels; sheens and clear coats"),
    preset!("fresnel", "dielectric Fresnel reflectance from both sides, for water, glass and skin"),
    preset!(
        "ggx",
        "split sum, directional and average albedo of GGX: what `bake --scene` bakes for glTF materials"
    ),
    preset!("ltc", "area lights: the matrices and magnitudes of linearly transformed cosines for GGX"),
    preset!(
        "skin",
        "skin: pre-integrated diffusion, profiles, blur kernels, Gaussians, transmittance, and their samples"
    ),
    preset!(
        "volume",
        "fog, water and fire: phase functions and their samples, transmittance, Fresnel of water, black bodies"
    ),
    preset!("colour", "metals and thin films in colour, Schlick's factor, masking and visibility"),
    preset!("tabulated", "GGX as a MERL binary, and as directions that sample it"),
    preset!(
        "mitsuba",
        "Mitsuba 3, whose masking is separable: albedos, split sum and glass over alpha, as EXR and NumPy modules"
    ),
    preset!("everything", "every kind of table on its own axes: a check of the whole, and a catalogue"),
    preset!("kelemen-skin", "the Beckmann texture of the skin shader of GPU Gems 3, chapter 14"),
];

/// Finds a preset by its id.
#[must_use]
pub fn preset(id: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|p| p.id == id)
}

impl Preset {
    /// Resolves it.
    ///
    /// # Errors
    /// None for the presets in [`PRESETS`]: a test parses them all.
    pub fn plan(&self) -> Result<Plan, RecipeError> {
        parse(self.source, &format!("presets/{}.toml", self.id))
    }
}
