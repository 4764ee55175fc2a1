//! `brdfbake stress [MODEL | FUNCTION | TABLE | TERM]...`: what holds at the ends of what is declared.

use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::report::stress;
use crate::verify::stress::{Stress, Subject, stress as walk};

/// Shown behind the help.
const EXAMPLES: &str = "Examples:\n  brdfbake stress lambert schlick:f32";

/// Arguments of `stress`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Ids of models, functions, tables, and terms of 32 bits; all if none is given.
    subjects: Vec<String>,
    /// Print one JSON object a line.
    #[arg(long, conflicts_with = "markdown")]
    json: bool,
    /// Print tables of Markdown, as in the topic `stability`.
    #[arg(long)]
    markdown: bool,
}

/// Runs it: exit code 4 where something does not hold inside a declared domain.
///
/// # Errors
/// [`Failure`] for an unknown subject, or where something does not hold.
pub fn run(args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    let named = args.subjects.iter().map(|id| Subject::find(id));
    let mut subjects: Vec<Subject> =
        named.collect::<Result<_, _>>().map_err(|e| Failure::new(Exit::Usage, e))?;
    if subjects.is_empty() {
        subjects.extend(Subject::all());
    }
    let found = walk(&subjects, cancel)?;
    let text = match (args.json, args.markdown) {
        (true, _) => {
            let line = |s: &Stress| serde_json::to_string(s).map_err(|e| Failure::new(Exit::Internal, e));
            found.iter().map(line).collect::<Result<Vec<_>, _>>()?.join("\n")
        }
        (_, true) => stress::markdown(&found),
        _ => stress::text(&found),
    };
    output::data(&text)?;
    let broken: Vec<&str> = found.iter().filter(|s| !s.holds()).map(|s| s.id).collect();
    if broken.is_empty() {
        return Ok(Exit::Done);
    }
    Err(Failure::new(Exit::Failed, format!("declared domains do not hold: {}", broken.join(", "))))
}
