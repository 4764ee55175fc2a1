//! Recipes: every fault with its exact message (`tests/bad`), presets, canonical form, and no panic on any input.
#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "a test fails by panicking")]

#[path = "recipes/bad.rs"]
mod bad;
#[path = "recipes/canonical.rs"]
mod canonical;
#[path = "recipes/fuzz.rs"]
mod fuzz;
#[path = "recipes/names.rs"]
mod names;
#[path = "recipes/presets.rs"]
mod presets;
#[path = "recipes/requests.rs"]
mod requests;
