//! Numbered findings: 1xxx input and output, 2xxx energy, 3xxx reciprocity, 4xxx stability, 5xxx encoding.

use super::{Law, Seen};
use crate::grid::Table;
use crate::grid::table::place;
use crate::tables::Spec;
use serde::Serialize;

/// Number of the finding that texels miss their tolerance.
pub const MISSED: u16 = 4010;

/// Something that a check found, with its number and place.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// Number; the thousands name the group.
    pub code: u16,
    /// `error` or `warning`.
    pub severity: Severity,
    /// Law or check that found it.
    pub law: String,
    /// What came of it.
    pub result: Verdict,
    /// Table kind and model.
    pub subject: String,
    /// What was found.
    pub message: String,
    /// Where: coordinates and parameters; empty where it is no place.
    pub at: String,
}

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// It stops the bake.
    Error,
    /// It is reported.
    Warning,
}

/// What came of a check.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// A law is broken.
    Broken,
    /// A law is broken, and let through for a reason.
    Waived,
    /// A law could not be checked.
    #[serde(rename = "not checked")]
    NotChecked,
    /// Texels miss their tolerance.
    Missed,
}

impl Verdict {
    /// Is it what `--strict` refuses? A waiver has its reason in the recipe.
    #[must_use]
    pub fn is_doubt(self) -> bool {
        matches!(self, Verdict::NotChecked | Verdict::Missed)
    }
}

impl Finding {
    /// A broken law.
    #[must_use]
    pub fn broken(law: &Law, seen: &Seen, spec: &Spec) -> Finding {
        Finding {
            code: law.code,
            severity: Severity::Error,
            law: law.id.to_owned(),
            result: Verdict::Broken,
            subject: subject(spec),
            message: format!("{}: margin {:.3e} ({})", law.statement, seen.margin, law.margin),
            at: seen.at.clone(),
        }
    }

    /// A law that could not be checked.
    #[must_use]
    pub fn unchecked(law: &Law, why: &str, spec: &Spec) -> Finding {
        Finding {
            code: law.code,
            severity: Severity::Warning,
            law: law.id.to_owned(),
            result: Verdict::NotChecked,
            subject: subject(spec),
            message: format!("not checked: {why}"),
            at: String::new(),
        }
    }

    /// Texels that miss their tolerance, as the recipe allows.
    #[must_use]
    pub fn missed(count: usize, tolerance: f64, table: &Table, spec: &Spec) -> Finding {
        let worst = table.largest_error();
        let (n, estimate) = (table.grid.len(), worst.value);
        Finding {
            code: MISSED,
            severity: Severity::Warning,
            law: "tolerance".to_owned(),
            result: Verdict::Missed,
            subject: subject(spec),
            message: format!(
                "{count} of {n} texels miss the tolerance {tolerance:e}; the worst has an estimated error of {estimate:e}"
            ),
            at: place(&worst.at),
        }
    }

    /// The same finding, let through for a reason.
    #[must_use]
    pub fn waived(mut self, reason: &str) -> Finding {
        self.severity = Severity::Warning;
        self.result = Verdict::Waived;
        self.message = format!("{}; waived: {reason}", self.message);
        self
    }
}

/// Table kind, model and fixed parameters in words.
#[must_use]
pub fn subject(spec: &Spec) -> String {
    let Some((info, params)) = &spec.model else { return spec.kind.id.to_owned() };
    let fixed: Vec<String> = params
        .to_json(&spec.swept())
        .iter()
        .map(|(k, v)| format!("{k} = {}", v.to_string().replace('"', "")))
        .collect();
    format!("{} of {} ({})", spec.kind.id, info.id, fixed.join(", "))
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "BB{:04} {}: {} [{}]", self.code, self.law, self.subject, self.message)?;
        if self.at.is_empty() { Ok(()) } else { write!(f, " at {}", self.at) }
    }
}
