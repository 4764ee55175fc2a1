//! Data goes to stdout, talk to stderr, and both go through here. A reader of stdout that went away is silent; everything
//! else that keeps data from being written is a failure of the run.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "the one place that prints")]

use super::terminal::{self, Paint, paint};
use super::{Exit, Failure, interrupt};
use std::io::{self, ErrorKind, Write};

/// Is somebody still reading stdout?
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reader {
    /// As far as one can tell.
    There,
    /// It closed the pipe: more data is wasted, but nothing is wrong.
    Gone,
}

/// Writes a block of data to stdout, and the end of its last line.
///
/// # Errors
/// [`Failure`] with [`Exit::Io`] if it cannot be written for another reason than a closed pipe.
pub fn data(text: &str) -> Result<Reader, Failure> {
    let end = if text.ends_with('\n') { "" } else { "\n" };
    let mut out = stdout();
    judge(
        out.write_all(text.as_bytes())
            .and_then(|()| out.write_all(end.as_bytes()))
            .and_then(|()| out.flush()),
    )
}

/// The one way to stdout, for data that is made bit by bit; what its writes return goes to [`judge`].
pub(super) fn stdout() -> impl Write {
    io::stdout().lock()
}

/// What the result of a write to stdout means.
///
/// # Errors
/// As [`data`].
pub(super) fn judge(result: io::Result<()>) -> Result<Reader, Failure> {
    match result {
        Ok(()) => Ok(Reader::There),
        Err(e) if e.kind() == ErrorKind::BrokenPipe => Ok(Reader::Gone),
        Err(e) => Err(Failure::io("stdout", &e)),
    }
}

/// Writes a line of talk to stderr. Where that fails there is nobody left to tell.
pub fn talk(text: &str) {
    let mut err = io::stderr().lock();
    let _ = writeln!(err, "{text}");
}

/// Tells a program what failed, on stdout. What keeps it from that is told to the user with the failure itself.
pub(super) fn error_objects(failure: &Failure) {
    let lines: Vec<String> = failure.objects().iter().map(ToString::to_string).collect();
    let _ = data(&lines.join("\n"));
}

/// Tells the user what failed.
pub fn error(failure: &Failure) {
    match failure.exit {
        Exit::Interrupted if !interrupt::is_first_to_tell() => {}
        Exit::Interrupted => talk(&failure.message),
        // diagnostics with carets carry their own heading
        _ if failure.message.starts_with("error") => {
            let styled = failure.styled.as_ref().filter(|_| terminal::is_coloured());
            talk(styled.unwrap_or(&failure.message));
        }
        _ => talk(&format!("{} {}", paint(Paint::Bad, "error:"), failure.message)),
    }
}
