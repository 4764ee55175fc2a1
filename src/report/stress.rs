//! What a walk over extremes found, as text and as tables of Markdown.

use crate::math::figures::short;
use crate::verify::stress::{Stress, Worst};

/// Columns of a subject.
struct Row {
    cells: [String; 6],
    faults: Vec<String>,
}

fn row(s: &Stress) -> Row {
    let at = |w: &Worst| if w.at.is_empty() { String::new() } else { format!(" at {}", w.at) };
    let digits = match (s.kind, &s.single) {
        ("term", Some(w)) => format!("{:.1}{}", w.value, at(w)),
        ("table", _) => String::new(),
        _ => format!("{:.1}{}", s.digits.value, at(&s.digits)),
    };
    let single = match (s.kind, &s.single) {
        ("table", Some(w)) => format!("{} texels{}", short(w.value), at(w)),
        _ => String::new(),
    };
    let evaluations = match s.evaluations.value {
        v if v > 0.0 => format!("{v:.0}{}", at(&s.evaluations)),
        _ => String::new(),
    };
    let verdict = if s.holds() { "holds".to_owned() } else { format!("DOES NOT HOLD ({})", s.faulty) };
    Row {
        cells: [s.id.to_owned(), s.points.to_string(), digits, single, evaluations, verdict],
        faults: s.faults.iter().map(|f| format!("{}: {} at {}", f.fault, f.message, f.at)).collect(),
    }
}

/// Lines for a terminal.
#[must_use]
pub fn text(found: &[Stress]) -> String {
    let mut lines = Vec::new();
    for s in found {
        let Row { cells: [id, points, digits, single, evaluations, verdict], faults } = row(s);
        lines.push(format!("{id} ({}): {verdict}, {points} points, {} refused", s.kind, s.refused));
        let parts =
            [("digits kept", digits), ("axis maps in 32 bits", single), ("most evaluations", evaluations)];
        lines.extend(
            parts.into_iter().filter(|(_, t)| !t.is_empty()).map(|(name, t)| format!("  {name}: {t}")),
        );
        lines.extend(faults.into_iter().map(|f| format!("  {f}")));
    }
    lines.join("\n")
}

/// Tables of Markdown, one for each kind of subject.
#[must_use]
pub fn markdown(found: &[Stress]) -> String {
    let mut parts = Vec::new();
    for (kind, header) in [
        ("model", "| model | points | digits kept, worst | most evaluations of E to 1e-5 | verdict |"),
        ("function", "| function | points | digits kept, worst | verdict |"),
        (
            "table",
            "| table | points | axis maps in 32 bits, worst | most evaluations of a texel to 1e-5 | verdict |",
        ),
        ("term", "| term | points | digits of 7.2 kept in 32 bits, worst | verdict |"),
    ] {
        let rows: Vec<String> = found.iter().filter(|s| s.kind == kind).map(|s| line(kind, row(s))).collect();
        if !rows.is_empty() {
            let rule = format!("|{}", "---|".repeat(header.matches('|').count() - 1));
            parts.push(format!("{header}\n{rule}\n{}", rows.join("\n")));
        }
    }
    parts.join("\n\n")
}

fn line(kind: &str, row: Row) -> String {
    let Row { cells: [id, points, digits, single, evaluations, verdict], faults } = row;
    let verdict = std::iter::once(verdict).chain(faults).collect::<Vec<_>>().join("; ").replace('|', "\\|");
    let cells = match kind {
        "model" => vec![format!("`{id}`"), points, digits, evaluations, verdict],
        "table" => vec![format!("`{id}`"), points, single, evaluations, verdict],
        _ => vec![format!("`{id}`"), points, digits, verdict],
    };
    format!("| {} |", cells.join(" | "))
}
