//! `brdfbake convert`: specular-glossiness materials of a scene as metallic-roughness, and what that costs.

use super::limits::Limits;
use super::scene_write::{self, Mode};
use super::{Exit, Failure, output};
use crate::cancel::Cancel;
use crate::encode::atomic;
use crate::pipeline::write_scene::{self, Request, convert};
use crate::scene;
use std::path::PathBuf;

/// Shown behind the help.
const EXAMPLES: &str = concat!(
    "Examples:",
    "\n  brdfbake convert spec-gloss.gltf",
    "\n  brdfbake convert spec-gloss.gltf --write converted.gltf",
);

/// Arguments of `convert`.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// Scene with specular-glossiness materials (.gltf, .glb).
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// How they are converted.
    #[arg(long, value_enum, default_value = "exact")]
    mode: Mode,
    /// Write the converted scene: a .gltf or .glb file, or a folder. Without it errors are told and nothing is written.
    #[arg(long, value_name = "PATH")]
    write: Option<PathBuf>,
    /// Write the error of F0 of each texel into this folder, as EXR.
    #[arg(long, value_name = "DIR")]
    errors: Option<PathBuf>,
    #[command(flatten)]
    limits: Limits,
    /// Print nothing but errors.
    #[arg(short, long, conflicts_with = "json")]
    quiet: bool,
    /// Print what became of each material as JSON on stdout.
    #[arg(long)]
    json: bool,
}

/// Runs it.
///
/// # Errors
/// [`Failure`] with the exit code of the cause; what was there is then as it was.
pub fn run(args: &Args, cancel: &Cancel) -> Result<Exit, Failure> {
    let mode = convert::Mode::from(args.mode);
    let talks = !args.quiet && !args.json;
    let converted = match &args.write {
        None => {
            let all = write_scene::measure(&args.scene, mode, scene::Limits::default())?;
            if talks {
                scene_write::tell_converted(&all);
            }
            all
        }
        Some(to) => {
            let request = Request { convert: Some(mode), keep_tables: true, ..Request::new(&args.scene, to) };
            let done = write_scene::write(&request, None, &args.limits.settings(to), cancel)?;
            if talks {
                scene_write::tell(&done);
            }
            done.converted
        }
    };
    if talks && converted.is_empty() {
        output::talk(&format!("no material has {}", convert::NAME));
    }
    if let Some(folder) = &args.errors {
        let maps =
            convert::error_maps(&converted, cancel).map_err(|e| Failure::new(Exit::of_encode(&e), e))?;
        let files: Vec<_> = maps.into_iter().map(|(name, bytes)| (folder.join(name), bytes)).collect();
        atomic::write_all(&files, cancel)?;
    }
    if args.json {
        let text = serde_json::to_string_pretty(&converted);
        output::data(&text.map_err(|e| Failure::new(Exit::Internal, e))?)?;
    }
    Ok(Exit::Done)
}
