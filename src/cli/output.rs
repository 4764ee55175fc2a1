//! Data goes to stdout, talk to stderr. A closed pipe is success, not a panic.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "the one place that prints")]

use super::Failure;
use std::io::Write;

/// Writes a block of data to stdout; a reader that went away is not an error.
pub fn data(text: &str) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(text.as_bytes());
    if !text.ends_with('\n') {
        let _ = out.write_all(b"\n");
    }
    let _ = out.flush();
}

/// Writes a line of talk to stderr.
pub fn talk(text: &str) {
    let mut err = std::io::stderr().lock();
    let _ = writeln!(err, "{text}");
}

/// Tells the user what failed.
pub fn error(failure: &Failure) {
    // diagnostics with carets carry their own heading
    if failure.message.starts_with("error") {
        talk(&failure.message);
    } else {
        talk(&format!("error: {}", failure.message));
    }
}
