//! The command from outside: what becomes of its output, of signals, of rows and of numbers in messages.
#![allow(clippy::unwrap_used, clippy::print_stderr, reason = "test")]

#[path = "command/eval.rs"]
mod eval;
#[path = "command/messages.rs"]
mod messages;
#[cfg(unix)]
#[path = "command/signals.rs"]
mod signals;
#[path = "command/stopping.rs"]
mod stopping;
#[cfg(unix)]
#[path = "command/streams.rs"]
mod streams;
#[path = "command/support.rs"]
mod support;
