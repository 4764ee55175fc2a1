//! `brdfbake plan SCENE...`: what would be baked, for whom, at what cost, and what not.

use super::{Exit, Failure, engine, output, planned, scene};
use serde_json::json;
use std::path::PathBuf;

/// Shown behind the help.
const EXAMPLES: &str =
    concat!("Examples:", "\n  brdfbake plan scene.glb", "\n  brdfbake plan scene.glb --engine three --json",);

/// Arguments of `plan`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// glTF scenes: .gltf or .glb files, folders with all such files below them, or patterns.
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    look: scene::Look,
    /// The tables of this engine that the scenes need, over what its shaders make of their roughness.
    #[arg(long, value_name = "ENGINE")]
    engine: Option<String>,
    /// Number of threads; all cores if not given.
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// End with 4 where something is needed and not baked, cut, or not known.
    #[arg(long)]
    strict: bool,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] for a scene that is refused, or an engine that is not known.
pub fn run(args: &Args) -> Result<Exit, Failure> {
    let engine = args.engine.as_deref().map(engine::plan).transpose()?;
    let job = scene::job(&scene::files(&args.scenes)?, &args.look, engine, args.jobs.map(usize::from))?;
    if args.json {
        let mut all = planned::json(scene::json(&job), &job.plan, false);
        all["dropped"] = json!(job.dropped);
        output::data(&all.to_string())?;
    } else {
        scene::tell(&job);
        output::data(&planned::text(&job.plan, false))?;
    }
    Ok(if args.strict && job.in_doubt() { Exit::Failed } else { Exit::Done })
}
