//! The registry of glTF extensions: what each one asks of the baker. One line an extension.
//!
//! An extension that is missing here is reported as unknown, never ignored. When a table becomes available,
//! its line changes from [`Asks::NotYet`] to [`Asks::Lobe`].
//!
//! Source: extensions/README.md of the glTF repository of the Khronos Group, and the open proposals there.

use super::json::{Allowed, NOT_NEGATIVE, UNIT};

/// Id of the table family of the GGX lobe.
pub const GGX: &str = "ggx";

/// An extension and what it asks for.
#[derive(Debug)]
pub struct Extension {
    /// Name as `extensionsUsed` spells it.
    pub name: &'static str,
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
    /// A texture of its own for the roughness of the base layer.
    RoughnessTexture,
    /// A lobe with its own roughness, from a table that can be baked.
    Lobe(Lobe),
    /// A table that cannot be baked yet.
    NotYet {
        /// The table, in words.
        table: &'static str,
        /// When it is asked for.
        on: Switch,
    },
}

/// A lobe with its own roughness.
#[derive(Debug)]
pub struct Lobe {
    /// Id of the table family.
    pub table: &'static str,
    /// Name of the layer, for reports.
    pub layer: &'static str,
    /// When it is asked for.
    pub on: Switch,
    /// Key of its roughness factor, or of its glossiness factor.
    pub factor: &'static str,
    /// Default of that factor.
    pub default: f64,
    /// Key of the texture that the factor is multiplied by.
    pub texture: &'static str,
    /// True if the factor is glossiness: roughness = 1 − glossiness.
    pub glossiness: bool,
}

/// The property that turns an extension off when it is zero. Textures only multiply it, so zero stays zero.
#[derive(Debug)]
pub enum Switch {
    /// On whenever the extension is there.
    Always,
    /// A number whose default is 0.
    Factor(&'static str, &'static Allowed),
    /// An RGB colour whose default is black.
    Colour(&'static str, &'static Allowed),
}

/// The entry of an extension.
#[must_use]
pub fn find(name: &str) -> Option<&'static Extension> {
    EXTENSIONS.iter().find(|extension| extension.name == name)
}

const fn none(name: &'static str, why: &'static str) -> Extension {
    Extension { name, asks: Asks::Nothing(why) }
}

const fn base(name: &'static str) -> Extension {
    Extension { name, asks: Asks::BaseLayer }
}

const fn packed(name: &'static str) -> Extension {
    Extension { name, asks: Asks::RoughnessTexture }
}

const fn later(name: &'static str, on: Switch, table: &'static str) -> Extension {
    Extension { name, asks: Asks::NotYet { table, on } }
}

const fn weight(key: &'static str) -> Switch {
    Switch::Factor(key, &UNIT)
}

const CLEARCOAT: Lobe = Lobe {
    table: GGX,
    layer: "clearcoat",
    on: weight("clearcoatFactor"),
    factor: "clearcoatRoughnessFactor",
    default: 0.0,
    texture: "clearcoatRoughnessTexture",
    glossiness: false,
};

const SPECULAR_GLOSSINESS: Lobe = Lobe {
    table: GGX,
    layer: "specular-glossiness layer",
    on: Switch::Always,
    factor: "glossinessFactor",
    default: 1.0,
    texture: "specularGlossinessTexture",
    glossiness: true,
};

const GEOMETRY: &str = "geometry";
const TEXTURES: &str = "texture transport";
const LIGHTS: &str = "lights";
const METADATA: &str = "metadata";
const BEHAVIOUR: &str = "behaviour of nodes";

/// All known extensions, in alphabetical order.
pub static EXTENSIONS: &[Extension] = &[
    base("ADOBE_materials_clearcoat_specular"),
    none("ADOBE_materials_clearcoat_tint", "tints what lies below the coat"),
    later("ADOBE_materials_thin_transparency", Switch::Always, "GGX transmission albedo (thin walls)"),
    none("AGI_articulations", GEOMETRY),
    none("AGI_stk_metadata", METADATA),
    none("CESIUM_primitive_outline", GEOMETRY),
    none("EXT_instance_features", METADATA),
    later("EXT_lights_area", Switch::Always, "linearly transformed cosines (area lights)"),
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
    later("KHR_interactivity", Switch::Always, "unknown: a graph may change any factor while the scene runs"),
    none("KHR_lights_punctual", LIGHTS),
    later("KHR_materials_anisotropy", weight("anisotropyStrength"), "anisotropic GGX albedo"),
    Extension { name: "KHR_materials_clearcoat", asks: Asks::Lobe(CLEARCOAT) },
    later("KHR_materials_coat", weight("coatFactor"), "GGX coat with darkening"),
    later("KHR_materials_diffuse_roughness", weight("diffuseRoughnessFactor"), "rough diffuse albedo"),
    later(
        "KHR_materials_diffuse_transmission",
        weight("diffuseTransmissionFactor"),
        "diffuse transmission albedo",
    ),
    later(
        "KHR_materials_dispersion",
        Switch::Factor("dispersion", &NOT_NEGATIVE),
        "GGX transmission albedo (per wavelength)",
    ),
    none("KHR_materials_emissive_strength", "emission"),
    later("KHR_materials_fuzz", weight("fuzzFactor"), "fuzz albedo (linearly transformed cosines)"),
    base("KHR_materials_ior"),
    later("KHR_materials_iridescence", weight("iridescenceFactor"), "thin-film Fresnel"),
    later("KHR_materials_openpbr", Switch::Always, "OpenPBR layers"),
    Extension { name: "KHR_materials_pbrSpecularGlossiness", asks: Asks::Lobe(SPECULAR_GLOSSINESS) },
    later("KHR_materials_sheen", Switch::Colour("sheenColorFactor", &UNIT), "Charlie sheen albedo"),
    base("KHR_materials_specular"),
    later("KHR_materials_sss", Switch::Always, "subsurface scattering"),
    later("KHR_materials_subsurface", Switch::Always, "subsurface scattering"),
    later("KHR_materials_transmission", weight("transmissionFactor"), "GGX transmission albedo"),
    Extension { name: "KHR_materials_unlit", asks: Asks::Unlit },
    none("KHR_materials_variants", "a choice of materials; all of them count as used"),
    later(
        "KHR_materials_volume",
        Switch::Factor("thicknessFactor", &NOT_NEGATIVE),
        "GGX transmission albedo (below a surface)",
    ),
    later("KHR_materials_volume_scatter", Switch::Always, "volume scattering"),
    none("KHR_mesh_quantization", GEOMETRY),
    none("KHR_meshopt_compression", GEOMETRY),
    none("KHR_node_hoverability", BEHAVIOUR),
    none("KHR_node_selectability", BEHAVIOUR),
    none("KHR_node_visibility", BEHAVIOUR),
    none("KHR_physics_rigid_bodies", BEHAVIOUR),
    none("KHR_texture_basisu", TEXTURES),
    none("KHR_texture_transform", TEXTURES),
    none("KHR_xmp", METADATA),
    none("KHR_xmp_json_ld", METADATA),
    none("MSFT_lod", "a choice of materials; all of them count as used"),
    packed("MSFT_packing_normalRoughnessMetallic"),
    packed("MSFT_packing_occlusionRoughnessMetallic"),
    none("MSFT_texture_dds", TEXTURES),
    later("NV_materials_mdl", Switch::Always, "unknown: the material is an MDL program"),
    none("VRMC_springBone", BEHAVIOUR),
];
