//! What verbs that take glTF scenes share: the files, how they are looked at, and what is said of them.

use super::terminal::{Paint, paint};
use super::{Exit, Failure, output};
use crate::math::figures::short;
use crate::pipeline::pool;
use crate::pipeline::suggest::Ranges;
use crate::plan::map::Kind;
use crate::plan::scene::{
    self as planning, Asked, AskedMap, Kept, ScenePlanError, Survey, SurveyOptions, Texels,
};
use crate::plan::{Plan, PlannedMap, PlannedTable};
use crate::recipe::Engine;
use crate::scene::{Fault, LeftOut, LeftOutKind, Need, Reader, SceneError};
use std::path::{Path, PathBuf};

/// Which pictures of scenes are read.
#[derive(Debug, Clone, clap::Args)]
pub struct Pictures {
    /// Read pictures of a scene below this folder; without it those that lie outside the scene's own folder are unknown.
    #[arg(long, value_name = "DIR")]
    pub(super) root: Option<PathBuf>,
    /// Largest picture that is read, in pixels: four bytes of memory each; 67108864 (8192 x 8192) if not given. Larger ones are
    /// unknown.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1 << 32))]
    pixels: Option<u64>,
}

/// How scenes are looked at.
#[derive(Debug, Clone, clap::Args)]
pub struct Look {
    #[command(flatten)]
    pub(super) pictures: Pictures,
    /// Tables go so far beyond the roughness of the scenes, on either side; 0 if not given.
    #[arg(long, value_name = "ROUGHNESS", value_parser = margin)]
    margin: Option<f64>,
    /// Which texels of a texture count: `whole`, all of them; `referenced`, those that the meshes cover with their texture
    /// coordinates. Where that is not known, all count and the plan says so.
    #[arg(long, value_name = "WHICH", default_value = "whole", value_parser = texels)]
    texels: Texels,
    /// Filter the normal and roughness textures of materials into maps with all levels, as KTX2; tables then cover the roughness of
    /// these levels. `normal`: fitted normals are written too; `anisotropy`: two widths and a direction.
    #[arg(long, value_name = "KIND", value_delimiter = ',', num_args = 0.., require_equals = true, default_missing_value = "roughness", value_parser = kind)]
    pub(super) maps: Vec<Kind>,
    /// Keep in this folder what was found in scenes, and read only those that changed since.
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,
}

impl Pictures {
    /// Root and limits, for a shader that takes roughness like this.
    pub(super) fn options(&self, reader: Reader) -> SurveyOptions {
        let pixels = self.pixels.unwrap_or(planning::PIXELS);
        SurveyOptions { root: self.root.clone(), pixels, reader, ..SurveyOptions::default() }
    }
}

impl Look {
    /// An option that says something of scenes, if one is given.
    pub(super) fn given(&self) -> Option<&'static str> {
        let options = [
            ("--root", self.pictures.root.is_some()),
            ("--pixels", self.pictures.pixels.is_some()),
            ("--margin", self.margin.is_some()),
            ("--texels", self.texels != Texels::default()),
            ("--maps", !self.maps.is_empty()),
            ("--keep", self.keep.is_some()),
        ];
        options.into_iter().find(|(_, given)| *given).map(|(name, _)| name)
    }
}

fn margin(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "it is no number".to_owned())?;
    if (0.0..=1.0).contains(&number) { Ok(number) } else { Err("it must be from 0 to 1".to_owned()) }
}

fn texels(text: &str) -> Result<Texels, String> {
    let allowed = || format!("there is {}", Texels::ALL.map(Texels::id).join(", "));
    Texels::ALL.into_iter().find(|t| t.id() == text).ok_or_else(allowed)
}

fn kind(text: &str) -> Result<Kind, String> {
    planning::KINDS
        .into_iter()
        .find(|k| k.id() == text)
        .ok_or_else(|| format!("there is {}", planning::KINDS.map(Kind::id).join(", ")))
}

/// Scenes, what they need, and what is baked for them.
#[derive(Debug)]
pub(super) struct Job {
    pub(super) survey: Survey,
    /// The tables, one for one those of `plan` unless an engine has its own.
    pub(super) asked: Vec<Asked>,
    /// The maps.
    pub(super) maps: Vec<AskedMap>,
    pub(super) plan: Plan,
    /// Tables of the engine that the scenes do not need.
    pub(super) dropped: Vec<String>,
    /// Scenes that were read; of the others it was known what they need.
    pub(super) read: usize,
}

impl Job {
    /// Is something needed and not baked, cut, or not known?
    pub(super) fn in_doubt(&self) -> bool {
        self.survey.needs.in_doubt() || self.asked.iter().any(|a| a.notes.iter().any(|n| n.seen))
    }
}

impl Job {
    /// The roughness that each table is read at, over all that it serves.
    pub(super) fn ranges(&self) -> Ranges {
        let mut all = Ranges::new();
        for table in &self.plan.tables {
            let families: Vec<_> = planning::served(table).collect();
            let served = self.survey.needs.needs.iter().filter(|n| families.contains(&n.table.as_ref()));
            for range in served.filter_map(|n| n.ranges.get("roughness")) {
                let ends = all.entry(table.name().to_owned()).or_insert([range.lo, range.hi]);
                *ends = [ends[0].min(range.lo), ends[1].max(range.hi)];
            }
        }
        all
    }
}

/// Reads scenes, tells what they need, and plans the tables.
pub(super) fn job(
    files: &[PathBuf],
    look: &Look,
    engine: Option<(&'static Engine, Plan)>,
    jobs: Option<usize>,
) -> Result<Job, Failure> {
    let roughness = engine.as_ref().map(|(engine, _)| engine.roughness);
    let reader = Reader {
        at_least: roughness.map_or(0.0, |r| r.at_least),
        widens: roughness.is_some_and(|r| r.widens),
        maps: !look.maps.is_empty(),
        margin: look.margin.unwrap_or(0.0),
    };
    let options = SurveyOptions { texels: look.texels, ..look.pictures.options(reader) };
    let mut kept = look.keep.as_deref().map_or_else(Kept::default, |folder| Kept::read(folder, &options));
    let found = pool(jobs)?.install(|| planning::survey_with(files, &options, &mut kept));
    let (mut survey, read) = found.map_err(|e| refused(&e))?;
    if let Some(folder) = &look.keep {
        kept.write(folder).map_err(|e| Failure::io(folder.display(), &e))?;
    }
    let asked = planning::asked(&survey.needs).map_err(unplanned)?;
    let (plan, dropped) = match engine {
        None => (planning::plan_of(&asked).map_err(unplanned)?, Vec::new()),
        Some((_, plan)) => {
            let (plan, dropped) = needed(plan, &survey);
            (Some(plan), dropped)
        }
    };
    let mut plan = plan.unwrap_or_else(|| Plan::nothing(planning::NAME));
    let mut maps = Vec::new();
    if !look.maps.is_empty() {
        let found = planning::maps(files, &look.maps, &options).map_err(|e| refused(&e))?;
        survey.needs.left_out.extend(found.left_out);
        maps = found.maps;
        let requests = maps.iter().map(|m| m.request.clone()).collect();
        plan = plan.with_maps(requests).map_err(Failure::input)?;
    }
    let reasons = planning::reasons(&survey, &asked, &maps);
    Ok(Job { survey, asked, maps, plan: plan.because(reasons), dropped, read })
}

/// The tables of an engine that serve what the scenes need.
fn needed(plan: Plan, survey: &Survey) -> (Plan, Vec<String>) {
    let needs = |table: &PlannedTable| {
        planning::served(table).any(|family| survey.needs.needs.iter().any(|n| n.table == family))
    };
    let dropped = plan.tables.iter().filter(|t| !needs(t)).map(|t| t.name().to_owned()).collect();
    (plan.only(needs), dropped)
}

/// The files that arguments name: a file, a folder with all below it, or a pattern.
pub(super) fn files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut all = Vec::new();
    for path in paths {
        if path.is_dir() {
            let folder = glob::Pattern::escape(&path.to_string_lossy());
            let mut below = Vec::new();
            for extension in ["gltf", "glb"] {
                below.extend(matching(&format!("{folder}/**/*.{extension}"))?);
            }
            below.sort();
            none_is_a_fault(&below, path)?;
            all.extend(below);
        } else if path.exists() || !path.to_string_lossy().contains(['*', '?', '[']) {
            all.push(path.clone());
        } else {
            let found = matching(&path.to_string_lossy())?;
            none_is_a_fault(&found, path)?;
            all.extend(found);
        }
    }
    let mut seen = std::collections::BTreeSet::new();
    all.retain(|path| seen.insert(path.clone()));
    Ok(all)
}

fn none_is_a_fault(found: &[PathBuf], path: &Path) -> Result<(), Failure> {
    if found.is_empty() {
        return Err(Failure::input(format!("{}: there is no .gltf or .glb file", path.display())));
    }
    Ok(())
}

fn matching(pattern: &str) -> Result<Vec<PathBuf>, Failure> {
    let paths = glob::glob(pattern).map_err(|e| Failure::usage(format!("{pattern}: {e}")))?;
    paths.map(|path| path.map_err(|e| Failure::new(Exit::Io, e))).collect()
}

/// All scenes that were refused, one a line; the machine's fault only if it is all of them.
pub(super) fn refused(errors: &[SceneError]) -> Failure {
    let io = errors.iter().all(|e| matches!(e.fault, Fault::Io { .. }));
    let lines: Vec<String> = errors.iter().map(ToString::to_string).collect();
    let fault = |e: &SceneError| serde_json::json!({ "file": e.file, "message": e.fault.to_string() });
    let exit = if io { Exit::Io } else { Exit::Input };
    Failure { faults: errors.iter().map(fault).collect(), ..Failure::new(exit, lines.join("\nerror: ")) }
}

fn unplanned(error: ScenePlanError) -> Failure {
    let exit =
        if matches!(error, ScenePlanError::Family { .. }) { Exit::Unsupported } else { Exit::Internal };
    Failure::new(exit, error)
}

/// Most lines of a kind that are told.
const LINES: usize = 12;

/// What scenes need and what was left out, for people.
pub(super) fn tell(job: &Job) {
    let survey = &job.survey;
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let materials = survey.scenes.iter().map(|s| s.materials).sum();
    let images: usize = survey.scenes.iter().map(|s| s.images).sum();
    let name = match survey.scenes.as_slice() {
        [one] => format!("scene {}", crate::math::shown::show(&one.file)),
        all => count(all.len(), "scene"),
    };
    let known = survey.scenes.len() - job.read;
    let known = if known > 0 { format!(", {known} known from before") } else { String::new() };
    output::talk(&format!("{name}: {}, {}{known}", count(materials, "material"), count(images, "picture")));
    for need in &survey.needs.needs {
        tell_need(need, survey.scenes.len() > 1);
    }
    for (asked, map) in job.maps.iter().zip(&job.plan.maps).take(LINES) {
        tell_map(asked, map, survey.scenes.len() > 1);
    }
    if job.maps.len() > LINES {
        output::talk(&format!("  and {} maps more; `plan --json` lists all", job.maps.len() - LINES));
    }
    for note in job.asked.iter().flat_map(|a| a.notes.iter().map(move |n| (a, n))).take(LINES) {
        output::talk(&format!("  cut: {}: {}", note.0.request.name, note.1));
    }
    for name in &job.dropped {
        output::talk(&format!("  left out: {name}: nothing in the scene asks for it"));
    }
    folded(survey.needs.left_out.iter().map(|left| format!("  left out: {}", shown(left))));
    let warnings = survey.scenes.iter().flat_map(|s| s.warnings.iter().map(move |w| (&s.file, w)));
    folded(warnings.map(|(file, w)| {
        format!("  {} {}: {w}", paint(Paint::Doubtful, "warning:"), crate::math::shown::show(file))
    }));
    if job.plan.tables.is_empty() && job.plan.maps.is_empty() {
        output::talk("  nothing to bake");
    }
}

/// A map, and who asks for it.
fn tell_map(asked: &AskedMap, map: &PlannedMap, with_files: bool) {
    let (n, [w, h]) = (asked.asked_by.len(), map.size);
    let s = if n == 1 { "" } else { "s" };
    output::talk(&format!("  needs map {}, {w} x {h} texels, asked {n} time{s}, such as", map.name()));
    for asker in asked.asked_by.iter().take(4) {
        let file = &asker.material.file;
        let file = if with_files { format!("{} ", crate::math::shown::show(file)) } else { String::new() };
        output::talk(&format!("    {file}{}: {}", asker.material, asker.why));
    }
}

fn shown(left: &LeftOut) -> String {
    match left.kind {
        LeftOutKind::Unknown => format!("{left} [unknown]"),
        LeftOutKind::NotSupported => format!("{left} [not supported]"),
        _ => left.to_string(),
    }
}

fn tell_need(need: &Need, with_files: bool) {
    let ranges: Vec<String> = need
        .ranges
        .iter()
        .map(|(id, r)| match (&r.values, r.value()) {
            (_, Some(value)) => format!("{id} {}", short(value)),
            (Some(values), _) => {
                format!("{id} {}", values.iter().map(short).collect::<Vec<_>>().join(" and "))
            }
            _ => format!("{id} [{}, {}]", short(r.lo), short(r.hi)),
        })
        .collect();
    let (n, s) = (need.asked_by.len(), if need.asked_by.len() == 1 { "" } else { "s" });
    output::talk(&format!(
        "  needs {} tables, {}, asked {n} time{s}, such as",
        need.table,
        ranges.join(", ")
    ));
    for asked in need.asked_by.iter().take(4) {
        let file = if with_files {
            format!("{} ", crate::math::shown::show(&asked.material.file))
        } else {
            String::new()
        };
        output::talk(&format!("    {file}{}: {}", asked.material, asked.why));
    }
}

/// The first lines, and how many more there are.
fn folded(lines: impl Iterator<Item = String>) {
    let mut more = 0;
    for (i, line) in lines.enumerate() {
        if i < LINES { output::talk(&line) } else { more += 1 }
    }
    if more > 0 {
        output::talk(&format!("  and {more} more; `plan --json` lists all"));
    }
}

/// The same as one JSON object.
pub(super) fn json(job: &Job) -> serde_json::Value {
    let mut line = serde_json::json!({ "reason": "scene" });
    if let (Some(to), Some(from)) =
        (line.as_object_mut(), job.plan.reasons.as_ref().and_then(|r| r.as_object()))
    {
        to.extend(from.clone());
    }
    line
}
