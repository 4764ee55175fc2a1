//! Albedos, split sums, compensation, sheen and clear coat against values that this program did not make: reference
//! integrals, closed forms, and the tables that renderers ship.
#![allow(clippy::unwrap_used, clippy::float_cmp, clippy::print_stdout, clippy::print_stderr, reason = "test")]

#[path = "tables_energy/channels.rs"]
mod channels;
mod common;
#[path = "tables_energy/engines.rs"]
mod engines;
#[path = "tables_energy/identities.rs"]
mod identities;
#[path = "tables_energy/support.rs"]
mod support;
#[path = "tables_energy/values.rs"]
mod values;
