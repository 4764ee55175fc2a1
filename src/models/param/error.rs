//! What can be wrong with the parameters of a model.

use crate::math::figures::exact;

/// What can be wrong with the parameters of a model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ParamError {
    /// No such parameter.
    #[error("{model}: no parameter `{key}`; it has {allowed}{}", hint(.suggestion.as_deref()))]
    Unknown {
        /// Model id.
        model: &'static str,
        /// The key given.
        key: String,
        /// The keys there are.
        allowed: String,
        /// The nearest one.
        suggestion: Option<String>,
    },
    /// A number outside its range.
    #[error("{model}: {key} = {} outside [{}, {}]", exact(.got), exact(.min), exact(.max))]
    Range {
        /// Model id.
        model: &'static str,
        /// The key.
        key: &'static str,
        /// The value given.
        got: f64,
        /// Least value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// A value of the wrong type, or a word that is not offered.
    #[error("{model}: {key} = {got} is not {allowed}")]
    Kind {
        /// Model id.
        model: &'static str,
        /// The key.
        key: &'static str,
        /// The value given.
        got: String,
        /// What is allowed.
        allowed: String,
    },
    /// One parameter under two of its names.
    #[error("{model}: `{key}` and `{other}` are the same parameter; leave one out")]
    Twice {
        /// Model id.
        model: &'static str,
        /// The name that was given first.
        key: String,
        /// The other one.
        other: String,
    },
    /// A parameter that was asked for by a name or a type that is not declared: a fault of the program.
    #[error("{model}: it declares no `{key}` that is {what}")]
    Undeclared {
        /// Model id.
        model: &'static str,
        /// The name that was asked for.
        key: String,
        /// What it was taken for.
        what: &'static str,
    },
    /// Parameters that are each in range but not together.
    #[error("{model}: {why}")]
    Together {
        /// Model id.
        model: &'static str,
        /// Why not.
        why: String,
    },
}

impl ParamError {
    /// The key at fault, if it is one.
    #[must_use]
    pub fn key(&self) -> Option<&str> {
        match self {
            ParamError::Unknown { key, .. } | ParamError::Twice { other: key, .. } => Some(key),
            ParamError::Range { key, .. } | ParamError::Kind { key, .. } => Some(key),
            ParamError::Undeclared { .. } | ParamError::Together { .. } => None,
        }
    }
}

fn hint(suggestion: Option<&str>) -> String {
    suggestion.map_or_else(String::new, |s| format!("; did you mean `{s}`?"))
}
