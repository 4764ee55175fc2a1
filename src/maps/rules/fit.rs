//! The nearest lobe, by search.

use super::{Method, Rule};

/// The rule.
pub static RULE: Rule = Rule {
    id: "fit",
    title: "the nearest GGX lobe",
    formula: "argmin D, D = 1/2 int |footprint - lobe| over the upper hemisphere",
    sources: &[],
    notes: "Fits the normal too where a normal map is written.",
    anisotropic: true,
    method: Method::Fit,
};
