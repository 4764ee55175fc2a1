//! Tables as formulas: errors as stated, at values from elsewhere, in code that compiles.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stderr,
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::disallowed_methods,
    reason = "test"
)]

mod code;
mod command;
mod solver;
mod split;
mod tables;
