//! `brdfbake laws [MODEL]`: reciprocity and energy of models over their domain.

use super::{Exit, Failure, albedo, output};
use crate::cancel::{Cancel, Cancelled};
use crate::models::{self, MODELS, ModelInfo};
use crate::verify::survey::{Survey, Verdict, survey_until};
use rayon::prelude::*;

/// Shown behind the help.
const EXAMPLES: &str = "Examples:\n  brdfbake laws lambert ggx";

/// Arguments of `laws`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Model ids; all models if none is given.
    models: Vec<String>,
    /// Print one JSON object a line.
    #[arg(long)]
    json: bool,
}

/// Runs it: exit code 4 if a model breaks a law that it claims.
///
/// # Errors
/// [`Failure`] for an unknown model, or a defect.
pub fn run(args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    let mut chosen: Vec<&'static ModelInfo> = Vec::new();
    for name in &args.models {
        chosen.push(models::find(name).ok_or_else(|| albedo::unknown_model(name))?.0);
    }
    if chosen.is_empty() {
        chosen.extend(MODELS);
    }
    let surveys: Result<Vec<Survey>, Cancelled> =
        chosen.par_iter().map(|m| survey_until(cancel, m)).collect();
    let surveys = surveys?;
    if args.json {
        let lines: Vec<String> =
            surveys.iter().map(|s| serde_json::to_string(s).unwrap_or_default()).collect();
        output::data(&lines.join("\n"))?;
    } else {
        output::data(&table(&surveys))?;
    }
    let defects: Vec<&str> =
        surveys.iter().filter(|s| s.verdict == Verdict::Defect).map(|s| s.model).collect();
    if defects.is_empty() {
        return Ok(Exit::Done);
    }
    Err(Failure::new(Exit::Failed, format!("laws that are claimed do not hold: {}", defects.join(", "))))
}

fn table(surveys: &[Survey]) -> String {
    let mut rows = vec![["model", "reciprocity", "largest E", "at", "verdict"].map(str::to_owned)];
    for s in surveys {
        rows.push([
            s.model.to_owned(),
            format!("{:.1e}", s.reciprocity.value),
            format!("{:.4}", s.largest_e.value),
            s.largest_e.at.clone(),
            s.words.clone(),
        ]);
    }
    let width = |c: usize| rows.iter().map(|r| r[c].chars().count()).max().unwrap_or(0);
    let widths = [width(0), width(1), width(2), width(3)];
    rows.iter()
        .map(|r| {
            let cells: Vec<String> = r.iter().zip(widths).map(|(cell, w)| format!("{cell:w$}")).collect();
            format!("{}  {}", cells.join("  "), r[4])
        })
        .collect::<Vec<_>>()
        .join("\n")
}
