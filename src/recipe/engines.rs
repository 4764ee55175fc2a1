//! The engines, and the files of each: one entry an engine.

use super::engine::Reader::{Fixed, Shader};
use super::engine::{Engine, EngineFile, Roughness, Shipped};

macro_rules! engine {
    ($id:literal, $title:literal, $version:literal, $reader:expr, $files:expr) => {
        Engine {
            id: $id,
            title: $title,
            version: $version,
            reader: $reader,
            recipe: include_str!(concat!("../../presets/engines/", $id, ".toml")),
            guide: include_str!(concat!("../../presets/engines/", $id, ".md")),
            files: $files,
            roughness: Roughness::AS_IT_IS,
        }
    };
}

const fn clamped(engine: Engine, at_least: f64, widens: bool, source: &'static str) -> Engine {
    Engine { roughness: Roughness { at_least, widens, source }, ..engine }
}

const THREE_ROUGHNESS: &str =
    "lights_physical_fragment.glsl: max(roughnessFactor, 0.0525) + geometryRoughness, at most 1";
const THREE_DFG: &str = "the table in build/three.module.js and build/three.tsl.js, by a plugin of the bundler; \
                         src/renderers/shaders/DFGLUTData.js in a checkout";
const FILAMENT_ROUGHNESS: &str =
    "MIN_PERCEPTUAL_ROUGHNESS 0.045; gltfio builds its materials with specularAntiAliasing";
const BEVY_ROUGHNESS: &str = "pbr_lighting.wgsl: perceptualRoughnessToRoughness clamps to [0.089, 1]";

const fn file(table: &'static str, replaces: &'static str, read: &'static str) -> EngineFile {
    EngineFile { table, replaces, read, shipped: None }
}

const fn measured(
    file: EngineFile,
    source: &'static str,
    whole: [f64; 2],
    practical: [f64; 2],
) -> EngineFile {
    EngineFile { shipped: Some(Shipped { source, whole, practical }), ..file }
}

const SPLIT: &str = "(mu, roughness); F0 r + F90 g";
const SWAPPED: &str = "(roughness, mu); F0 r + F90 g";
const MIX: &str = "(mu, roughness); mix(r, g, F0), 1 + F0 (1 / g - 1), cloth b";
const FLIPPED: &str = "(mu, 1 - roughness); mix(r, g, F0)";
const LTC_1: &str =
    "(roughness, sqrt(1 - mu)) (63 / 64) + 0.5 / 64; M^-1 = [[r, 0, b], [0, 1, 0], [g, 0, a]]";
const LTC_2: &str = "(roughness, sqrt(1 - mu)) (63 / 64) + 0.5 / 64; F0 r + (F90 - F0) g; a at the coordinates of the horizon";
const OSL_GLASS: &str = "linear in mu, roughness and sqrt((eta - 1.001) / 3.999); 1 - (R + T)";
const CORNERS: &str = "texel i at i / (n - 1), clamped";

const SHADER_TABLES: &str = "shader.tables at 97dbe6f5, Apache-2.0";
const OPENPBR: &str = "linear in the cosine, in roughness and in ior above 1 or 1 / ior below; code / 65535";
macro_rules! openpbr {
    ($table:literal, $list:literal) => {
        file($table, concat!("impl/data/openpbr_", $list, "_data.h"), OPENPBR)
    };
}

macro_rules! cycles {
    ($table:literal, $array:literal) => {
        file($table, concat!("table_", $array, " in src/scene/shader.tables"), CORNERS)
    };
}

const FILAMENT: EngineFile = measured(
    file("filament-dfg", "generated/data/dfg.inc of the build, with DFG_LUT_SIZE = 64", MIX),
    "the table in filament.wasm of 1.53.4, Apache-2.0; the largest are of the cloth, which has a pole",
    [3.898e2, 4.151e-2],
    [8.041e-2, 5.416e-3],
);

/// Every engine.
pub static ENGINES: &[Engine] = &[
    clamped(
        engine!(
            "bevy",
            "Bevy",
            "0.20-dev (bevyengine/bevy 4805ca79), crates/bevy_pbr",
            Shader("wgsl"),
            &[
                measured(
                    file(
                        "bevy-dfg",
                        "the resource DfgLut, or crates/bevy_pbr/src/environment_map/dfg.ktx2",
                        SPLIT
                    ),
                    "dfg.ktx2 at 4805ca79, MIT or Apache-2.0",
                    [7.581e-2, 4.489e-4],
                    [9.343e-3, 1.318e-4]
                ),
                file(
                    "bevy-ltc-matrix",
                    "the resource AreaLightLuts, or crates/bevy_pbr/src/ltc/ltc.ktx2, layer 0",
                    LTC_1
                ),
                measured(
                    file(
                        "bevy-ltc-magnitude",
                        "the resource AreaLightLuts, or crates/bevy_pbr/src/ltc/ltc.ktx2, layer 1",
                        LTC_2
                    ),
                    "ltc.ktx2 at 4805ca79, MIT or Apache-2.0",
                    [9.664e-2, 9.163e-4],
                    [3.672e-2, 6.692e-4]
                ),
            ]
        ),
        0.089,
        false,
        BEVY_ROUGHNESS,
    ),
    clamped(
        engine!(
            "three",
            "three.js",
            "r187",
            Shader("glsl"),
            &[
                measured(
                    file("three-dfg", THREE_DFG, SWAPPED),
                    "DFGLUTData.js of 0.187.0, MIT",
                    [1.479e-1, 4.544e-3],
                    [3.840e-2, 1.809e-3]
                ),
                file("three-ltc-matrix", "examples/jsm/lights/RectAreaLightTexturesLib.js", LTC_1),
                measured(
                    file("three-ltc-magnitude", "examples/jsm/lights/RectAreaLightTexturesLib.js", LTC_2),
                    "RectAreaLightTexturesLib.js of 0.187.0, MIT",
                    [9.682e-2, 9.129e-4],
                    [3.668e-2, 6.654e-4]
                ),
            ]
        ),
        0.0525,
        true,
        THREE_ROUGHNESS,
    ),
    clamped(
        engine!(
            "filament",
            "Filament",
            "1.53.4, libs/ibl/src/CubemapIBL.cpp and tools/cmgen",
            Shader("glsl"),
            &[FILAMENT]
        ),
        0.045,
        true,
        FILAMENT_ROUGHNESS,
    ),
    clamped(
        engine!(
            "filament-centre",
            "Filament, rows where its shaders read them",
            "1.53.4, as filament",
            Shader("glsl"),
            &[FILAMENT]
        ),
        0.045,
        true,
        FILAMENT_ROUGHNESS,
    ),
    engine!(
        "babylon",
        "Babylon.js",
        "9.34, Misc/brdfTextureTools.js",
        Shader("glsl"),
        &[
            measured(
                file(
                    "babylon-environment-brdf",
                    "scene.environmentBRDFTexture, or the base64 text of the environment BRDF in Misc/brdfTextureTools.js",
                    "(mu, roughness), expanded from RGBD; (F90 - F0) r + F0 g, sheen b"
                ),
                "environmentBRDF of 9.34.0, Apache-2.0; the largest are of the sheen, which has a pole",
                [3.624e2, 6.514e-3],
                [2.530e-2, 1.583e-3]
            ),
            file(
                "babylon-openpbr-brdf",
                "scene.openPBREnvironmentBRDFTexture, or the base64 text of the OpenPBR BRDF in Misc/brdfTextureTools.js",
                "(mu, roughness), expanded from RGBD; (F90 - F0) r + F0 g, b / 16 of the tint at 82 degrees"
            ),
            file(
                "babylon-fuzz-brdf",
                "scene.environmentFuzzBRDFTexture, or the base64 text of the fuzz BRDF in Misc/brdfTextureTools.js",
                "(roughness, mu); A = 0.005 + 0.875 r, B = -0.18 + 0.182 g, R = 0.75 b"
            ),
        ]
    ),
    engine!(
        "unreal",
        "Unreal's split sum, as published",
        "Karis 2013, section 'Environment BRDF'; the engine's own source was not read",
        Shader("hlsl"),
        &[file("unreal-dfg", "the pre-integrated GF texture", SPLIT)]
    ),
    engine!(
        "simplepbr",
        "Panda3D, panda3d-simplepbr",
        "0.13.1, simplepbr/textures/brdf_lut.txo",
        Shader("glsl"),
        &[file("simplepbr-dfg", "the texture object brdf_lut.txo", "(mu, roughness); F0 r + g")]
    ),
    engine!(
        "gltf-sample-renderer",
        "glTF Sample Renderer",
        "source/Renderer/shaders/ibl.glsl",
        Shader("glsl"),
        &[file("gltf-ggx", "the picture lut_ggx.png", "(mu, roughness); F0 r + g")]
    ),
    engine!(
        "godot",
        "Godot",
        "4.x, forward_clustered/integrate_dfg.glsl",
        Shader("glsl"),
        &[file(
            "godot-dfg",
            "the table that the renderer makes at start-up",
            "(mu, 1 - roughness); mix(r, g, F0), cloth b"
        )]
    ),
    engine!(
        "playcanvas",
        "PlayCanvas",
        "src/scene/area-light-luts.js",
        Shader("glsl"),
        &[
            file("playcanvas-ltc-matrix", "the asset area-light-luts.bin", LTC_1),
            measured(
                file("playcanvas-ltc-magnitude", "the asset area-light-luts.bin", LTC_2),
                "area-light-luts.json at 0aaef5e4, MIT; the numbers of ltc.js",
                [9.682e-2, 9.129e-4],
                [3.668e-2, 6.654e-4]
            ),
        ]
    ),
    engine!(
        "selfshadow-ltc",
        "LTC tables of Heitz and Hill",
        "selfshadow/ltc_code 31e5e96b, fit/results",
        Fixed("the files have many readers"),
        &[
            file("ltc-1", "ltc.js", LTC_1),
            measured(
                file("ltc-2", "ltc.js", LTC_2),
                "fit/results/ltc.js, BSD",
                [9.682e-2, 9.129e-4],
                [3.668e-2, 6.654e-4]
            )
        ]
    ),
    engine!(
        "cycles",
        "Cycles",
        "blender/cycles 97dbe6f5, src/app/cycles_precompute.cpp",
        Fixed("lookup_table_read in its kernel steps evenly along every axis of every table"),
        &[
            measured(
                cycles!("cycles-ggx-E", "ggx_E"),
                SHADER_TABLES,
                [1.009e-1, 7.247e-4],
                [7.848e-3, 3.074e-4]
            ),
            measured(
                cycles!("cycles-ggx-Eavg", "ggx_Eavg"),
                SHADER_TABLES,
                [2.942e-4, 1.572e-4],
                [2.942e-4, 1.716e-4]
            ),
            cycles!("cycles-ggx-glass-E", "ggx_glass_E"),
            cycles!("cycles-ggx-glass-Eavg", "ggx_glass_Eavg"),
            cycles!("cycles-ggx-glass-inv-E", "ggx_glass_inv_E"),
            cycles!("cycles-ggx-glass-inv-Eavg", "ggx_glass_inv_Eavg"),
            cycles!("cycles-ggx-gen-schlick-ior-s", "ggx_gen_schlick_ior_s"),
            cycles!("cycles-ggx-gen-schlick-s", "ggx_gen_schlick_s"),
            cycles!("cycles-sheen-ltc", "sheen_ltc"),
            cycles!("cycles-thin-film-cmf", "thin_film_cmf"),
        ]
    ),
    engine!(
        "ltc-sheen",
        "Sheen of Zeltner, Burley and Chiang",
        "tizian/ltc-sheen 92624114, fitting/python",
        Fixed("the table has many readers"),
        &[file(
            "ltc-sheen-volume",
            "fitting/python/data/ltc_table_sheen_volume.npy",
            "[mu][roughness], both at i / 31, no less than 0.01; A, B, R"
        )]
    ),
    engine!(
        "unity-hdrp",
        "Unity, High Definition Render Pipeline",
        "Runtime/Material/PreIntegratedFGD",
        Shader("hlsl"),
        &[file(
            "hdrp-ggx-disney-diffuse",
            "the texture _PreIntegratedFGD_GGXDisneyDiffuse, made at start-up",
            "(sqrt(mu), roughness) (63 / 64) + 0.5 / 64; (F90 - F0) r + F0 g, diffuse b + 0.5"
        )]
    ),
    engine!(
        "materialx",
        "MaterialX",
        "MaterialXView, ALBEDO_TABLE_SIZE = 128",
        Shader("glsl"),
        &[file(
            "materialx-albedo",
            "the texture u_albedoTable, made at start-up",
            "(mu, alpha); F0 r + F90 g"
        )]
    ),
    engine!(
        "ogre",
        "OGRE 1.x",
        "14.6, Media/RTShaderLib",
        Shader("glsl"),
        &[
            file("ogre-dfg", "Media/RTShaderLib/dfgLUTmultiscatter.dds", FLIPPED),
            file("ogre-ltc-matrix", "Media/RTShaderLib/ltc_1.dds", LTC_1),
            file("ogre-ltc-magnitude", "Media/RTShaderLib/ltc_2.dds", LTC_2),
        ]
    ),
    engine!(
        "ogre-next",
        "Ogre-Next",
        "3.0 and later, Components/Hlms/Pbs and Samples/Media/Hlms/Pbs",
        Shader("hlsl"),
        &[
            file(
                "ogre-next-ltc-matrix",
                "ltcMatrix0.dds",
                "(alpha, sqrt(1 - mu)) (63 / 64) + 0.5 / 64; M^-1 = [[r, 0, b], [0, 1, 0], [g, 0, a]]"
            ),
            file(
                "ogre-next-ltc-magnitude",
                "ltcMatrix1.dds",
                "(alpha, sqrt(1 - mu)) (63 / 64) + 0.5 / 64; F0 r + (1 - F0) g; a at the coordinates of the horizon"
            ),
            file("ogre-next-dfg", "brtfLutDfg.dds", "(mu, 1 - roughness); F0 r + g, diffuse b"),
        ]
    ),
    engine!(
        "osl",
        "Open Shading Language, libbsdl",
        "AcademySoftwareFoundation/OpenShadingLanguage 6fd6c609, src/libbsdl/src/genluts.cpp",
        Fixed("get_cosine and TabulatedEnergyCurve of libbsdl hold its axes, and average over them"),
        &[
            file(
                "osl-mini-microfacet-ggx",
                "BSDL/SPI/microfacet_tools_luts.h of the build",
                "linear between the cosines max((i / 15)^2, 1e-6) and in roughness; 1 - E"
            ),
            file("osl-dielectric-front", "BSDL/SPI/bsdf_dielectric_front_luts.h of the build", OSL_GLASS),
        ]
    ),
    engine!(
        "o3de",
        "Open 3D Engine",
        "Atom, BRDFTexture/BRDFTextureCS.azsl",
        Shader("hlsl"),
        &[file(
            "o3de-dfg",
            "the table that the pass BRDFTexture makes at start-up",
            "(mu, 1 - roughness); F0 r + F90 g"
        )]
    ),
    engine!(
        "openpbr",
        "OpenPBR's reference BSDF",
        "adobe/openpbr-bsdf a29da96, impl/openpbr_microfacet_multiple_scattering_data.h",
        Fixed("openpbr_ior_to_exact_index and its like step evenly along every axis"),
        &[
            openpbr!("openpbr-dielectric-inside", "ideal_dielectric_energy_complement"),
            openpbr!("openpbr-dielectric", "ideal_dielectric_energy_complement"),
            openpbr!("openpbr-dielectric-avg-inside", "ideal_dielectric_avg_energy_complement"),
            openpbr!("openpbr-dielectric-avg", "ideal_dielectric_avg_energy_complement"),
            openpbr!("openpbr-opaque-inside", "opaque_dielectric_energy_complement"),
            openpbr!("openpbr-opaque", "opaque_dielectric_energy_complement"),
            openpbr!("openpbr-opaque-avg-inside", "opaque_dielectric_avg_energy_complement"),
            openpbr!("openpbr-opaque-avg", "opaque_dielectric_avg_energy_complement"),
            openpbr!("openpbr-metal", "ideal_metal_energy_complement"),
            openpbr!("openpbr-metal-avg", "ideal_metal_avg_energy_complement"),
            file(
                "openpbr-sheen",
                "impl/data/openpbr_ltc_data.h",
                "linear in mu and roughness on the ends (openpbr_disney_sheen_fetch_coeffs)"
            ),
        ]
    ),
];
