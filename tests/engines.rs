//! The tables of engines: the registry, and every baked file against the shipped one, read as the engine reads them.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::cast_possible_truncation,
    reason = "test"
)]

mod arrays;
mod compare;
mod files;
mod interfaces;
mod openpbr;
mod places;
mod registry;
mod suggest;
mod support;
