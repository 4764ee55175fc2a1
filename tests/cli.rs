//! The command as a user runs it: exit codes, streams, files left alone when something fails.
#![allow(clippy::unwrap_used, reason = "test")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

fn brdfbake(args: &[&str]) -> Output {
    command(args).output().unwrap()
}

fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_brdfbake"));
    command.args(args).current_dir(env!("CARGO_MANIFEST_DIR")).env("NO_COLOR", "1");
    command
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// An empty folder that is removed when the test ends.
fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn files(dir: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut all: Vec<_> = std::fs::read_dir(dir)
        .unwrap()
        .map(|e| e.unwrap().path())
        .map(|p| (PathBuf::from(p.file_name().unwrap()), std::fs::read(&p).unwrap()))
        .collect();
    all.sort();
    all
}

fn recipe(dir: &Path, tables: &str) -> PathBuf {
    let path = dir.join("recipe.toml");
    std::fs::write(&path, format!("name = \"test\"\n{tables}")).unwrap();
    path
}

const SMALL: &str = r#"
[[table]]
kind = "dfg"
name = "small"
outputs = ["exr:half", "exr:float"]
[[table.axis]]
id = "mu"
length = 24
[[table.axis]]
id = "roughness"
length = 24
"#;

#[test]
fn arguments_are_well_formed() {
    use clap::CommandFactory;
    brdfbake::cli::Cli::command().debug_assert();
}

#[test]
fn bytes_do_not_depend_on_threads_or_on_the_run() {
    let dir = folder();
    let recipe = recipe(dir.path(), SMALL);
    let runs: Vec<_> = ["1", "2", "2"]
        .iter()
        .enumerate()
        .map(|(i, jobs)| {
            let target = dir.path().join(format!("run{i}"));
            let o = brdfbake(&["bake", text(&recipe), "-q", "--jobs", jobs, "-o", text(&target)]);
            assert_eq!(code(&o), 0, "{}", err(&o));
            assert!(o.stdout.is_empty() && o.stderr.is_empty(), "--quiet prints nothing");
            files(&target)
        })
        .collect();
    assert_eq!(runs[0].len(), 3);
    assert_eq!(runs[0], runs[1]);
    assert_eq!(runs[0], runs[2]);
}

#[test]
fn json_messages_are_one_object_a_line() {
    let dir = folder();
    let recipe = recipe(dir.path(), SMALL);
    let o = brdfbake(&["bake", text(&recipe), "--message-format", "json", "-o", text(dir.path())]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let lines: Vec<serde_json::Value> = out(&o).lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    let reasons: Vec<&str> = lines.iter().map(|l| l["reason"].as_str().unwrap()).collect();
    assert_eq!(reasons, ["plan", "table-started", "table-finished", "summary"]);
    let finished = &lines[2];
    assert!(finished["integration"]["largest"].as_f64().unwrap() <= finished["tolerance"].as_f64().unwrap());
    assert!(finished["bake_seconds"].as_f64().unwrap() > 0.0);
    assert_eq!(finished["reconstruction"].as_array().unwrap().len(), 2);
    assert_eq!(lines[3]["written"], 3);
}

#[test]
fn plain_lines_go_to_stderr_when_there_is_no_terminal() {
    let dir = folder();
    let recipe = recipe(dir.path(), SMALL);
    let o = brdfbake(&["bake", text(&recipe), "-o", text(dir.path())]);
    assert!(out(&o).is_empty());
    assert!(err(&o).contains("small: integration") && err(&o).contains("files written"), "{}", err(&o));
}

#[test]
fn a_broken_law_stops_the_bake_and_leaves_earlier_outputs_alone() {
    let dir = folder();
    let target = dir.path().join("out");
    let good = recipe(dir.path(), SMALL);
    assert_eq!(code(&brdfbake(&["bake", text(&good), "-q", "-o", text(&target)])), 0);
    let before = files(&target);
    let model = "model = \"cook-torrance-1982\"\ntolerance = 1e-2\nouputs";
    let bad = SMALL.replace("outputs", model).replace("ouputs", "outputs");
    let bad = recipe(dir.path(), &bad);
    let o = brdfbake(&["bake", text(&bad), "-q", "-o", text(&target)]);
    assert_eq!(code(&o), 4, "{}", err(&o));
    // law, finding number, model, place and remedy are named
    for part in ["BB2001 energy", "cook-torrance-1982", "mu = ", "waive"] {
        assert!(err(&o).contains(part), "{part} is missing in: {}", err(&o));
    }
    assert_eq!(files(&target), before);
    let json = brdfbake(&["bake", text(&bad), "--message-format", "json", "-o", text(&target)]);
    assert!(out(&json).lines().any(|l| l.contains("\"reason\":\"finding\"") && l.contains("2001")));
}

#[test]
fn a_waived_law_is_written_into_the_file() {
    let dir = folder();
    let waive = r#"waive = [
        { law = "energy", reason = "comparison with the paper" },
        { law = "range", reason = "comparison with the paper" },
        { law = "split", reason = "comparison with the paper" },
    ]
    model = "cook-torrance-1982"
    tolerance = 1e-2
    outputs"#;
    let recipe = recipe(dir.path(), &SMALL.replace("outputs", waive));
    let o = brdfbake(&["bake", text(&recipe), "-o", text(dir.path())]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    assert!(err(&o).contains("waived: comparison with the paper"), "{}", err(&o));
    let o = brdfbake(&["inspect", "--json", text(&dir.path().join("small.half.exr"))]);
    let json: serde_json::Value = serde_json::from_str(&out(&o)).unwrap();
    assert_eq!(json["provenance"]["verified"], false);
    assert_eq!(json["provenance"]["waived"][0]["reason"], "comparison with the paper");
}

#[test]
fn exit_codes_are_those_of_the_table() {
    let dir = folder();
    let target = text(dir.path());
    let expect = |args: &[&str], expected: i32, message: &str| {
        let o = brdfbake(args);
        assert_eq!(code(&o), expected, "{args:?}: {}", err(&o));
        assert!(err(&o).contains(message), "{args:?}: {}", err(&o));
    };
    expect(&["bake", "--nonsense"], 2, "--nonsense");
    expect(&["bake", "defualt", "-o", target], 3, "did you mean `default`?");
    expect(&["bake", "./missing.toml", "-o", target], 5, "missing.toml");
    expect(&["bake", "--scene", "missing.glb", "-o", target], 5, "missing.glb");
    expect(&["inspect", "missing.exr"], 5, "missing.exr");
    expect(&["inspect", "Cargo.toml"], 3, "not a file of exr");
    expect(&["albedo", "gggx"], 3, "did you mean `ggx`?");
    expect(&["albedo", "ggx", "-p", "alhpa=0.5"], 3, "did you mean `alpha`?");
    expect(&["albedo", "ggx", "-p", "alpha=7"], 3, "alpha = 7 outside [0, 2]");
    expect(&["albedo", "ggx", "--mu", "1.5"], 3, "outside [0, 1]");
    expect(&["albedo", "ggx", "-t", "1e-18"], 4, "above the tolerance");
    expect(&["describe", "nothing-of-this-name"], 3, "nothing is called");
    expect(&["diff", "Cargo.toml", "src"], 3, "cannot compare a file with a folder");
    // the masking of GTR is an integral of its own, known to 4e-13 / alpha
    let fine = SMALL.replace("outputs", "model = \"gtr\"\ntolerance = 1e-12\noutputs");
    let missed = recipe(dir.path(), &fine.replace("length = 24", "length = 4"));
    expect(&["bake", text(&missed), "-q", "-o", target], 4, "miss the tolerance");
    let help = brdfbake(&["--help"]);
    assert_eq!(code(&help), 0);
    assert!(out(&help).contains("130  interrupted"));
}

#[test]
fn diff_tells_equal_from_not() {
    let dir = folder();
    let (a, b) = (dir.path().join("a"), dir.path().join("b"));
    let first = recipe(dir.path(), SMALL);
    assert_eq!(code(&brdfbake(&["bake", text(&first), "-q", "-o", text(&a)])), 0);
    let second =
        recipe(dir.path(), &SMALL.replace("outputs", "params = { masking = \"separable\" }\noutputs"));
    assert_eq!(code(&brdfbake(&["bake", text(&second), "-q", "-o", text(&b)])), 0);
    let (fa, fb) = (a.join("small.half.exr"), b.join("small.half.exr"));
    assert_eq!(code(&brdfbake(&["diff", text(&fa), text(&fa)])), 0);
    let o = brdfbake(&["diff", text(&fa), text(&fb)]);
    assert_eq!(code(&o), 4);
    assert!(out(&o).contains("dfg.scale"), "{}", out(&o));
    assert_eq!(code(&brdfbake(&["diff", text(&fa), text(&fb), "--tolerance", "0.5", "-q"])), 0);
    assert_eq!(code(&brdfbake(&["diff", text(&a), text(&b), "-q"])), 4);
    // half against float of the same table: the difference is the rounding of the half floats
    let o = brdfbake(&["diff", text(&fa), text(&a.join("small.float.exr")), "--tolerance", "2.5e-4"]);
    assert_eq!(code(&o), 0, "{}", out(&o));
}

#[test]
fn inspect_knows_what_a_file_holds() {
    let dir = folder();
    let recipe = recipe(dir.path(), SMALL);
    assert_eq!(code(&brdfbake(&["bake", text(&recipe), "-q", "-o", text(dir.path())])), 0);
    let o = brdfbake(&["inspect", text(&dir.path().join("small.half.exr"))]);
    let text = out(&o);
    for part in [
        "dfg.scale",
        "Walter2007",
        "alpha = roughness * roughness",
        "tolerance",
        "reciprocity",
        "bilinear",
        "correlated",
    ] {
        assert!(text.contains(part), "{part} is missing in:\n{text}");
    }
}

#[test]
fn eval_appends_values_and_names_the_line_at_fault() {
    let dir = folder();
    let path = dir.path().join("in.csv");
    let header = "model,params_json,wi_theta,wi_phi,wo_theta,wo_phi,note\n";
    let good = "ggx,\"{\"\"alpha\"\": 0.25}\",0.5,0,0.5,3.140625,kept\nlambert,,0.1,0,1.6,0,below\n";
    std::fs::write(&path, format!("{header}{good}")).unwrap();
    let o = brdfbake(&["eval", text(&path)]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let lines: Vec<String> = out(&o).lines().map(str::to_owned).collect();
    // formula in 50-digit arithmetic: 1.6380234898266188
    assert!(lines[1].contains(",kept,1.638023489826618"), "{}", lines[1]);
    assert!(lines[2].ends_with(",below,0e0"), "a direction below the horizon: {}", lines[2]);
    for (row, message) in [
        ("ggx,\"{\"\"alpha\"\": 0}\",0.5,0,0.5,3,x\n", "is a mirror"),
        ("ggx,\"{\"\"alpha\": 1}\",0.5,0,0.5,3,x\n", "params_json"),
        ("ggx,,north,0,0.5,3,x\n", "wi_theta = `north` is not a finite number"),
        ("gxg,,0,0,0.5,3,x\n", "did you mean `ggx`"),
    ] {
        std::fs::write(&path, format!("{header}{good}{row}")).unwrap();
        let o = brdfbake(&["eval", text(&path)]);
        assert!(code(&o) == 3 || code(&o) == 6, "{row}: {}", err(&o));
        assert!(err(&o).contains(":4:") && err(&o).contains(message), "{row}: {}", err(&o));
    }
}

#[test]
fn a_scene_bakes_what_its_materials_ask_for() {
    let dir = folder();
    let o = brdfbake(&["bake", "--scene", "tests/scenes/four_materials.glb", "-o", text(dir.path())]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    assert!(
        err(&o).contains("left out: KHR_materials_unlit") && err(&o).contains("needs sheen tables"),
        "{}",
        err(&o)
    );
    for table in ["ggx-dfg", "coat-albedo", "sheen-albedo"] {
        assert!(dir.path().join(format!("{table}.exr")).exists(), "{table}");
    }
    let unlit = dir.path().join("unlit.gltf");
    std::fs::write(
        &unlit,
        r#"{"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_unlit"],
            "materials": [{"extensions": {"KHR_materials_unlit": {}}}],
            "meshes": [{"primitives": [{"attributes": {}, "material": 0}]}]}"#,
    )
    .unwrap();
    let target = dir.path().join("none");
    let o = brdfbake(&["bake", "--scene", text(&unlit), "-o", text(&target)]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    assert!(err(&o).contains("nothing to bake"), "{}", err(&o));
    // the manifest says so
    let names: Vec<_> = std::fs::read_dir(&target).unwrap().map(|e| e.unwrap().file_name()).collect();
    assert_eq!(names, ["manifest.json"]);
}

/// A scene of one material.
fn one_material(path: &Path, rough: &str, more: &str) {
    let text = format!(
        r#"{{ "asset": {{ "version": "2.0" }}, "materials": [{{ "name": "tin\u001b[2J", "pbrMetallicRoughness":
            {{ "roughnessFactor": {rough}, "metallicFactor": 0 }}, "extensions": {{ {more} }} }}],
            "meshes": [{{ "primitives": [{{ "attributes": {{ "NORMAL": 1 }}, "material": 0 }}] }}] }}"#
    );
    std::fs::write(path, text).unwrap();
}

#[test]
fn stale_tables_are_named_and_the_manifest_says_who_asked() {
    let dir = folder();
    let (scene, target) = (dir.path().join("a.gltf"), dir.path().join("out"));
    let bake =
        |more: &[&str]| brdfbake(&[&["bake", "--scene", text(&scene), "-o", text(&target)], more].concat());
    one_material(&scene, "0.5", "");
    let o = bake(&[]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    assert!(!err(&o).contains('\u{1b}'), "{}", err(&o));
    let manifest = || -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(target.join("manifest.json")).unwrap()).unwrap()
    };
    let first = manifest();
    assert_eq!(first["scenes"]["files"][0]["file"], "a.gltf");
    assert_eq!(first["scenes"]["needs"][0]["asked_by"][0]["material"]["index"], 0);
    assert!(first.get("stale").is_none());
    // nothing is needed now: what lies there does not belong to it
    one_material(&scene, "0", "");
    let o = bake(&[]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let second = manifest();
    assert_eq!(second["tables"].as_array().unwrap().len(), 0);
    assert_eq!(second["stale"], serde_json::json!(["ggx-dfg.exr"]));
    // and baked again they are stale no more
    one_material(&scene, "0.5", "");
    assert_eq!(code(&bake(&[])), 0);
    assert!(manifest().get("stale").is_none());
}

#[test]
fn strict_refuses_scenes_that_ask_for_what_is_not_known() {
    let dir = folder();
    let (scene, target) = (dir.path().join("a.gltf"), dir.path().join("out"));
    one_material(&scene, "0.5", r#""ACME_materials_glitter": {}"#);
    let args = ["bake", "--scene", text(&scene), "-o", text(&target)];
    let o = brdfbake(&[&args[..], &["--strict"]].concat());
    assert_eq!(code(&o), 4, "{}", err(&o));
    assert!(!target.exists());
    assert_eq!(code(&brdfbake(&["plan", text(&scene), "--strict"])), 4);
    assert_eq!(code(&brdfbake(&["plan", text(&scene)])), 0);
}

#[test]
fn numbers_of_f32_are_shown_as_f32() {
    let dir = folder();
    let scene = dir.path().join("a.gltf");
    one_material(&scene, "0.4399999976158142", "");
    for args in [
        &["plan", text(&scene)][..],
        &["plan", text(&scene), "--json"],
        &["bake", "--scene", text(&scene), "--dry-run"],
    ] {
        let o = brdfbake(args);
        let told = out(&o) + &err(&o);
        assert!(code(&o) == 0 && told.contains("0.44") && !told.contains("0.4399"), "{args:?}: {told}");
    }
}

#[test]
fn an_engine_bakes_as_many_of_its_files_as_the_scene_needs() {
    let dir = folder();
    let scene = dir.path().join("a.gltf");
    one_material(&scene, "0.5", "");
    let o = brdfbake(&["plan", text(&scene), "--engine", "bevy", "--json"]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let told: serde_json::Value = serde_json::from_slice(&o.stdout).unwrap();
    let names: Vec<&str> =
        told["planned"].as_array().unwrap().iter().map(|t| t["table"].as_str().unwrap()).collect();
    // its table for the split sum, and none for area lights
    assert!(!names.is_empty() && names.iter().all(|n| !n.contains("ltc")), "{names:?}");
    assert!(
        told["dropped"].as_array().unwrap().iter().any(|n| n.as_str().unwrap().contains("ltc")),
        "{told}"
    );
    // a mirror is read at 0.089 by its shaders
    one_material(&scene, "0", "");
    let o = brdfbake(&["plan", text(&scene), "--engine", "bevy", "--json"]);
    let told: serde_json::Value = serde_json::from_slice(&o.stdout).unwrap();
    assert_eq!(told["needs"][0]["ranges"]["roughness"]["lo"], 0.089);
}

#[test]
fn folders_and_patterns_name_scenes() {
    let dir = folder();
    std::fs::create_dir(dir.path().join("below")).unwrap();
    one_material(&dir.path().join("a.gltf"), "0.5", "");
    one_material(&dir.path().join("below/b.gltf"), "0.25", "");
    let pattern = dir.path().join("**/*.gltf");
    for scenes in [text(dir.path()), text(&pattern)] {
        let o = brdfbake(&["plan", scenes, "--json"]);
        assert_eq!(code(&o), 0, "{}", err(&o));
        let told: serde_json::Value = serde_json::from_slice(&o.stdout).unwrap();
        let files: Vec<&str> =
            told["files"].as_array().unwrap().iter().map(|f| f["file"].as_str().unwrap()).collect();
        assert_eq!(files, ["a.gltf", "below/b.gltf"], "{scenes}");
    }
    let o = brdfbake(&["plan", text(&dir.path().join("*.glb"))]);
    assert_eq!(code(&o), 3, "{}", err(&o));
    // what says how scenes are read wants one
    let o = brdfbake(&["bake", "ggx", "--margin", "0.1", "--dry-run"]);
    assert!(code(&o) == 2 && err(&o).contains("--margin") && err(&o).contains("--scene"), "{}", err(&o));
}

#[test]
fn materials_are_judged_by_the_command() {
    let dir = folder();
    let scene = dir.path().join("a.gltf");
    one_material(&scene, "0.01", "");
    let o = brdfbake(&["check", text(&scene), "--json"]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let told: serde_json::Value = serde_json::from_slice(&o.stdout).unwrap();
    let rules: Vec<&str> =
        told["scenes"][0]["broken"].as_array().unwrap().iter().map(|b| b["rule"].as_str().unwrap()).collect();
    assert_eq!(rules, ["albedo", "bright-base", "smooth-half", "smooth-float"]);
    assert_eq!(code(&brdfbake(&["check", text(&scene), "--strict"])), 4);
    let off: Vec<String> = rules.iter().map(|r| format!("--rule={r}=off")).collect();
    let off: Vec<&str> = off.iter().map(String::as_str).collect();
    assert_eq!(code(&brdfbake(&[&["check", text(&scene), "--strict"], &off[..]].concat())), 0);
    let o = brdfbake(&["check", text(&scene), "--rule", "albdo=2"]);
    assert!(code(&o) == 2 && err(&o).contains("albedo"), "{}", err(&o));
}

#[test]
fn an_output_folder_that_cannot_be_written_is_found_before_the_work() {
    let dir = folder();
    let file = dir.path().join("file");
    std::fs::write(&file, "not a folder").unwrap();
    let o = brdfbake(&["bake", "-q", "-o", text(&file.join("out"))]);
    assert_eq!(code(&o), 5, "{}", err(&o));
    assert_eq!(std::fs::read(&file).unwrap(), b"not a folder");
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_earlier_outputs_alone() {
    let dir = folder();
    let target = dir.path().join("out");
    let first = recipe(dir.path(), SMALL);
    assert_eq!(code(&brdfbake(&["bake", text(&first), "-q", "-o", text(&target)])), 0);
    let before = files(&target);
    let long = SMALL.replace("length = 24", "length = 1500").replace("outputs", "tolerance = 1e-11\noutputs");
    let long = recipe(dir.path(), &long);
    let mut child =
        command(&["bake", text(&long), "-q", "-o", text(&target)]).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(300));
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let start = Instant::now();
    let status = child.wait().unwrap();
    assert_eq!(status.code(), Some(130));
    assert!(start.elapsed() < Duration::from_secs(20), "it does not stop");
    assert_eq!(files(&target), before);
}

#[test]
fn lists_and_descriptions_come_from_the_registries() {
    for (what, id) in [
        ("models", "ggx-conductor"),
        ("tables", "dfg"),
        ("presets", "default"),
        ("formats", "exr"),
        ("laws", "energy"),
    ] {
        let o = brdfbake(&["list", what]);
        assert!(out(&o).lines().any(|l| l.starts_with(id)), "{what}: {}", out(&o));
        let json: serde_json::Value =
            serde_json::from_str(&out(&brdfbake(&["list", what, "--json"]))).unwrap();
        assert!(json.as_array().unwrap().iter().any(|e| e["id"] == id));
    }
    for m in brdfbake::models::MODELS {
        let o = brdfbake(&["describe", m.id]);
        assert!(code(&o) == 0 && out(&o).contains(m.formula), "{}", m.id);
    }
}

#[test]
fn plots_are_drawn_as_svg_and_png() {
    let dir = folder();
    let (svg, png) = (dir.path().join("lobe.svg"), dir.path().join("lobe.png"));
    let o = brdfbake(&["plot", "ggx", "-p", "alpha=0.3", "-o", text(&svg), "-o", text(&png)]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    let drawn = std::fs::read_to_string(&svg).unwrap();
    // f at 60 degrees in the mirror direction: D / (4 mu^2) G2 with D = 1 / (pi alpha^2), in the caption
    assert!(drawn.contains("<polyline") && drawn.contains("60 deg: largest f"), "no curve");
    let image = brdfbake::encode::read::read_file(&png).unwrap();
    assert!(image.channels.iter().any(|c| c.values.iter().any(|v| *v < 0.5)), "an empty picture");
    assert_eq!(code(&brdfbake(&["plot", "ggx", "-p", "alpha=0", "-o", text(&svg)])), 6);
    assert_eq!(code(&brdfbake(&["plot", "ggx", "-o", text(&dir.path().join("lobe.gif"))])), 2);
    assert_eq!(code(&brdfbake(&["plot", "ggx", "--angles", "95"])), 2);
}

#[test]
fn laws_of_all_models_are_printed() {
    let o = brdfbake(&["laws"]);
    assert_eq!(code(&o), 0, "{}", err(&o));
    for m in brdfbake::models::MODELS {
        assert!(out(&o).lines().any(|l| l.starts_with(m.id)), "{}", m.id);
    }
    assert!(out(&o).contains("known: not passive"));
    assert_eq!(code(&brdfbake(&["laws", "gggx"])), 3);
}
