//! Parameter maps from files to files: read, filter, measure, round, write as one transaction.
//!
//! The folder gets the maps, with all levels, a map of errors, and a manifest that [`audit`](super::audit) reads. Nothing is
//! written if anything fails.

mod check;
mod input;
mod output;
mod record;

pub use check::{Measured, RuleMeasured};
pub use input::{FromLobe, Input, RoughnessInput};
pub use output::Output;
pub use record::{LevelRecord, MapRecord, Place};

use super::transaction::{self, Transaction, Waiting};
use super::{MANIFEST, PipelineError, Settings, pool};
use crate::cancel::{Cancel, Cancelled};
use crate::encode::{EncodeError, ReadError};
use crate::maps::{self, FilterError, TexelFault};
use crate::picture::PictureError;
use std::path::PathBuf;

/// What is asked for.
#[derive(Debug, Clone)]
pub struct MapRequest {
    /// How the names of its files begin.
    pub name: String,
    /// The normal map; the normals are flat without one.
    pub normal: Option<Input>,
    /// The roughness.
    pub roughness: RoughnessInput,
    /// Factor of the roughness: `roughnessFactor` of glTF. What is written stands for a factor of 1.
    pub factor: f64,
    /// How a texel's lobe is found.
    pub filter: maps::Settings,
    /// Files that are written.
    pub outputs: Vec<Output>,
    /// Texels of a level that are measured against the texels of the maps themselves, beside the worst.
    pub check: usize,
    /// Measure every published rule at the same texels.
    pub compare: bool,
}

/// Why there are no maps.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// A file that cannot be read.
    #[error("{path}: {source}")]
    Read {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: ReadError,
    },
    /// A file that is no image.
    #[error("{path}: {source}")]
    Picture {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: PictureError,
    },
    /// A texel that is no normal or no roughness.
    #[error("{path}: level 0, texel ({x}, {y}): {fault}{}", more(*.others))]
    Texel {
        /// The file.
        path: PathBuf,
        /// Column.
        x: usize,
        /// Row.
        y: usize,
        /// What is wrong.
        fault: TexelFault,
        /// Other texels with a fault.
        others: usize,
    },
    /// A number out of range.
    #[error("{what} = {got} outside {allowed}")]
    Number {
        /// What it is.
        what: &'static str,
        /// The number.
        got: f64,
        /// What it may be.
        allowed: &'static str,
    },
    /// Maps of different sizes.
    #[error(
        "{a} has {} x {} texels, {b} has {} x {}: maps of one surface have one size. Resample one of them, or ask for it (--resample)",
        .sizes[0][0], .sizes[0][1], .sizes[1][0], .sizes[1][1]
    )]
    Sizes {
        /// One file.
        a: PathBuf,
        /// The other.
        b: PathBuf,
        /// Their sizes.
        sizes: [[usize; 2]; 2],
    },
    /// Neither a normal map nor a roughness map: there is nothing to filter.
    #[error("neither a normal map nor a roughness map is given: there is nothing to filter")]
    Nothing,
    /// The filter failed.
    #[error(transparent)]
    Filter(#[from] FilterError),
    /// A map that a container does not take.
    #[error("map {map}: {source}")]
    Encode {
        /// The map.
        map: String,
        /// Why not.
        source: EncodeError,
    },
    /// Threads, files, memory.
    #[error(transparent)]
    Run(#[from] PipelineError),
}

fn more(n: usize) -> String {
    match n {
        0 => String::new(),
        1 => "; one more texel has a fault".to_owned(),
        n => format!("; {n} more texels have faults"),
    }
}

impl From<Cancelled> for MapError {
    fn from(e: Cancelled) -> MapError {
        MapError::Run(PipelineError::Cancelled(e))
    }
}

/// What a run did.
#[derive(Debug, Clone, PartialEq)]
pub struct MapOutcome {
    /// What the files say of themselves.
    pub record: MapRecord,
    /// Names of the files.
    pub files: Vec<String>,
    /// Files that are new or changed.
    pub written: usize,
    /// Files that had the same bytes already.
    pub unchanged: usize,
}

/// Reads, filters, measures and writes. `progress` is told of texels that are done and of their number.
///
/// # Errors
/// [`MapError`]; the output folder is then as it was.
pub fn run(
    request: &MapRequest,
    settings: &Settings,
    cancel: &Cancel,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<MapOutcome, MapError> {
    let sources = input::read(request, cancel)?;
    let pool = pool(settings.jobs)?;
    let (levels, maps, measured) = pool.install(|| -> Result<_, MapError> {
        let levels = maps::filter(&sources.surface, &request.filter, cancel, progress)?;
        let maps = output::plan(request, &sources, &levels);
        let measured = check::measure(request, &sources.surface, &levels, &maps, cancel)?;
        Ok((levels, maps, measured))
    })?;
    let record = record::record(request, &sources, &levels, measured);
    let files = pool.install(|| output::files(request, &maps, &record, cancel))?;
    let names: Vec<String> = files.iter().map(|f| f.name.clone()).chain([MANIFEST.to_owned()]).collect();
    let waiting = Waiting { timeout: settings.lock_timeout, told: &|| {} };
    transaction::check(&settings.out, &names).map_err(PipelineError::from)?;
    let (mut open, _) =
        Transaction::begin(&settings.out, &names, cancel, &waiting).map_err(PipelineError::from)?;
    for file in &files {
        open.stage(&file.name, &file.bytes).map_err(PipelineError::from)?;
    }
    let manifest = record::manifest(&record, &files);
    let written = open.commit(&manifest).map_err(PipelineError::from)?;
    let files = names;
    Ok(MapOutcome { record, files, written: written.written, unchanged: written.unchanged })
}
