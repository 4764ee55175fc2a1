//! The command: one file a verb, each with its arguments and `run`. Printing happens here and nowhere else.

pub mod albedo;
pub mod bake;
mod build_step;
pub mod cache;
pub mod check;
pub mod completions;
pub mod converge;
pub mod convert;
pub mod describe;
pub mod diff;
mod engine;
pub mod eval;
pub mod exit;
pub mod fit;
pub mod golden;
pub mod guide;
pub mod inspect;
mod interrupt;
pub mod laws;
pub mod limits;
pub mod list;
pub mod man;
pub mod map;
mod map_facets;
mod map_options;
mod map_sbrdf;
pub mod output;
pub mod plan;
mod planned;
pub mod plot;
pub mod preview;
pub mod progress;
pub mod report;
pub mod reuse;
pub mod scene;
mod scene_write;
pub mod schema;
pub mod stress;
mod suggest;
pub mod terminal;
mod texel;
pub mod verify;

use crate::cancel::Cancel;
use crate::pipeline::pool;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
pub use exit::{Exit, Failure};
use std::io::Write;
use std::sync::Arc;
use terminal::Asked;

/// Bakes BRDF lookup textures to a tolerance, and verifies them as it bakes.
#[derive(Debug, Parser)]
#[command(name = "brdfbake", version, about, after_help = exit::TABLE, max_term_width = 110)]
pub struct Cli {
    #[command(subcommand)]
    verb: Verb,
    /// Colour messages on stderr; `auto` heeds NO_COLOR.
    #[arg(long, value_enum, default_value = "auto", global = true, value_name = "WHEN")]
    color: terminal::Color,
}

#[derive(Debug, Subcommand)]
enum Verb {
    /// Bake the tables of a recipe, a preset, an engine or a glTF scene.
    Bake(Box<bake::Args>),
    /// Tell what glTF scenes need: each table, who asks for it, its axes, bytes and seconds, and what was left out and why.
    Plan(plan::Args),
    /// Judge the materials of glTF scenes, texel by texel: energy, metalness, base colours, roughness.
    Check(check::Args),
    /// Print what a baked file (or any picture of a format that is read) holds.
    Inspect(inspect::Args),
    /// Compare two images or two output folders.
    Diff(diff::Args),
    /// Filter normal and roughness maps: levels of lobes fitted to what they stand for, with their errors.
    Map(Box<map::Args>),
    /// Convert specular-glossiness materials of a glTF scene to metallic-roughness, with the error of each.
    Convert(convert::Args),
    /// Shade spheres by integration and by baked tables, beside each other: a row over roughness, or the materials of a glTF file.
    Preview(preview::Args),
    /// Write a page of an output folder: pictures of its tables and their errors, curves, spheres, laws, worst texels.
    Report(report::Args),
    /// Re-check baked files from what they say of themselves, and folders against their manifest.
    Verify(verify::Args),
    /// Tell what the cache of baked tables and maps holds, or clear it.
    Cache(cache::Args),
    /// Compare a fresh bake with committed outputs, or commit them.
    Golden(golden::Args),
    /// Evaluate models and functions at directions read as CSV; append the value.
    Eval(eval::Args),
    /// Print the directional albedo of a model with its error estimate.
    Albedo(albedo::Args),
    /// Check reciprocity and energy of models over their domain.
    Laws(laws::Args),
    /// Walk the ends of declared domains: what is not finite, gains energy, loses digits, or is not as its estimate says.
    Stress(stress::Args),
    /// Measure error against evaluations, time and bytes, for this baker and for the samplers of others; with charts.
    Converge(converge::Args),
    /// Draw the lobe of a model as a polar plot.
    Plot(plot::Args),
    /// Fit a formula to the split sum of a model, or to any table, as shader code.
    Fit(fit::Args),
    /// List models, functions, tables, presets, engines, formats, laws or quantities.
    List(list::Args),
    /// Describe a model, function, table, preset, engine, law or quantity.
    Describe(describe::Args),
    /// Print a page of the guide: recipes, axes, formats, one engine, and more.
    Guide(guide::Args),
    /// Print the JSON schema of recipes, for editors and for programs that write recipes.
    Schema(schema::Args),
    /// Print what makes a shell complete verbs, options and their values.
    Completions(completions::Args),
    /// Print a manual page, or write all of them.
    Man(man::Args),
}

/// Runs a parsed command. `cancel` is set when the user interrupts.
///
/// # Errors
/// [`Failure`] carries the message and the exit code.
pub fn run(cli: Cli, cancel: &Arc<Cancel>) -> Result<Exit, Failure> {
    match cli.verb {
        Verb::Bake(args) => bake::run(&args, cancel),
        Verb::Plan(args) => plan::run(&args),
        Verb::Check(args) => check::run(&args, cancel),
        Verb::Inspect(args) => inspect::run(&args, cancel),
        Verb::Diff(args) => diff::run(&args, cancel),
        Verb::Map(args) => map::run(&args, cancel),
        Verb::Convert(args) => convert::run(&args, cancel),
        Verb::Preview(args) => preview::run(&args, cancel),
        Verb::Report(args) => report::run(&args, cancel),
        Verb::Verify(args) => pool(None)?.install(|| verify::run(&args, cancel)),
        Verb::Cache(args) => cache::run(&args),
        Verb::Golden(args) => golden::run(&args, cancel),
        Verb::Eval(args) => eval::run(&args, cancel),
        Verb::Albedo(args) => albedo::run(&args, cancel),
        Verb::Laws(args) => pool(None)?.install(|| laws::run(&args, cancel)),
        Verb::Stress(args) => pool(None)?.install(|| stress::run(&args, cancel)),
        Verb::Converge(args) => pool(None)?.install(|| converge::run(&args, cancel)),
        Verb::Plot(args) => plot::run(&args, cancel),
        Verb::Fit(args) => pool(None)?.install(|| fit::run(&args, cancel)),
        Verb::List(args) => list::run(&args),
        Verb::Describe(args) => describe::run(&args),
        Verb::Guide(args) => guide::run(&args),
        Verb::Schema(args) => schema::run(&args),
        Verb::Completions(args) => completions::run(&args),
        Verb::Man(args) => man::run(&args, cancel),
    }
}

/// The program: parse, run, print the failure, return the exit code.
#[must_use]
pub fn main() -> std::process::ExitCode {
    let cancel = Arc::new(Cancel::new());
    interrupt::install(&cancel);
    let asked = Asked::of(std::env::args_os().skip(1));
    terminal::set(asked.color);
    let parsed = Cli::command().color(asked.color.into()).try_get_matches();
    let done = match parsed.and_then(|matches| Cli::from_arg_matches(&matches)) {
        Ok(cli) => run(cli, &cancel),
        Err(e) => answer(&e, asked.json),
    };
    let exit = done.unwrap_or_else(|failure| {
        if asked.json {
            output::error_objects(&failure);
        }
        output::error(&failure);
        failure.exit
    });
    exit.into()
}

/// Prints help, the version, or what is wrong with the arguments; clap knows where, and whether colours are wanted.
fn answer(error: &clap::Error, json: bool) -> Result<Exit, Failure> {
    if json && error.use_stderr() {
        let text = error.render().to_string();
        let message = text.strip_prefix("error: ").unwrap_or(&text).trim_end();
        output::error_objects(&Failure::usage(message));
    }
    let printed = error.print().and_then(|()| output::stdout().flush());
    if error.use_stderr() {
        return Ok(Exit::Usage);
    }
    output::judge(printed).map(|_| Exit::Done)
}
