//! Spheres by integration and by tables.

use super::support::{brdfbake, code, err, folder, out, text};
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
