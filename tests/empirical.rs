//! The empirical and diffuse models against high-precision reference values, closed forms and limits.
#![allow(clippy::excessive_precision, reason = "reference values are quoted with all their digits")]
#![allow(clippy::unwrap_used, reason = "a test may fail by panicking")]

mod closed_forms;
mod largest;
mod limits;
mod stiff;
mod support;
mod values;
