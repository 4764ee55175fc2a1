//! `brdfbake golden`: bless, check, tolerances of channels, pictures of differences.
#![allow(clippy::unwrap_used, reason = "test")]

use brdfbake::encode::read;
use std::path::Path;
use std::process::{Command, Output};

const RECIPE: &str = r#"
name = "golden"
[[table]]
kind = "dfg"
name = "t"
outputs = ["exr:half", "rust:float"]
[[table.axis]]
id = "mu"
length = 8
[[table.axis]]
id = "roughness"
length = 8
"#;

fn golden(what: &str, folder: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_brdfbake"))
        .args(["golden", what])
        .arg(folder)
        .args(more)
        .output()
        .unwrap()
}

fn said(o: &Output) -> String {
    String::from_utf8_lossy(&o.stdout).into_owned() + &String::from_utf8_lossy(&o.stderr)
}

#[test]
fn a_blessed_folder_checks_and_a_changed_one_does_not() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    std::fs::write(folder.join("recipe.toml"), RECIPE).unwrap();
    let blessed = golden("bless", folder, &[]);
    assert_eq!(blessed.status.code(), Some(0), "{}", said(&blessed));
    let same = golden("check", folder, &[]);
    assert_eq!(same.status.code(), Some(0), "{}", said(&same));

    // separable masking moves the numbers by more than an ulp and by less than 0.4
    let other = RECIPE.replace("outputs", "params = { masking = \"separable\" }\noutputs");
    std::fs::write(folder.join("recipe.toml"), &other).unwrap();
    let drawn = folder.join("drawn");
    let different = golden("check", folder, &["--draw", drawn.to_str().unwrap()]);
    assert_eq!(different.status.code(), Some(4), "{}", said(&different));
    assert!(said(&different).contains("t.exr: different"), "{}", said(&different));
    // two channels of 8 x 8 texels, three panels each, gaps of 4
    let picture = read::read_file(&drawn.join("t.exr.diff.png")).unwrap();
    assert_eq!((picture.width, picture.height), (32, 20));

    // wide enough tolerances pass for pictures; the array in source code is compared byte by byte
    std::fs::write(folder.join("golden.toml"), "absolute = 0.4\n").unwrap();
    let source = golden("check", folder, &[]);
    assert_eq!(source.status.code(), Some(4), "{}", said(&source));
    let told = said(&source);
    assert!(told.contains("t.exr: equal") && told.contains("t.rs: different"), "{told}");
    std::fs::write(folder.join("recipe.toml"), other.replace(", \"rust:float\"", "")).unwrap();
    std::fs::remove_file(folder.join("t.rs")).unwrap();
    assert_eq!(golden("check", folder, &[]).status.code(), Some(0));

    // one channel with a tolerance of its own
    let own = "absolute = 0.4\n[channel.\"dfg.bias\"]\nulps = 1\n";
    std::fs::write(folder.join("golden.toml"), own).unwrap();
    assert_eq!(golden("check", folder, &[]).status.code(), Some(4));
}

#[test]
fn missing_outputs_and_bad_settings_are_told() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    std::fs::write(folder.join("recipe.toml"), RECIPE).unwrap();
    let missing = golden("check", folder, &[]);
    assert_eq!(missing.status.code(), Some(4));
    assert!(said(&missing).contains("only the second has it"), "{}", said(&missing));
    std::fs::write(folder.join("golden.toml"), "ulp = 1\n").unwrap();
    let bad = golden("check", folder, &[]);
    assert_eq!(bad.status.code(), Some(3));
    assert!(
        said(&bad).contains("golden.toml") && said(&bad).contains("unknown field `ulp`"),
        "{}",
        said(&bad)
    );
    std::fs::write(folder.join("golden.toml"), "ulps = -1\n").unwrap();
    assert!(said(&golden("check", folder, &[])).contains("must not be negative"));
    assert_eq!(golden("check", &folder.join("none"), &[]).status.code(), Some(5));
}
