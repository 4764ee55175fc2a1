//! `brdfbake report DIR`: a page for people of what a folder holds.

use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::encode::atomic;
use crate::pipeline::pages::{self, Asked, EVALUATIONS, ReportError};
use crate::pipeline::pool;
use crate::report::page;
use std::io::ErrorKind;
use std::path::PathBuf;
use std::sync::Arc;

/// Shown behind the help.
const EXAMPLES: &str = concat!(
    "Examples:",
    "\n  brdfbake report textures",
    "\n  brdfbake report textures --against others --out page",
);

/// Arguments of `report`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// A folder that `bake` wrote.
    folder: PathBuf,
    /// Compare with the tables of the same names in another folder.
    #[arg(long, value_name = "DIR")]
    against: Option<PathBuf>,
    /// Integrand evaluations that a table may take when its texels are integrated anew to see what they are off by; 0 for none.
    #[arg(long, value_name = "N", default_value_t = EVALUATIONS)]
    evaluations: u64,
    /// Also draw error against time, of this machine: a section of its own, that differs from run to run.
    #[arg(long)]
    timings: bool,
    /// Where the pages go; the folder itself if none.
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Print nothing but errors.
    #[arg(short, long)]
    quiet: bool,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] where a folder has no manifest of tables, or a page cannot be written.
pub fn run(args: &Args, cancel: &Arc<Cancel>) -> Result<Exit, Failure> {
    let name = |p: &PathBuf| {
        p.file_name().map_or_else(|| "the other folder".to_owned(), |n| n.to_string_lossy().into_owned())
    };
    let other = args.against.as_ref().map(name);
    if args.timings && args.evaluations == 0 {
        return Err(Failure::usage("--timings: nothing is timed with --evaluations 0"));
    }
    let asked = Asked {
        against: args.against.as_deref().zip(other.as_deref()),
        evaluations: args.evaluations,
        timings: args.timings,
    };
    let made = pool(None)?.install(|| pages::of_folder(&args.folder, &asked, cancel)).map_err(failure)?;
    let out = args.out.as_ref().unwrap_or(&args.folder);
    std::fs::create_dir_all(out).map_err(|e| Failure::io(out.display(), &e))?;
    let files: Vec<_> = made.into_iter().map(|(name, bytes)| (out.join(name), bytes)).collect();
    atomic::write_all(&files, cancel)?;
    if !args.quiet {
        output::talk(&out.join(page::NAME).display().to_string());
    }
    Ok(Exit::Done)
}

fn failure(error: ReportError) -> Failure {
    match &error {
        ReportError::Cancelled(stopped) => Failure::from(*stopped),
        ReportError::Io { source, .. } if source.kind() == ErrorKind::NotFound => Failure::input(error),
        ReportError::Io { .. } => Failure::new(Exit::Io, error),
        _ => Failure::input(error),
    }
}
