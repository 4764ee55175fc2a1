//! `brdfbake bake --scene FILE`: the plan that a glTF scene asks for, and what was left out and why.

use super::progress::Format;
use super::{Exit, Failure, output};
use crate::plan::scene::ScenePlanError;
use crate::plan::{self, Plan};
use crate::scene::{self, Limits, Needs};
use std::path::Path;

/// Reads the scene, tells what it needs and what is left out, and plans the tables; `None` if it needs none.
pub(super) fn plan(path: &Path, quiet: bool, format: Format) -> Result<Option<Plan>, Failure> {
    let scene = scene::read(path, &Limits::default()).map_err(|e| {
        let exit = if matches!(e.fault, scene::Fault::Io { .. }) { Exit::Io } else { Exit::Input };
        Failure::new(exit, e)
    })?;
    let needs = scene::analyse(&scene);
    match format {
        Format::Json => json(&scene.file_name, &needs)?,
        Format::Human if quiet => {}
        Format::Human => human(&scene, &needs),
    }
    plan::scene::plan(&needs).map_err(|e| {
        let exit =
            if matches!(e, ScenePlanError::Family { .. }) { Exit::Unsupported } else { Exit::Internal };
        Failure::new(exit, e)
    })
}

fn human(scene: &scene::Scene, needs: &Needs) {
    output::talk(&format!("scene {}: {} materials", scene.file_name, scene.materials.len()));
    for need in &needs.needs {
        let [lo, hi] = need.roughness;
        let (n, s) = (need.asked_by.len(), if need.asked_by.len() == 1 { "" } else { "s" });
        output::talk(&format!(
            "  needs {} tables, roughness [{lo}, {hi}], asked {n} time{s}, such as",
            need.table
        ));
        for asked in need.asked_by.iter().take(4) {
            output::talk(&format!("    {}: {}", asked.material, asked.why));
        }
    }
    for left in &needs.left_out {
        output::talk(&format!("  left out: {left}"));
    }
    for warning in &scene.warnings {
        output::talk(&format!("  warning: {warning}"));
    }
    if needs.needs.is_empty() {
        output::talk("  nothing to bake");
    }
}

fn json(file: &str, needs: &Needs) -> Result<(), Failure> {
    let line = serde_json::json!({ "reason": "scene", "file": file, "needs": needs.needs, "left_out": needs.left_out });
    output::data(&line.to_string()).map(|_| ())
}
