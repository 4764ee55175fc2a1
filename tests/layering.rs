//! A room imports only rooms of a smaller rank; equal ranks are strangers.
#![allow(clippy::unwrap_used, reason = "test")]

use std::path::{Path, PathBuf};

const RANKS: &[(&str, u32)] = &[
    ("cancel", 0),
    ("cite", 0),
    ("math", 1),
    ("grid", 2),
    ("integrate", 2),
    ("picture", 2),
    ("terms", 2),
    ("models", 3),
    ("functions", 4),
    ("tables", 4),
    ("maps", 5),
    ("verify", 5),
    ("encode", 6),
    ("report", 7),
    ("scene", 6),
    ("plan", 7),
    ("recipe", 8),
    ("pipeline", 9),
    ("guide", 9),
    ("build", 10),
    ("cli", 11),
];

fn rank(room: &str) -> Option<u32> {
    RANKS.iter().find(|(name, _)| *name == room).map(|(_, rank)| *rank)
}

fn files(dir: &Path, out: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, out);
        } else if path.extension().is_some_and(|e| e == "rs") {
            out.push(path);
        }
    }
}

/// Rooms that a line of code names as `crate::room`, also inside `crate::{a, b::c}`. Doc comments are links, not uses.
fn rooms(source: &str) -> Vec<String> {
    let code: String =
        source.lines().filter(|l| !l.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
    let mut found = Vec::new();
    for (i, _) in code.match_indices("crate::") {
        let rest = &code[i + "crate::".len()..];
        if let Some(group) = rest.strip_prefix('{') {
            let mut depth = 1;
            let mut start = true;
            let mut name = String::new();
            for c in group.chars() {
                match c {
                    '{' => depth += 1,
                    '}' => depth -= 1,
                    ',' if depth == 1 => {
                        found.push(std::mem::take(&mut name));
                        start = true;
                        continue;
                    }
                    _ => {}
                }
                if depth == 0 {
                    break;
                }
                if start && (c.is_alphanumeric() || c == '_') {
                    name.push(c);
                } else if !name.is_empty() {
                    start = false;
                }
            }
            found.push(name);
        } else {
            found.push(rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect());
        }
    }
    found.retain(|r| !r.is_empty());
    found
}

#[test]
fn groups_are_split() {
    let source = "use crate::{grid::{Axis, Texel}, math};\n/// [x](crate::cli)\nuse crate::terms::ggx;";
    assert_eq!(rooms(source), ["grid", "math", "terms"]);
}

#[test]
fn rooms_import_only_lower_rooms() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut all = Vec::new();
    files(&src, &mut all);
    let mut faults = Vec::new();
    for file in all {
        let relative = file.strip_prefix(&src).unwrap();
        let own = relative.components().next().unwrap().as_os_str().to_string_lossy().replace(".rs", "");
        if ["lib", "main"].contains(&own.as_str()) {
            continue;
        }
        let own_rank = rank(&own).unwrap_or_else(|| panic!("room `{own}` has no rank"));
        for room in rooms(&std::fs::read_to_string(&file).unwrap()) {
            match rank(&room) {
                Some(r) if r < own_rank || room == own => {}
                Some(r) => {
                    faults.push(format!("{}: rank {own_rank} imports {room} of rank {r}", relative.display()))
                }
                None => faults.push(format!("{}: unknown room {room}", relative.display())),
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn files_are_short() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut all = Vec::new();
    files(&src, &mut all);
    let long: Vec<String> = all
        .iter()
        .map(|f| (f, std::fs::read_to_string(f).unwrap().lines().count()))
        .filter(|(_, n)| *n > 400)
        .map(|(f, n)| format!("{}: {n} lines", f.display()))
        .collect();
    assert!(long.is_empty(), "{}", long.join("\n"));
}
