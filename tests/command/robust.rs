//! Bakes of scenes with their tables and filtered maps that are killed, that find the disk full, whose folder vanishes.
//!
//! The short form runs with the others. The long one kills as often as `BRDFBAKE_KILLS` says:
//!
//! ```sh
//! BRDFBAKE_KILLS=300 cargo test --release --test house -- --ignored --nocapture killed_for_long
//! ```

use super::support::{brdfbake, code, command, err, folder, names, text};
use brdfbake::pipeline::audit::{Verdict, audit};
use brdfbake::verify::seeds::Seeds;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Kills of the short form.
const KILLS: usize = 5;

/// A scene: tables, and maps in two containers.
const BAKE: [&str; 7] = [
    "bake",
    "--scene",
    "tests/scenes/bumps/bumps.gltf",
    "--maps=normal,anisotropy",
    "-q",
    "--no-cache",
    "-o",
];

type Files = BTreeMap<String, Vec<u8>>;

fn held(folder: &Path) -> Files {
    names(folder).into_iter().map(|n| (n.clone(), std::fs::read(folder.join(n)).unwrap())).collect()
}

fn bake(folder: &Path) -> std::process::Output {
    brdfbake(&[&BAKE[..], &[text(folder)]].concat())
}

/// What a bake that is left alone writes, and how long it takes.
fn reference(dir: &Path) -> (Files, Duration) {
    let target = dir.join("reference");
    let start = Instant::now();
    let o = bake(&target);
    let took = start.elapsed();
    assert_eq!(code(&o), 0, "{}", err(&o));
    let files = held(&target);
    assert!(
        files.keys().any(|n| n.contains(".roughness.")) && files.keys().any(|n| n.ends_with(".exr")),
        "tables and maps"
    );
    (files, took)
}

/// Kills bakes at drawn moments. What stands then has a manifest that tells the truth, or none; the next bake makes it whole.
fn killed(kills: usize, seed: u64) {
    let dir = folder();
    let (files, took) = reference(dir.path());
    let target = dir.path().join("out");
    let mut seeds = Seeds::new(seed);
    let mut early = 0;
    for kill in 0..kills {
        let mut child = command(&[&BAKE[..], &[text(&target)]].concat())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(took.mul_f64(1.1 * seeds.unit()));
        let done = child.try_wait().unwrap().is_some();
        child.kill().unwrap();
        child.wait().unwrap();
        early += usize::from(!done);
        if target.join("manifest.json").exists() {
            let found = audit(&target).unwrap();
            assert_eq!(found.verdict(), Verdict::Whole, "kill {kill}: {found:?}");
        }
    }
    let o = bake(&target);
    assert_eq!(code(&o), 0, "{}", err(&o));
    assert!(held(&target) == files, "the files are those of a bake that was left alone");
    eprintln!("{early} of {kills} bakes were killed before they ended");
}

#[test]
fn maps_and_scenes_that_are_killed_are_made_whole() {
    killed(KILLS, 1);
}

#[test]
#[ignore = "long: as many kills as BRDFBAKE_KILLS says"]
fn maps_and_scenes_that_are_killed_for_long() {
    let kills = std::env::var("BRDFBAKE_KILLS").ok().and_then(|s| s.parse().ok()).unwrap_or(100);
    killed(kills, u64::from(std::process::id()));
}

/// No file may become larger than a few blocks, as on a disk that is full: an error, and the folder as it was.
#[test]
fn maps_on_a_full_disk_change_nothing() {
    let dir = folder();
    let target = dir.path().join("out");
    let earlier = brdfbake(&[
        "map",
        "--roughness",
        "0.4",
        "--normal",
        "tests/scenes/bumps/normal.png",
        "--format",
        "png",
        "-q",
        "-o",
        text(&target),
    ]);
    assert_eq!(code(&earlier), 0, "{}", err(&earlier));
    let before = held(&target);
    let full = |args: &[&str]| {
        // the signal of a limit is ignored, so that writing fails as it does on a full disk
        let script = "trap '' XFSZ; ulimit -f 4; exec \"$@\"";
        let program = env!("CARGO_BIN_EXE_brdfbake");
        Command::new("sh")
            .args(["-c", script, "sh", program])
            .args(args)
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .unwrap()
    };
    for args in [
        vec![
            "map",
            "--roughness",
            "0.3",
            "--normal",
            "tests/scenes/bumps/normal.png",
            "--format",
            "ktx2",
            "-q",
            "-o",
            text(&target),
        ],
        [&BAKE[..], &[text(&target)]].concat(),
    ] {
        let o = full(&args);
        assert_eq!(code(&o), 5, "{args:?}: {}", err(&o));
        assert!(held(&target) == before, "{args:?}: {:?}", names(&target));
    }
}

/// The folder is taken away while it is baked into: an error of the file system, and no panic.
#[test]
fn a_folder_that_vanishes_is_an_error() {
    let dir = folder();
    let (_, took) = reference(dir.path());
    let target = dir.path().join("out");
    let child = command(&[&BAKE[..], &[text(&target)]].concat()).stderr(Stdio::piped()).spawn().unwrap();
    let start = Instant::now();
    // taken away until the bake ends, whatever it made anew
    let mut child = child;
    let status = loop {
        if start.elapsed() > took / 4 {
            let _ = std::fs::remove_dir_all(&target);
        }
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        std::thread::sleep(Duration::from_millis(2));
        assert!(start.elapsed() < Duration::from_secs(120), "it hangs");
    };
    // fast machines may be done before
    assert!([Some(0), Some(5)].contains(&status.code()), "{status:?}");
    if status.code() == Some(0) && target.join("manifest.json").exists() {
        assert_eq!(audit(&target).unwrap().verdict(), Verdict::Whole);
    }
}
