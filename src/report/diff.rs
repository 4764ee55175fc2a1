//! The differences of two files or folders, as text.

use super::text::{Lines, counted, number};
use crate::encode::diff_files::{FileDiff, PathDiff};
use crate::encode::diff_json::JsonDiff;
use crate::encode::{ImageDiff, Tolerance};

/// How two files or folders differ. `a` and `b` are how the caller calls them. The text ends with a newline.
#[must_use]
pub fn diff(a: &str, b: &str, result: &PathDiff) -> String {
    let mut lines = Lines::default();
    let verdict = if result.equal() { "equal" } else { "different" };
    lines.plain(&format!("{a} and {b}: {verdict}"));
    match result {
        PathDiff::File(d) => file(&mut lines, d),
        PathDiff::Folder(d) => {
            let unequal = d.files.iter().filter(|(_, f)| !f.equal()).count();
            for (name, f) in &d.files {
                lines.plain(&format!("{name}: {}", if f.equal() { "equal" } else { "different" }));
                file(&mut lines, f);
            }
            lines.plain(&format!("{}, {unequal} different", counted(d.files.len(), "file")));
        }
    }
    lines.finish()
}

fn file(lines: &mut Lines, d: &FileDiff) {
    match d {
        FileDiff::Identical => lines.item("bytes", "the same"),
        FileDiff::Image(d) => image(lines, d),
        FileDiff::Json { difference: None } => lines.item("json", "the same values, laid out differently"),
        FileDiff::Json { difference: Some(j) } => json(lines, "json", j),
        FileDiff::Bytes { offset, sizes: [x, y] } => {
            lines.item("bytes", &format!("{x} against {y} bytes, different from offset {offset} on"));
        }
        FileDiff::OnlyFirst => lines.item("missing", "only the first has it"),
        FileDiff::OnlySecond => lines.item("missing", "only the second has it"),
    }
}

fn image(lines: &mut Lines, d: &ImageDiff) {
    for s in &d.shape {
        lines.item("shape", s);
    }
    for n in &d.notes {
        lines.item("note", n);
    }
    if !d.mapping.is_empty() {
        lines.item("channels", &format!("compared {}", d.mapping.join(", ")));
    }
    for c in &d.channels {
        let Some(w) = &c.worst else {
            lines.item(&c.name, "the same values");
            continue;
        };
        let (largest, rmse, ulps) = (number(c.largest), number(c.rmse), number(c.ulps));
        let (x, y) = (w.x, w.y);
        lines.item(
            &c.name,
            &format!(
                "largest {largest}, RMSE {rmse}, up to {ulps} ulps, {} different, {} outside the tolerance\n\
                 worst at x = {x}, y = {y}: {} against {}",
                c.different, c.outside, w.a, w.b
            ),
        );
    }
    if let Some(j) = &d.metadata {
        json(lines, "metadata", j);
    }
    lines.item("tolerance", &tolerance(d.tolerance));
}

fn tolerance(t: Tolerance) -> String {
    match (t.absolute > 0.0, t.ulps > 0.0) {
        (false, false) => "none: the values must be the same".to_owned(),
        (true, false) => number(t.absolute),
        (false, true) => format!("{} ulps", number(t.ulps)),
        (true, true) => format!("{} or {} ulps, whichever is larger", number(t.absolute), number(t.ulps)),
    }
}

fn json(lines: &mut Lines, label: &str, j: &JsonDiff) {
    let side = |v: &Option<String>| v.clone().unwrap_or_else(|| "(absent)".to_owned());
    let at = if j.path.is_empty() { "the whole value" } else { &j.path };
    lines.item(label, &format!("first difference at {at}\n{} against {}", side(&j.a), side(&j.b)));
}
