//! Spheres by integration and by tables.

use super::support::{brdfbake, code, err, folder, out, text, write};
use brdfbake::encode::read::read_file;
use serde_json::Value as Json;

/// F_ms E_ms of white metal is 1 - E, but for rounding.
const CANCELS: f64 = 1e-9;
/// What a 32-bit float of an EXR and the tolerance of the moments leave of 1.
const STORED: f64 = 1e-5;
/// What the default table is off by over roughness 0.2 to 0.6, rounding to half included, as the table of the guide's page has it.
const TABLE: [f64; 2] = [1e-6, 1e-3];

fn numbers(args: &[&str]) -> Vec<Json> {
    let o = brdfbake(&[&["preview", "--json"], args].concat());
    assert_eq!(code(&o), 0, "{}", err(&o));
    let all: Json = serde_json::from_str(&out(&o)).unwrap();
    all["spheres"].as_array().unwrap().clone()
}

fn number(sphere: &Json, key: &str) -> f64 {
    sphere[key].as_f64().unwrap()
}

#[test]
fn white_metal_in_a_furnace_is_white_and_grey_metal_errs_by_its_table() {
    let dir = folder();
    let file = dir.path().join("white.exr");
    let white = ["--furnace", "--base", "1,1,1", "--size", "16", "-o", text(&file)];
    for sphere in numbers(&white) {
        assert!(number(&sphere, "largest") < CANCELS, "{sphere}");
    }
    let image = read_file(&file).unwrap();
    let red = image.channel("integrated.R").unwrap();
    assert_eq!((image.width, image.height), (80, 16));
    assert!(red.values.iter().all(|v| *v == 0.0 || (v - 1.0).abs() < STORED));
    let grey =
        ["--furnace", "--base", "0.5,0.5,0.5", "--size", "16", "--roughness", "0.2,0.6", "-o", text(&file)];
    for sphere in numbers(&grey) {
        // a uniform sky makes the prefiltered environment exact: what is left is the table, rounding to half included
        let [all, table] = ["largest", "table_largest"].map(|k| number(&sphere, k));
        assert!(all > TABLE[0] && all < TABLE[1] && (all - table).abs() < STORED, "{sphere}");
        assert!(number(&sphere, "own_error") < STORED);
    }
}

#[test]
fn the_table_of_an_engine_shows_its_size() {
    let dir = folder();
    let file = dir.path().join("p.png");
    let args =
        ["--furnace", "--base", "0.5,0.5,0.5", "--size", "16", "--roughness", "0.3", "-o", text(&file)];
    let own = number(&numbers(&args)[0], "table_largest");
    // 16 x 16 texels against 64 x 64 on axes that follow the lobe
    let three = numbers(&[&args[..], &["--engine", "three"]].concat());
    assert!(number(&three[0], "table_largest") > own, "{} {own}", three[0]);
    let o = brdfbake(&["preview", "--engine", "osl", "-o", text(&file)]);
    assert_eq!(code(&o), 6, "{}", err(&o));
    assert!(err(&o).contains("no split sum"), "{}", err(&o));
}

#[test]
fn the_materials_of_a_scene_are_spheres() {
    let dir = folder();
    let file = dir.path().join("p.png");
    let scene = "tests/scenes/four_materials.glb";
    let spheres = numbers(&["--scene", scene, "--size", "16", "-o", text(&file)]);
    let names: Vec<&str> = spheres.iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["car paint", "velvet seat", "worn steel"]);
    let steel = &spheres[2];
    assert!((number(steel, "metallic") - 1.0).abs() < 1e-9 && number(steel, "roughness") > 0.3, "{steel}");
    let size = read_file(&file).unwrap();
    assert_eq!((size.width, size.height), (48, 48));
}

#[test]
fn a_terminal_gets_the_picture() {
    let run = |protocol: &str| {
        out(&brdfbake(&["preview", "--size", "16", "--roughness", "0.5", "--terminal", protocol]))
    };
    let kitty = run("kitty");
    assert!(kitty.starts_with("\u{1b}_Gf=100,a=T,m=") && kitty.contains("\u{1b}\\"));
    let iterm = run("iterm");
    let size: usize = iterm.split("size=").nth(1).unwrap().split(':').next().unwrap().parse().unwrap();
    let data = iterm.split(':').nth(1).unwrap().split('\u{7}').next().unwrap();
    assert_eq!(data.trim_end_matches('=').len() * 3 / 4, size);
    assert!(iterm.starts_with("\u{1b}]1337;File=inline=1;"));
}

/// A square plate that faces the viewer, and another behind it, turned away, of glTF 2.0 in text.
fn plates(two_sided: bool) -> String {
    let corners: [[f32; 3]; 4] = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let mut bytes: Vec<u8> = corners.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    bytes.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
    let data: String = bytes.iter().map(|b| format!("%{b:02x}")).collect();
    serde_json::json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [
            { "children": [1, 2], "scale": [2, 2, 2] },
            { "mesh": 0 },
            { "mesh": 1, "translation": [0, 0, -1], "rotation": [0, 1, 0, 0] },
        ],
        "materials": [
            { "name": "near", "pbrMetallicRoughness": { "roughnessFactor": 0.5 } },
            { "name": "far", "doubleSided": two_sided, "pbrMetallicRoughness": { "roughnessFactor": 0.7 } },
        ],
        "meshes": [
            { "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "material": 0 }] },
            { "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "material": 1 }] },
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 48, "byteLength": 12 },
        ],
        "buffers": [{ "byteLength": 60, "uri": format!("data:application/octet-stream,{data}") }],
    })
    .to_string()
}

/// The middle of a plate is the point of a sphere whose normal looks at the viewer; what is hidden or turned away is not seen.
#[test]
fn a_mesh_is_shaded_as_spheres_are() {
    let dir = folder();
    let scene = write(dir.path(), "plates.gltf", &plates(false));
    let (mesh, sphere) = (dir.path().join("mesh.exr"), dir.path().join("sphere.exr"));
    let shade = |turn: &str| {
        let o = brdfbake(&[
            "preview",
            "--json",
            "--size",
            "33",
            "--scene",
            text(&scene),
            "--mesh",
            "--turn",
            turn,
            "-o",
            text(&mesh),
        ]);
        assert_eq!(code(&o), 0, "{}", err(&o));
        let all: Json = serde_json::from_str(&out(&o)).unwrap();
        all["materials"].as_array().unwrap().clone()
    };
    let front = shade("0");
    assert_eq!(front.len(), 2);
    let pixels = |m: &[Json], i: usize| m[i]["pixels"].as_u64().unwrap();
    assert!(pixels(&front, 0) > 400 && pixels(&front, 1) == 0, "{front:?}");
    // glTF's base colour is white where none is given
    numbers(&["--size", "33", "--roughness", "0.5", "--base", "1,1,1", "-o", text(&sphere)]);
    let [a, b] = [&mesh, &sphere].map(|f| read_file(f).unwrap());
    for channel in ["integrated.R", "read.G", "difference.B"] {
        let middle = 16 * 33 + 16;
        let [a, b] = [&a, &b].map(|i| i.channel(channel).unwrap().values[middle]);
        assert!((a - b).abs() < STORED, "{channel}: {a} {b}");
    }
    // from behind it is the other one's front, and no longer hidden
    let back = shade("180");
    assert!(pixels(&back, 0) == 0 && pixels(&back, 1) > 400, "{back:?}");
    let bytes = std::fs::read(&mesh).unwrap();
    shade("180");
    assert_eq!(bytes, std::fs::read(&mesh).unwrap());
    // both sides of the far one, from the side of the near one: still hidden
    write(dir.path(), "plates.gltf", &plates(true));
    assert_eq!(pixels(&shade("0"), 1), 0);
    // --mesh without a scene, and a scene without triangles
    let o = brdfbake(&["preview", "--mesh", "-o", text(&mesh)]);
    assert_eq!(code(&o), 2, "{}", err(&o));
    let empty = write(dir.path(), "empty.gltf", r#"{ "asset": { "version": "2.0" }, "materials": [{}] }"#);
    let o = brdfbake(&["preview", "--scene", text(&empty), "--mesh", "-o", text(&mesh)]);
    assert!(code(&o) == 3 && err(&o).contains("no triangle"), "{}", err(&o));
}
