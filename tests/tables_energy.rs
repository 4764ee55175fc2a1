//! Albedos, split sums, compensation, sheen and clear coat against values that this program did not make: reference
//! integrals, closed forms, and the tables that renderers ship.
#![allow(clippy::unwrap_used, clippy::float_cmp, clippy::print_stdout, clippy::print_stderr, reason = "test")]

mod channels;
mod engines;
mod identities;
mod support;
mod values;
