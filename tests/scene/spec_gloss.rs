//! Specular-glossiness to metallic-roughness: the published numbers, and what is written.

use std::fs;
use std::path::{Path, PathBuf};

use brdfbake::cancel::Cancel;
use brdfbake::maps::spec_gloss::{diffuse_ratio, solve};
use brdfbake::picture;
use brdfbake::pipeline::Settings;
use brdfbake::pipeline::write_scene::convert::{ConvertError, Converted, Mode, NAME, error_maps};
use brdfbake::pipeline::write_scene::{self, Request, SceneWriteError};
use serde_json::{Value, json};

use super::fixture;
use crate::common::shared;
use crate::tolerance::{F0_OF_CODES, FEW_ROUNDINGS, FIVE_DIGITS, LOBE_DIGITS_NINE, QUOTED_DIGITS};

/// Diffuse, specular, base, metallic, error of F0.
type Row = ([f64; 3], [f64; 3], [f64; 3], f64, f64);

/// Values of a calculation of its own (numpy).
const SOLVED: [Row; 6] = [
    ([0.5, 0.25, 0.1], [0.04; 3], [0.5, 0.25, 0.1], 0.0, 0.0),
    ([0.0; 3], [0.955, 0.638, 0.538], [0.955, 0.638, 0.538], 1.0, 0.0),
    ([0.5, 0.25, 0.1], [0.02; 3], [0.510416667, 0.255208333, 0.102083333], 0.0, 0.02),
    ([0.3, 0.2, 0.1], [0.2; 3], [0.45908993, 0.335185668, 0.211281406], 0.486851143, 0.0766),
    ([0.1; 3], [0.5, 0.4, 0.3], [0.539136167, 0.450202233, 0.361268299], 0.889339343, 0.0257),
    ([0.5; 3], [0.5; 3], [0.746461948; 3], 0.651132027, 0.0),
];

#[test]
fn the_published_conversion_and_its_error() {
    for (diffuse, specular, base, metallic, error) in SOLVED {
        let got = solve(diffuse, specular);
        for (a, b) in got.base.iter().zip(base) {
            assert!((a - b).abs() < LOBE_DIGITS_NINE, "{diffuse:?} {specular:?}: {got:?}");
        }
        assert!((got.metallic - metallic).abs() < LOBE_DIGITS_NINE, "{diffuse:?} {specular:?}: {got:?}");
        assert!(
            (got.f0_error(specular) - error).abs() < QUOTED_DIGITS,
            "{diffuse:?} {specular:?}: {}",
            got.f0_error(specular)
        );
    }
    // no pair of colours is out of range
    for i in 0..1000 {
        let part = |k: u32| f64::from((i * 37 + k * 101) % 1000) / 999.0;
        let got = solve([part(1), part(2), part(3)], [part(4), part(5), part(6)]);
        assert!(got.base.iter().all(|b| (0.0..=1.0).contains(b)) && (0.0..=1.0).contains(&got.metallic));
    }
}

#[test]
fn the_diffuse_part_of_an_exact_conversion() {
    for (mu, ratio) in [(1.0, 0.99992), (0.5, 0.99504), (0.2, 0.98469), (0.1, 0.97900), (0.02, 0.97340)] {
        assert!((diffuse_ratio(mu) - ratio).abs() < FIVE_DIGITS, "{mu}: {}", diffuse_ratio(mu));
    }
}

fn convert(scene: &Path, to: &Path, mode: Mode) -> Result<write_scene::SceneOutcome, SceneWriteError> {
    let request = Request { convert: Some(mode), ..Request::new(scene, to) };
    write_scene::write(&request, None, &Settings::new(""), &Cancel::new())
}

fn json_of(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// The codes of a picture of 8 bits that a texture of a scene samples.
fn codes(scene: &Path, root: &Value, info: &Value) -> Vec<Vec<f64>> {
    let number = |v: &Value| usize::try_from(v.as_u64().unwrap()).unwrap();
    let texture = &root["textures"][number(&info["index"])];
    let image = &root["images"][number(&texture["source"])];
    let bytes = fs::read(scene.parent().unwrap().join(image["uri"].as_str().unwrap())).unwrap();
    let picture = picture::read_bytes(&bytes).unwrap();
    let plane = |name: &str| {
        picture.plane(name).unwrap().values.iter().map(|v| f64::from((v * 255.0).round())).collect()
    };
    ["R", "G", "B"].map(plane).to_vec()
}

/// The scene of the tables of values: a copy of ours, or the shared one.
fn scenes() -> Vec<PathBuf> {
    vec![fixture("spec_gloss/eight.gltf")]
}

#[test]
fn eight_texels_by_both_ways() {
    let expected = json_of(&fixture("spec_gloss/expected.json"));
    for scene in scenes() {
        let out = tempfile::tempdir().unwrap();
        let done = convert(&scene, out.path(), Mode::Solve).unwrap();
        let root = json_of(&done.scene);
        assert!(!fs::read_to_string(&done.scene).unwrap().contains(NAME));
        let pbr = &root["materials"][0]["pbrMetallicRoughness"];
        let (base, rest) = (
            codes(&done.scene, &root, &pbr["baseColorTexture"]),
            codes(&done.scene, &root, &pbr["metallicRoughnessTexture"]),
        );
        for (i, want) in expected.as_array().unwrap().iter().enumerate() {
            for c in 0..3 {
                assert_eq!(Some(base[c][i]), want["base8"][c].as_f64(), "texel {i}");
            }
            assert_eq!(
                (Some(rest[1][i]), Some(rest[2][i])),
                (want["roughness8"].as_f64(), want["metallic8"].as_f64()),
                "texel {i}"
            );
        }
        let [one]: [Converted; 1] = done.converted.try_into().unwrap();
        // texel 3: specular 124/255, diffuse 149, 124, 89
        assert_eq!((one.size, one.at), ([4, 2], [3, 0]));
        assert!((one.f0_error - 0.0766).abs() < F0_OF_CODES, "{}", one.f0_error);
        assert!((one.f0_error_stored - one.f0_error).abs() < F0_OF_CODES);
        let maps = error_maps(std::slice::from_ref(&one), &Cancel::new()).unwrap();
        assert_eq!(maps[0].0, "material0.f0-error.exr");

        let exact = tempfile::tempdir().unwrap();
        let done = convert(&scene, exact.path(), Mode::Exact).unwrap();
        let root = json_of(&done.scene);
        let material = &root["materials"][0];
        assert_eq!(material["extensions"]["KHR_materials_ior"], json!({ "ior": 0 }));
        assert_eq!(
            material["extensions"]["KHR_materials_specular"],
            json!({ "specularColorTexture": { "index": 1 } })
        );
        assert_eq!(material["pbrMetallicRoughness"]["baseColorTexture"], json!({ "index": 0 }));
        assert_eq!(root["extensionsUsed"], json!(["KHR_materials_specular", "KHR_materials_ior"]));
        let rest = codes(&done.scene, &root, &material["pbrMetallicRoughness"]["metallicRoughnessTexture"]);
        for (i, want) in expected.as_array().unwrap().iter().enumerate() {
            assert_eq!(Some(rest[1][i]), want["roughness8"].as_f64(), "texel {i}");
        }
        assert_eq!(done.converted[0].f0_error, 0.0);
        assert!(done.converted[0].roughness_error_stored < FEW_ROUNDINGS);
        assert_eq!(done.converted[0].diffuse_ratio.len(), 5);
    }
}

#[test]
fn the_shared_scene_gives_the_values_beside_it() {
    let Some(shared) = shared() else { return };
    let cases = shared.join("cases/scenes");
    assert_eq!(
        json_of(&cases.join("s02-expected-solve.json")),
        json_of(&fixture("spec_gloss/expected.json"))
    );
    let out = [0, 1].map(|_| tempfile::tempdir().unwrap());
    let theirs = convert(&cases.join("s02-textured.gltf"), out[0].path(), Mode::Solve).unwrap();
    let ours = convert(&scenes()[0], out[1].path(), Mode::Solve).unwrap();
    assert_eq!(theirs.converted[0].errors, ours.converted[0].errors);
}

/// Factors alone, numbers as text, other extensions, and the material beside it.
#[test]
fn factors_need_no_picture() {
    let out = tempfile::tempdir().unwrap();
    let scene = out.path().join("s.gltf");
    let own =
        r#"{"diffuseFactor":[0.30,0.2,0.1,0.50],"specularFactor":[2.0e-1,0.2,0.2],"glossinessFactor":0.25}"#;
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"extensionsUsed":["{NAME}","KHR_texture_transform"],"materials":[{{"name":"a","alphaCutoff":0.10000000149011612,"extensions":{{"{NAME}":{own}}}}},{{"name":"b"}}]}}"#
    );
    fs::write(&scene, &text).unwrap();
    let done = convert(&scene, &out.path().join("e.gltf"), Mode::Exact).unwrap();
    let written = fs::read_to_string(&done.scene).unwrap();
    for kept in [
        r#""baseColorFactor":[0.30,0.2,0.1,0.50]"#,
        r#""specularColorFactor":[2.0e-1,0.2,0.2]"#,
        "0.10000000149011612",
        r#"{"name":"b"}"#,
    ] {
        assert!(written.contains(kept), "{kept}: {written}");
    }
    let root = json_of(&done.scene);
    assert_eq!(root["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"], 0.75);
    assert_eq!(
        root["extensionsUsed"],
        json!(["KHR_texture_transform", "KHR_materials_specular", "KHR_materials_ior"])
    );
    let done = convert(&scene, &out.path().join("s2.gltf"), Mode::Solve).unwrap();
    let root = json_of(&done.scene);
    assert_eq!(root["materials"][0].get("extensions"), None);
    let metallic = root["materials"][0]["pbrMetallicRoughness"]["metallicFactor"].as_f64().unwrap();
    assert!((metallic - 0.486851143).abs() < LOBE_DIGITS_NINE);
    assert!((done.converted[0].f0_error - 0.0766).abs() < QUOTED_DIGITS);
    assert_eq!(done.files, ["s2.gltf"]);
}

#[test]
fn what_one_picture_cannot_hold_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("s.gltf");
    let fault = |own: &str, more: &str, mode: Mode| {
        let text = format!(
            r#"{{"asset":{{"version":"2.0"}},"extensionsUsed":["{NAME}"],"images":[{{"uri":"d.png"}},{{"uri":"s.png"}}],
               "samplers":[{{"wrapS":33071}}],"textures":[{{"source":0}},{{"source":1}},{{"source":1,"sampler":0}},{{}}]
               {more},"materials":[{{"extensions":{{"{NAME}":{own}}}}}]}}"#
        );
        fs::write(&scene, text).unwrap();
        for (from, to) in [("sg-diffuse.png", "d.png"), ("sg-specgloss.png", "s.png")] {
            fs::copy(fixture("spec_gloss").join(from), folder.path().join(to)).unwrap();
        }
        convert(&scene, &folder.path().join("new.gltf"), mode).map(|_| ())
    };
    let with =
        |second: &str| format!(r#"{{"diffuseTexture":{{"index":0}},"specularGlossinessTexture":{second}}}"#);
    let alike = |second: &str| match fault(&with(second), "", Mode::Solve) {
        Err(SceneWriteError::Convert(ConvertError::Coordinates { what, .. })) => what,
        other => panic!("{other:?}"),
    };
    assert_eq!(alike(r#"{"index":1,"texCoord":1}"#), "UV set");
    assert_eq!(
        alike(r#"{"index":1,"extensions":{"KHR_texture_transform":{"scale":[2,2]}}}"#),
        "KHR_texture_transform"
    );
    assert_eq!(alike(r#"{"index":2}"#), "wrap mode");
    // kept apart they are fine
    fault(&with(r#"{"index":1,"texCoord":1}"#), "", Mode::Exact).unwrap();
    let text = |own: &str, more: &str| fault(own, more, Mode::Exact).unwrap_err().to_string();
    assert!(text(&with(r#"{"index":3}"#), "").contains("no core image"));
    assert!(text(r#"{"glossinessFactor":1.5}"#, "").contains("glossinessFactor = 1.5, allowed [0, 1]"));
    let pointer = format!(
        r#","animations":[{{"channels":[{{"target":{{"extensions":{{"KHR_animation_pointer":{{"pointer":"/materials/0/extensions/{NAME}/glossinessFactor"}}}}}}}}]}}]"#
    );
    assert!(text(&with(r#"{"index":1}"#), &pointer).contains("an animation changes"));
}
