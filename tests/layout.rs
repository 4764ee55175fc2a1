//! Every file of tests is a module of one binary: with `autotests = false` one that nobody names is never compiled.
#![allow(clippy::unwrap_used, reason = "test")]

use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

#[derive(Deserialize)]
struct Manifest {
    test: Vec<Target>,
}

#[derive(Deserialize)]
struct Target {
    name: String,
}

/// The names of the test binaries, in the order of `Cargo.toml`.
pub(crate) fn binaries() -> Vec<String> {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml")).unwrap();
    toml::from_str::<Manifest>(&text).unwrap().test.into_iter().map(|t| t.name).collect()
}

/// The files of a module and of those that it names with `mod`; the folder is that of its children.
fn files(file: &Path, children: &Path, found: &mut Vec<PathBuf>) {
    let text = std::fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    found.push(file.to_owned());
    for name in text.lines().filter_map(|l| l.strip_prefix("mod ")?.strip_suffix(';')) {
        let folder = children.join(name);
        let file = Some(folder.with_extension("rs")).filter(|f| f.exists());
        files(&file.unwrap_or_else(|| folder.join("mod.rs")), &folder, found);
    }
}

/// Sources below a folder, but for those of programs with a `Cargo.toml` of their own.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.join("Cargo.toml").exists() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn every_file_of_tests_is_in_one_binary() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let mut uses: BTreeMap<PathBuf, Vec<String>> = BTreeMap::new();
    for binary in binaries() {
        let mut found = Vec::new();
        files(&tests.join(&binary).with_extension("rs"), &tests, &mut found);
        for file in found {
            uses.entry(file).or_default().push(binary.clone());
        }
    }
    let mut there = Vec::new();
    sources(&tests, &mut there);
    let mut faults = Vec::new();
    for file in there {
        let name = file.strip_prefix(&tests).unwrap().display();
        // helpers are shared; what has tests stands in one binary, or runs twice
        let has_tests = std::fs::read_to_string(&file).unwrap().contains("\n#[test]");
        match uses.get(&file).map(Vec::as_slice).unwrap_or_default() {
            [] => faults.push(format!(
                "tests/{name} is in no test binary: write `mod NAME;` in tests/numbers.rs, baked.rs, files.rs or house.rs, or in the \
                 file that its folder is named after"
            )),
            [_] => {}
            several if has_tests && !file.ends_with("counted.rs") => {
                faults.push(format!("tests/{name} is in {}: its tests run more than once", several.join(" and ")))
            }
            _ => {}
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Bounds with no name that are left: those of one place, whose reason is beside them. It may fall.
const UNNAMED: usize = 21;

/// Does a line compare with a number such as `1e-9` that has no name?
fn has_a_bound(line: &str) -> bool {
    let code = line.split("//").next().unwrap_or_default().split('"').next().unwrap_or_default();
    let asserts = ["assert!(", "near!(", "assert_relative("].iter().any(|a| code.contains(a));
    let number = |text: &str| {
        let mut digits = text.match_indices("e-").map(|(at, _)| (&text[..at], &text[at + 2..]));
        digits.any(|(a, b)| {
            a.ends_with(|c: char| c.is_ascii_digit()) && b.starts_with(|c: char| c.is_ascii_digit())
        })
    };
    let right =
        code.rsplit_once('<').map(|(_, right)| right).or(code.rsplit_once(", ").map(|(_, last)| last));
    asserts && right.is_some_and(number)
}

#[test]
fn bounds_have_names_and_reasons() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let mut all = Vec::new();
    sources(&tests, &mut all);
    let mut found = Vec::new();
    for file in all.iter().filter(|f| !f.starts_with(tests.join("sweep"))) {
        let text = std::fs::read_to_string(file).unwrap();
        let name = file.strip_prefix(&tests).unwrap().display().to_string();
        found.extend(
            text.lines()
                .enumerate()
                .filter(|(_, l)| has_a_bound(l))
                .map(|(i, l)| format!("tests/{name}:{}: {}", i + 1, l.trim())),
        );
    }
    assert!(
        found.len() <= UNNAMED,
        "{} bounds without a name, at most {UNNAMED} are allowed: take one of tests/tolerance.rs, or write one there with its reason\n{}",
        found.len(),
        found.join("\n")
    );
}
