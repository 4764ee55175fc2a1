//! What scenes ask for: fixtures under `tests/scenes`, faults under `tests/scenes/bad`.
#![allow(
    clippy::unwrap_used,
    clippy::print_stderr,
    reason = "a test fails by panicking; a skip must be seen"
)]
#![allow(clippy::float_cmp, reason = "factors are copied from the file, not computed: they must be equal")]

mod bad;
mod covered;
mod judged;
mod planned;
mod spec_gloss;
mod uri;
mod write;

use std::path::{Path, PathBuf};

use brdfbake::scene::{
    EXTENSIONS, Fault, LeftOutKind, Limits, Look, Needs, Scene, Spread, Warning, analyse, read, read_slice,
};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes").join(name)
}

fn load(name: &str) -> Scene {
    read(&fixture(name), &Limits::default()).unwrap()
}

/// A scene from its materials and primitives, and what it asks for.
fn needs_of(materials: &str, primitives: &str, more: &str) -> Needs {
    analyse(&scene_of(materials, primitives, more))
}

fn scene_of(materials: &str, primitives: &str, more: &str) -> Scene {
    let text = format!(
        r#"{{ "asset": {{ "version": "2.0" }}, "materials": [{materials}],
              "meshes": [{{ "primitives": [{primitives}] }}] {more} }}"#
    );
    read_slice(text.as_bytes(), "inline.gltf", &Limits::default()).unwrap()
}

/// The roughness that the tables of a family must cover.
fn roughness(needs: &Needs, table: &str) -> [f64; 2] {
    let need = needs.needs.iter().find(|n| n.table == table).unwrap();
    let range = &need.ranges["roughness"];
    [range.lo, range.hi]
}

/// Who asks for the table, as `material: why`.
fn askers(needs: &Needs) -> Vec<String> {
    needs.needs.iter().flat_map(|n| &n.asked_by).map(|a| format!("{}: {}", a.material, a.why)).collect()
}

fn left_out(needs: &Needs) -> Vec<String> {
    needs.left_out.iter().map(|l| format!("{:?} {l}", l.kind)).collect()
}

#[test]
fn four_materials_ask_for_one_table_and_the_rest_is_named() {
    let scene = load("four_materials.gltf");
    let files: Vec<_> = scene.external_files.iter().map(|f| (f.at.as_str(), f.path.as_str())).collect();
    assert_eq!(files, [("buffers[0].uri", "car.bin"), ("images[0].uri", "textures/worn steel.png")]);
    assert_eq!(scene.warnings, []);
    let needs = analyse(&scene);
    let tables: Vec<&str> = needs.needs.iter().map(|n| n.table.as_ref()).collect();
    assert_eq!(tables, ["ggx", "coat", "sheen"]);
    assert_eq!(roughness(&needs, "ggx"), [0.0, 1.0]);
    assert_eq!(roughness(&needs, "coat"), [0.03, 0.03]);
    assert_eq!(
        askers(&needs),
        [
            "#0 \"car paint\": base layer, roughness 0.4, KHR_materials_ior, KHR_materials_specular",
            "#2 \"velvet seat\": base layer, roughness 0.8",
            "#3 \"worn steel\": base layer, roughness [0, 0.6] (texture)",
            "the default material: base layer, roughness 1 (1 primitive without a material)",
            "#0 \"car paint\": clearcoat, roughness 0.03, ior 1.5",
            "#2 \"velvet seat\": sheen, sheen_roughness 0.5",
        ]
    );
    assert_eq!(
        left_out(&needs),
        [
            "AsksForNothing KHR_materials_unlit: a constant colour, whatever else the material says \
             (#1 \"number plate\")",
            "Unused material: no mesh primitive uses it (#4 \"spare\")",
            "AsksForNothing KHR_texture_transform: texture transport",
        ]
    );
}

#[test]
fn a_glb_asks_for_what_its_text_form_asks_for() {
    let told = |name: &str| serde_json::to_string(&analyse(&load(name))).unwrap().replace(name, "NAME");
    assert_eq!(told("four_materials.glb"), told("four_materials.gltf"));
    // The foreign reader accepts the fixture, so it is a real GLB and not only one that we like.
    let bytes = std::fs::read(fixture("four_materials.glb")).unwrap();
    let foreign = gltf::Gltf::from_slice(&bytes).unwrap();
    assert_eq!(foreign.materials().len(), 5);
    assert_eq!(foreign.blob.unwrap().len() % 4, 0);
}

#[test]
fn a_factor_of_zero_asks_for_nothing_and_says_so() {
    let needs = analyse(&load("everything_off.gltf"));
    assert_eq!(askers(&needs), ["#0 \"plain\": base layer, roughness 0.5"]);
    assert_eq!(needs.left_out.len(), 11);
    for left in &needs.left_out {
        assert_eq!(left.kind, LeftOutKind::AsksForNothing, "{left}");
        assert!(left.why.starts_with("off: "), "{left}");
    }
    assert_eq!(
        needs.left_out[1].to_string(),
        "KHR_materials_clearcoat: off: clearcoatFactor = 0 (#0 \"plain\")"
    );
    assert_eq!(
        needs.left_out[5].to_string(),
        "KHR_materials_sheen: off: sheenColorFactor is black (#0 \"plain\")"
    );
}

#[test]
fn every_layer_asks_for_its_tables_and_the_rest_is_named() {
    let needs = analyse(&load("not_supported.gltf"));
    let tables: Vec<&str> = needs.needs.iter().map(|n| n.table.as_ref()).collect();
    // the default metal has no diffuse lobe, so that neither roughness of it nor transmission through it does anything; the coat is a
    // mirror by default, and volumes scatter every way alike
    let want = ["ggx", "anisotropic", "film", "sheen", "glass", "fuzz", "subsurface", "area-light"];
    for table in want {
        assert!(tables.contains(&table), "{table} of {tables:?}");
    }
    assert_eq!(tables.len(), want.len(), "{tables:?}");
    let unknown = |what: &str| needs.left_out.iter().find(|l| l.what == what).unwrap();
    assert_eq!(unknown("ACME_materials_glitter").kind, LeftOutKind::Unknown);
    let required = unknown("ACME_physics");
    assert!(
        required.kind == LeftOutKind::Unknown && required.why.contains("the file requires"),
        "{required}"
    );
    assert!(unknown("KHR_materials_diffuse_roughness").why.contains("a metal has no diffuse lobe"));
    assert!(needs.in_doubt());
}

#[test]
fn fifty_materials_with_one_reason_are_one_entry() {
    let one = r#"{ "extensions": { "KHR_materials_openpbr": {} } }"#;
    let primitives: Vec<_> = (0..50).map(|i| format!("{{ \"material\": {i} }}")).collect();
    let needs = needs_of(&[one; 50].join(","), &primitives.join(","), "");
    let want = "NotSupported KHR_materials_openpbr: no table for it; asks for: the layers of OpenPBR as one stack \
                (#0, #1, #2, #3 and 46 more)";
    assert_eq!(left_out(&needs), [want]);
    assert_eq!(needs.left_out[0].materials.len(), 50);
}

#[test]
fn variants_and_levels_of_detail_count_as_used() {
    // 0 by the primitive, 1 by a variant, 2 as a level of detail of 1 (and 1 of 2: a cycle); 3 by nobody.
    let materials = r#"{ "pbrMetallicRoughness": { "roughnessFactor": 0.5 } },
        { "pbrMetallicRoughness": { "roughnessFactor": 0.25 }, "extensions": { "MSFT_lod": { "ids": [2] } } },
        { "pbrMetallicRoughness": { "roughnessFactor": 0.75 }, "extensions": { "MSFT_lod": { "ids": [1] } } },
        { "pbrMetallicRoughness": { "roughnessFactor": 0.9 } }"#;
    let primitive = r#"{ "material": 0, "extensions": { "KHR_materials_variants":
        { "mappings": [{ "material": 1, "variants": [0] }] } } }"#;
    let scene = scene_of(materials, primitive, "");
    assert_eq!(scene.materials.iter().map(|m| m.used).collect::<Vec<_>>(), [true, true, true, false]);
    assert_eq!(roughness(&analyse(&scene), "ggx"), [0.25, 0.75]);
}

#[test]
fn animated_factors_count_as_their_whole_range() {
    // The clearcoat is off and the base is smooth at rest; an animation changes both.
    let materials = r#"{ "pbrMetallicRoughness": { "roughnessFactor": 0.1, "metallicFactor": 0 },
        "extensions": { "KHR_materials_clearcoat": { "clearcoatRoughnessFactor": 0.2 },
                        "KHR_materials_specular": { "specularFactor": 0 } } }"#;
    let channel = |pointer: &str| {
        format!(
            r#"{{ "target": {{ "extensions": {{ "KHR_animation_pointer": {{ "pointer": "{pointer}" }} }} }} }}"#
        )
    };
    let still = needs_of(materials, r#"{ "material": 0 }"#, "");
    assert_eq!(askers(&still), Vec::<String>::new());
    assert_eq!(
        left_out(&still),
        [
            "AsksForNothing base layer: no reflection: specularFactor = 0 and metallicFactor = 0 (#0)",
            "AsksForNothing KHR_materials_clearcoat: off: clearcoatFactor = 0 (#0)",
        ]
    );
    let channels = [
        channel("/materials/0/pbrMetallicRoughness/roughnessFactor"),
        channel("/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor"),
        channel("/materials/0/extensions/KHR_materials_specular/specularFactor"),
        channel("/nodes/7/translation"),
    ];
    let more = format!(r#", "animations": [{{ "channels": [{}] }}]"#, channels.join(","));
    let moving = needs_of(materials, r#"{ "material": 0 }"#, &more);
    assert_eq!(
        askers(&moving),
        [
            "#0: base layer, roughness [0, 1] (animation), KHR_materials_specular",
            "#0: clearcoat, roughness 0.2, ior 1.5",
        ]
    );
}

#[test]
fn glossiness_is_one_minus_roughness() {
    // The core material is a fall-back only if the file says it.
    let gloss = r#""extensions": { "KHR_materials_pbrSpecularGlossiness": { "glossinessFactor": 0.75
        , "specularGlossinessTexture": { "index": 0 } } }"#;
    let textures = r#", "textures": [{}]"#;
    let alone = needs_of(&format!("{{ {gloss} }}"), r#"{ "material": 0 }"#, textures);
    assert_eq!(askers(&alone), ["#0: specular-glossiness layer, roughness [0.25, 1] (texture)"]);
    let both = format!(r#"{{ "pbrMetallicRoughness": {{ "roughnessFactor": 0.125 }}, {gloss} }}"#);
    let both = needs_of(&both, r#"{ "material": 0 }"#, textures);
    assert_eq!(roughness(&both, "ggx"), [0.125, 1.0]);
}

#[test]
fn packed_textures_spread_roughness_too() {
    let materials = r#"{ "pbrMetallicRoughness": { "roughnessFactor": 0.5 },
        "extensions": { "MSFT_packing_occlusionRoughnessMetallic": { "normalTexture": { "index": 0 } } } }"#;
    let scene = scene_of(materials, r#"{ "material": 0 }"#, "");
    let range = scene.materials[0].range("", "roughnessFactor", &Look::none());
    assert_eq!(range.spread, Spread::Texture);
    assert_eq!(roughness(&analyse(&scene), "ggx"), [0.0, 0.5]);
}

#[test]
fn a_black_reflection_needs_no_table_but_a_black_colour_does() {
    let at = |metallic: &str, specular: &str| {
        let materials = format!(
            r#"{{ "pbrMetallicRoughness": {{ "metallicFactor": {metallic} }},
                  "extensions": {{ "KHR_materials_specular": {{ {specular} }} }} }}"#
        );
        needs_of(&materials, r#"{ "material": 0 }"#, "").needs.len()
    };
    assert_eq!(at("0", r#""specularFactor": 0"#), 0);
    assert_eq!(at("0.1", r#""specularFactor": 0"#), 1);
    // F90 stays 1, so grazing angles still reflect.
    assert_eq!(at("0", r#""specularColorFactor": [0, 0, 0]"#), 1);
}

#[test]
fn files_without_anything_to_shade_say_so() {
    let want = ["AsksForNothing file: it has no mesh primitive, so nothing is shaded"];
    let only_asset = read_slice(br#"{"asset":{"version":"2.0"}}"#, "a.gltf", &Limits::default()).unwrap();
    assert_eq!(
        (analyse(&only_asset).needs, left_out(&analyse(&only_asset))),
        (vec![], want.map(String::from).into())
    );
    let library = read_slice(
        br#"{"asset":{"version":"2.0"},"materials":[{"name":"oak"}]}"#,
        "library.gltf",
        &Limits::default(),
    );
    let needs = analyse(&library.unwrap());
    assert_eq!(left_out(&needs), [want[0], "Unused material: no mesh primitive uses it (#0 \"oak\")"]);
}

#[test]
fn what_is_odd_is_a_warning() {
    let text = "\u{feff}{\"asset\":{\"version\":\"2.1\"},\"extensionsRequired\":[\"ACME_a\"],\
                \"materials\":[{\"extensions\":{\"KHR_materials_ior\":{}}}]}";
    let scene = read_slice(text.as_bytes(), "bom.gltf", &Limits::default()).unwrap();
    assert_eq!(
        scene.warnings,
        [
            Warning::ByteOrderMark,
            Warning::NotDeclared { extension: "KHR_materials_ior".to_owned() },
            Warning::RequiredNotUsed { extension: "ACME_a".to_owned() },
        ]
    );
    // What follows a container is not read, even if it looks like a BIN chunk.
    let mut glb = std::fs::read(fixture("four_materials.glb")).unwrap();
    let declared = u32::try_from(glb.len()).unwrap();
    glb.extend_from_slice(b"\x04\0\0\0BIN\0abcd");
    let scene = read_slice(&glb, "tail.glb", &Limits::default()).unwrap();
    assert_eq!(scene.warnings, [Warning::TrailingBytes { declared, actual: glb.len() }]);
    let want =
        format!("GLB header declares {declared} bytes, the file has {}; the rest was not read", glb.len());
    assert_eq!(scene.warnings[0].to_string(), want);
}

#[test]
fn cyclic_nodes_do_no_harm() {
    let text = r#"{"asset":{"version":"2.0"},"nodes":[{"children":[1]},{"children":[0,1],"mesh":0}],
        "meshes":[{"primitives":[{}]}]}"#;
    let scene = read_slice(text.as_bytes(), "cycle.gltf", &Limits::default()).unwrap();
    assert!(scene.default_material_used);
}

#[test]
fn limits_are_checked_before_the_work() {
    let default = Limits::default();
    let path = fixture("four_materials.gltf");
    let size = std::fs::metadata(&path).unwrap().len();
    let fault = |limits: &Limits| read(&path, limits).unwrap_err().fault;
    let too_large = fault(&Limits { file_bytes: size - 1, ..default });
    assert!(matches!(too_large, Fault::FileTooLarge { bytes, limit } if bytes == size && limit == size - 1));
    assert!(matches!(fault(&Limits { json_bytes: 100, ..default }), Fault::JsonTooLarge { limit: 100, .. }));
    let many = fault(&Limits { json_values: 10, ..default });
    let want = "too many JSON values: the one at extensionsUsed[5] is one more than the 10 allowed";
    assert_eq!(many.to_string(), want);
    assert!(read(&path, &Limits { file_bytes: size, ..default }).is_ok());
    // The bulk of a file is stepped over and costs nothing.
    let bulk = format!(r#"{{"asset":{{"version":"2.0"}},"accessors":[{}0]}}"#, "0,".repeat(100_000));
    assert!(read_slice(bulk.as_bytes(), "bulk.gltf", &Limits { json_values: 3, ..default }).is_ok());
}

#[test]
fn only_regular_files_are_read() {
    let limits = Limits::default();
    assert!(matches!(read(&fixture("bad"), &limits).unwrap_err().fault, Fault::NotAFile));
    let missing = read(&fixture("no_such.glb"), &limits).unwrap_err();
    assert!(matches!(missing.fault, Fault::Io { .. }), "{missing}");
    assert!(std::error::Error::source(&missing).is_some());
}

#[test]
fn the_registry_is_sorted_and_has_no_twins() {
    let names: Vec<_> = EXTENSIONS.iter().map(|e| e.name).collect();
    let mut sorted = names.clone();
    sorted.sort_unstable();
    sorted.dedup();
    assert_eq!(names, sorted);
}

#[test]
fn names_cannot_write_to_the_terminal() {
    let materials = r#"{ "name": "\u001b[2J\u202e evil\nname" }"#;
    let needs = needs_of(materials, r#"{ "material": 0 }"#, "");
    assert_eq!(askers(&needs), [r#"#0 "\u{1b}[2J\u{202e} evil\nname": base layer, roughness 1"#]);
}

/// Real files, if the folder of shared assets is at hand.
#[test]
fn sample_assets_ask_for_what_they_show() {
    let Some(shared) = std::env::var_os("BRDFBAKE_SHARED") else {
        eprintln!("SKIPPED: BRDFBAKE_SHARED is not set, so no sample assets were read");
        return;
    };
    // File, askers, roughness, families: counted by hand in the files.
    let want = [
        ("AnisotropyStrengthTest.glb", 43, [1.0 / 6.0, 1.0], "anisotropic ggx"),
        ("ClearCoatTest.glb", 19, [0.0, 1.0], "coat ggx"),
        ("DamagedHelmet.glb", 1, [0.0, 1.0], "ggx"),
        ("SpecularTest.glb", 1, [0.8, 0.8], "ggx"),
        ("TransmissionRoughnessTest.glb", 9, [0.0, 1.0], "ggx glass"),
    ];
    for (name, askers, want_roughness, families) in want {
        let scene = read(&Path::new(&shared).join("assets").join(name), &Limits::default()).unwrap();
        let needs = analyse(&scene);
        let mut tables: Vec<&str> = needs.needs.iter().map(|n| n.table.as_ref()).collect();
        tables.sort_unstable();
        assert_eq!(tables.join(" "), families, "{name}");
        let ggx = needs.needs.iter().find(|n| n.table == "ggx").unwrap();
        let got = (ggx.asked_by.len(), roughness(&needs, "ggx"));
        assert_eq!(got, (askers, want_roughness), "{name}");
        assert_eq!(scene.warnings, [], "{name}");
    }
}
