//! Plan -> bake -> verify -> encode -> write. Nothing is replaced unless every table of the plan is baked and verified, and every map made; what that
//! promises of an output folder is told in [`transaction`].
//!
//! The pipeline never prints: it sends [`Event`]s to a [`Progress`].

mod advice;
mod again;
#[cfg(feature = "unstable")]
pub mod audit;
#[cfg(not(feature = "unstable"))]
pub(crate) mod audit;
mod companion;
pub(crate) mod cost;
mod event;
mod fit;
#[cfg(feature = "unstable")]
pub mod fresh;
#[cfg(not(feature = "unstable"))]
pub(crate) mod fresh;
mod gather;
#[cfg(feature = "unstable")]
pub mod golden;
#[cfg(not(feature = "unstable"))]
pub(crate) mod golden;
mod in_memory;
mod manifest;
#[cfg(feature = "unstable")]
pub mod map;
#[cfg(not(feature = "unstable"))]
pub(crate) mod map;
#[cfg(all(feature = "scene", feature = "unstable"))]
pub mod materials;
#[cfg(all(feature = "scene", not(feature = "unstable")))]
pub(crate) mod materials;
#[cfg(feature = "unstable")]
pub mod memory;
#[cfg(not(feature = "unstable"))]
pub(crate) mod memory;
mod memory_map;
#[cfg(all(feature = "report", feature = "unstable"))]
pub mod pages;
#[cfg(all(feature = "report", not(feature = "unstable")))]
pub(crate) mod pages;
#[cfg(feature = "report")]
mod pages_map;
#[cfg(all(feature = "report", feature = "scene"))]
pub(crate) mod preview;
mod reached;
#[cfg(feature = "unstable")]
pub mod recheck;
#[cfg(not(feature = "unstable"))]
pub(crate) mod recheck;
mod size;
#[cfg(feature = "unstable")]
pub mod suggest;
#[cfg(not(feature = "unstable"))]
pub(crate) mod suggest;
mod table;
mod texels;
mod threads;
pub(crate) mod transaction;
mod work;
#[cfg(all(feature = "scene", feature = "unstable"))]
pub mod write_scene;
#[cfg(all(feature = "scene", not(feature = "unstable")))]
pub(crate) mod write_scene;

pub use crate::plan::MANIFEST;
pub use again::{CACHE_LIMIT, Cache, CacheSize, KeptIn};
pub use companion::{Companion, Seen};
pub use cost::Large;
pub use event::{
    ChoiceEntry, Event, Extremum, MapPlanEntry, Phase, PlanEntry, Progress, ReconstructionEntry, Silent,
};
pub use in_memory::{Baked, InMemoryError, bake, bake_until};
pub use manifest::{FileRecord, Manifest, TableRecord};
pub use map::{MapError, MapRecord};
pub use reached::Reached;
pub use threads::{MOST_THREADS, pool};
pub use transaction::{Recovery, TransactionError};

use crate::cancel::{Cancel, Cancelled};
use crate::encode::{EncodeError, RangeFault};
use crate::plan::Plan;
use crate::tables::driver::BakeError;
use crate::verify::Finding;
use again::Again;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use transaction::{Transaction, Waiting};
use work::Work;

/// Where to write and what to use for it.
#[derive(Debug, Clone)]
pub struct Settings {
    /// Output folder.
    pub out: PathBuf,
    /// Threads, at most [`MOST_THREADS`]; the number of cores if none.
    pub jobs: Option<usize>,
    /// How long to wait for another run that writes into the folder.
    pub lock_timeout: Duration,
    /// Write nothing where a law could not be checked or a texel misses its tolerance.
    pub strict: bool,
    /// Bytes of memory that the run may take; [`memory::MEMORY`], or what is available if that is less, if none.
    pub memory: Option<u64>,
    /// Bake everything, even what the folder or the cache holds already.
    pub force: bool,
    /// Bake plans of more than [`cost::TEXELS`] texels or [`cost::BYTES`] bytes, too.
    pub large: bool,
    /// Where baked tables and maps are kept for other folders and scenes; nowhere if none.
    pub cache: Option<Cache>,
}

impl Settings {
    /// Settings for a folder: every core, [`LOCK_TIMEOUT`], [`memory::MEMORY`], and what the folder holds is not baked again. No
    /// cache.
    #[must_use]
    pub fn new(out: impl Into<PathBuf>) -> Settings {
        Settings {
            out: out.into(),
            jobs: None,
            lock_timeout: LOCK_TIMEOUT,
            strict: false,
            memory: None,
            force: false,
            large: false,
            cache: None,
        }
    }
}

/// How long a run waits for another one that writes into its folder, if nothing else is said.
pub const LOCK_TIMEOUT: Duration = Duration::from_secs(60);

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
        "table {table}: no table with axes up to {longest} reads to within {asked:e}; {reached}. To mend it, {}",
        reached::remedy(*searched, *longer)
    )]
    Size {
        /// Table name.
        table: String,
        /// Error that was asked for.
        asked: f64,
        /// Longest axis.
        longest: usize,
        /// How near it came.
        reached: Reached,
        /// Were other warps tried?
        searched: bool,
        /// Could axes be longer?
        longer: bool,
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
    /// A map cannot be made.
    #[error("map {map}: {error}")]
    Map {
        /// Map name.
        map: String,
        /// Why.
        #[source]
        error: Box<MapError>,
    },
    /// Laws that do not hold and are not waived.
    #[error("{} broken; nothing was written", laws(.0.len()))]
    Laws(Vec<Finding>),
    /// Laws that could not be checked, or texels that miss their tolerance, where neither is allowed.
    #[error("{} in doubt; nothing was written, since `strict` is set", doubts(.0.len()))]
    Doubt(Vec<Finding>),
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
    /// The output folder, or a file in it, cannot be written.
    #[error(transparent)]
    Files(#[from] TransactionError),
    /// A table that takes more memory than there is.
    #[error(
        "table {table} takes up to {} of memory, and {} may be taken. Take shorter axes, or a binary container in place of text; \
         or allow more, where the machine has it",
        size(*.needed), size(*.limit)
    )]
    Memory {
        /// Table name.
        table: String,
        /// Most bytes that it takes.
        needed: u64,
        /// Bytes that may be taken.
        limit: u64,
    },
    /// A map that takes more memory than there is.
    #[error(
        "map {map} takes up to {} of memory, and {} may be taken. Take smaller images, or write fewer containers at once; \
         or allow more, where the machine has it",
        size(*.needed), size(*.limit)
    )]
    MapMemory {
        /// Map name.
        map: String,
        /// Most bytes that it takes.
        needed: u64,
        /// Bytes that may be taken.
        limit: u64,
    },
    /// A plan so large that it was probably not meant.
    #[error("the plan is large: {0}. If that is meant, allow it (--yes-large)")]
    Large(Large),
    /// More threads were asked for than are allowed.
    #[error("{from} = {jobs}: at most {limit} threads are allowed")]
    Jobs {
        /// Who asked: `jobs`, or a variable of the environment.
        from: &'static str,
        /// How many.
        jobs: usize,
        /// Most that are allowed.
        limit: usize,
    },
    /// The threads could not be started.
    #[error(
        "cannot start {jobs} threads: {message}; take fewer, or allow the process more threads and memory"
    )]
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

/// Bytes for people: `1.3 GB`.
fn size(bytes: u64) -> String {
    bytesize::ByteSize::b(bytes).display().si().to_string()
}

fn laws(n: usize) -> String {
    if n == 1 { "one law is".to_owned() } else { format!("{n} laws are") }
}

fn doubts(n: usize) -> String {
    if n == 1 { "one thing is".to_owned() } else { format!("{n} things are") }
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
    /// Tables and maps that were not baked, since the folder or the cache held them.
    pub kept: usize,
}

/// Runs a plan. `cancel` is looked at between texels and before files are moved to their names.
///
/// # Errors
/// [`PipelineError`]; in every case but [`TransactionError::Stuck`] the output folder is as it was.
pub fn run(
    plan: &Plan,
    settings: &Settings,
    cancel: &Cancel,
    progress: &dyn Progress,
) -> Result<Outcome, PipelineError> {
    run_with(plan, settings, cancel, progress, None)
}

/// [`run`], with files that somebody makes of the tables. They are part of the transaction.
///
/// # Errors
/// As [`run`].
pub fn run_with(
    plan: &Plan,
    settings: &Settings,
    cancel: &Cancel,
    progress: &dyn Progress,
    mut companion: Option<&mut dyn Companion>,
) -> Result<Outcome, PipelineError> {
    let start = Instant::now();
    check(plan, settings)?;
    let pool = pool(settings.jobs)?;
    progress.event(&Event::plan(plan));
    let mut names = plan.files();
    names.extend(companion.iter().flat_map(|c| c.names(plan)));
    let mut files = begin(&names, settings, cancel, progress)?;
    // a companion looks at texels, which only a bake has
    let mut again = Again::look(plan, settings, companion.is_none(), &mut files)?;
    let mut work = Work { plan, settings, pool: &pool, cancel, progress, kept: 0 };
    let tables = work.tables(&mut again, &mut files, companion.as_deref_mut())?;
    let maps = work.maps(&mut again, &mut files, companion.as_deref_mut())?;
    let mut manifest = Manifest::new(plan, tables, maps, Vec::new());
    manifest.set_sizes(|name| files.staged(name));
    again.give(&manifest, &files, progress);
    let extra = companion.map_or_else(Vec::new, |c| c.finish(&manifest));
    let written = plan.files().into_iter().chain(extra.iter().map(|(name, _)| name.clone()));
    manifest.stale = Manifest::stale(&settings.out, &written.collect::<Vec<_>>());
    for (name, bytes) in &extra {
        files.stage(name, bytes)?;
    }
    let kept = work.kept;
    let written = files.commit(&manifest.to_bytes())?;
    let outcome = Outcome { manifest, written: written.written, unchanged: written.unchanged, kept };
    progress.event(&Event::summary(&outcome, &settings.out, start.elapsed().as_secs_f64()));
    Ok(outcome)
}

/// What would stop a run before it begins, without a trace: a plan that is larger than was allowed, conflicts of file names, and more
/// memory than there is.
///
/// # Errors
/// [`PipelineError::Large`], [`PipelineError::Files`] and [`PipelineError::Memory`].
pub fn check(plan: &Plan, settings: &Settings) -> Result<(), PipelineError> {
    if let Some(large) = cost::large(plan).filter(|_| !settings.large) {
        return Err(PipelineError::Large(large));
    }
    transaction::check(&settings.out, &plan.files())?;
    memory::check(plan, settings.memory)
}

/// Locks the output folder.
fn begin<'a>(
    names: &[String],
    settings: &Settings,
    cancel: &'a Cancel,
    progress: &dyn Progress,
) -> Result<Transaction<'a>, PipelineError> {
    let (folder, timeout) = (settings.out.as_path(), settings.lock_timeout);
    let told = || progress.event(&Event::Waiting { folder, seconds: timeout.as_secs_f64() });
    let waiting = Waiting { timeout, told: &told };
    let (files, recovered) = Transaction::begin(folder, names, cancel, &waiting)?;
    if let Some(recovery) = recovered {
        progress.event(&Event::Recovered { folder, recovery });
    }
    Ok(files)
}
