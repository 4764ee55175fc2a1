//! Scenes to tables: what ranges do to axes, what pictures tell, and what is left out. Values are those of the files, by hand, or of
//! the extensions' formulas.

use super::scene_of;
use crate::tolerance::{FEW_ROUNDINGS, MANY_ROUNDINGS};
use brdfbake::plan::Plan;
use brdfbake::plan::scene::{Kept, Survey, SurveyOptions, asked, plan, survey, survey_with};
use brdfbake::scene::{LeftOutKind, Needs, Reader, analyse};
use std::path::{Path, PathBuf};

/// Values that are written with nine digits or more behind the point.
const NINE_DIGITS: f64 = 1e-9;
/// Half of the sixth digit behind the point.
const HALF_A_DIGIT: f64 = 5e-7;

const MESH: &str = r#"{ "attributes": { "POSITION": 0, "NORMAL": 1 }, "material": 0 }"#;

fn needs(materials: &str) -> Needs {
    let count = materials.matches("\"pbr").count().max(1);
    let primitives: Vec<String> =
        (0..count).map(|i| format!(r#"{{ "attributes": {{ "NORMAL": 1 }}, "material": {i} }}"#)).collect();
    analyse(&scene_of(materials, &primitives.join(","), ""))
}

fn range(needs: &Needs, table: &str, id: &str) -> [f64; 2] {
    let need = needs.needs.iter().find(|n| n.table == table).unwrap_or_else(|| panic!("no {table}"));
    let range = need.ranges.get(id).unwrap_or_else(|| panic!("{table} has no {id}"));
    [range.lo, range.hi]
}

/// The axes of a table: id, domain, length.
fn axes(plan: &Plan, table: &str) -> Vec<(&'static str, [f64; 2], usize)> {
    let table = plan.tables.iter().find(|t| t.name() == table).unwrap_or_else(|| panic!("no {table}"));
    table.bound.spec.grid.axes().iter().map(|a| (a.quantity.id, a.domain, a.len)).collect()
}

fn channels(plan: &Plan, table: &str) -> Vec<&'static str> {
    plan.tables.iter().find(|t| t.name() == table).unwrap().bound.spec.layout.ids().collect()
}

fn close(a: [f64; 2], b: [f64; 2]) {
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < NINE_DIGITS), "{a:?} against {b:?}");
}

fn pbr(text: &str, extensions: &str) -> String {
    format!(r#"{{ "pbrMetallicRoughness": {{ {text} }}, "extensions": {{ {extensions} }} }}"#)
}

#[test]
fn ranges_trim_axes_and_one_value_drops_one() {
    let two =
        [pbr(r#""roughnessFactor": 0.25"#, ""), pbr(r#""roughnessFactor": 0.6, "metallicFactor": 0"#, "")];
    let planned = plan(&needs(&two.join(","))).unwrap().unwrap();
    for table in ["ggx-dfg", "ggx-albedo"] {
        let axes = axes(&planned, table);
        assert_eq!(axes[1].1, [0.25, 0.6], "{table}");
        assert!(axes[1].2 < 64 && axes[0].1 == [0.0, 1.0], "{table}: {axes:?}");
    }
    let one = plan(&needs(&two[1])).unwrap().unwrap();
    assert_eq!(axes(&one, "ggx-dfg").iter().map(|a| a.0).collect::<Vec<_>>(), ["mu"]);
    let alpha = one.tables[0].bound.spec.model.as_ref().unwrap().1.number("alpha").unwrap();
    assert!((alpha - 0.36).abs() < FEW_ROUNDINGS);
    assert_eq!(channels(&one, "ggx-dfg"), ["dfg.scale", "dfg.bias"]);
}

#[test]
fn a_white_metal_needs_no_split_and_a_coloured_one_does() {
    // F = F0 + (1 - F0) (1 - v.h)^5 is 1 only where F0 is: the spec's metal keeps F90 = 1
    let white = plan(&needs(&pbr(r#""roughnessFactor": 0.4"#, ""))).unwrap().unwrap();
    assert_eq!(channels(&white, "ggx-dfg"), ["dfg.total"]);
    let gold = plan(&needs(&pbr(r#""roughnessFactor": 0.4, "baseColorFactor": [1, 0.77, 0.34, 1]"#, "")));
    assert_eq!(channels(&gold.unwrap().unwrap(), "ggx-dfg"), ["dfg.scale", "dfg.bias"]);
}

#[test]
fn mirrors_and_things_without_effect_ask_for_nothing() {
    let glass =
        r#""KHR_materials_transmission": { "transmissionFactor": 1 }, "KHR_materials_ior": { "ior": 1.33 }"#;
    let smooth = needs(&pbr(r#""roughnessFactor": 0, "metallicFactor": 0"#, glass));
    assert_eq!(smooth.needs, []);
    assert!(!smooth.in_doubt());
    let closed = r#""KHR_materials_volume": { "thicknessFactor": 1 }, "KHR_materials_dispersion": { "dispersion": 0.5 }"#;
    let closed = needs(&pbr(r#""roughnessFactor": 0.5, "metallicFactor": 0"#, closed));
    assert_eq!(closed.needs.iter().map(|n| n.table.as_ref()).collect::<Vec<_>>(), ["ggx"]);
    for name in ["KHR_materials_volume", "KHR_materials_dispersion"] {
        let left = closed.left_out.iter().find(|l| l.what == name).unwrap();
        assert!(left.kind == LeftOutKind::AsksForNothing && left.why.starts_with("no effect"), "{left}");
    }
    let points = scene_of("{}", r#"{ "attributes": { "POSITION": 0 }, "material": 0, "mode": 0 }"#, "");
    assert_eq!(analyse(&points).needs, []);
    // with normals they are lit
    let lit = scene_of("{}", r#"{ "attributes": { "NORMAL": 0 }, "material": 0, "mode": 1 }"#, "");
    assert_eq!(analyse(&lit).needs.len(), 1);
}

#[test]
fn rough_glass_is_asked_for_from_both_sides_at_the_indices_that_occur() {
    let glass = |rough: f64, ior: f64| {
        let more = format!(
            r#""KHR_materials_transmission": {{ "transmissionFactor": 1 }}, "KHR_materials_ior": {{ "ior": {ior} }},
               "KHR_materials_volume": {{ "thicknessFactor": 1 }}"#
        );
        pbr(&format!(r#""roughnessFactor": {rough}, "metallicFactor": 0"#), &more)
    };
    let two = needs(&[glass(0.4, 1.33), glass(0.2, 1.76)].join(","));
    assert_eq!(range(&two, "glass", "roughness"), [0.2, 0.4]);
    assert_eq!(range(&two, "glass", "ior"), [1.33, 1.76]);
    // ((n - 1) / (n + 1))², by hand
    close(range(&two, "ggx", "f0"), [0.020_059_312, 0.075_824_407]);
    let planned = plan(&two).unwrap().unwrap();
    assert_eq!(channels(&planned, "glass-albedo"), ["r", "t", "r.inside", "t.inside"]);
    let axes = axes(&planned, "glass-albedo");
    assert_eq!((axes[1].1, axes[2]), ([0.2, 0.4], ("eta", [1.33, 1.76], 2)));
}

#[test]
fn sheen_film_and_anisotropy_follow_their_extensions() {
    let sheen =
        r#""KHR_materials_sheen": { "sheenColorFactor": [0.2, 0.3, 0.1], "sheenRoughnessFactor": 0.35 }"#;
    let planned =
        plan(&needs(&pbr(r#""roughnessFactor": 0.8, "metallicFactor": 0"#, sheen))).unwrap().unwrap();
    let of = axes(&planned, "sheen-albedo");
    assert_eq!((of.len(), of[0].0, of[0].1[1]), (1, "mu", 1.0));
    assert!(of[0].1[0] > 0.0, "E passes 1 at mu = 0");
    let sheen = planned.tables.iter().find(|t| t.name() == "sheen-albedo").unwrap();
    let r = sheen.bound.spec.model.as_ref().unwrap().1.number("roughness").unwrap();
    assert!((r - 0.1225).abs() < FEW_ROUNDINGS);

    let film = r#""KHR_materials_iridescence": { "iridescenceFactor": 1, "iridescenceIor": 1.4,
        "iridescenceThicknessMinimum": 200, "iridescenceThicknessMaximum": 500 }"#;
    let planned =
        plan(&needs(&pbr(r#""roughnessFactor": 0.1, "metallicFactor": 0"#, film))).unwrap().unwrap();
    let of = axes(&planned, "film-fresnel");
    assert_eq!(
        of.iter().map(|a| (a.0, a.1)).collect::<Vec<_>>(),
        [("mu", [0.0, 1.0]), ("film", [200.0, 500.0])]
    );
    let film = planned.tables.iter().find(|t| t.name() == "film-fresnel").unwrap();
    let n = |id: &str| film.bound.spec.params.number(id).unwrap();
    assert!((n("n2") - 1.4).abs() < FEW_ROUNDINGS && (n("n3") - 1.5).abs() < MANY_ROUNDINGS);

    let brushed = r#""KHR_materials_anisotropy": { "anisotropyStrength": 0.6 }"#;
    let brushed = needs(&pbr(r#""roughnessFactor": 0.3"#, brushed));
    // alpha_b = 0.09, alpha_t = 0.09 + 0.91 0.36
    close(range(&brushed, "anisotropic", "alpha_x"), [0.4176; 2]);
    close(range(&brushed, "anisotropic", "alpha_y"), [0.09; 2]);
    let planned = plan(&brushed).unwrap().unwrap();
    assert_eq!(axes(&planned, "anisotropic-albedo").iter().map(|a| a.0).collect::<Vec<_>>(), ["mu", "phi"]);
}

#[test]
fn dispersion_spreads_the_index_over_three() {
    let glass = r#""KHR_materials_transmission": { "transmissionFactor": 1 }, "KHR_materials_volume": { "thicknessFactor": 1 },
        "KHR_materials_dispersion": { "dispersion": 2 }"#;
    let needs = needs(&pbr(r#""roughnessFactor": 0.3, "metallicFactor": 0"#, glass));
    // half spread (1.5 - 1) 0.025 2 on either side
    close(range(&needs, "glass", "ior"), [1.475, 1.525]);
}

#[test]
fn shaders_that_clamp_and_widen_are_followed() {
    let scene = scene_of(&pbr(r#""roughnessFactor": 0"#, ""), MESH, "");
    let reader = Reader { at_least: 0.0525, widens: true, ..Reader::default() };
    let needs = brdfbake::scene::analyse_with(&scene, &brdfbake::scene::Look::none(), reader);
    assert_eq!(range(&needs, "ggx", "roughness"), [0.0525, 1.0]);
    let reader = Reader { margin: 0.1, ..Reader::default() };
    let scene = scene_of(&pbr(r#""roughnessFactor": 0.5"#, ""), MESH, "");
    let needs = brdfbake::scene::analyse_with(&scene, &brdfbake::scene::Look::none(), reader);
    assert_eq!(range(&needs, "ggx", "roughness"), [0.4, 0.6]);
}

pub(super) fn write_png(path: &Path, width: u32, texels: &[[u8; 3]]) {
    let mut encoder = png::Encoder::new(
        std::fs::File::create(path).unwrap(),
        width,
        u32::try_from(texels.len()).unwrap() / width,
    );
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().unwrap().write_image_data(texels.as_flattened()).unwrap();
}

fn textured(uri: &str) -> String {
    textured_with(uri, r#""roughnessFactor": 0.8, "#)
}

pub(super) fn textured_with(uri: &str, factors: &str) -> String {
    format!(
        r#"{{ "asset": {{ "version": "2.0" }}, "images": [{{ "uri": "{uri}" }}], "textures": [{{ "source": 0 }}],
            "materials": [{{ "pbrMetallicRoughness": {{ {factors}"metallicRoughnessTexture": {{ "index": 0 }} }} }}],
            "meshes": [{{ "primitives": [{{ "attributes": {{ "NORMAL": 1 }}, "material": 0 }}] }}] }}"#
    )
}

fn surveyed(file: &Path, options: &SurveyOptions) -> Survey {
    survey(&[PathBuf::from(file)], options).unwrap()
}

#[test]
fn texels_of_pictures_bound_the_range() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(folder.path().join("inner/textures")).unwrap();
    let levels = [45, 60, 75, 90].map(|g| [0, g, 255]);
    for at in ["inner/textures/mr.png", "mr.png"] {
        write_png(&folder.path().join(at), 2, &levels);
    }
    let file = folder.path().join("inner/a.gltf");
    let default = SurveyOptions::default();
    // 0.8 45/255 and 0.8 90/255; an escaped slash is a slash
    for uri in ["textures/mr.png", "textures%2Fmr.png"] {
        std::fs::write(&file, textured(uri)).unwrap();
        let found = surveyed(&file, &default);
        close(range(&found.needs, "ggx", "roughness"), [0.141_176_470_588, 0.282_352_941_176]);
        assert!(found.needs.needs[0].asked_by[0].why.contains("texture of 4 levels"));
        assert!(!found.needs.in_doubt());
    }
    std::fs::write(&file, textured("../mr.png")).unwrap();
    let outside = surveyed(&file, &default);
    assert_eq!(range(&outside.needs, "ggx", "roughness"), [0.0, 0.8]);
    let left = outside.needs.left_out.iter().find(|l| l.kind == LeftOutKind::Unknown).unwrap();
    assert!(left.why.contains("--root"), "{left}");
    let rooted = SurveyOptions { root: Some(folder.path().to_owned()), ..SurveyOptions::default() };
    close(range(&surveyed(&file, &rooted).needs, "ggx", "roughness"), [0.141_176_470_588, 0.282_352_941_176]);
    // a limit on pixels makes it unknown
    std::fs::write(&file, textured("textures/mr.png")).unwrap();
    let small = SurveyOptions { pixels: 2, ..SurveyOptions::default() };
    let left = surveyed(&file, &small).needs.left_out;
    assert!(left.iter().any(|l| l.why.contains("--pixels")), "{left:?}");
}

#[test]
fn several_scenes_make_one_plan() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, rough: f64| {
        let text = format!(
            r#"{{ "asset": {{ "version": "2.0" }}, "materials": [{{ "pbrMetallicRoughness": {{ "roughnessFactor": {rough} }} }}],
                "meshes": [{{ "primitives": [{{ "attributes": {{ "NORMAL": 1 }}, "material": 0 }}] }}] }}"#
        );
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    let files = [write("a.gltf", 0.3), write("b.gltf", 0.7)];
    let both = survey(&files, &SurveyOptions::default()).unwrap();
    assert_eq!(range(&both.needs, "ggx", "roughness"), [0.3, 0.7]);
    assert_eq!(both.scenes.iter().map(|s| s.file.as_str()).collect::<Vec<_>>(), ["a.gltf", "b.gltf"]);
    let names: Vec<String> = asked(&both.needs).unwrap().into_iter().map(|a| a.request.name).collect();
    assert_eq!(names, ["ggx-dfg", "ggx-albedo", "ggx-average-albedo"]);
    let broken = folder.path().join("c.gltf");
    std::fs::write(&broken, "{}").unwrap();
    let faults = survey(&[files[0].clone(), broken], &SurveyOptions::default()).unwrap_err();
    assert_eq!(faults.len(), 1);
}

#[test]
fn what_was_found_is_kept_until_a_file_changes() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.gltf");
    write_png(&folder.path().join("mr.png"), 1, &[[0, 51, 0]]);
    std::fs::write(&file, textured("mr.png")).unwrap();
    let (files, options, shelf) = ([file.clone()], SurveyOptions::default(), folder.path().join("kept"));
    let run = |options: &SurveyOptions| {
        let mut kept = Kept::read(&shelf, options);
        let (found, read) = survey_with(&files, options, &mut kept).unwrap();
        kept.write(&shelf).unwrap();
        (range(&found.needs, "ggx", "roughness"), read, found)
    };
    let (first, second) = (run(&options), run(&options));
    close(first.0, [0.16, 0.16]);
    assert_eq!((first.1, second.1), (1, 0));
    assert_eq!(first.2, second.2);
    // another size of the picture, and another time of the scene
    write_png(&folder.path().join("mr.png"), 2, &[[0, 51, 0], [0, 255, 0]]);
    let third = run(&options);
    close(third.0, [0.16, 0.8]);
    assert_eq!(third.1, 1);
    std::fs::write(&file, textured_with("mr.png", r#""roughnessFactor": 0.5, "#)).unwrap();
    close(run(&options).0, [0.1, 0.5]);
    // other options find other things
    let widened = Reader { widens: true, ..Reader::default() };
    let other = run(&SurveyOptions { reader: widened, ..SurveyOptions::default() });
    assert_eq!(other.1, 1);
    close(other.0, [0.1, 1.0]);
}

/// The acceptance scenes and values that lie beside the project, where they are at hand.
#[test]
fn acceptance_scenes_are_planned_as_their_list_says() {
    let Some(shared) = std::env::var_os("BRDFBAKE_SHARED") else {
        eprintln!("SKIPPED: BRDFBAKE_SHARED is not set, so no acceptance scenes were planned");
        return;
    };
    let folder = Path::new(&shared).join("cases/scenes");
    let found = |name: &str| surveyed(&folder.join(name), &SurveyOptions::default()).needs;
    let tables =
        |needs: &Needs| needs.needs.iter().map(|n| n.table.to_string()).collect::<Vec<_>>().join(" ");
    for (name, want) in [
        ("p01-constant.gltf", "ggx"),
        ("p02-mirror-glass.gltf", ""),
        ("p03-rough-glass.gltf", "ggx glass"),
        ("p04-sheen.gltf", "ggx sheen"),
        ("p05-film.gltf", "ggx film"),
        ("p06-anisotropic.gltf", "ggx anisotropic"),
        ("p07-nothing-real.gltf", "ggx"),
        ("p08-points.gltf", ""),
        ("p09-textured.gltf", "ggx"),
    ] {
        let needs = found(name);
        assert_eq!(tables(&needs), want, "{name}");
        assert!(!needs.in_doubt(), "{name}: {:?}", needs.left_out);
        plan(&needs).unwrap();
    }
    assert_eq!(range(&found("p01-constant.gltf"), "ggx", "roughness"), [0.25, 0.6]);
    // printed to five digits; the second one is 0.075824 by the formula
    let f0 = range(&found("p03-rough-glass.gltf"), "ggx", "f0");
    assert!(
        (f0[0] - 0.020_059).abs() < HALF_A_DIGIT && (f0[1] - 0.075_826).abs() < 10.0 * HALF_A_DIGIT,
        "{f0:?}"
    );
    close(range(&found("p09-textured.gltf"), "ggx", "roughness"), [0.141_176_470_588, 0.282_352_941_176]);
    close(
        range(&found("inner/u02-godot-escape.gltf"), "ggx", "roughness"),
        [0.176_470_588_235, 0.352_941_176_471],
    );
    assert!(found("inner/u01-blender-parent.gltf").in_doubt());
    let root = SurveyOptions { root: Some(folder.clone()), ..SurveyOptions::default() };
    let inside = surveyed(&folder.join("inner/u01-blender-parent.gltf"), &root).needs;
    close(range(&inside, "ggx", "roughness"), [0.176_470_588_235, 0.352_941_176_471]);
    let helmet =
        surveyed(&Path::new(&shared).join("assets/DamagedHelmet.glb"), &SurveyOptions::default()).needs;
    assert_eq!(range(&helmet, "ggx", "roughness"), [0.0, 1.0]);
    assert!(helmet.needs[0].asked_by[0].why.contains("256 levels"), "{}", helmet.needs[0].asked_by[0].why);
}
