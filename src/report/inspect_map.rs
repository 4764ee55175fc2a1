//! What a parameter map says of itself.

use super::text::Lines;
use serde_json::Value;

/// Tells of the metadata of a map; false if they are of something else.
pub(super) fn map(lines: &mut Lines, text: &str) -> bool {
    let Ok(json) = serde_json::from_str::<Value>(text) else { return false };
    let (Some(map), Some(levels)) = (json["map"].as_str(), json["levels"].as_array()) else { return false };
    let word = |key: &str| json[key].as_str().unwrap_or("?").to_owned();
    lines.plain("Parameter map");
    lines.item("name", &format!("{}.{map}", word("name")));
    for channel in json["channels"].as_array().into_iter().flatten() {
        let [id, meaning] = ["id", "meaning"].map(|k| channel[k].as_str().unwrap_or("?"));
        lines.item(id, meaning);
    }
    lines.item("storage", &word("storage"));
    lines.item("rule", &format!("{}: {}", word("rule"), word("formula")));
    lines.item(
        "lobes",
        &format!("{}, normals {}, objective {}", word("shape"), word("normals"), word("objective")),
    );
    for input in json["inputs"].as_array().into_iter().flatten() {
        let [role, file] = ["role", "file"].map(|k| input[k].as_str().unwrap_or("?"));
        lines.item("input", &format!("{role}: {file}"));
    }
    lines.plain("Levels: D is half the integral of |footprint - lobe|, 0 the same, 1 disjoint");
    for (k, level) in levels.iter().enumerate() {
        lines.item(&k.to_string(), &self::level(level));
    }
    for place in json["worst"].as_array().into_iter().flatten().take(5) {
        let number = |key: &str| place[key].as_u64().unwrap_or(0);
        let d = place["distance"].as_f64().unwrap_or(f64::NAN);
        lines.item(
            "worst",
            &format!("level {} ({}, {}): D {d:.4}", number("level"), number("x"), number("y")),
        );
    }
    lines.item("made by", &word("tool"));
    true
}

fn level(level: &Value) -> String {
    let whole = |v: &Value| v.as_u64().unwrap_or(0);
    let number = |v: &Value| v.as_f64().unwrap_or(f64::NAN);
    let mut text = format!(
        "{} x {}, roughness {:.4} to {:.4}, D mean {:.4}, largest {:.4} (doubt {:.4})",
        whole(&level["size"][0]),
        whole(&level["size"][1]),
        number(&level["roughness"][0]),
        number(&level["roughness"][1]),
        number(&level["mean"]),
        number(&level["largest"]),
        number(&level["doubt"]),
    );
    if let Some(m) = level.get("measured") {
        text +=
            &format!("; measured mean {:.4}, stored {:.4}", number(&m["mean"]), number(&m["stored_mean"]));
    }
    for (key, what) in [("at_limit", "at the limit alpha = 1"), ("hopeless", "with D >= 0.5")] {
        if whole(&level[key]) > 0 {
            text += &format!("; {} {what}", whole(&level[key]));
        }
    }
    text
}
