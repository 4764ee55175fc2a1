//! `brdfbake diff A B`: the comparison behind golden-image tests.

use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::encode::ReadError;
use crate::encode::diff::Tolerance;
use crate::encode::diff_files::{self, DiffError};
use crate::math::figures::exact;
use crate::report;
use std::path::PathBuf;

/// Arguments of `diff`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// First image or folder.
    a: PathBuf,
    /// Second image or folder.
    b: PathBuf,
    /// Largest absolute difference that counts as equal.
    #[arg(long, value_name = "X", default_value_t = 0.0)]
    tolerance: f64,
    /// Largest difference in steps of the stored precision that counts as equal.
    #[arg(long, value_name = "N", default_value_t = 0.0)]
    ulps: f64,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
    /// Print nothing; the exit code tells.
    #[arg(short, long)]
    quiet: bool,
}

/// Runs it: exit code 0 if equal within the tolerance, 4 if not.
///
/// # Errors
/// [`Failure`] when a file cannot be read.
pub fn run(args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    if !(args.tolerance >= 0.0 && args.ulps >= 0.0) {
        return Err(Failure::usage(format!(
            "--tolerance {} and --ulps {} must not be negative",
            exact(args.tolerance),
            exact(args.ulps)
        )));
    }
    let tolerance = Tolerance { absolute: args.tolerance, ulps: args.ulps };
    let diff = diff_files::paths_until(cancel, &args.a, &args.b, tolerance).map_err(failure)?;
    if !args.quiet {
        let (a, b) = (args.a.display().to_string(), args.b.display().to_string());
        let json = || serde_json::to_string(&diff).unwrap_or_default();
        output::data(&if args.json { json() } else { report::diff(&a, &b, &diff) })?;
    }
    Ok(if diff.equal() { Exit::Done } else { Exit::Failed })
}

fn failure(error: DiffError) -> Failure {
    match &error {
        DiffError::Read { source, .. } => Failure { message: error.to_string(), ..read_failure(source) },
        DiffError::Cancelled(stopped) => Failure::from(*stopped),
        DiffError::Kinds { .. } => Failure::input(error),
        _ => Failure::new(Exit::Io, error),
    }
}

/// The exit code of a reading fault: 5 if the system refused, 3 if the file is not what it should be.
pub(super) fn read_failure(error: &ReadError) -> Failure {
    match error {
        ReadError::Cancelled(stopped) => Failure::from(*stopped),
        ReadError::Io { .. } => Failure::new(Exit::Io, error),
        _ => Failure::input(error),
    }
}
