//! `brdfbake plan SCENE...`: what would be baked, for whom, at what cost, and what not.

use super::{Exit, Failure, engine, output, scene};
use crate::pipeline::cost::{self, Cost};
use crate::pipeline::memory;
use crate::plan::{PlannedMap, PlannedTable};
use bytesize::ByteSize;
use serde_json::{Value as Json, json};
use std::path::PathBuf;

/// Arguments of `plan`.
#[derive(Debug, clap::Args)]
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
    let costs: Vec<Cost> = job.plan.tables.iter().map(cost::of).collect();
    if args.json {
        let mut all = scene::json(&job);
        let tables = job.plan.tables.iter().zip(&costs).map(|(t, c)| table(t, c));
        if !job.plan.maps.is_empty() {
            all["planned_maps"] = job.plan.maps.iter().map(map).collect();
        }
        all["planned"] = Json::Array(tables.collect());
        all["dropped"] = json!(job.dropped);
        output::data(&all.to_string())?;
    } else {
        scene::tell(&job);
        let lines = job.plan.tables.iter().zip(&costs).map(|(t, c)| line(&job, t, c));
        let lines = lines.chain(job.plan.maps.iter().map(map_line));
        let mut text = lines.collect::<Vec<_>>().join("\n");
        let (bytes, seconds) = costs.iter().fold((0, 0.0), |(b, s), c| (b + c.bytes, s + c.seconds));
        if costs.len() > 1 {
            text.push_str(&format!("\nall: at most {}, about {}", size(bytes), time(seconds)));
        }
        output::data(if text.is_empty() { "nothing to bake" } else { &text })?;
    }
    Ok(if args.strict && job.in_doubt() { Exit::Failed } else { Exit::Done })
}

fn size(bytes: u64) -> String {
    ByteSize::b(bytes).display().si().to_string()
}

fn time(seconds: f64) -> String {
    if seconds < 0.095 { format!("{:.0} ms", seconds * 1e3) } else { format!("{seconds:.1} s") }
}

fn axes(table: &PlannedTable) -> Vec<Json> {
    let axes = table.bound.spec.grid.axes().iter();
    axes.map(|a| json!({ "id": a.quantity.id, "domain": a.domain, "length": a.len })).collect()
}

fn table(table: &PlannedTable, cost: &Cost) -> Json {
    let spec = &table.bound.spec;
    json!({
        "table": table.name(),
        "kind": spec.kind.id,
        "model": spec.model.as_ref().map(|(info, _)| info.id),
        "params": table.asked.request.params,
        "channels": spec.layout.ids().collect::<Vec<_>>(),
        "axes": axes(table),
        "tolerance": table.tolerance,
        "files": table.files(),
        "texels": spec.grid.len(),
        "bytes": cost.bytes,
        "seconds": cost.seconds,
    })
}

fn map(map: &PlannedMap) -> Json {
    json!({ "map": map.name(), "size": map.size, "levels": map.levels(), "memory": memory::map(map), "files": map.files(), "asked": map.asked.canonical() })
}

fn map_line(map: &PlannedMap) -> String {
    let kinds: Vec<&str> = map.asked.kinds().iter().map(|k| k.id()).collect();
    let [w, h] = map.size;
    let (name, kinds, memory) = (map.name(), kinds.join(", "), size(memory::map(map)));
    format!("{name}: map of {kinds}; {w} x {h}, {} levels, at most {memory} of memory", map.levels())
}

fn line(job: &scene::Job, table: &PlannedTable, cost: &Cost) -> String {
    let spec = &table.bound.spec;
    let axis = |a: &crate::grid::Axis| {
        let [lo, hi] = a.domain;
        format!("{} [{lo}, {hi}] x {}", a.quantity.id, a.len)
    };
    let axes = spec.grid.axes().iter().map(axis).collect::<Vec<_>>().join(", ");
    // those that the scene has set, not those that are left as they are
    let given = job.asked.iter().find(|a| a.request.name == table.name());
    let fixed = given.into_iter().flat_map(|a| &a.request.request.params);
    let fixed: Vec<String> = fixed.map(|(id, value)| format!("{id} = {value}")).collect();
    let fixed = if fixed.is_empty() { String::new() } else { format!("; {}", fixed.join(", ")) };
    format!(
        "{}: {} over {axes}{fixed}; at most {}, about {}",
        table.name(),
        spec.layout.ids().collect::<Vec<_>>().join(", "),
        size(cost.bytes),
        time(cost.seconds)
    )
}
