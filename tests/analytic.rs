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

#[path = "analytic/code.rs"]
mod code;
#[path = "analytic/command.rs"]
mod command;
mod common;
#[path = "analytic/solver.rs"]
mod solver;
#[path = "analytic/split.rs"]
mod split;
#[path = "analytic/tables.rs"]
mod tables;
