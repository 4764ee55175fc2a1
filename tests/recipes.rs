//! Recipes: every fault with its exact message (`tests/bad`), presets, canonical form, and no panic on any input.
#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "a test fails by panicking")]

mod bad;
mod canonical;
mod fuzz;
mod names;
mod presets;
mod requests;
mod text;
