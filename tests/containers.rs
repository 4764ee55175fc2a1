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

#[path = "containers/blocks.rs"]
mod blocks;
#[path = "containers/code.rs"]
mod code;
#[path = "containers/dds_file.rs"]
mod dds_file;
#[path = "containers/exr_file.rs"]
mod exr_file;
#[path = "containers/front_ends.rs"]
mod front_ends;
#[path = "containers/hostile.rs"]
mod hostile;
#[path = "containers/ktx2_file.rs"]
mod ktx2_file;
#[path = "containers/others.rs"]
mod others;
mod sample;
#[path = "containers/storages.rs"]
mod storages;
#[path = "containers/support.rs"]
mod support;
