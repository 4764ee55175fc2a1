//! `brdfbake verify DIR`: does a folder hold what its manifest says?

use super::{Exit, Failure, output};
use crate::pipeline::audit::{self, Activity, Audit, AuditError, Origin, State, Verdict};
use std::path::PathBuf;

/// Arguments of `verify`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Output folder of a bake, with its manifest.json.
    folder: PathBuf,
    /// Files that the manifest does not name fail, too.
    #[arg(long)]
    strict: bool,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
    /// Print nothing; the exit code tells.
    #[arg(short, long, conflicts_with = "json")]
    quiet: bool,
}

/// Runs it: exit code 0 if every file has the bytes that its manifest lists, 4 if not.
///
/// # Errors
/// [`Failure`] for a folder without manifest, or one that cannot be read.
pub fn run(args: &Args) -> Result<Exit, Failure> {
    let audit = audit::audit(&args.folder).map_err(failure)?;
    let verdict = audit.verdict();
    if args.json {
        let mut json = serde_json::to_value(&audit).map_err(|e| Failure::new(Exit::Internal, e))?;
        json["verdict"] = serde_json::to_value(verdict).map_err(|e| Failure::new(Exit::Internal, e))?;
        output::data(&json.to_string())?;
    } else if !args.quiet {
        output::data(&text(&args.folder.display().to_string(), &audit))?;
    }
    let foreign = args.strict && !audit.foreign.is_empty();
    Ok(if verdict != Verdict::Whole || foreign { Exit::Failed } else { Exit::Done })
}

fn text(folder: &str, audit: &Audit) -> String {
    let mut lines = Vec::new();
    for checked in &audit.files {
        let name = &checked.file;
        match &checked.state {
            State::Whole => {}
            State::Missing => lines.push(format!("{name}: missing")),
            State::Changed { origin: Some(origin), .. } => {
                lines.push(format!("{name}: of another bake, {}", from(origin)));
            }
            State::Changed { bytes: [got, told], blake3: [hash, listed], origin: None } => {
                lines.push(format!(
                    "{name}: {got} bytes with hash {}, the manifest lists {told} with {}",
                    short(hash),
                    short(listed)
                ));
            }
        }
    }
    for foreign in &audit.foreign {
        let from = foreign.origin.as_ref().map_or_else(String::new, |o| format!(": {}", from(o)));
        lines.push(format!("{}: not in the manifest{from}", foreign.file));
    }
    match audit.activity {
        Activity::Idle => {}
        Activity::Running => lines.push("a bake is at work in the folder".to_owned()),
        Activity::Killed => {
            lines.push(
                "a bake was killed in the folder; the next one finishes or removes what it left".to_owned(),
            );
        }
    }
    let all = audit.files.len();
    let whole = audit.files.iter().filter(|f| f.state == State::Whole).count();
    let verdict = match audit.verdict() {
        Verdict::Whole => format!("all {all} files are those of its manifest"),
        Verdict::Mixture => format!("a mixture of bakes: {whole} of {all} files are those of its manifest"),
        Verdict::Damaged => format!("{whole} of {all} files are those of its manifest"),
    };
    lines.push(format!("{folder}: {verdict} (recipe {}, {})", audit.recipe, short(&audit.hash)));
    lines.join("\n")
}

fn from(origin: &Origin) -> String {
    let Origin { recipe, table, hash, tool } = origin;
    format!("table {table} of recipe {recipe}, {}, by {tool}", short(hash))
}

/// The beginning of a hash.
fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

fn failure(error: AuditError) -> Failure {
    let exit = match error {
        AuditError::NoManifest { .. } => Exit::Failed,
        AuditError::Manifest { .. } => Exit::Input,
        _ => Exit::Io,
    };
    Failure::new(exit, error)
}
