//! Planned maps: read, filter, measure, round, encode. They are written with the tables of their plan, in its transaction; [`run`] is
//! a plan of one map.
//!
//! The folder gets the maps, with all levels, a map of errors, and a manifest that [`audit`](super::audit) reads. Nothing is
//! written if anything fails.

mod certificate;
mod check;
mod from_lobe;
mod input;
mod output;
mod pictured;
mod record;
mod sbrdf;
pub mod texel;
mod texel_file;

pub use crate::plan::map::sbrdf::{ColourInput, NumberInput, Origin};
pub use crate::plan::map::{
    AnisotropyInput, FromLobe, Input, MapRequest, Output, RoughnessInput, SbrdfRequest, Second, Source,
};
pub use certificate::{CertificateRecord, Gained, Worst};
pub use check::{Measured, RuleMeasured, StoredMeasured};
pub use pictured::Pictured;
pub use record::{InputRecord, Job, LevelRecord, MapEntry, MapFile, MapRecord, Place};
pub use sbrdf::{Ladder, MeasuredLobes, Normalisation, Residual, SbrdfRecord};

use super::{Event, MANIFEST, PipelineError, Progress, Settings};
use crate::cancel::{Cancel, Cancelled};
use crate::encode::{EncodeError, ReadError};
use crate::maps::sbrdf::tabulated::TableFault;
use crate::maps::{self, FilterError, TexelFault};
use crate::models::ParamError;
use crate::picture::PictureError;
use crate::plan::map::PlannedMap;
use crate::plan::{Plan, PlanError};
use std::path::PathBuf;
use std::time::Instant;

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
    /// A table that is no BRDF.
    #[error("{path}: {fault}")]
    Table {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        fault: TableFault,
    },
    /// A number of a lobe that a model does not take.
    #[error("conversion: {0}")]
    Lobe(#[from] ParamError),
    /// A file that is another one than when it was planned.
    #[error("{path} has changed since the map was planned; run it again")]
    Changed {
        /// The file.
        path: PathBuf,
    },
    /// The request cannot be.
    #[error(transparent)]
    Plan(#[from] PlanError),
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

/// A map alone: planned, made and written. `progress` is told of texels that are done and of their number.
///
/// # Errors
/// [`MapError`]; the output folder is then as it was.
pub fn run(
    request: &MapRequest,
    settings: &Settings,
    cancel: &Cancel,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<MapOutcome, MapError> {
    let plan = Plan::from_all(NAME, Vec::new(), vec![request.clone()])?;
    let files = plan.maps.iter().flat_map(PlannedMap::files).chain([MANIFEST.to_owned()]).collect();
    let outcome = match super::run(&plan, settings, cancel, &Told(progress)) {
        Err(PipelineError::Map { error, .. }) => return Err(*error),
        other => other?,
    };
    let Some(entry) = outcome.manifest.maps.into_iter().next() else {
        return Err(PlanError { faults: Vec::new() }.into());
    };
    Ok(MapOutcome { record: entry.record, files, written: outcome.written, unchanged: outcome.unchanged })
}

/// Name of the plan of a map alone.
const NAME: &str = "map";

/// Progress of the one map of a plan.
struct Told<'a>(&'a (dyn Fn(usize, usize) + Sync));

impl Progress for Told<'_> {
    fn event(&self, event: &Event<'_>) {
        if let Event::MapProgress { done, texels, .. } = event {
            (self.0)(*done, *texels);
        }
    }
}

/// A map ready to be written.
pub(super) struct Made {
    pub(super) entry: MapEntry,
    pub(super) files: Vec<(String, Vec<u8>)>,
}

/// Makes a map of the plan of this name.
pub(super) fn make(
    plan: &str,
    planned: &PlannedMap,
    index: usize,
    cancel: &Cancel,
    progress: &dyn Progress,
) -> Result<Made, MapError> {
    let (name, request, start) = (planned.name(), &planned.asked, Instant::now());
    progress.event(&Event::MapStarted { map: name, index, size: planned.size });
    let sources = input::read(planned, cancel)?;
    let tell = |done, texels| progress.event(&Event::MapProgress { map: name, index, done, texels });
    let levels = maps::filter(&sources.surface, &request.filter, cancel, &tell)?;
    let lobes = match (&request.sbrdf, &sources.target) {
        (Some(sbrdf), Some(target)) => {
            Some((sbrdf, sbrdf::find((request, sbrdf), target, (&sources.surface, &levels), cancel)?))
        }
        _ => None,
    };
    let maps = output::plan(request, &sources, &levels, lobes.as_ref().map(|l| &l.1), cancel)?;
    let measured = check::measure(request, &sources.surface, &levels, &maps, cancel)?;
    let mut record = record::record(plan, planned, &sources, &levels, measured);
    if let Some((sbrdf, found)) = &lobes {
        record.sbrdf = Some(found.record(request, sbrdf, &maps, cancel)?);
    }
    drop(lobes);
    let files = output::files(planned, &maps, &record, cancel)?;
    let told = record.levels.iter().map(|l| f64::from(l.largest)).fold(0.0, f64::max);
    let entry = record.with(&files);
    progress.event(&Event::MapFinished {
        map: name,
        index,
        levels: entry.record.levels.len(),
        largest: told,
        hopeless: entry.record.levels.iter().map(|l| l.hopeless).sum(),
        normals: &entry.record.normals,
        shape: &entry.record.shape,
        seconds: start.elapsed().as_secs_f64(),
    });
    Ok(Made { entry, files: files.into_iter().map(|f| (f.name, f.bytes)).collect() })
}
