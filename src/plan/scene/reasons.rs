//! Why tables are baked, as JSON: for the manifest and for programs.

use super::{Asked, AskedMap, Survey};
use serde_json::{Value as Json, json};

/// Scenes with their hashes, what they need and who asks, the tables for it, where they stop short, and what was left out.
#[must_use]
pub fn reasons(survey: &Survey, asked: &[Asked], maps: &[AskedMap]) -> Json {
    let scenes: Vec<Json> = survey
        .scenes
        .iter()
        .map(|s| {
            json!({ "file": s.file, "blake3": s.hash, "materials": s.materials, "images": s.images, "warnings": s.warnings })
        })
        .collect();
    let tables: Vec<Json> = asked
        .iter()
        .map(|a| json!({ "table": a.request.name, "family": a.family, "cut": a.notes }))
        .collect();
    let mut all = json!({
        "files": scenes,
        "needs": survey.needs.needs,
        "tables": tables,
        "left_out": survey.needs.left_out,
    });
    if !maps.is_empty() {
        let one = |m: &AskedMap| json!({ "map": m.request.name, "asked_by": m.asked_by });
        all["maps"] = maps.iter().map(one).collect();
    }
    all
}
