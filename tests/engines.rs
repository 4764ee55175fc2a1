//! The tables of engines: the registry, and every baked file against the shipped one, read as the engine reads them.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::cast_possible_truncation,
    reason = "test"
)]

#[path = "engines/arrays.rs"]
mod arrays;
mod common;
#[path = "engines/compare.rs"]
mod compare;
#[path = "engines/files.rs"]
mod files;
#[path = "engines/interfaces.rs"]
mod interfaces;
#[path = "engines/places.rs"]
mod places;
#[path = "engines/registry.rs"]
mod registry;
#[path = "engines/suggest.rs"]
mod suggest;
#[path = "engines/support.rs"]
mod support;
