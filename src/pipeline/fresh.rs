//! Does a folder hold what a plan would bake? Nothing is baked to tell: the manifest names the identity of every table and map, and the
//! hash of every file.

use super::MANIFEST;
use super::manifest;
use crate::plan::Plan;
use serde::Deserialize;
use std::collections::BTreeSet;
use std::path::Path;

/// What of a manifest is looked at.
#[derive(Deserialize)]
struct Held {
    tool: String,
    hash: String,
    #[serde(default)]
    tables: Vec<Unit>,
    #[serde(default)]
    maps: Vec<Unit>,
}

#[derive(Deserialize)]
struct Unit {
    files: Vec<File>,
}

#[derive(Deserialize)]
struct File {
    file: String,
    bytes: u64,
    blake3: String,
}

/// Why the folder does not hold what the plan would bake, a line a reason; empty if it does.
#[must_use]
pub fn stale(plan: &Plan, folder: &Path) -> Vec<String> {
    let path = folder.join(MANIFEST);
    let bytes = match std::fs::read(&path) {
        Ok(bytes) => bytes,
        Err(e) => return vec![format!("{}: {e}", path.display())],
    };
    let held: Held = match serde_json::from_slice(&bytes) {
        Ok(held) => held,
        Err(e) => return vec![format!("{}: {e}", path.display())],
    };
    let mut why = Vec::new();
    let tool = manifest::tool();
    if held.tool != tool {
        why.push(format!("{MANIFEST} is of {}, this is {tool}", held.tool));
    }
    if held.hash != plan.units_hash() {
        why.push(format!(
            "{MANIFEST} is of another plan: a recipe, a preset, an input or an option has changed"
        ));
    }
    let mut listed = BTreeSet::new();
    for file in held.tables.iter().chain(&held.maps).flat_map(|u| &u.files) {
        // several tables may be in one file
        if listed.insert(&file.file) {
            why.extend(changed(folder, file));
        }
    }
    let names = plan.files();
    why.extend(
        names
            .iter()
            .filter(|n| **n != MANIFEST && !listed.contains(n))
            .map(|n| format!("{n} is not there yet")),
    );
    why
}

fn changed(folder: &Path, file: &File) -> Option<String> {
    let name = &file.file;
    match std::fs::read(folder.join(name)) {
        Err(e) => Some(format!("{name}: {e}")),
        Ok(bytes)
            if bytes.len() as u64 != file.bytes || blake3::hash(&bytes).to_hex().as_str() != file.blake3 =>
        {
            Some(format!("{name} has other bytes than {MANIFEST} says"))
        }
        Ok(_) => None,
    }
}
