//! The command from outside: what becomes of its output, of signals, of rows and of numbers in messages.
#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "test")]

mod again;
mod arguments;
mod build_steps;
mod eval;
mod help;
mod messages;
mod objects;
mod outside;
mod plots;
mod preview;
mod report;
#[cfg(unix)]
mod robust;
mod schema;
#[cfg(unix)]
mod signals;
mod stopping;
#[cfg(unix)]
mod streams;
mod support;
