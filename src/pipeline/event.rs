//! What a run tells while it works. One event is one line of `--message-format json`.

use super::{KeptIn, Outcome, Recovery};
use crate::grid::provenance::{ChoiceRecord, LawRecord, SizeRecord};
use crate::grid::table::Extreme;
use crate::plan::{Plan, PlannedMap, PlannedTable};
use crate::verify::Finding;
use serde::Serialize;
use std::path::Path;

/// Receives events. Implementations must not fail; a table's progress comes from several threads.
pub trait Progress: Sync {
    /// Something happened.
    fn event(&self, event: &Event<'_>);
}

/// Ignores everything.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn event(&self, _event: &Event<'_>) {}
}

/// Something that happened. Serialised with `reason` as its tag.
#[derive(Debug, Clone, Serialize)]
#[serde(tag = "reason", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Event<'a> {
    /// The plan, before work starts.
    Plan {
        /// Recipe name.
        recipe: &'a str,
        /// Tables in order.
        tables: Vec<PlanEntry<'a>>,
        /// Maps in order.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        maps: Vec<MapPlanEntry<'a>>,
    },
    /// Another run holds the output folder.
    Waiting {
        /// The folder.
        folder: &'a Path,
        /// How long this run waits at most.
        seconds: f64,
    },
    /// A killed run had left files in the output folder.
    Recovered {
        /// The folder.
        folder: &'a Path,
        /// What was done about them.
        recovery: Recovery,
    },
    /// Work on a table starts.
    TableStarted {
        /// Table name.
        table: &'a str,
        /// Its number in the plan.
        index: usize,
        /// Number of texels.
        texels: usize,
    },
    /// The size of a table was found.
    SizeFound {
        /// Table name.
        table: &'a str,
        /// Its number in the plan.
        index: usize,
        /// Texels along each axis, fastest first.
        size: Vec<usize>,
        /// Texture coordinate of each axis as a formula.
        coordinates: Vec<String>,
        /// What was asked for, and how it was found.
        #[serde(flatten)]
        record: &'a SizeRecord,
        /// Seconds spent.
        seconds: f64,
    },
    /// Steps of a phase of a table are done. Not part of the JSON stream.
    #[serde(skip)]
    TableProgress {
        /// Table name.
        table: &'a str,
        /// Its number in the plan.
        index: usize,
        /// What it is going through.
        phase: Phase,
        /// Steps done.
        done: usize,
        /// Steps in all; 0 where that is not known before the end.
        steps: usize,
    },
    /// A table is baked, verified and encoded (not yet written).
    TableFinished {
        /// Table name.
        table: &'a str,
        /// Its number in the plan.
        index: usize,
        /// Tolerance asked for.
        tolerance: f64,
        /// Largest estimated integration error.
        integration: Extremum<'a>,
        /// Largest rounding error, for each output.
        encoding: Vec<(String, f64)>,
        /// Largest and mean reconstruction error, for each output, over the whole and the practical domain.
        reconstruction: Vec<ReconstructionEntry>,
        /// Integrand evaluations.
        evaluations: u64,
        /// Texels that missed the tolerance.
        missed: u64,
        /// What came of every law.
        laws: &'a [LawRecord],
        /// Is every texel within the tolerance?
        tolerance_met: bool,
        /// No law broken or waived, the tolerance met, and a law that says what the numbers mean held.
        verified: bool,
        /// Seconds spent on integration.
        bake_seconds: f64,
        /// Seconds spent on laws, rounding and the comparison between texels.
        check_seconds: f64,
    },
    /// A table is not baked: its files are there, and what was found when they were baked holds.
    TableKept {
        /// Table name.
        table: &'a str,
        /// Its number in the plan.
        index: usize,
        /// Where they were.
        from: KeptIn,
        /// Texels that missed the tolerance.
        missed: u64,
        /// What came of every law.
        laws: &'a [LawRecord],
        /// As in [`Event::TableFinished`].
        verified: bool,
    },
    /// A map is not made: its files are there.
    MapKept {
        /// Map name.
        map: &'a str,
        /// Its number in the plan.
        index: usize,
        /// Where they were.
        from: KeptIn,
    },
    /// The cache could not be written; the bake goes on without it.
    CacheFault {
        /// Its folder.
        folder: &'a Path,
        /// The system's message.
        message: String,
    },
    /// Work on a map starts.
    MapStarted {
        /// Map name.
        map: &'a str,
        /// Its number in the plan.
        index: usize,
        /// Width and height of its first level.
        size: [usize; 2],
    },
    /// Texels of a map are done. Not part of the JSON stream.
    #[serde(skip)]
    MapProgress {
        /// Map name.
        map: &'a str,
        /// Its number in the plan.
        index: usize,
        /// Texels done.
        done: usize,
        /// Texels of all levels.
        texels: usize,
    },
    /// A map is filtered, measured and encoded (not yet written).
    MapFinished {
        /// Map name.
        map: &'a str,
        /// Its number in the plan.
        index: usize,
        /// Levels.
        levels: usize,
        /// Largest D of a texel.
        largest: f64,
        /// Texels with D of 0.5 and more.
        hopeless: usize,
        /// `mean` or `fit`.
        normals: &'a str,
        /// `isotropic` or `anisotropic`.
        shape: &'a str,
        /// Seconds spent.
        seconds: f64,
    },
    /// A finding that does not stop the run: a waived law, one that could not be checked, a missed tolerance.
    Finding {
        /// Table name.
        table: &'a str,
        /// The finding.
        #[serde(flatten)]
        finding: &'a Finding,
    },
    /// Everything is written.
    Summary {
        /// Number of tables.
        tables: usize,
        /// Number of maps.
        maps: usize,
        /// Where they are.
        folder: &'a Path,
        /// Files that are new or changed.
        written: usize,
        /// Files that had the same bytes already.
        unchanged: usize,
        /// Tables and maps that were not baked, since their files were there.
        kept: usize,
        /// Bytes in all files.
        bytes: u64,
        /// Seconds in all.
        seconds: f64,
    },
}

/// What a table goes through, and what its steps are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Its size is searched; nobody knows how many tables will be tried.
    Size,
    /// Texels are integrated.
    Bake,
    /// Laws are checked.
    Laws,
    /// Texels are fitted to the reader: points of the truth.
    Fit,
    /// What is read between the texels: points that are compared.
    Between,
}

impl Phase {
    /// In a word or two.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Phase::Size => "size",
            Phase::Bake => "bake",
            Phase::Laws => "laws",
            Phase::Fit => "fit",
            Phase::Between => "between texels",
        }
    }
}

/// A table of the plan.
#[derive(Debug, Clone, Serialize)]
pub struct PlanEntry<'a> {
    /// Table name.
    pub name: &'a str,
    /// Table kind.
    pub kind: &'a str,
    /// Model, if it has one.
    pub model: Option<&'a str>,
    /// Texels along each axis, fastest first; 0 where the length is to be found.
    pub size: Vec<usize>,
    /// Tolerance.
    pub tolerance: f64,
    /// Files that will be written.
    pub files: Vec<String>,
    /// Hash of its resolved recipe.
    pub hash: &'a str,
    /// Most bytes of memory that it takes.
    pub memory: u64,
}

/// A map of the plan.
#[derive(Debug, Clone, Serialize)]
pub struct MapPlanEntry<'a> {
    /// Map name.
    pub name: &'a str,
    /// Width and height of its first level.
    pub size: [usize; 2],
    /// Files that will be written.
    pub files: Vec<String>,
    /// Hash of what was asked and of its images.
    pub hash: &'a str,
    /// Most bytes of memory that it takes.
    pub memory: u64,
}

/// The largest of something, borrowed.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Extremum<'a> {
    /// The value.
    pub largest: f64,
    /// Channel.
    pub channel: &'a str,
    /// Axis ids and values.
    pub at: &'a [(String, f64)],
}

impl<'a> From<&'a Extreme> for Extremum<'a> {
    fn from(e: &'a Extreme) -> Self {
        Extremum { largest: e.value, channel: &e.channel, at: &e.at }
    }
}

/// Reconstruction errors of one output.
#[derive(Debug, Clone, Serialize)]
pub struct ReconstructionEntry {
    /// `container:storage`.
    pub output: String,
    /// Largest over the whole domain.
    pub whole: f64,
    /// Mean over the whole domain.
    pub whole_mean: f64,
    /// Largest over the practical domain.
    pub practical: Option<f64>,
    /// Mean over the practical domain.
    pub practical_mean: Option<f64>,
    /// Where it is far above the tolerance: what would mend it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub advice: Vec<String>,
    /// Where texels are fitted: the same for each choice, in the order `exact`, `least-squares`, `minimax`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub choices: Vec<ChoiceEntry>,
}

/// Reconstruction errors of one choice of texels.
#[derive(Debug, Clone, Serialize)]
pub struct ChoiceEntry {
    /// `exact`, `least-squares` or `minimax`.
    pub texels: String,
    /// Largest over the whole domain.
    pub whole: f64,
    /// Mean over the whole domain.
    pub whole_mean: f64,
    /// Largest over the practical domain.
    pub practical: Option<f64>,
    /// Mean over the practical domain.
    pub practical_mean: Option<f64>,
}

impl From<&ChoiceRecord> for ChoiceEntry {
    fn from(c: &ChoiceRecord) -> Self {
        ChoiceEntry {
            texels: c.texels.clone(),
            whole: c.whole.largest.value,
            whole_mean: c.whole.mean,
            practical: c.practical.as_ref().map(|p| p.largest.value),
            practical_mean: c.practical.as_ref().map(|p| p.mean),
        }
    }
}

/// Texels along each axis; 0 where the length is to be found.
fn lengths(table: &PlannedTable) -> Vec<usize> {
    let searched = |i: &usize| table.asked.size.as_ref().is_some_and(|s| s.axes.contains(i));
    let axes = table.bound.spec.grid.axes().iter().enumerate();
    axes.map(|(i, a)| if searched(&i) { 0 } else { a.len }).collect()
}

impl<'a> Event<'a> {
    pub(super) fn plan(plan: &'a Plan) -> Event<'a> {
        let tables = plan
            .tables
            .iter()
            .map(|t| PlanEntry {
                name: t.name(),
                kind: t.bound.spec.kind.id,
                model: t.bound.spec.model.as_ref().map(|(m, _)| m.id),
                size: lengths(t),
                tolerance: t.tolerance,
                files: t.files(),
                hash: &t.identity,
                memory: super::memory::table(t),
            })
            .collect();
        let map = |m: &'a PlannedMap| MapPlanEntry {
            name: m.name(),
            size: m.size,
            files: m.files(),
            hash: &m.identity,
            memory: super::memory::map(m),
        };
        Event::Plan { recipe: &plan.name, tables, maps: plan.maps.iter().map(map).collect() }
    }

    pub(super) fn summary(outcome: &Outcome, folder: &'a Path, seconds: f64) -> Event<'a> {
        let manifest = &outcome.manifest;
        let tables = manifest.tables.iter().flat_map(|t| &t.files).map(|f| f.bytes);
        let maps = manifest.maps.iter().flat_map(|m| &m.files).map(|f| f.bytes);
        Event::Summary {
            tables: manifest.tables.len(),
            maps: manifest.maps.len(),
            folder,
            written: outcome.written,
            unchanged: outcome.unchanged,
            kept: outcome.kept,
            bytes: tables.chain(maps).sum(),
            seconds,
        }
    }
}
