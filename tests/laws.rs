//! Laws look at what they say they look at, or say that they did not; and what they look at they judge rightly.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "test")]

#[path = "laws/declared.rs"]
mod declared;
#[path = "laws/files.rs"]
mod files;
#[path = "laws/honest.rs"]
mod honest;
#[path = "laws/shipped.rs"]
mod shipped;
#[path = "laws/support.rs"]
mod support;
