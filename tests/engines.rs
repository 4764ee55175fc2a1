//! The tables of engines: the registry, and every baked file against the shipped one, read as the engine reads them.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::cast_possible_truncation,
    reason = "test"
)]

mod common;
#[path = "engines/compare.rs"]
mod compare;
#[path = "engines/files.rs"]
mod files;
#[path = "engines/registry.rs"]
mod registry;
#[path = "engines/support.rs"]
mod support;
