//! What a parameter map says of itself.

use super::sheet::counts;
use super::text::{Lines, number};
use crate::encode::Image;
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
    conversion(lines, &json["conversion"]);
    lobes(lines, &json["sbrdf"]);
    lines.item("made by", &word("tool"));
    true
}

/// What is told of a conversion and of lobes, as lines of text.
#[cfg(feature = "report")]
pub(super) fn beside(record: &Value) -> String {
    let mut lines = Lines::default();
    conversion(&mut lines, &record["conversion"]);
    lobes(&mut lines, &record["sbrdf"]);
    lines.finish()
}

/// What a conversion of other lobes cost.
fn conversion(lines: &mut Lines, json: &Value) {
    let number = |v: &Value| v.as_f64().unwrap_or(f64::NAN);
    let Some(from) = json["from"].as_str() else { return };
    let pair = |key: &str| format!("mean {:.4}, largest {:.4}", number(&json[key][0]), number(&json[key][1]));
    lines.item("converted", &format!("from {from} ({})", json["rule"].as_str().unwrap_or("?")));
    lines.item("", &format!("D {}\nE differs: {}", pair("distance"), pair("energy")));
    let gained = &json["gained"];
    if gained["texels"].as_u64().unwrap_or(0) > 0 {
        let (n, most) = (&gained["texels"], number(&gained["largest"]));
        lines.item("finding", &format!("{n} texels reflect more than before, {most:.4} at most"));
    }
}

/// What is told of lobes of Lafortune.
fn lobes(lines: &mut Lines, json: &Value) {
    let number = |v: &Value| v.as_f64().unwrap_or(f64::NAN);
    let Some(normalise) = json["normalise"].as_str() else { return };
    let way = if json["reciprocal"].as_bool() == Some(true) { "reciprocal" } else { "not reciprocal" };
    lines.item("SBRDF", &format!("{} lobes of Lafortune, {normalise} integral, {way}", json["lobes"]));
    for (k, level) in json["levels"].as_array().into_iter().flatten().enumerate() {
        let (mean, largest) = (number(&level["mean"]), number(&level["largest"]));
        let mut text = format!("level {k}: residual mean {mean:.4}, largest {largest:.4}");
        if let Some(m) = level.get("measured") {
            let (own, refit) = (number(&m["mean"]), number(&m["refit"]));
            text += &format!("; against the footprints {own:.4}, refit {refit:.4}");
        }
        lines.item("", &text);
    }
    let storage = &json["storage"];
    lines.item(
        "",
        &format!(
            "storage changes the lobes by {:.4} (largest {:.4})",
            number(&storage[0]),
            number(&storage[1])
        ),
    );
}

/// A histogram of every channel: sixteen parts of its range, each as high as its share of the fullest.
pub(super) fn histograms(lines: &mut Lines, image: &Image) {
    const BARS: [char; 9] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    lines.plain("Histograms of the first level");
    for plane in &image.channels {
        let s = plane.statistics();
        if s.finite == 0 {
            continue;
        }
        let counts = counts(plane, [s.min, s.max], 16);
        let most = counts.iter().copied().max().unwrap_or(0).max(1);
        // no part that holds anything is blank
        let bars: String = counts.iter().map(|c| BARS[(c * 8).div_ceil(most)]).collect();
        lines.item(&plane.name, &format!("{} |{bars}| {}", number(s.min), number(s.max)));
    }
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
