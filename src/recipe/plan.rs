//! A resolved recipe: tables that are bound to their bakers, with everything that was left to a default filled in.

use super::bind;
use super::canonical;
use super::document::{Document, Entry};
use super::fault::{Fault, Faults};
use super::outputs::{self, Output};
use super::section::unknown_word;
use super::sizing::Sizing;
use super::{TOLERANCE, name, probe};
use crate::grid::fit::Texels;
use crate::grid::provenance::{SizeRecord, Waiver};
use crate::tables::driver::OnMiss;
use crate::tables::spec::Request;
use crate::tables::{Bound, Setting, TableInfo};
use crate::verify;
use serde_json::Value as Json;
use std::collections::HashSet;

/// What to bake, checked: every name is known, every number in its range, every table bound.
#[derive(Debug)]
pub struct Plan {
    /// Name of the recipe.
    pub name: String,
    /// Name and tables with all defaults filled in; the same for recipes that mean the same.
    pub canonical: Json,
    /// blake3 of the canonical form and the program version, in hex.
    pub hash: String,
    /// The tables, in the order of the recipe.
    pub tables: Vec<PlannedTable>,
}

/// A table of a [`Plan`].
#[derive(Debug)]
pub struct PlannedTable {
    /// Stem of its file names; portable, and unique in the plan without regard to case.
    pub name: String,
    /// Name of its one file, if the recipe names it. Tables that name the same file follow each other in it.
    pub file: Option<String>,
    /// Text before and behind the numbers of that file.
    pub around: [Option<String>; 2],
    /// Kind, layout, model, parameters, axes and baker.
    pub bound: Bound,
    /// Absolute tolerance of each channel, within [`TOLERANCE`].
    pub tolerance: f64,
    /// What to do with a texel that misses the tolerance.
    pub on_miss: OnMiss,
    /// Files to write: at least one, none twice.
    pub outputs: Vec<Output>,
    /// Measure the error of a reader between texels?
    pub reconstruction: bool,
    /// What its size must achieve, if that is to be found; the axes then have lengths that stand in.
    pub size: Option<Sizing>,
    /// What its texels hold.
    pub texels: Texels,
    /// How its size was found, once it is.
    pub found: Option<SizeRecord>,
    /// Laws that it may break, in the order of [`LAWS`](crate::verify::LAWS).
    pub waivers: Vec<Waiver>,
    /// Everything above that the recipe decides, under the keys of a recipe, in fixed order.
    pub canonical: Json,
    /// blake3 of the canonical form and the program version, in hex. The name of the recipe is not in it; that of the
    /// table is.
    pub hash: String,
}

impl PlannedTable {
    /// The same table on a grid of the size that was found. The recipe, and so the hash, remain what they were.
    #[must_use]
    pub fn sized(&self, bound: Bound, found: SizeRecord) -> PlannedTable {
        PlannedTable {
            name: self.name.clone(),
            file: self.file.clone(),
            around: self.around.clone(),
            bound,
            tolerance: self.tolerance,
            on_miss: self.on_miss,
            outputs: self.outputs.clone(),
            reconstruction: self.reconstruction,
            size: self.size.clone(),
            texels: self.texels,
            found: Some(found),
            waivers: self.waivers.clone(),
            canonical: self.canonical.clone(),
            hash: self.hash.clone(),
        }
    }
}

/// A table asked for by a program instead of a file.
#[derive(Debug, Clone)]
pub struct TableRequest {
    /// Stem of its file names.
    pub name: String,
    /// Kind, layout, model, parameters, axes.
    pub request: Request,
    /// Absolute tolerance; half a step of the finest storage if none.
    pub tolerance: Option<f64>,
    /// What to do with a texel that misses it.
    pub on_miss: OnMiss,
    /// Files to write; at least one.
    pub outputs: Vec<Output>,
    /// Measure the error of a reader between texels?
    pub reconstruction: bool,
    /// What its size must achieve. With axes in the request, [`Sizing::axes`] are those whose lengths stand in.
    pub size: Option<Sizing>,
    /// What its texels hold.
    pub texels: Texels,
    /// Laws that it may break.
    pub waivers: Vec<Waiver>,
}

impl TableRequest {
    /// A request with the defaults of a recipe: half precision EXR, default tolerance, reconstruction measured where texels are blended.
    #[must_use]
    pub fn new(name: impl Into<String>, request: Request) -> TableRequest {
        let reconstruction = crate::tables::find(&request.kind).is_none_or(|kind| kind.blended);
        TableRequest {
            name: name.into(),
            request,
            tolerance: None,
            on_miss: OnMiss::Fail,
            outputs: vec![outputs::default()],
            reconstruction,
            size: None,
            texels: Texels::default(),
            waivers: Vec::new(),
        }
    }
}

/// Why requests make no plan: every fault with the path of its key, such as `table[0].outputs[1]`.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanError {
    /// Paths and faults, in the order of the requests.
    pub faults: Vec<(String, Fault)>,
}

impl std::fmt::Display for PlanError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, (path, fault)) in self.faults.iter().enumerate() {
            write!(f, "{}{path}: {fault}", if i > 0 { "\n" } else { "" })?;
            for more in [fault.allowed(), fault.remedy()].into_iter().flatten() {
                write!(f, "; {more}")?;
            }
        }
        Ok(())
    }
}

impl std::error::Error for PlanError {}

impl Plan {
    /// Resolves requests that a program makes, by the same rules as a file.
    ///
    /// # Errors
    /// [`PlanError`] with every fault.
    pub fn from_requests(name: &str, tables: Vec<TableRequest>) -> Result<Plan, PlanError> {
        let mut faults = Faults::default();
        let count = tables.len();
        if count == 0 || count > super::MAX_TABLES {
            let allowed = format!("1 to {}", super::MAX_TABLES);
            faults.key("table", Fault::Count { key: "table", got: count, allowed });
        }
        let tables =
            tables.into_iter().take(super::MAX_TABLES).enumerate().map(|(i, t)| entry(i, t)).collect();
        let document = Document { name: Some(name.to_owned()), tolerance: None, tables };
        match resolve(document, &mut faults) {
            Some(plan) if faults.is_empty() => Ok(plan),
            _ => Err(PlanError { faults: faults.list.into_iter().map(|(p, f)| (p.path, f)).collect() }),
        }
    }
}

impl Plan {
    /// One plan with the tables of several, in order.
    ///
    /// # Errors
    /// [`PlanError`] if there are no tables, too many, or two of the same name.
    pub fn join(name: &str, plans: Vec<Plan>) -> Result<Plan, PlanError> {
        let tables: Vec<PlannedTable> = plans.into_iter().flat_map(|p| p.tables).collect();
        let fault = |path: &str, fault| Err(PlanError { faults: vec![(path.to_owned(), fault)] });
        if tables.is_empty() || tables.len() > super::MAX_TABLES {
            let allowed = format!("1 to {}", super::MAX_TABLES);
            return fault("table", Fault::Count { key: "table", got: tables.len(), allowed });
        }
        let mut taken = HashSet::new();
        for (i, table) in tables.iter().enumerate() {
            if !taken.insert(table.name.to_ascii_lowercase()) {
                return fault(
                    &format!("table[{i}].name"),
                    Fault::Twice {
                        what: "table name",
                        got: table.name.clone(),
                        why: "two plans have it".to_owned(),
                    },
                );
            }
        }
        let canonical = canonical::plan(name, &tables);
        let hash = canonical::hash(&canonical);
        Ok(Plan { name: name.to_owned(), canonical, hash, tables })
    }
}

fn entry(i: usize, table: TableRequest) -> Entry {
    let Request { kind, layout, channels, model, params, axes } = table.request;
    Entry {
        path: format!("table[{i}]"),
        name: Some(table.name),
        file: None,
        around: [None, None],
        kind: Some(kind),
        layout,
        channels: channels.map(|c| c.into_iter().map(Some).collect()),
        model,
        params,
        tolerance: table.tolerance,
        outputs: Some(table.outputs.into_iter().map(Some).collect()),
        on_miss: table.on_miss,
        reconstruction: Some(table.reconstruction),
        size: table.size,
        texels: table.texels,
        waivers: table.waivers.into_iter().map(Some).collect(),
        axes: axes.map(|axes| axes.into_iter().map(Some).collect()),
    }
}

/// Resolves a document. None if a part of it is missing; the faults say which.
pub(super) fn resolve(document: Document, faults: &mut Faults) -> Option<Plan> {
    if let Some(fault) = document.name.as_deref().and_then(name::recipe) {
        faults.value("name", fault);
    }
    check_tolerance(document.tolerance, "tolerance".to_owned(), faults);
    name::files(&document.tables, faults);
    let mut taken = HashSet::new();
    let tables: Vec<Option<PlannedTable>> = document
        .tables
        .into_iter()
        .map(|entry| {
            check_name(&entry, &mut taken, faults);
            table(entry, document.tolerance, faults)
        })
        .collect();
    let tables: Vec<PlannedTable> = tables.into_iter().collect::<Option<_>>()?;
    let name = document.name?;
    let canonical = canonical::plan(&name, &tables);
    let hash = canonical::hash(&canonical);
    Some(Plan { name, canonical, hash, tables })
}

fn check_name(entry: &Entry, taken: &mut HashSet<String>, faults: &mut Faults) {
    let Some(name) = &entry.name else { return };
    let path = format!("{}.name", entry.path);
    if let Some(fault) = name::table(name) {
        faults.value(path, fault);
        return;
    }
    let mut stems = vec![name.to_ascii_lowercase()];
    // two storages in one container: their files are told apart by `name.storage`
    let outputs: Vec<&Output> = entry.outputs.iter().flatten().flatten().collect();
    for output in &outputs {
        if outputs.iter().any(|o| o.container == output.container && o.storage != output.storage) {
            stems.push(format!("{name}.{}", output.storage).to_ascii_lowercase());
        }
    }
    stems.sort();
    stems.dedup();
    if let Some(stem) = stems.iter().find(|stem| taken.contains(*stem)) {
        let why = "file names must differ by more than case".to_owned();
        faults.value(path, Fault::Twice { what: "table name", got: stem.clone(), why });
    }
    taken.extend(stems);
}

fn table(entry: Entry, tolerance: Option<f64>, faults: &mut Faults) -> Option<PlannedTable> {
    let before = faults.len();
    check_tolerance(entry.tolerance, format!("{}.tolerance", entry.path), faults);
    let (outputs, stored) = outputs::resolve(&entry, faults);
    let bound = bind::bind(&entry, faults);
    let kind = entry.kind.as_deref().and_then(crate::tables::find);
    let waivers = kind.map(|kind| waivers(&entry, kind, faults));
    outputs::check_file(&entry, &outputs, faults);
    if let Some(bound) = &bound {
        outputs::check(&entry, bound, &stored, faults);
    }
    if faults.len() > before {
        return None;
    }
    let (path, listed) = (entry.path.clone(), entry.outputs.is_some());
    let finest = stored.iter().flatten().map(|s| s.half_step).fold(f64::INFINITY, f64::min);
    let bound = bound?;
    let spec = &bound.spec;
    let (kind, setting) =
        (spec.kind, Setting { layout: &spec.layout, model: spec.model.as_ref().map(|m| m.0) });
    let least = (kind.least_tolerance)(&setting);
    let mut planned = PlannedTable {
        name: entry.name?,
        file: entry.file,
        around: entry.around,
        bound,
        tolerance: entry.tolerance.or(tolerance).unwrap_or(finest.max(least)),
        on_miss: entry.on_miss,
        outputs,
        reconstruction: entry.reconstruction.unwrap_or(kind.blended),
        size: None,
        texels: entry.texels,
        found: None,
        waivers: waivers?,
        canonical: Json::Null,
        hash: String::new(),
    };
    planned.size = entry.size.map(|mut size| {
        if entry.axes.is_none() {
            // the kind's own axes: all of them
            size.axes = (0..planned.bound.spec.grid.axes().len()).collect();
        }
        size
    });
    let before = faults.len();
    probe::look(&path, [listed, entry.axes.is_none()], &planned, faults);
    if faults.len() > before {
        return None;
    }
    planned.canonical = canonical::table(&planned);
    planned.hash = canonical::hash(&planned.canonical);
    Some(planned)
}

fn check_tolerance(tolerance: Option<f64>, path: String, faults: &mut Faults) {
    let [min, max] = TOLERANCE;
    if let Some(got) = tolerance.filter(|t| !(min..=max).contains(t)) {
        faults.value(path, Fault::Range { key: "tolerance".to_owned(), got, min, max });
    }
}

/// The waivers in the order of the laws.
fn waivers(entry: &Entry, kind: &'static TableInfo, faults: &mut Faults) -> Vec<Waiver> {
    let mut known: Vec<Waiver> = Vec::new();
    for (i, waiver) in entry.waivers.iter().enumerate() {
        let Some(waiver) = waiver else { continue };
        let law = waiver.law.as_str();
        let fault = if verify::find(law).is_none() {
            unknown_word("law", law, verify::LAWS.iter().map(|l| l.id))
        } else if !kind.laws.contains(&law) {
            Fault::IdleWaiver { kind: kind.id, law: law.to_owned(), allowed: kind.laws.join(", ") }
        } else if known.iter().any(|w| w.law == law) {
            let why = "one waiver a law is enough".to_owned();
            Fault::Twice { what: "waiver of law", got: law.to_owned(), why }
        } else if waiver.reason.trim().is_empty() {
            let path = format!("{}.waive[{i}].reason", entry.path);
            let limit = super::section::LONGEST_TEXT;
            faults.value(path, Fault::TextLength { key: "reason".to_owned(), got: 0, limit });
            continue;
        } else {
            known.push(waiver.clone());
            continue;
        };
        faults.value(format!("{}.waive[{i}].law", entry.path), fault);
    }
    known.sort_by_key(|w| verify::LAWS.iter().position(|l| l.id == w.law));
    known
}
