//! `brdfbake diff A B`: the comparison behind golden-image tests.

use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::encode::ReadError;
use crate::encode::diff::{Pairing, Tolerance};
use crate::encode::diff_files::{self, DiffError, Manner};
use crate::encode::layout::Layout;
use crate::math::figures::exact;
use crate::report;
use std::path::PathBuf;

/// Shown behind the help.
const EXAMPLES: &str = concat!(
    "Examples:",
    "\n  brdfbake diff a.exr b.exr --tolerance 1e-3",
    "\n  brdfbake diff textures others --json",
);

/// Arguments of `diff`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
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
    /// Channels to compare, first file = second file; others are left out. Without it they are matched by name, or by position where
    /// the two files have no name in common.
    #[arg(long, value_name = "A=B", value_delimiter = ',', conflicts_with = "by_position")]
    channels: Vec<String>,
    /// Match channels by position, whatever their names.
    #[arg(long)]
    by_position: bool,
    /// How the numbers of bare files (.bin) lie, such as 128x64x2:half; without it the manifest beside them tells.
    #[arg(long, value_name = "WxHxC:STORAGE")]
    raw: Option<String>,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
    /// Print nothing; the exit code tells.
    #[arg(short, long, conflicts_with = "json")]
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
    let manner = Manner {
        tolerance,
        pairing: pairing(args)?,
        layout: layout(args.raw.as_deref(), [&args.a, &args.b])?,
    };
    let diff = diff_files::paths_until(cancel, &args.a, &args.b, &manner).map_err(failure)?;
    if !args.quiet {
        let (a, b) = (args.a.display().to_string(), args.b.display().to_string());
        let json = || serde_json::to_string(&diff).unwrap_or_default();
        output::data(&if args.json { json() } else { report::diff(&a, &b, &diff) })?;
    }
    Ok(if diff.equal() { Exit::Done } else { Exit::Failed })
}

/// Pairs of channels as they are asked for.
fn pairing(args: &Args) -> Result<Pairing, Failure> {
    if (args.by_position || !args.channels.is_empty()) && args.a.is_dir() {
        return Err(Failure::usage("--channels and --by-position are for two files, not for folders"));
    }
    if args.by_position {
        return Ok(Pairing::Position);
    }
    let pair = |text: &String| match text.split_once('=') {
        Some((a, b)) if !a.is_empty() && !b.is_empty() => Ok([a.to_owned(), b.to_owned()]),
        _ => Err(Failure::usage(format!("--channels `{text}` is not NAME=NAME, such as R=dfg.scale"))),
    };
    let pairs: Vec<[String; 2]> = args.channels.iter().map(pair).collect::<Result<_, _>>()?;
    Ok(if pairs.is_empty() { Pairing::Best } else { Pairing::Named(pairs) })
}

/// The layout of bare files, which one of the files must be.
pub(super) fn layout<'a>(
    text: Option<&str>,
    files: impl IntoIterator<Item = &'a PathBuf>,
) -> Result<Option<Layout>, Failure> {
    let Some(text) = text else { return Ok(None) };
    let is_bare = |p: &PathBuf| p.is_dir() || Layout::is_of(p);
    if !files.into_iter().any(is_bare) {
        return Err(Failure::usage("--raw tells how .bin files lie, but no .bin file is given"));
    }
    Layout::parse(text).map(Some).map_err(|e| Failure::usage(format!("--raw: {e}")))
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
