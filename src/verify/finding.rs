//! Numbered findings: 1xxx input and output, 2xxx energy, 3xxx reciprocity, 4xxx stability, 5xxx encoding.

use super::{Law, Outcome};
use crate::tables::Spec;
use serde::Serialize;

/// Something that a check found, with its number and place.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// Number; the thousands name the group.
    pub code: u16,
    /// `error` or `warning`.
    pub severity: Severity,
    /// Law or check that found it.
    pub law: String,
    /// Table kind and model.
    pub subject: String,
    /// What was found.
    pub message: String,
    /// Where: coordinates and parameters.
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

impl Finding {
    /// A broken law.
    #[must_use]
    pub fn broken(law: &Law, outcome: &Outcome, spec: &Spec) -> Finding {
        Finding {
            code: law.code,
            severity: Severity::Error,
            law: law.id.to_owned(),
            subject: subject(spec),
            message: format!("{}: margin {:.3e} ({})", law.statement, outcome.margin, law.margin),
            at: outcome.at.clone(),
        }
    }

    /// The same finding, let through for a reason.
    #[must_use]
    pub fn waived(mut self, reason: &str) -> Finding {
        self.severity = Severity::Warning;
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
        write!(f, "BB{:04} {}: {} [{}] at {}", self.code, self.law, self.subject, self.message, self.at)
    }
}
