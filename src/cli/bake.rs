//! `brdfbake bake`.

use super::build_step::BuildStep;
use super::limits::Limits;
use super::progress::{self, Format};
use super::reuse::Reuse;
use super::{Exit, Failure, engine, output, planned, scene, scene_write, suggest};
use crate::cancel::Cancel;
use crate::pipeline::pages::Collector;
use crate::pipeline::suggest::Ranges;
use crate::pipeline::write_scene::Bake;
use crate::pipeline::{self, Companion, PipelineError, Settings};
use crate::plan::Plan;
use crate::recipe::{self, LoadError};
use std::path::PathBuf;
use std::sync::Arc;

/// Shown behind the help.
const EXAMPLES: &str = concat!(
    "Examples:",
    "\n  brdfbake bake mine.toml -o textures",
    "\n  brdfbake bake mine.toml -o textures --check",
    "\n  brdfbake bake split-sum --dry-run",
    "\n  brdfbake bake --engine three --dry-run",
    "\n  brdfbake bake --scene scene.glb --dry-run",
);

/// Arguments of `bake`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Recipe file (TOML), or the name of a preset; the preset `default` if nothing else is given.
    recipe: Option<String>,
    /// Bake only what the materials of these glTF files (.gltf, .glb, folders, patterns) ask for.
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with = "recipe")]
    scene: Vec<PathBuf>,
    #[command(flatten)]
    look: scene::Look,
    /// Bake the tables that this engine loads, in its own files (`list engines`); with `--scene` only those that it needs.
    #[arg(long, value_name = "ENGINE", conflicts_with = "recipe")]
    engine: Option<String>,
    /// Bake nothing: print the smallest table that the engine's shader could read to within this error, its recipe, and
    /// the lines that read it. 1e-3 if no error is given. With `--scene` over the roughness that the scenes hold.
    #[arg(long, value_name = "ERROR", requires = "engine", conflicts_with_all = SUGGESTS_NOT, num_args = 0..=1, default_missing_value = "1e-3")]
    suggest: Option<f64>,
    /// Where the suggestion must hold: everywhere, or where mu >= 0.05 and roughness >= 0.09.
    #[arg(long, value_enum, default_value = "whole", requires = "suggest", conflicts_with_all = SUGGESTS_NOT)]
    domain: suggest::Domain,
    /// Output folder.
    #[arg(short, long, value_name = "DIR", default_value = "brdfbake-out")]
    out: PathBuf,
    #[command(flatten)]
    write: scene_write::SceneWrite,
    /// Also write `report.html` into the output folder: each table with the errors of its texels, as a page.
    #[arg(long)]
    report: bool,
    /// Tell in the report how long each table took.
    #[arg(long, requires = "report", conflicts_with_all = ["suggest", "check", "dry_run"])]
    timings: bool,
    #[command(flatten)]
    step: BuildStep,
    #[command(flatten)]
    limits: Limits,
    #[command(flatten)]
    reuse: Reuse,
    /// Print nothing but errors.
    #[arg(short, long, conflicts_with = "message_format")]
    quiet: bool,
    /// Text on stderr, or one JSON object a line on stdout.
    #[arg(long, value_enum, default_value = "human")]
    message_format: Format,
    /// Write nothing, and end with 4, where a law could not be checked, a texel misses its tolerance, or something that a scene
    /// needs is not baked or not known.
    #[arg(long)]
    strict: bool,
    /// Bake nothing: print what would be baked, at what cost, as `plan` does.
    #[arg(long, conflicts_with_all = ["lock_timeout", "force", "no_cache", "cache_dir", "cache_size"])]
    dry_run: bool,
}

/// What a suggestion does nothing with; `requires` is silent where what is required is refused.
const SUGGESTS_NOT: [&str; 18] = [
    "recipe",
    "maps",
    "out",
    "write",
    "report",
    "quiet",
    "strict",
    "dry_run",
    "lock_timeout",
    "memory",
    "check",
    "stamp",
    "depfile",
    "yes_large",
    "force",
    "no_cache",
    "cache_dir",
    "cache_size",
];

/// What `--strict` says of scenes.
const DOUBT: &str = "something that the scene needs is not baked, is cut, or is not known; nothing was written, since `strict` is set";

impl Args {
    fn settings(&self) -> Settings {
        self.reuse.settings(Settings { strict: self.strict, ..self.limits.settings(&self.out) })
    }

    /// Is there talk on stderr?
    fn talks(&self) -> bool {
        !self.quiet && self.message_format == Format::Human
    }
}

/// Runs it.
///
/// # Errors
/// [`Failure`] with the exit code of the cause; the output folder is then as it was.
pub fn run(args: &Args, cancel: &Arc<Cancel>) -> Result<Exit, Failure> {
    if let Some(option) = args.look.given().filter(|_| args.scene.is_empty()) {
        return Err(Failure::usage(format!(
            "{option} says how scenes are read, but no scene is given; name one with --scene"
        )));
    }
    let scenes = scene::files(&args.scene)?;
    let mut written = scene_write::check(&args.write, &args.look, &scenes)?;
    let engine = args.engine.as_deref().map(engine::plan).transpose()?;
    let format = args.message_format;
    let suggested = args.suggest.map(|error| suggest::Asked { error, domain: args.domain, format });
    if let (Some((engine, plan)), Some(asked), true) = (&engine, suggested, scenes.is_empty()) {
        return suggest::run(engine, plan, asked, &Ranges::new(), args.limits.jobs(), cancel);
    }
    let mut told = serde_json::json!({ "reason": "dry-run" });
    let (engine, plan) = if args.scene.is_empty() {
        match engine {
            Some((engine, plan)) => (Some(engine), plan),
            None => (None, plan(args.recipe.as_deref().unwrap_or("default"))?),
        }
    } else {
        let entry = engine.as_ref().map(|(engine, _)| *engine);
        let job = scene::job(&scenes, &args.look, engine, args.limits.jobs())?;
        match args.message_format {
            // a dry run tells all at once
            Format::Json if args.dry_run => told = scene::json(&job),
            Format::Json => output::data(&scene::json(&job).to_string()).map(|_| ())?,
            Format::Human if args.quiet => {}
            Format::Human => scene::tell(&job),
        }
        if let (Some(engine), Some(asked)) = (entry, suggested) {
            return suggest::run(engine, &job.plan, asked, &job.ranges(), args.limits.jobs(), cancel);
        }
        scene_write::serve(&mut written, &job, entry.is_some());
        if args.strict && job.in_doubt() {
            return Err(Failure::new(Exit::Failed, DOUBT));
        }
        (entry, job.plan)
    };
    let settings = args.settings();
    let asked = [args.limits.jobs().is_some(), !args.scene.is_empty()];
    if let Some(exit) = args.step.check(&plan, &args.out, args.message_format, args.quiet, asked)? {
        return Ok(exit);
    }
    if args.dry_run {
        pipeline::check(&plan, &settings)?;
        match args.message_format {
            Format::Human if args.quiet => {}
            Format::Human => output::data(&planned::text(&plan, args.report)).map(|_| ())?,
            Format::Json => output::data(&planned::json(told, &plan, args.report).to_string()).map(|_| ())?,
        }
        return Ok(Exit::Done);
    }
    let reporter = progress::reporter(args.message_format, args.quiet, cancel);
    let mut collector = args.report.then(|| Collector::new(args.timings));
    let companion = collector.as_mut().map(|c| c as &mut dyn Companion);
    let done = pipeline::run_with(&plan, &settings, cancel, reporter.progress(), companion);
    reporter.finish()?;
    match done {
        Ok(outcome) => {
            if let Some(engine) = engine.filter(|_| args.talks()) {
                engine::report(engine, &outcome);
            }
            let any = !outcome.manifest.tables.is_empty() || !outcome.manifest.maps.is_empty();
            let bake = any.then_some(Bake { manifest: &outcome.manifest, folder: &args.out });
            scene_write::run(&written, bake, &settings, cancel, args.talks())?;
            args.step.done(&plan, args.recipe.as_deref(), &args.out)?;
            Ok(Exit::Done)
        }
        Err(error) => {
            // what is in doubt was reported as it was found
            if let (PipelineError::Laws(findings), Format::Json) = (&error, args.message_format) {
                for finding in findings {
                    report_finding(finding)?;
                }
            }
            Err(error.into())
        }
    }
}

fn report_finding(finding: &crate::verify::Finding) -> Result<(), Failure> {
    let fields = serde_json::to_value(finding).map_err(|e| Failure::new(Exit::Internal, e))?;
    let mut line = serde_json::Map::new();
    line.insert("reason".to_owned(), "finding".into());
    line.extend(fields.as_object().cloned().unwrap_or_default());
    output::data(&serde_json::Value::Object(line).to_string()).map(|_| ())
}

/// The plan of a recipe file or of a preset.
pub(super) fn plan(name: &str) -> Result<Plan, Failure> {
    let looks_like_a_file = name.contains(['/', '\\', '.']);
    if !looks_like_a_file {
        if let Some(preset) = recipe::PRESETS.iter().find(|p| p.id == name) {
            return Ok(recipe::parse(preset.source, &format!("presets/{name}.toml"))?);
        }
        let ids: Vec<&str> = recipe::PRESETS.iter().map(|p| p.id).collect();
        let offer = crate::math::nearest::offer(name, ids);
        return Err(Failure::input(format!(
            "no preset `{name}`{offer}\nA recipe file is given by its path, such as ./{name}.toml"
        )));
    }
    recipe::load(std::path::Path::new(name)).map_err(|error| match error {
        LoadError::Recipe(e) => e.into(),
        other => Failure::new(Exit::Io, other).at("file", name),
    })
}
