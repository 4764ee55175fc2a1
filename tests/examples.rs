//! Every folder of `out-examples/` is what its `command.txt` makes today. `cargo bless` makes them anew.
//! Those that need a browser are made by hand; `.ci/run` runs their commands.
#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "test")]

use brdfbake::encode::Tolerance;
use brdfbake::encode::diff_files;
use std::path::Path;
use std::process::Command;

const OWN: [&str; 4] = ["README.md", "command.txt", "normal.png", "recipe.toml"];

/// Runs a command whose last word is the folder of the example, or a file in it, with another folder in its place.
fn run(command: &str, name: &str, out: &Path, root: &Path) {
    let mut words: Vec<&str> = command.split_whitespace().collect();
    assert_eq!(words.remove(0), "brdfbake");
    let target = words.pop().unwrap();
    let inside = target.split_once(name).unwrap_or_else(|| panic!("{command}")).1;
    let status = Command::new(env!("CARGO_BIN_EXE_brdfbake"))
        .args(words)
        .arg(if inside.is_empty() { out.to_path_buf() } else { out.join(inside.trim_start_matches('/')) })
        .args(inside.is_empty().then_some("--quiet"))
        .current_dir(root)
        .status()
        .unwrap();
    assert!(status.success(), "{command}");
}

#[test]
fn examples_are_what_their_commands_make() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut count = 0;
    for entry in std::fs::read_dir(root.join("out-examples")).unwrap() {
        let folder = entry.unwrap().path();
        let commands = std::fs::read_to_string(folder.join("command.txt")).unwrap();
        if let Some(other) = commands.lines().find(|c| !c.starts_with("brdfbake ")) {
            eprintln!("skipped: {other}");
            continue;
        }
        let fresh = tempfile::tempdir().unwrap();
        let bless = std::env::var_os("BLESS").is_some();
        let out = if bless { folder.clone() } else { fresh.path().to_path_buf() };
        for command in commands.lines() {
            run(command, folder.file_name().unwrap().to_str().unwrap(), &out, root);
        }
        if !bless {
            for own in OWN.iter().filter(|f| folder.join(f).exists()) {
                std::fs::copy(folder.join(own), fresh.path().join(own)).unwrap();
            }
            // bit for bit, metadata included
            let diff =
                diff_files::folders(&folder, fresh.path(), Tolerance { absolute: 0.0, ulps: 0.0 }).unwrap();
            assert!(diff.equal(), "{}: {diff:#?}", folder.display());
        }
        count += 1;
    }
    assert!(count >= 5);
}

/// Who takes a table without this program reads how from the page beside it: its formulas and errors are those of the manifest.
#[test]
fn tables_to_take_are_described_as_they_are() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("out-examples/15-default-tables");
    let page = std::fs::read_to_string(folder.join("README.md")).unwrap();
    let manifest: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.join("manifest.json")).unwrap()).unwrap();
    for table in manifest["tables"].as_array().unwrap() {
        let name = table["name"].as_str().unwrap();
        let row = page.lines().find(|l| l.starts_with(&format!("| `{name}` |"))).unwrap();
        let read = &table["files"][0]["reconstruction"];
        for part in ["whole", "practical"] {
            let error = read[part]["largest"]["value"].as_f64().unwrap();
            assert!(row.contains(&format!("| {error:.1e} |")), "{name}: {part} {error:.1e}: {row}");
        }
        let texels: Vec<String> = table["size"].as_array().unwrap().iter().map(ToString::to_string).collect();
        assert!(row.contains(&format!("| {} |", texels.join(" x "))), "{name}: {row}");
        for axis in table["axes"].as_array().unwrap() {
            assert!(page.contains(axis["coordinate"].as_str().unwrap()), "{name}: {}", axis["coordinate"]);
        }
    }
}
