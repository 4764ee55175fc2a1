//! Laws look at what they say they look at, or say that they did not; and what they look at they judge rightly.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test")]

mod declared;
mod files;
mod honest;
mod shipped;
mod support;

pub(crate) use support::bake;
