//! Help has examples, and each of them runs.

use super::support::{SMALL, code, err, folder, write};
use clap::CommandFactory;
use std::path::Path;
use std::process::Command;

/// What the examples name.
fn prepared(dir: &Path) {
    let at = |name: &str| Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(name);
    for (from, to) in [("scenes/four_materials.glb", "scene.glb"), ("footprints/normal.png", "normal.png")] {
        std::fs::copy(at(from), dir.join(to)).unwrap();
    }
    for file in std::fs::read_dir(at("scenes/spec_gloss")).unwrap() {
        let path = file.unwrap().path();
        std::fs::copy(&path, dir.join(path.file_name().unwrap())).unwrap();
    }
    std::fs::copy(at("scenes/spec_gloss/eight.gltf"), dir.join("spec-gloss.gltf")).unwrap();
    write(dir, "mine.toml", SMALL);
    write(dir, "directions.csv", "model,params_json,wi_theta,wi_phi,wo_theta,wo_phi\nggx,,0.5,0,0.5,3\n");
    for to in ["textures", "others", "golden"] {
        run(dir, &["bake", "mine.toml", "--quiet", "-o", to]);
    }
    run(dir, &["map", "--normal", "normal.png", "--roughness", "0.4", "--quiet", "-o", "maps"]);
    write(&dir.join("golden"), "recipe.toml", SMALL);
    for to in ["a.exr", "b.exr"] {
        std::fs::copy(dir.join("textures/small.exr"), dir.join(to)).unwrap();
    }
}

fn run(dir: &Path, args: &[&str]) {
    let o = Command::new(env!("CARGO_BIN_EXE_brdfbake"))
        .args(args)
        .current_dir(dir)
        .env("BRDFBAKE_CACHE_DIR", "")
        .output()
        .unwrap();
    assert_eq!(code(&o), 0, "{args:?}: {}", err(&o));
}

#[test]
fn every_example_of_the_help_runs() {
    let dir = folder();
    prepared(dir.path());
    let mut command = brdfbake::cli::Cli::command();
    command.build();
    for verb in command.get_subcommands().filter(|c| c.get_name() != "help") {
        let help = verb.get_after_help().map(ToString::to_string).unwrap_or_default();
        let name = verb.get_name();
        let examples: Vec<&str> = help.lines().filter_map(|l| l.strip_prefix("  brdfbake ")).collect();
        assert!(help.starts_with("Examples:\n") && !examples.is_empty(), "{name}: its help has no examples");
        for example in examples {
            let words: Vec<&str> = example.split(' ').collect();
            assert_eq!(words[0], name, "{example}");
            run(dir.path(), &words);
        }
    }
    assert!(dir.path().join("pages/brdfbake-bake.1").exists());
}

/// Angles are in radians in files and rows, in degrees where people type them for a picture; wherever one is meant, the help says which.
#[test]
fn help_says_radians_or_degrees_wherever_an_angle_is_meant() {
    let is_angle = |id: &str, text: &str| {
        let text = text.to_lowercase();
        let meant = ["angle", "azimuth", "rotation"]
            .iter()
            .any(|w| text.split(|c: char| !c.is_alphabetic()).any(|t| t == *w));
        (meant && !text.contains("cosine")) || ["phi", "theta"].contains(&id.split('_').next().unwrap_or(id))
    };
    let mut seen = 0;
    let mut check = |what: &str, unit: &str, page: &str| {
        seen += 1;
        let words = match unit {
            "rad" => "radians",
            "deg" => "degrees",
            other => panic!("{what} measures an angle, and its unit is {other}"),
        };
        assert!(page.contains(words), "{what}: {page}");
    };
    let quantities = brdfbake::grid::quantity::QUANTITIES;
    let o = super::support::brdfbake(&["list", "quantities"]);
    let list = super::support::out(&o);
    for q in quantities.iter().filter(|q| is_angle(q.id, q.meaning)) {
        let line = list.lines().find(|l| l.split(' ').next() == Some(q.id)).unwrap();
        check(q.id, q.unit, line);
    }
    let models = brdfbake::models::MODELS.iter().map(|m| (m.id, m.params, brdfbake::cli::describe::model(m)));
    let functions =
        brdfbake::functions::all().map(|f| (f.id, f.params, brdfbake::cli::describe::function(f)));
    let tables = brdfbake::tables::TABLES.iter().map(|t| (t.id, t.params, brdfbake::cli::describe::table(t)));
    for (id, params, page) in models.chain(functions).chain(tables) {
        for p in params.iter().filter(|p| is_angle(p.id, p.doc)) {
            let line = page.lines().find(|l| l.trim_start().starts_with(&format!("{} (", p.id))).unwrap();
            check(&format!("{id}: {}", p.id), p.unit, line);
        }
    }
    let mut command = brdfbake::cli::Cli::command();
    command.build();
    for verb in command.get_subcommands() {
        for arg in verb.get_arguments() {
            let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
            let id = arg.get_id().as_str();
            if arg.get_action().takes_values() && is_angle(id, &help) {
                seen += 1;
                let named = help.contains("radians") || help.contains("degrees");
                assert!(named, "{} {id}: {help}", verb.get_name());
            }
        }
    }
    assert!(seen >= 10, "{seen}");
}
