//! `brdfbake golden check|bless DIR`: golden-image tests of a recipe.

use super::interrupt::Scratch;
use super::limits::Limits;
use super::{Exit, Failure, bake, output};
use crate::cancel::Cancel;
use crate::encode::atomic;
use crate::encode::diff_files::{FileDiff, FolderDiff, PathDiff};
use crate::encode::read;
use crate::pipeline::golden::{Golden, GoldenError};
use crate::pipeline::{self, Silent};
use crate::plan::Plan;
use crate::report;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Shown behind the help.
const EXAMPLES: &str =
    concat!("Examples:", "\n  brdfbake golden check golden", "\n  brdfbake golden bless golden",);

/// Arguments of `golden`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Compare a fresh bake with the folder, or write it there.
    #[arg(value_enum)]
    what: What,
    /// Folder with `recipe.toml` (or a `golden.toml` that names a recipe and tolerances) and the committed outputs.
    folder: PathBuf,
    /// Write pictures of the differences into this folder.
    #[arg(long, value_name = "DIR")]
    draw: Option<PathBuf>,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    limits: Limits,
}

/// What to do with a golden folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum What {
    /// Exit code 0 if the outputs are equal within the tolerances, 4 if not.
    Check,
    /// Write fresh outputs into the folder.
    Bless,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] for a folder that cannot be read, or a bake that fails; the committed outputs are then as they were.
pub fn run(args: &Args, cancel: &Arc<Cancel>) -> Result<Exit, Failure> {
    if args.what == What::Bless && (args.draw.is_some() || args.json) {
        let option = if args.json { "--json" } else { "--draw" };
        return Err(Failure::usage(format!("{option} tells of a comparison, and `bless` compares nothing")));
    }
    let golden = Golden::load(&args.folder).map_err(failure)?;
    let plan = plan(&golden, &args.folder)?;
    let bake =
        |out: &Path| pipeline::run(&plan, &args.limits.settings(out), cancel, &Silent).map_err(Failure::from);
    if args.what == What::Bless {
        let done = bake(&args.folder)?;
        output::talk(&format!(
            "{}: {} files written, {} unchanged",
            args.folder.display(),
            done.written,
            done.unchanged
        ));
        return Ok(Exit::Done);
    }
    let fresh = Scratch::new(cancel).map_err(|e| Failure::io("temporary folder", &e))?;
    bake(fresh.path())?;
    let diff = golden.compare(&args.folder, fresh.path()).map_err(failure)?;
    if let Some(target) = &args.draw {
        draw(&diff, &args.folder, fresh.path(), target, cancel)?;
    }
    let equal = diff.equal();
    let diff = PathDiff::Folder(diff);
    let text = if args.json {
        serde_json::to_string(&diff).unwrap_or_default()
    } else {
        report::diff(&args.folder.display().to_string(), "a fresh bake", &diff)
    };
    output::data(&text)?;
    Ok(if equal { Exit::Done } else { Exit::Failed })
}

fn plan(golden: &Golden, folder: &Path) -> Result<Plan, Failure> {
    if golden.recipe.contains('.') {
        return bake::plan(&folder.join(&golden.recipe).display().to_string());
    }
    bake::plan(&golden.recipe)
}

/// Pictures of the files that differ: `NAME.diff.png`.
fn draw(
    diff: &FolderDiff,
    committed: &Path,
    fresh: &Path,
    target: &Path,
    cancel: &Arc<Cancel>,
) -> Result<(), Failure> {
    let mut files = Vec::new();
    for (name, _) in diff.files.iter().filter(|(_, d)| matches!(d, FileDiff::Image(_))) {
        let (a, b) = (read::read_file(&committed.join(name)), read::read_file(&fresh.join(name)));
        if let (Ok(a), Ok(b)) = (a, b)
            && let Some(png) =
                report::difference::draw(&a, &b).map_err(|e| Failure::new(Exit::Internal, e))?
        {
            files.push((target.join(format!("{name}.diff.png")), png));
        }
    }
    if !files.is_empty() {
        std::fs::create_dir_all(target).map_err(|e| Failure::io(target.display(), &e))?;
        atomic::write_all(&files, cancel)?;
    }
    for (path, _) in &files {
        output::talk(&format!("{}", path.display()));
    }
    Ok(())
}

fn failure(error: GoldenError) -> Failure {
    match error {
        GoldenError::Io { .. } => Failure::new(Exit::Io, error),
        _ => Failure::input(error),
    }
}
