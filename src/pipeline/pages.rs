//! Reports: of a bake while it runs, with all that it knows of its texels; and of a folder, with what its files say and a sample that is
//! integrated anew.

use super::map::MapEntry;
use super::pages_map::{self, told};
use super::{Companion, MANIFEST, Manifest, Seen, TableRecord, transaction::is_plain};
use crate::cancel::{Cancel, Cancelled};
use crate::encode::read::{self, Image};
use crate::grid::provenance::SCHEMA;
use crate::grid::{Grid, Provenance, Table};
use crate::plan::Plan;
use crate::report::page::{self, Against, Convergence, FileView, Head, Origin, Section, Texels, View};
use crate::tables::Bound;
use crate::tables::driver::bake_again;
use crate::tables::spec::Request;
use crate::verify::converge::{self, ConvergeError, converge};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// Evaluations that a table may take when it is integrated anew for a report.
pub const EVALUATIONS: u64 = 20_000_000;
/// Texels that are integrated anew in any case.
const LEAST: usize = 16;
/// Texels of the chart of error against evaluations, and the power of two of its largest budget.
const CHART: (usize, u32) = (24, 12);
/// Evaluations of a texel, on average, beyond which there is no such chart: it asks for much smaller errors than the bake.
const COSTLY: u64 = 20_000;

/// Makes the report of a bake as its tables come.
#[derive(Debug, Default)]
pub struct Collector {
    /// Show how long it took?
    pub timings: bool,
    sections: Vec<Section>,
}

impl Collector {
    /// Without, or with, a section of times.
    #[must_use]
    pub fn new(timings: bool) -> Collector {
        Collector { timings, sections: Vec::new() }
    }
}

impl Companion for Collector {
    fn names(&self, plan: &Plan) -> Vec<String> {
        let units = plan.tables.len() + plan.maps.len();
        std::iter::once(page::NAME.to_owned()).chain((0..units).map(page::page_of)).collect()
    }

    fn table(&mut self, record: &TableRecord, seen: Seen, cancel: &Cancel) -> Result<(), Cancelled> {
        let Seen { table, stored, seconds } = seen;
        let file = record.files.first().map_or_else(String::new, |f| f.file.clone());
        let texels = Texels {
            grid: table.grid,
            file,
            stored,
            integrals: table.values,
            estimates: table.errors,
            evaluations: table.evaluations,
            origin: Origin::Bake,
        };
        let mut view = view(record, Ok(texels), self.timings.then_some(seconds), None);
        view.convergence = convergence(&record.provenance, self.timings, cancel)?;
        self.sections.push(page::section(&view, None));
        Ok(())
    }

    fn map(
        &mut self,
        entry: &MapEntry,
        files: &[(String, Vec<u8>)],
        cancel: &Cancel,
    ) -> Result<(), Cancelled> {
        let bytes = |name: &str| {
            let found = files.iter().find(|(file, _)| file == name);
            found.map(|(_, bytes)| bytes.clone()).ok_or_else(|| "not written".to_owned())
        };
        self.sections.push(page::map_section(&pages_map::view(entry, &bytes, cancel)?));
        Ok(())
    }

    fn finish(&mut self, manifest: &Manifest) -> Vec<(String, Vec<u8>)> {
        page::pages(&head(manifest), &self.sections)
    }
}

/// Why there is no report of a folder.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReportError {
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// The manifest cannot be read.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's message.
        #[source]
        source: std::io::Error,
    },
    /// It is not the manifest of a bake of tables.
    #[error("{path} is not the manifest of a bake of tables: {message}")]
    Manifest {
        /// The file.
        path: PathBuf,
        /// Why not.
        message: String,
    },
}

/// What is shown of a folder.
#[derive(Debug, Clone)]
pub struct Asked<'a> {
    /// Another folder to compare with, and what the page calls it.
    pub against: Option<(&'a Path, &'a str)>,
    /// Evaluations that each table may take when it is integrated anew; 0 for none.
    pub evaluations: u64,
    /// Show error against time?
    pub timings: bool,
}

/// The report of a folder: names and bytes of its pages.
///
/// # Errors
/// [`ReportError`] if there is no manifest that can be read; a file that cannot is told in the page.
pub fn of_folder(
    folder: &Path,
    asked: &Asked<'_>,
    cancel: &Cancel,
) -> Result<Vec<(String, Vec<u8>)>, ReportError> {
    let manifest = manifest(folder)?;
    let other = match asked.against {
        Some((folder, name)) => Some((self::manifest(folder)?, folder, name)),
        None => None,
    };
    let mut head = head(&manifest);
    if let Some((b, _, name)) = &other {
        let only = b.tables.iter().map(|t| &t.provenance.name);
        let only = only.filter(|n| manifest.tables.iter().all(|t| t.provenance.name != **n)).cloned();
        head.against = Some(((*name).to_owned(), only.collect()));
    }
    let mut sections = Vec::new();
    for record in &manifest.tables {
        cancel.check()?;
        let texels = match table(folder, record, cancel) {
            Ok((table, file)) => Ok(again(&record.provenance, table, file, asked.evaluations, cancel)?),
            Err(why) => Err(why),
        };
        let mut against = None;
        if let Some((b, folder, _)) = &other
            && let Some(record) = b.tables.iter().find(|t| t.provenance.name == record.provenance.name)
        {
            let table = table(folder, record, cancel).map(|(table, _)| table);
            against = Some(Against { provenance: record.provenance.clone(), table });
        }
        cancel.check()?;
        let mut view = view(record, texels, None, against);
        if asked.evaluations > 0 {
            view.convergence = convergence(&record.provenance, asked.timings, cancel)?;
        }
        sections.push(page::section(&view, other.as_ref().map(|(.., name)| *name)));
    }
    for entry in &manifest.maps {
        let bytes = |name: &str| read::load_until(cancel, &folder.join(name)).map_err(told);
        sections.push(page::map_section(&pages_map::view(entry, &bytes, cancel)?));
    }
    Ok(page::pages(&head, &sections))
}

fn manifest(folder: &Path) -> Result<Manifest, ReportError> {
    let path = folder.join(MANIFEST);
    let bytes = std::fs::read(&path).map_err(|source| ReportError::Io { path: path.clone(), source })?;
    let manifest: Result<Manifest, _> = serde_json::from_slice(&bytes);
    let fault = |message: String| ReportError::Manifest { path: path.clone(), message };
    let manifest = manifest.map_err(|e| fault(e.to_string()))?;
    if manifest.schema > SCHEMA {
        let read =
            format!("it is of version {}; this program reads versions up to {SCHEMA}", manifest.schema);
        return Err(fault(read));
    }
    Ok(manifest)
}

fn head(manifest: &Manifest) -> Head {
    Head {
        recipe: manifest.recipe.clone(),
        hash: manifest.hash.clone(),
        tool: manifest.tool.clone(),
        scenes: manifest.scenes.clone(),
        stale: manifest.stale.clone(),
        against: None,
    }
}

fn view(
    record: &TableRecord,
    texels: Result<Texels, String>,
    seconds: Option<[f64; 2]>,
    against: Option<Against>,
) -> View {
    let file = |f: &super::FileRecord| FileView {
        file: f.file.clone(),
        container: f.container.clone(),
        bytes: f.bytes,
        encoding: f.encoding.clone(),
        reconstruction: f.reconstruction.clone(),
        texels: f.texels.clone(),
    };
    View {
        provenance: record.provenance.clone(),
        files: record.files.iter().map(file).collect(),
        texels,
        seconds,
        against,
        convergence: Err("not asked for".to_owned()),
    }
}

/// Error against evaluations of a table, or why it is not drawn.
fn convergence(
    p: &Provenance,
    timings: bool,
    cancel: &Cancel,
) -> Result<Result<Convergence, String>, Cancelled> {
    let texels: usize = p.axes.iter().map(|r| r.axis.len).product();
    let each = p.integration.evaluations / texels.max(1) as u64;
    if each > COSTLY {
        return Ok(Err(format!("a texel takes {each} evaluations; `converge` draws it")));
    }
    let bound = match bind(p) {
        Ok(bound) => bound,
        Err(why) => return Ok(Err(why)),
    };
    let (texels, power) = CHART;
    match converge(&bound, converge::Asked { seed: 1, texels, power, cancel }) {
        Ok((chart, times)) => Ok(Ok(Convergence { chart, times: timings.then_some(times) })),
        Err(ConvergeError::Cancelled(stopped)) => Err(stopped),
        Err(why) => Ok(Err(why.to_string())),
    }
}

/// The numbers of a table from the first of its files that is read, and which that is; or why there are none.
fn table(folder: &Path, record: &TableRecord, cancel: &Cancel) -> Result<(Table, String), String> {
    let mut why = vec!["the manifest names no file".to_owned()];
    for file in &record.files {
        if !is_plain(&file.file) {
            why.push(format!("`{}` is not the name of a file in the folder", file.file));
            continue;
        }
        match read::read_file_until(cancel, &folder.join(&file.file)) {
            Ok(image) => match texels(&record.provenance, &image) {
                Ok(table) => return Ok((table, file.file.clone())),
                Err(fault) => why.push(format!("{}: {fault}", file.file)),
            },
            Err(fault) => why.push(format!("{}: {}", file.file, told(fault))),
        }
    }
    Err(if why.len() > 1 { why[1..].join("; ") } else { why.remove(0) })
}

/// The numbers of a picture as those of a table.
fn texels(p: &Provenance, image: &Image) -> Result<Table, String> {
    let grid = Grid::new(p.axes.iter().map(|r| r.axis.clone()).collect()).map_err(|e| e.to_string())?;
    let [x, y, z] = grid.extent();
    if (image.width, image.height) != (x, y * z) {
        return Err(format!(
            "it has {} x {} pixels, the manifest tells of {x} x {}",
            image.width,
            image.height,
            y * z
        ));
    }
    let planes: Option<Vec<_>> = p.channels.iter().map(|c| image.channel(&c.id)).collect();
    let planes = planes.ok_or("its channels are not those of the manifest")?;
    let values = (0..grid.len()).flat_map(|t| planes.iter().map(move |plane| plane.values[t])).collect();
    Ok(Table { grid, channels: p.channels.clone(), values, errors: Vec::new(), evaluations: Vec::new() })
}

/// What was baked, bound anew from what its files say.
fn bind(p: &Provenance) -> Result<Bound, String> {
    Request::recorded(p).bind().map_err(|e| e.to_string())
}

/// Integrates as many texels anew as the evaluations allow, spread evenly.
fn again(
    p: &Provenance,
    table: Table,
    file: String,
    evaluations: u64,
    cancel: &Cancel,
) -> Result<Texels, Cancelled> {
    let n = table.channels.len();
    let len = table.grid.len();
    let mut texels = Texels {
        integrals: vec![f64::NAN; len * n],
        estimates: vec![f64::NAN; len * n],
        evaluations: Vec::new(),
        origin: Origin::None { why: "not asked for".to_owned() },
        grid: table.grid,
        stored: table.values,
        file,
    };
    if evaluations == 0 {
        return Ok(texels);
    }
    let bound = match bind(p) {
        Ok(bound) => bound,
        Err(why) => {
            texels.origin = Origin::None { why };
            return Ok(texels);
        }
    };
    let each = p.integration.evaluations / len.max(1) as u64 + 1;
    let most = usize::try_from(evaluations / each).unwrap_or(usize::MAX).max(LEAST).min(len);
    let step = len.div_ceil(most);
    let chosen: Vec<usize> = (0..len).step_by(step).collect();
    let tolerance = p.integration.tolerance;
    let fresh = chosen.par_iter().map(|&t| {
        cancel.check()?;
        Ok(bake_again(&bound, t, tolerance))
    });
    let fresh: Vec<_> = fresh.collect::<Result<_, Cancelled>>()?;
    let mut done = 0;
    let mut why = String::new();
    for (t, estimate) in chosen.into_iter().zip(fresh) {
        match estimate {
            Ok(e) => {
                texels.integrals[t * n..(t + 1) * n].copy_from_slice(&e.value[..n]);
                texels.estimates[t * n..(t + 1) * n].copy_from_slice(&e.error[..n]);
                done += 1;
            }
            Err(e) => why = e.of(p.channels.iter().map(|c| c.id.as_str())),
        }
    }
    texels.origin = if done > 0 { Origin::Again { texels: done } } else { Origin::None { why } };
    Ok(texels)
}
