//! What files and reports say of a table, against what it is: formulas of coordinates, errors as an engine reads, and that a
//! file is replaced and never written over.
#![allow(clippy::unwrap_used, reason = "test")]

mod formulas;
mod readers;
#[cfg(unix)]
mod replaced;
