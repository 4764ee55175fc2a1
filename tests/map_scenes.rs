//! Maps of the materials of scenes: which are asked for, by whom, and what becomes of them.
#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "test")]

use crate::map_files::{normal_code, picture};
use crate::tolerance::SINGLE;
use brdfbake::cancel::Cancel;
use brdfbake::picture::read_bytes;
use brdfbake::pipeline::write_scene::{self, Bake, Request};
use brdfbake::pipeline::{self, Manifest, Settings, Silent};
use brdfbake::plan::Plan;
use brdfbake::plan::map::Kind;
use brdfbake::plan::scene::{self as planning, SceneMaps, SurveyOptions};
use brdfbake::scene::{LeftOutKind, Reader};
use serde_json::{Value as Json, json};
use std::path::{Path, PathBuf};

/// Pyramids of 30 degrees, and a packed map: occlusion, roughness 128, metallic.
pub(crate) fn scene(dir: &Path, materials: &Json) -> PathBuf {
    let s = 30_f64.to_radians().tan();
    let slope =
        |x: u32, y: u32| [if x.is_multiple_of(2) { s } else { -s }, if y.is_multiple_of(2) { s } else { -s }];
    picture(dir, "n.png", [8, 8], 3, |x, y, c| normal_code(slope(x, y), c));
    picture(dir, "mr.png", [4, 4], 3, |x, _, c| match c {
        0 => 255,
        1 => 128,
        _ => {
            if x % 2 == 0 {
                40
            } else {
                80
            }
        }
    });
    let count = materials.as_array().unwrap().len();
    let position = json!({ "POSITION": 0 });
    let primitives: Vec<Json> =
        (0..count).map(|m| json!({ "attributes": position, "material": m })).collect();
    let triangle: Vec<u8> = [[0_f32; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
        .concat()
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    std::fs::write(dir.join("t.bin"), triangle).unwrap();
    let scene = json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": ["KHR_texture_transform"],
        "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "buffers": [{ "uri": "t.bin", "byteLength": 36 }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] }],
        "samplers": [{ "wrapS": 33071, "wrapT": 10497 }, {}],
        "images": [{ "uri": "n.png" }, { "uri": "mr.png" }],
        "textures": [{ "source": 0, "sampler": 1 }, { "source": 1, "sampler": 1 }, { "source": 1, "sampler": 0 }],
        "materials": materials,
        "meshes": [{ "primitives": primitives }],
    });
    let path = dir.join("scene.gltf");
    std::fs::write(&path, serde_json::to_string_pretty(&scene).unwrap()).unwrap();
    path
}

/// A material with both textures.
pub(crate) fn material(factor: f64, scale: f64) -> Json {
    json!({
        "pbrMetallicRoughness": { "roughnessFactor": factor, "metallicRoughnessTexture": { "index": 1 } },
        "normalTexture": { "index": 0, "scale": scale },
    })
}

fn found(path: &Path, kinds: &[Kind]) -> SceneMaps {
    planning::maps(&[path.to_owned()], kinds, &SurveyOptions::default()).unwrap()
}

pub(crate) fn bake(maps: &SceneMaps, out: &Path) -> Manifest {
    let requests = maps.maps.iter().map(|m| m.request.clone()).collect();
    let plan = Plan::nothing("scene").with_maps(requests).unwrap();
    pipeline::run(&plan, &Settings::new(out), &Cancel::new(), &Silent).unwrap().manifest
}

#[test]
fn equal_jobs_are_one_and_others_are_not() {
    let dir = tempfile::tempdir().unwrap();
    let materials = json!([material(1.0, 1.0), material(0.5, 1.0), material(1.0, 1.0), material(1.0, 0.5), { "name": "plain" }]);
    let path = scene(dir.path(), &materials);
    let maps = found(&path, &[Kind::Roughness]);
    let askers: Vec<Vec<Option<usize>>> =
        maps.maps.iter().map(|m| m.asked_by.iter().map(|a| a.material.index).collect()).collect();
    assert_eq!(askers, [vec![Some(0), Some(2)], vec![Some(1)], vec![Some(3)]]);
    assert!(maps.left_out.is_empty(), "{:?}", maps.left_out);
    let out = dir.path().join("out");
    let manifest = bake(&maps, &out);
    assert_eq!(manifest.maps.len(), 3);
    // sizes differ: the larger one; levels stand above the factor, which is inside; metallic keeps its means
    assert_eq!(manifest.maps[1].record.levels[0].size, [8, 8]);
    let [first, second] = [0, 1].map(|k| manifest.maps[1].record.levels[k].roughness[0]);
    assert!((first - 0.25).abs() < 0.01 && second > 0.5, "{first} {second}");
    let file = std::fs::read(out.join("material1.roughness.ktx2")).unwrap();
    let image = brdfbake::encode::read::read_bytes(&file).unwrap();
    let code = |c: &str, i: usize| (image.channel(c).unwrap().values[i] * 255.0).round().to_string();
    assert_eq!([code("R", 0), code("G", 0)], ["255", "64"]);
    assert_eq!([code("B", 0), code("B", 1), code("B", 4)], ["50", "50", "50"]);
}

/// What cannot be filtered together is refused by name; a smaller factor of the same textures is no reason.
#[test]
fn other_coordinates_are_refused_by_name() {
    let dir = tempfile::tempdir().unwrap();
    let mut set = material(1.0, 1.0);
    set["normalTexture"]["texCoord"] = 1.into();
    let mut moved = material(1.0, 1.0);
    moved["normalTexture"]["extensions"] = json!({ "KHR_texture_transform": { "scale": [2, 2] } });
    let mut both = moved.clone();
    both["pbrMetallicRoughness"]["metallicRoughnessTexture"]["extensions"] =
        json!({ "KHR_texture_transform": { "scale": [2, 2], "rotation": 0 } });
    let mut wrap = material(1.0, 1.0);
    wrap["pbrMetallicRoughness"]["metallicRoughnessTexture"]["index"] = 2.into();
    let path = scene(dir.path(), &json!([set, moved, both, wrap]));
    let maps = found(&path, &[Kind::Roughness]);
    assert_eq!(maps.maps.len(), 1);
    assert_eq!(maps.maps[0].asked_by[0].material.index, Some(2));
    let told: Vec<&str> = maps.left_out.iter().map(|l| l.why.as_str()).collect();
    for (why, part) in told.iter().zip(["UV set 1", "KHR_texture_transform", "wrap"]) {
        assert!(why.contains(part), "{told:?}");
    }
    assert!(maps.left_out.iter().all(|l| l.kind == LeftOutKind::NotSupported && l.materials.len() == 1));
    std::fs::remove_file(dir.path().join("n.png")).unwrap();
    let unknown = found(&path, &[Kind::Roughness]);
    assert!(unknown.maps.is_empty());
    assert!(unknown.left_out.iter().any(|l| l.kind == LeftOutKind::Unknown && l.why.contains("n.png")));
}

/// `KHR_materials_anisotropy`: facets of two widths, whatever was asked for, with texture, strength and rotation inside.
#[test]
fn brushed_materials_have_facets_of_two_widths() {
    let dir = tempfile::tempdir().unwrap();
    let brushed = |own: Json| {
        let mut brushed = material(1.0, 1.0);
        brushed["extensions"] = json!({ "KHR_materials_anisotropy": own });
        brushed
    };
    let plain = brushed(json!({ "anisotropyStrength": 0.6, "anisotropyRotation": 0.5 }));
    let off = brushed(json!({ "anisotropyStrength": 0.0, "anisotropyTexture": { "index": 1 } }));
    // R and G of the texture are a direction, B is 40 or 80
    let drawn = brushed(json!({ "anisotropyStrength": 1.0, "anisotropyTexture": { "index": 1 } }));
    let other =
        brushed(json!({ "anisotropyStrength": 1.0, "anisotropyTexture": { "index": 1, "texCoord": 1 } }));
    let path = scene(dir.path(), &json!([plain, off, drawn, other]));
    let maps = found(&path, &[Kind::Roughness]);
    assert_eq!(maps.maps.len(), 3);
    let told: Vec<&str> = maps.left_out.iter().map(|l| l.why.as_str()).collect();
    assert_eq!(told, ["normalTexture has UV set 0, and anisotropyTexture 1"]);
    assert!(maps.maps[0].asked_by[0].why.ends_with("anisotropyStrength 0.6"), "{:?}", maps.maps[0].asked_by);
    let out = dir.path().join("out");
    let manifest = bake(&maps, &out);
    let shapes: Vec<&str> = manifest.maps.iter().map(|m| m.record.shape.as_str()).collect();
    assert_eq!(shapes, ["anisotropic", "isotropic", "anisotropic"]);
    let read =
        |name: &str| brdfbake::encode::read::read_file(&out.join(format!("{name}.anisotropy.ktx2"))).unwrap();
    let first = read("material0");
    let number = |image: &brdfbake::encode::Image, c: usize, i: usize| image.channels[c].values[i];
    let direction =
        |image: &brdfbake::encode::Image, i: usize| [0, 1].map(|c| 2.0 * number(image, c, i) - 1.0);
    assert!((number(&first, 2, 0) - 0.6).abs() < 0.005, "{}", number(&first, 2, 0));
    let [x, y] = direction(&first, 0);
    assert!((x - 0.5_f64.cos()).abs() < 0.005 && (y - 0.5_f64.sin()).abs() < 0.005, "{x} {y}");
    // red 255, green 128: along the tangent; the texture is brought to the size of the normals, and repeats
    let third = read("material2");
    let [x, y] = direction(&third, 0);
    assert!((x.abs() - 1.0).abs() < 0.005 && y.abs() < 0.02, "{x} {y}");
    assert!((number(&third, 2, 0) - 50.0 / 255.0).abs() < 0.005, "{}", number(&third, 2, 0));
    // the filter sees both widths: D of its lobe is told and measured alike
    let level = &manifest.maps[0].record.levels[1];
    assert!(level.measured.as_ref().unwrap().miss < 0.02 && level.mean > 0.0, "{level:?}");
}

/// Tables that are planned with maps reach as far as their levels do; materials without normals do not widen them.
#[test]
fn tables_cover_the_levels_of_maps() {
    let dir = tempfile::tempdir().unwrap();
    let mut flat = material(1.0, 1.0);
    flat.as_object_mut().unwrap().remove("normalTexture");
    for (material, maps, hi) in [
        (material(1.0, 1.0), false, 128.0 / 255.0),
        (material(1.0, 1.0), true, 1.0),
        (flat, true, 128.0 / 255.0),
    ] {
        let path = scene(dir.path(), &json!([material]));
        let reader = Reader { maps, ..Reader::default() };
        let options = SurveyOptions { reader, ..SurveyOptions::default() };
        let survey = planning::survey(&[path], &options).unwrap();
        let range = &survey.needs.needs.iter().find(|n| n.table == "ggx").unwrap().ranges["roughness"];
        assert!((range.lo - 128.0 / 255.0).abs() < SINGLE && (range.hi - hi).abs() < SINGLE, "{range:?}");
    }
}

/// Images in the scene's own file, and fitted normals.
#[test]
fn embedded_images_are_read() {
    let dir = tempfile::tempdir().unwrap();
    let path = scene(dir.path(), &json!([material(0.7, 1.0)]));
    let outside = bake(&found(&path, &[Kind::Normal, Kind::Anisotropy]), &dir.path().join("a"));
    let mut text: Json = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    for image in text["images"].as_array_mut().unwrap() {
        let bytes = std::fs::read(dir.path().join(image["uri"].as_str().unwrap())).unwrap();
        assert!(read_bytes(&bytes).is_ok());
        let escaped: String = bytes.iter().map(|b| format!("%{b:02X}")).collect();
        image["uri"] = format!("data:image/png,{escaped}").into();
    }
    let own = dir.path().join("own.gltf");
    std::fs::write(&own, text.to_string()).unwrap();
    let inside = bake(&found(&own, &[Kind::Normal, Kind::Anisotropy]), &dir.path().join("b"));
    let [a, b] = [&outside, &inside].map(|m| &m.maps[0]);
    // the same maps; their files name what they were made of, and so does their identity
    assert_eq!(a.record.levels, b.record.levels);
    assert_ne!(a.record.recipe.hash, b.record.recipe.hash);
    assert_eq!(a.files.len(), 4);
    assert_eq!(b.record.inputs[0].file, "images[1]");
}

/// The scene gets its maps by the extension's own URI; materials, textures and factors stay.
#[test]
fn scenes_name_their_maps() {
    let dir = tempfile::tempdir().unwrap();
    let path = scene(dir.path(), &json!([material(0.5, 0.8), { "name": "plain" }, material(1.0, 1.0)]));
    for kinds in [&[Kind::Roughness][..], &[Kind::Roughness, Kind::Normal]] {
        let maps = found(&path, kinds);
        let tables = dir.path().join("tables");
        let manifest = bake(&maps, &tables);
        let uses: Vec<(usize, String)> = maps
            .maps
            .iter()
            .flat_map(|m| m.asked_by.iter().map(|a| (a.material.index.unwrap(), m.request.name.clone())))
            .collect();
        let baked = Bake { manifest: &manifest, folder: &tables };
        let written = |rewrite: bool, to: &str| {
            let request = Request { uses: uses.clone(), rewrite, ..Request::new(&path, dir.path().join(to)) };
            let done = write_scene::write(&request, Some(baked), &Settings::new(""), &Cancel::new()).unwrap();
            let bytes = std::fs::read(&done.scene).unwrap();
            let parts = brdfbake::scene::write::Parts::open(&bytes).unwrap();
            (serde_json::from_str::<Json>(&parts.text).unwrap(), done)
        };
        let old: Json = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
        for to in ["new/scene.gltf", "new/scene.glb"] {
            let (new, _) = written(false, to);
            for key in ["materials", "textures", "images", "samplers"] {
                assert_eq!(old[key], new[key], "{key}");
            }
            let object = &new["extensions"]["BRDFBAKE_lookup_tables"];
            let fits = kinds.contains(&Kind::Normal);
            let scale = |mut entry: Json| {
                if fits {
                    entry["normalScale"] = 1.into();
                }
                entry
            };
            assert_eq!(
                object["materials"][0],
                scale(json!({ "material": 0, "map": 0, "roughnessFactor": 1 }))
            );
            assert_eq!(
                object["materials"][1],
                scale(json!({ "material": 2, "map": 1, "roughnessFactor": 1 }))
            );
            let files = object["maps"][0]["files"].as_array().unwrap();
            assert_eq!(files.len(), kinds.len());
            assert_eq!(files[0]["channels"], json!(["R", "roughness", "B"]));
            let inside = to.ends_with("glb");
            assert_eq!(files[0].get("uri").is_none(), inside);
            if !inside {
                let file = dir.path().join("new").join(files[0]["uri"].as_str().unwrap());
                let hash = blake3::hash(&std::fs::read(file).unwrap()).to_hex().to_string();
                assert_eq!(files[0]["blake3"], hash.as_str());
            }
        }
        // the base level as a core texture, with its factor inside
        let (new, done) = written(true, "replaced/scene.gltf");
        assert_eq!(done.rewritten, [0, 2]);
        let pbr = &new["materials"][0]["pbrMetallicRoughness"];
        assert_eq!(pbr["roughnessFactor"], 1);
        let texture = &new["textures"]
            [usize::try_from(pbr["metallicRoughnessTexture"]["index"].as_u64().unwrap()).unwrap()];
        assert_eq!(texture["sampler"], 1);
        let image = &new["images"][usize::try_from(texture["source"].as_u64().unwrap()).unwrap()];
        let file = dir.path().join("replaced").join(image["uri"].as_str().unwrap());
        let level = read_bytes(&std::fs::read(file).unwrap()).unwrap();
        assert_eq!((level.width, level.height), (8, 8));
        let codes = [0, 1, 2].map(|c: usize| (level.planes[c].values[0] * 255.0).round().to_string());
        assert_eq!(codes, ["255", "64", "50"]);
        if kinds.contains(&Kind::Normal) {
            assert_eq!(new["materials"][0]["normalTexture"]["scale"], 1);
        }
    }
}

/// A file from above the scene's folder takes no other's name: not of a file that is there, nor of one of the scene's own.
#[test]
fn files_from_above_take_no_name() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("models");
    std::fs::create_dir_all(folder.join("textures")).unwrap();
    std::fs::create_dir(dir.path().join("textures")).unwrap();
    let path = scene(&folder, &json!([material(1.0, 1.0)]));
    std::fs::rename(folder.join("n.png"), folder.join("textures/x.png")).unwrap();
    std::fs::rename(folder.join("mr.png"), dir.path().join("textures/x.png")).unwrap();
    let mut text: Json = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    // the one from above first
    text["images"] = json!([{ "uri": "../textures/x.png" }, { "uri": "textures/x.png" }]);
    std::fs::write(&path, text.to_string()).unwrap();
    let to = dir.path().join("new");
    std::fs::create_dir_all(to.join("textures")).unwrap();
    let read = |path: &Path| std::fs::read(path).unwrap();
    let (own, above) = (read(&folder.join("textures/x.png")), read(&dir.path().join("textures/x.png")));
    let write = || {
        let root = Some(dir.path().to_owned());
        let request = Request { root, ..Request::new(&path, to.join("scene.gltf")) };
        let done = write_scene::write(&request, None, &Settings::new(""), &Cancel::new()).unwrap();
        let text: Json = serde_json::from_slice(&read(&done.scene)).unwrap();
        [0, 1].map(|i: usize| text["images"][i]["uri"].as_str().unwrap().to_owned())
    };
    let [first, second] = write();
    assert_eq!(second, "textures/x.png");
    assert!(first.starts_with("textures/x-") && first.ends_with(".png"), "{first}");
    assert!(read(&to.join(&first)) == above && read(&to.join(&second)) == own);
    // the same again, and once more beside a file of somebody else
    assert_eq!(write(), [first.clone(), second.clone()]);
    let mut text: Json = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    text["images"] = json!([{ "uri": "../textures/x.png" }, { "uri": "../textures/x.png" }]);
    std::fs::write(&path, text.to_string()).unwrap();
    assert_eq!(write(), [first.clone(), first]);
    assert!(read(&to.join("textures/x.png")) == own);
}
