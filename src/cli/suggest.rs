//! `bake --engine NAME [--scene FILE] --suggest`: prints what `pipeline::suggest` finds.

use super::progress::Format;
use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::math::figures::exact;
use crate::pipeline;
use crate::pipeline::suggest::{self, Ranges, Size, Suggestion, Want};
use crate::plan::Plan;
use crate::recipe::Engine;

/// Where an error must hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Domain {
    /// Everywhere.
    Whole,
    /// Where mu >= 0.05 and roughness >= 0.09.
    Practical,
}

/// Longest axis of a suggested table.
const LONGEST: usize = 256;

/// Errors that can be asked for.
const ERRORS: std::ops::RangeInclusive<f64> = 1e-7..=0.5;

/// What is asked for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Asked {
    pub(super) error: f64,
    pub(super) domain: Domain,
    pub(super) format: Format,
}

/// Runs it, over the roughness that tables are read at: exit code 4 if an error is out of reach for some table.
///
/// # Errors
/// [`Failure`] for an error out of range, an interrupted run, or a table that cannot be baked.
pub(super) fn run(
    engine: &Engine,
    plan: &Plan,
    asked: Asked,
    ranges: &Ranges,
    jobs: Option<usize>,
    cancel: &Cancel,
) -> Result<Exit, Failure> {
    let Asked { error, domain, format } = asked;
    if !ERRORS.contains(&error) {
        return Err(Failure::usage(format!(
            "--suggest {} outside {} to {}",
            exact(error),
            exact(ERRORS.start()),
            exact(ERRORS.end())
        )));
    }
    let want = Want { error, practical: domain == Domain::Practical, longest: LONGEST };
    let pool = pipeline::pool(jobs)?;
    let all = pool.install(|| suggest::suggest_within(engine, plan, want, ranges, cancel))?;
    for suggestion in &all {
        output::data(&match format {
            Format::Json => json(suggestion),
            Format::Human => page(engine, suggestion),
        })?;
    }
    // what was not searched is no failure
    let failed = all.iter().any(|s| s.own.is_some() && s.found.is_none());
    Ok(if failed { Exit::Failed } else { Exit::Done })
}

fn json(suggestion: &Suggestion) -> String {
    let mut line = serde_json::Map::new();
    line.insert("reason".to_owned(), "suggestion".into());
    if let Ok(serde_json::Value::Object(fields)) = serde_json::to_value(suggestion) {
        line.extend(fields);
    }
    serde_json::Value::Object(line).to_string()
}

fn page(engine: &Engine, suggestion: &Suggestion) -> String {
    let mut text = format!("{}: {}\n", engine.title, suggestion.table);
    if let Some(own) = &suggestion.own {
        text.push_str(&format!("  the engine's: {}\n", size(own)));
    }
    if let Some(found) = &suggestion.found {
        text.push_str(&format!("  suggested:    {}\n", size(&found.size)));
    }
    for note in &suggestion.notes {
        text.push_str(&format!("  {note}\n"));
    }
    if let Some(found) = &suggestion.found {
        text.push_str(&format!(
            "\nrecipe:\n\n{}\nshader, {}:\n\n{}",
            found.recipe,
            found.language.to_uppercase(),
            found.lines
        ));
    }
    text
}

fn size(size: &Size) -> String {
    let texels: Vec<String> = size.texels.iter().map(ToString::to_string).collect();
    let errors = |[largest, mean]: [f64; 2]| format!("{largest:.1e} at most, {mean:.1e} in the mean");
    let practical = size
        .practical
        .map_or_else(String::new, |p| format!("; where mu >= 0.05 and roughness >= 0.09, {}", errors(p)));
    format!(
        "{} {}, {} bytes of texels, off between the texels by {}{practical}",
        texels.join(" x "),
        size.output,
        size.bytes,
        errors(size.whole)
    )
}
