//! The empirical and diffuse models against high-precision reference values, closed forms and limits.
#![allow(clippy::excessive_precision, reason = "reference values are quoted with all their digits")]
#![allow(clippy::unwrap_used, reason = "a test may fail by panicking")]

#[path = "empirical/closed_forms.rs"]
mod closed_forms;
#[path = "empirical/support.rs"]
mod support;
#[path = "empirical/values.rs"]
mod values;
