//! The registry of glTF extensions: what each one asks of the baker. One line an extension.
//!
//! An extension that is missing here is reported as unknown, never ignored. One that asks for tables has its line in a file of
//! [`asks`](super::asks), with the numbers that it reads and what it makes of them. One that would need a table kind that does
//! not exist names that kind ([`Asks::NotYet`]); once the kind is there, a test says so.
//!
//! Source: extensions/README.md of the glTF repository of the Khronos Group, and the open proposals there.

use super::asks::{
    Answer, Subject, anisotropy, base as layer, coats, diffuse, film, glass, scattering, sheen, spec_gloss,
};
use super::factor::Factor;

/// Id of the table family of the GGX lobe.
pub const GGX: &str = "ggx";
/// Id of the family of coats of a fixed index.
pub const COAT: &str = "coat";
/// Id of the family of rough interfaces, seen from both sides.
pub const GLASS: &str = "glass";
/// Id of the family of Charlie's sheen.
pub const SHEEN: &str = "sheen";
/// Id of the family of layers of fibres.
pub const FUZZ: &str = "fuzz";
/// Id of the family of thin films.
pub const FILM: &str = "film";
/// Id of the family of anisotropic GGX lobes.
pub const ANISOTROPIC: &str = "anisotropic";
/// Id of the family of rough diffuse lobes.
pub const ROUGH_DIFFUSE: &str = "rough-diffuse";
/// Id of the family of phase functions.
pub const PHASE: &str = "phase";
/// Id of the family of diffusion profiles.
pub const SUBSURFACE: &str = "subsurface";
/// Id of the family of transformed cosines, for area lights.
pub const AREA_LIGHT: &str = "area-light";

/// An extension and what it asks for.
#[derive(Debug)]
pub struct Extension {
    /// Name as `extensionsUsed` spells it.
    pub name: &'static str,
    /// When it does anything.
    pub on: Switch,
    /// The numbers that are read.
    pub factors: &'static [Factor],
    /// What it asks for.
    pub asks: Asks,
}

/// What an extension asks for.
#[derive(Debug)]
pub enum Asks {
    /// No table, and why.
    Nothing(&'static str),
    /// The table of the base layer, whatever it changes there.
    BaseLayer,
    /// Nothing, and takes away what the rest of the material asks for.
    Unlit,
    /// Nothing that glTF's material model knows: another one takes its place.
    Replaced(&'static str),
    /// A texture of its own for the roughness of the base layer.
    RoughnessTexture,
    /// What the function makes of a material, which is tables of these families, or nothing.
    Layer(&'static [&'static str], fn(&Subject<'_>) -> Vec<Answer>),
    /// Area lights: transformed cosines over the roughness of every lobe that they light.
    AreaLights,
    /// Something that cannot be told from the file, and why.
    Unknown(&'static str),
    /// A table of a kind that does not exist.
    NotYet {
        /// The table, in words.
        table: &'static str,
        /// Id that the kind would have.
        kind: &'static str,
    },
}

/// The property that turns an extension off when it is zero. Textures only multiply it, so zero stays zero.
#[derive(Debug)]
pub enum Switch {
    /// On whenever the extension is there.
    Always,
    /// One of its factors, off at 0 or black.
    Factor(&'static str),
}

/// The entry of an extension.
#[must_use]
pub fn find(name: &str) -> Option<&'static Extension> {
    EXTENSIONS.iter().find(|extension| extension.name == name)
}

const fn line(name: &'static str, asks: Asks) -> Extension {
    Extension { name, on: Switch::Always, factors: &[], asks }
}

const fn none(name: &'static str, why: &'static str) -> Extension {
    line(name, Asks::Nothing(why))
}

const fn packed(name: &'static str) -> Extension {
    line(name, Asks::RoughnessTexture)
}

const fn replaced(name: &'static str, by: &'static str) -> Extension {
    line(name, Asks::Replaced(by))
}

const GEOMETRY: &str = "geometry";
const TEXTURES: &str = "texture transport";
const LIGHTS: &str = "lights";
const METADATA: &str = "metadata";
const BEHAVIOUR: &str = "behaviour of nodes";

/// All known extensions, in alphabetical order.
pub static EXTENSIONS: &[Extension] = &[
    line("ADOBE_materials_clearcoat_specular", Asks::BaseLayer),
    none("ADOBE_materials_clearcoat_tint", "tints what lies below the coat"),
    glass::THIN,
    none("AGI_articulations", GEOMETRY),
    none("AGI_stk_metadata", METADATA),
    none("CESIUM_primitive_outline", GEOMETRY),
    none("EXT_instance_features", METADATA),
    line("EXT_lights_area", Asks::AreaLights),
    none("EXT_lights_ies", LIGHTS),
    none("EXT_lights_image_based", LIGHTS),
    none("EXT_mesh_features", METADATA),
    none("EXT_mesh_gpu_instancing", GEOMETRY),
    none("EXT_mesh_manifold", GEOMETRY),
    none("EXT_meshopt_compression", GEOMETRY),
    none("EXT_structural_metadata", METADATA),
    none("EXT_texture_astc", TEXTURES),
    none("EXT_texture_avif", TEXTURES),
    none("EXT_texture_webp", TEXTURES),
    none("FB_geometry_metadata", METADATA),
    none("GODOT_single_root", METADATA),
    none("KHR_animation_pointer", "animation; animated roughness is asked for over [0, 1]"),
    none("KHR_audio_emitter", "sound"),
    none("KHR_draco_mesh_compression", GEOMETRY),
    none("KHR_gaussian_splatting", GEOMETRY),
    line("KHR_interactivity", Asks::Unknown("a graph may change any factor while the scene runs")),
    none("KHR_lights_punctual", LIGHTS),
    anisotropy::LAYER,
    coats::CLEARCOAT,
    coats::COAT_LAYER,
    diffuse::ROUGH,
    diffuse::TRANSMITTED,
    glass::DISPERSION,
    none("KHR_materials_emissive_strength", "emission"),
    sheen::FIBRES,
    layer::INDEX,
    film::LAYER,
    line(
        "KHR_materials_openpbr",
        Asks::NotYet { table: "the layers of OpenPBR as one stack", kind: "openpbr" },
    ),
    spec_gloss::LAYER,
    sheen::LAYER,
    layer::SPECULAR,
    scattering::EARLIER,
    scattering::LAYER,
    glass::TRANSMISSION,
    line("KHR_materials_unlit", Asks::Unlit),
    none("KHR_materials_variants", "a choice of materials; all of them count as used"),
    glass::VOLUME,
    scattering::VOLUME,
    none("KHR_mesh_quantization", GEOMETRY),
    none("KHR_meshopt_compression", GEOMETRY),
    none("KHR_node_hoverability", BEHAVIOUR),
    none("KHR_node_selectability", BEHAVIOUR),
    none("KHR_node_visibility", BEHAVIOUR),
    none("KHR_physics_rigid_bodies", BEHAVIOUR),
    replaced("KHR_techniques_webgl", "shaders of the file's own"),
    none("KHR_texture_basisu", TEXTURES),
    none("KHR_texture_transform", TEXTURES),
    none("KHR_xmp", METADATA),
    none("KHR_xmp_json_ld", METADATA),
    none("MSFT_lod", "a choice of materials; all of them count as used"),
    packed("MSFT_packing_normalRoughnessMetallic"),
    packed("MSFT_packing_occlusionRoughnessMetallic"),
    none("MSFT_texture_dds", TEXTURES),
    replaced("NV_materials_mdl", "an MDL program"),
    replaced("VRM", "what its materialProperties say, toon shading as a rule"),
    replaced("VRMC_materials_mtoon", "toon shading"),
    none("VRMC_node_constraint", BEHAVIOUR),
    none("VRMC_springBone", BEHAVIOUR),
    none("VRMC_vrm", METADATA),
];
