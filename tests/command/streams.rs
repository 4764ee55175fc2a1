//! Data that cannot be written is a failure, in whatever verb; a reader that goes away is none.

use super::support::{SMALL, brdfbake, code, command, err, folder, text, write};
use std::collections::BTreeSet;
use std::fs::File;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Every verb that has data for stdout, in each of its ways to print it; `DIR` is a folder with a baked table.
const PRINTING: &[&[&str]] = &[
    &["--help"],
    &["--version"],
    &["help", "bake"],
    &["bake", "DIR/small.toml", "--message-format", "json", "-o", "DIR/again"],
    &["bake", "DIR/broken.toml", "--message-format", "json", "-o", "DIR/broken"],
    &["bake", "--dry-run"],
    &["bake", "--dry-run", "--message-format", "json"],
    &["bake", "--scene", "tests/scenes/four_materials.glb", "--message-format", "json", "--dry-run"],
    &["bake", "--engine", "osl", "--suggest"],
    &["bake", "--engine", "osl", "--suggest", "--message-format", "json"],
    &["plan", "tests/scenes/four_materials.glb"],
    &["plan", "tests/scenes/four_materials.glb", "--json"],
    &["check", "tests/scenes/four_materials.glb"],
    &["check", "tests/scenes/four_materials.glb", "--json"],
    &["convert", "tests/scenes/spec_gloss/eight.gltf", "--mode", "exact", "--json"],
    &["inspect", "DIR/out/small.exr"],
    &["inspect", "DIR/out/small.exr", "--json"],
    &["diff", "DIR/out/small.exr", "DIR/out/small.exr"],
    &["diff", "DIR/out", "DIR/out", "--json"],
    &["verify", "DIR/out"],
    &["verify", "DIR/out", "--json"],
    &["verify", "DIR/out/small.exr"],
    &["stress", "schlick:f32"],
    &["stress", "schlick:f32", "--json"],
    &["converge", "ggx", "--texels", "2", "--power", "5", "-o", "DIR/converge"],
    &["converge", "ggx", "--texels", "2", "--power", "5", "--json"],
    &["cache", "--cache-dir", "DIR/cache"],
    &["cache", "--cache-dir", "DIR/cache", "--json"],
    &["golden", "check", "DIR/golden"],
    &["golden", "check", "DIR/golden", "--json"],
    &["eval", "DIR/rows.csv"],
    &["albedo", "ggx", "--mu", "1"],
    &["albedo", "ggx", "--mu", "1", "--json"],
    &["laws", "lambert"],
    &["laws", "lambert", "--json"],
    &["fit", "-t", "fresnel-dielectric", "-d", "1", "--form", "polynomial"],
    &["map", "--normal", "tests/footprints/normal.png", "--json", "-o", "DIR/maps"],
    &["preview", "--size", "8", "--roughness", "0.5", "-o", "DIR/preview.png"],
    &["preview", "--size", "8", "--roughness", "0.5", "-o", "DIR/preview.exr", "--json"],
    &["guide", "axes"],
    &["list", "models"],
    &["list", "models", "--json"],
    &["describe", "ggx"],
    &["guide"],
    &["guide", "three"],
    &["schema"],
    &["completions", "bash"],
    &["man"],
    &["man", "bake"],
];

/// Verbs without data: what they have to say goes to stderr.
const SILENT: &[&str] = &["plot", "report"];

/// A folder with what the commands read.
fn prepared() -> tempfile::TempDir {
    let dir = folder();
    let small = write(dir.path(), "small.toml", SMALL);
    let broken = "kind = \"albedo\"\nmodel = \"cook-torrance-1982\"\ntolerance = 1e-2\noutputs";
    let broken = SMALL.replace("kind = \"fresnel-dielectric\"", "").replace("outputs", broken);
    write(dir.path(), "broken.toml", &broken.replace("id = \"eta\"", "id = \"roughness\""));
    let rows = "model,params_json,wi_theta,wi_phi,wo_theta,wo_phi\nggx,,0.5,0,0.5,3\n";
    write(dir.path(), "rows.csv", rows);
    for target in ["out", "golden"] {
        let o = brdfbake(&["bake", text(&small), "-q", "-o", text(&dir.path().join(target))]);
        assert_eq!(code(&o), 0, "{}", err(&o));
    }
    write(&dir.path().join("golden"), "recipe.toml", SMALL);
    dir
}

fn run(args: &[&str], dir: &Path, stdout: Stdio) -> Output {
    let args: Vec<String> = args.iter().map(|a| a.replace("DIR", text(dir))).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    command(&args).stdout(stdout).stderr(Stdio::piped()).spawn().unwrap().wait_with_output().unwrap()
}

#[test]
fn a_full_disk_is_told_by_every_verb() {
    let Ok(full) = File::options().write(true).open("/dev/full") else {
        eprintln!("SKIPPED: this system has no /dev/full");
        return;
    };
    let dir = prepared();
    for args in PRINTING {
        let o = run(args, dir.path(), full.try_clone().unwrap().into());
        assert_eq!(code(&o), 5, "{args:?}: {}", err(&o));
        assert!(err(&o).contains("stdout"), "{args:?}: {}", err(&o));
    }
    assert!(!dir.path().join("again/manifest.json").exists(), "messages that nobody gets stop the bake");
}

#[test]
fn a_reader_that_goes_away_is_silent() {
    let dir = prepared();
    for args in PRINTING {
        let whole = run(args, dir.path(), Stdio::piped());
        // a pipe whose other end is closed already
        let mut reader = Command::new("true").stdin(Stdio::piped()).spawn().unwrap();
        let pipe = reader.stdin.take().unwrap();
        reader.wait().unwrap();
        let o = run(args, dir.path(), pipe.into());
        assert_eq!(code(&o), code(&whole), "{args:?}: {}", err(&o));
        // times differ from run to run
        let words = |o: &Output| err(o).chars().filter(|c| !c.is_ascii_digit()).collect::<String>();
        assert_eq!(words(&o), words(&whole), "{args:?}");
    }
}

#[test]
fn every_verb_is_among_them() {
    use clap::CommandFactory;
    let verbs = brdfbake::cli::Cli::command();
    let verbs: BTreeSet<&str> = verbs.get_subcommands().map(clap::Command::get_name).collect();
    let tested: BTreeSet<&str> =
        PRINTING.iter().map(|args| args[0]).filter(|a| !a.starts_with('-') && *a != "help").collect();
    let silent: BTreeSet<&str> = SILENT.iter().copied().collect();
    assert_eq!(verbs, &tested | &silent);
}
