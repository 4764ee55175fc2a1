//! Storages that couple channels, containers beside EXR and PNG, code; each read by something that is not ours.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::float_cmp,
    clippy::print_stderr,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::disallowed_methods,
    clippy::type_complexity,
    reason = "tests"
)]

mod blocks;
mod code;
mod dds_file;
mod exr_file;
mod front_ends;
mod hostile;
mod ktx2_file;
mod others;
mod outside;
mod storages;
mod support;
