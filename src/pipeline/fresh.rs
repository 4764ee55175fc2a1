//! Does a folder hold what a plan would bake? Nothing is baked to tell: the manifest names the identity of every table and map, and the
//! hash of every file.

use super::MANIFEST;
use super::audit::{State, of_listed};
use super::manifest;
use crate::plan::Plan;
use std::path::Path;

/// Why the folder does not hold what the plan would bake, a line a reason; empty if it does.
#[must_use]
pub fn stale(plan: &Plan, folder: &Path) -> Vec<String> {
    let held = match of_listed(folder) {
        Ok(held) => held,
        Err(e) => return vec![e.to_string()],
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
    for file in &held.files {
        let name = &file.file;
        match file.state {
            State::Whole => {}
            State::Missing => why.push(format!("{name} is missing")),
            State::Changed { .. } => why.push(format!("{name} has other bytes than {MANIFEST} says")),
        }
    }
    let listed = |name: &String| name == MANIFEST || held.files.iter().any(|f| f.file == *name);
    why.extend(plan.files().iter().filter(|n| !listed(n)).map(|n| format!("{n} is not there yet")));
    why
}
