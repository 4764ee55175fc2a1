//! Plan -> bake -> verify -> encode -> write. Nothing is written unless every table of the plan is baked and verified.
//!
//! The pipeline never prints: it sends [`Event`]s to a [`Progress`].

mod event;
mod fit;
pub mod golden;
mod manifest;
mod size;
pub mod suggest;
mod table;
mod texels;

pub use event::{Event, Extremum, Progress, Silent};
pub use manifest::{FileRecord, MANIFEST, Manifest, TableRecord};

use crate::cancel::{Cancel, Cancelled};
use crate::encode::atomic::{self, WriteError};
use crate::encode::{self, EncodeError, RangeFault};
use crate::recipe::{Plan, PlannedTable};
use crate::tables::driver::BakeError;
use crate::verify::Finding;
use std::path::PathBuf;
use std::time::Instant;
use table::Made;

/// Where to write and how many threads to use.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Output folder.
    pub out: PathBuf,
    /// Threads; the number of cores if none.
    pub jobs: Option<usize>,
}

/// Why nothing was written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PipelineError {
    /// A texel has no value, or misses the tolerance.
    #[error("table {table}: {error}")]
    Bake {
        /// Table name.
        table: String,
        /// Why.
        #[source]
        error: BakeError,
    },
    /// No size reaches the error that was asked for.
    #[error(
        "table {table}: no table with axes up to {longest} reads to within {asked:e}; the best reached {reached:e}. Ask for a larger \
         error, allow `longest` or `warps = \"search\"`, store it in more bits, or move an axis off the corner where it bends"
    )]
    Size {
        /// Table name.
        table: String,
        /// Error that was asked for.
        asked: f64,
        /// Longest axis.
        longest: usize,
        /// Least error of all trials.
        reached: f64,
    },
    /// Too many points to fit texels to.
    #[error(
        "table {table}: its texels cannot be fitted: that takes {points} integrals, and at most {limit} are allowed. Take shorter \
         axes, or `texels = \"exact\"`"
    )]
    Fit {
        /// Table name.
        table: String,
        /// Points that are needed.
        points: usize,
        /// Most that are allowed.
        limit: usize,
    },
    /// A grid of the search that cannot be.
    #[error("table {table}: {message}")]
    SizeGrid {
        /// Table name.
        table: String,
        /// Why.
        message: String,
    },
    /// Laws that do not hold and are not waived.
    #[error("{} broken; nothing was written", laws(.0.len()))]
    Laws(Vec<Finding>),
    /// A value that the storage cannot hold.
    #[error("table {table}, {output}: {error}")]
    Range {
        /// Table name.
        table: String,
        /// Container and storage.
        output: String,
        /// Which value.
        #[source]
        error: RangeFault,
    },
    /// A table that the container cannot hold.
    #[error("table {table}, {output}: {error}")]
    Encode {
        /// Table name.
        table: String,
        /// Container and storage.
        output: String,
        /// Why.
        #[source]
        error: EncodeError,
    },
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// Files could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The threads could not be started.
    #[error("cannot start {jobs} threads: {message}")]
    Threads {
        /// How many.
        jobs: usize,
        /// The system's message.
        message: String,
    },
    /// Metadata could not be written as JSON (a number that is not finite).
    #[error("table {table}: metadata: {message}")]
    Metadata {
        /// Table name.
        table: String,
        /// The message.
        message: String,
    },
}

fn laws(n: usize) -> String {
    if n == 1 { "one law is".to_owned() } else { format!("{n} laws are") }
}

/// What a run did.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// The manifest, as written.
    pub manifest: Manifest,
    /// Files that are new or changed.
    pub written: usize,
    /// Files that had the same bytes already.
    pub unchanged: usize,
}

/// Runs a plan. `cancel` is looked at between texels and before files are moved to their names.
///
/// # Errors
/// [`PipelineError`]; in every case but a failed rename the output folder is as it was.
pub fn run(
    plan: &Plan,
    settings: &Settings,
    cancel: &Cancel,
    progress: &dyn Progress,
) -> Result<Outcome, PipelineError> {
    let start = Instant::now();
    atomic::check_writable(&settings.out)?;
    let jobs = settings.jobs.unwrap_or(0);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(jobs)
        .build()
        .map_err(|e| PipelineError::Threads { jobs, message: e.to_string() })?;
    progress.event(&Event::plan(plan));
    let mut made = Vec::new();
    let mut findings = Vec::new();
    for (index, planned) in plan.tables.iter().enumerate() {
        match pool.install(|| table::make(plan, planned, index, cancel, progress)) {
            Ok(table) => made.push(table),
            // the other tables are still checked, so that one run shows every broken law
            Err(PipelineError::Laws(broken)) => findings.extend(broken),
            Err(e) => return Err(e),
        }
    }
    if !findings.is_empty() {
        return Err(PipelineError::Laws(findings));
    }
    let files = join(plan, &mut made)?;
    let mut manifest = Manifest::new(plan, made.into_iter().map(|m| m.record).collect());
    manifest.set_sizes(&files);
    let mut files: Vec<(PathBuf, Vec<u8>)> =
        files.into_iter().map(|(name, bytes)| (settings.out.join(name), bytes)).collect();
    files.push((settings.out.join(MANIFEST), manifest.to_bytes()));
    let written = atomic::write_all(&files, cancel)?;
    let outcome = Outcome { manifest, written: written.written, unchanged: written.unchanged };
    progress.event(&Event::summary(&outcome, start.elapsed().as_secs_f64()));
    Ok(outcome)
}

/// The files of all tables; those of tables that name the same one are joined, in the order of the tables.
fn join(plan: &Plan, made: &mut [Made]) -> Result<Vec<(String, Vec<u8>)>, PipelineError> {
    let mut files: Vec<(String, usize, Vec<Vec<u8>>)> = Vec::new();
    for (i, made) in made.iter_mut().enumerate() {
        for (name, bytes) in std::mem::take(&mut made.files) {
            match files.iter_mut().find(|(other, ..)| *other == name) {
                Some((_, _, parts)) => parts.push(bytes),
                None => files.push((name, i, vec![bytes])),
            }
        }
    }
    let one = |(name, table, mut parts): (String, usize, Vec<Vec<u8>>)| {
        if parts.len() == 1 {
            return Ok((name, parts.swap_remove(0)));
        }
        let output = plan.tables.get(table).and_then(|t| t.outputs.first());
        let joined = match output.and_then(|o| encode::encoder(&o.container)) {
            Some(encoder) => encoder.join(&parts),
            None => Ok(parts.concat()),
        };
        joined.map(|bytes| (name.clone(), bytes)).map_err(|error| PipelineError::Encode {
            table: plan.tables.get(table).map_or_else(String::new, |t| t.name.clone()),
            output: name,
            error,
        })
    };
    files.into_iter().map(one).collect()
}

/// Names of every file that a plan writes, in order, relative to the output folder.
#[must_use]
pub fn outputs(plan: &Plan) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for name in plan.tables.iter().flat_map(file_names) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names.push(MANIFEST.to_owned());
    names
}

/// File names of one table, one an output: `name.exr`, or `name.float.exr` where a container is used twice; or the one
/// that the recipe gives.
#[must_use]
pub fn file_names(planned: &PlannedTable) -> Vec<String> {
    if let Some(file) = &planned.file {
        return vec![file.clone()];
    }
    let outputs = &planned.outputs;
    outputs
        .iter()
        .map(|o| {
            let extension = encode::encoder(&o.container).map_or("bin", |e| e.extension());
            let twice = outputs.iter().filter(|other| other.container == o.container).count() > 1;
            if twice {
                format!("{}.{}.{extension}", planned.name, o.storage)
            } else {
                format!("{}.{extension}", planned.name)
            }
        })
        .collect()
}
