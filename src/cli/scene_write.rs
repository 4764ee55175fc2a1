//! `brdfbake bake --scene SCENE --write PATH`: the scene with the tables that were baked for it.

use super::scene::{Job, Look};
use super::{Exit, Failure, output};
use crate::cancel::{Cancel, Cancelled};
use crate::math::figures::{short, significant};
use crate::math::shown::show;
use crate::pipeline::Settings;
use crate::pipeline::transaction::TransactionError;
use crate::pipeline::write_scene::convert::{self, ConvertError, Converted, DiffuseRatio};
use crate::pipeline::write_scene::{self, Bake, Request, SceneOutcome, SceneWriteError, Target};
use crate::plan::PlannedTable;
use crate::plan::scene as planning;
use crate::scene::Fault;
use crate::scene::write::tables::Place;
use std::path::PathBuf;

/// With these no scene is written; `requires` is silent where what is required is refused.
const WRITES_NOT: [&str; 4] = ["recipe", "suggest", "check", "depfile"];

/// Options of a scene that is written.
#[derive(Debug, clap::Args)]
pub(super) struct SceneWrite {
    /// Write the scene with its tables: a .gltf or .glb file, or a folder. The root gets the extension BRDFBAKE_lookup_tables
    /// (provisional, used and not required); every number's text and every member that is not known stays.
    #[arg(long, value_name = "PATH", requires = "scene", conflicts_with_all = WRITES_NOT)]
    write: Option<PathBuf>,
    /// Write the same object into `extras`: beside the extension, or in place of it.
    #[arg(long, value_enum, requires = "write", conflicts_with_all = WRITES_NOT, num_args = 0..=1, default_missing_value = "also")]
    extras: Option<Extras>,
    /// Convert specular-glossiness materials of the scene that is written, which then no longer names
    /// KHR_materials_pbrSpecularGlossiness; what that costs is printed. With `--maps` the base level of each map takes the place of the
    /// core textures.
    #[arg(long, requires = "write", conflicts_with_all = WRITES_NOT)]
    replace: bool,
    /// How they are converted.
    #[arg(long, value_enum, requires = "replace", conflicts_with_all = WRITES_NOT, default_value = "exact")]
    spec_gloss: Mode,
}

/// How specular-glossiness becomes metallic-roughness.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Mode {
    /// With KHR_materials_specular and ior 0: F0, F90 and roughness stay, the diffuse part is up to 3 % less at grazing views
    Exact,
    /// By the published conversion, with the core of glTF alone: F0 is off by up to 0.077
    Solve,
}

impl From<Mode> for convert::Mode {
    fn from(mode: Mode) -> convert::Mode {
        match mode {
            Mode::Exact => convert::Mode::Exact,
            Mode::Solve => convert::Mode::Solve,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Extras {
    Also,
    Only,
}

/// The scenes that are to be written, and what would keep them from it, before anything is baked.
pub(super) fn check(args: &SceneWrite, look: &Look, scenes: &[PathBuf]) -> Result<Vec<Request>, Failure> {
    let Some(to) = &args.write else { return Ok(Vec::new()) };
    let place = match args.extras {
        None => Place::Extension,
        Some(Extras::Also) => Place::Both,
        Some(Extras::Only) => Place::Extras,
    };
    let convert = args.replace.then(|| args.spec_gloss.into());
    let mut all: Vec<(Target, Request)> = Vec::new();
    for scene in scenes {
        let root = look.pictures.root.clone();
        let rewrite = args.replace && !look.maps.is_empty();
        let request = Request { place, convert, root, rewrite, ..Request::new(scene, to) };
        let target = Target::of(&request)?;
        if all.iter().any(|(other, _)| *other == target) {
            let message =
                "two scenes would be written to one file; give a folder, and scenes of different names";
            return Err(Failure::usage(format!("--write {}: {message}", to.display())));
        }
        all.push((target, request));
    }
    Ok(all.into_iter().map(|(_, request)| request).collect())
}

/// Notes which tables serve which material; an engine's own serve the families of their kind.
pub(super) fn serve(requests: &mut [Request], job: &Job, engine: bool) {
    for (request, surveyed) in requests.iter_mut().zip(&job.survey.scenes) {
        for map in &job.maps {
            for asker in map.asked_by.iter().filter(|a| a.material.file == surveyed.file) {
                request.uses.extend(asker.material.index.map(|i| (i, map.request.name.clone())));
            }
        }
        for need in &job.survey.needs.needs {
            let names: Vec<String> = if engine {
                let serves =
                    |table: &&PlannedTable| planning::served(table).any(|family| family == need.table);
                job.plan.tables.iter().filter(serves).map(|t| t.name().to_owned()).collect()
            } else {
                let own = job.asked.iter().filter(|asked| asked.family == need.table);
                own.map(|asked| asked.request.name.clone()).collect()
            };
            for asked in need.asked_by.iter().filter(|asked| asked.material.file == surveyed.file) {
                request.serves.push((asked.material.index, names.clone()));
            }
        }
    }
}

/// Writes scenes, and tells what was written.
pub(super) fn run(
    requests: &[Request],
    bake: Option<Bake<'_>>,
    settings: &Settings,
    cancel: &Cancel,
    talks: bool,
) -> Result<(), Failure> {
    for request in requests {
        let done = write_scene::write(request, bake, settings, cancel)?;
        if talks {
            tell(&done);
        }
    }
    Ok(())
}

/// What was written, for people.
pub(super) fn tell(done: &SceneOutcome) {
    tell_converted(&done.converted);
    if !done.rewritten.is_empty() {
        let all: Vec<String> = done.rewritten.iter().map(|i| format!("#{i}")).collect();
        output::talk(&format!(
            "  core textures are the base level of their maps now, with factors of 1: material {}; readers make their own, plain, levels of them",
            all.join(", ")
        ));
    }
    for note in &done.notes {
        output::talk(&format!("  note: {note}"));
    }
    let (beside, s) = (done.files.len() - 1, if done.files.len() == 2 { "" } else { "s" });
    output::talk(&format!("wrote {}, {beside} file{s} beside it", done.scene.display()));
}

/// What became of materials, for people.
pub(super) fn tell_converted(all: &[Converted]) {
    for one in all {
        let name = one.name.as_ref().map_or_else(String::new, |n| format!(" \"{}\"", show(n)));
        let [w, h] = one.size;
        let size = if one.size == [1, 1] { "factors".to_owned() } else { format!("{w}x{h} texels") };
        let mut line = format!("converted material #{}{name}, {size}: ", one.material);
        match one.mode {
            convert::Mode::Exact => line.push_str("F0, F90 and roughness are exact"),
            convert::Mode::Solve => {
                let [x, y] = one.at;
                let (most, mean) = (short(one.f0_error), short(one.f0_error_mean));
                let stored = short(one.f0_error_stored);
                line.push_str(&format!(
                    "largest error of F0 {most} at ({x}, {y}), mean {mean}, as stored {stored}"
                ));
            }
        }
        line.push_str(&format!("; roughness as stored within {}", short(one.roughness_error_stored)));
        output::talk(&line);
    }
    if let Some(exact) = all.iter().find(|one| !one.diffuse_ratio.is_empty()) {
        let at = |r: &DiffuseRatio| format!("{} at mu {}", significant(r.ratio, 5), r.mu);
        let ratios: Vec<String> = exact.diffuse_ratio.iter().map(at).collect();
        output::talk(&format!(
            "  their diffuse part is multiplied, under even light, by {}",
            ratios.join(", ")
        ));
    }
}

impl From<SceneWriteError> for Failure {
    fn from(error: SceneWriteError) -> Failure {
        let exit = match &error {
            SceneWriteError::Files(TransactionError::Cancelled) => return Failure::from(Cancelled),
            SceneWriteError::Scene(e) if matches!(e.fault, Fault::Io { .. }) => Exit::Io,
            SceneWriteError::Read { .. } | SceneWriteError::Changed { .. } | SceneWriteError::Files(_) => {
                Exit::Io
            }
            SceneWriteError::Place { .. }
            | SceneWriteError::Itself { .. }
            | SceneWriteError::Overwrites { .. } => Exit::Usage,
            SceneWriteError::Convert(ConvertError::Coordinates { .. } | ConvertError::Animated { .. }) => {
                Exit::Unsupported
            }
            _ => Exit::Input,
        };
        Failure::new(exit, error)
    }
}
