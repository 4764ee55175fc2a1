//! `bake --engine NAME --suggest`: the smallest table that an engine could read instead of its own, for an error.
//!
//! An engine whose shader can be told new lines is not bound to its axes. For each of its split sums the search of
//! `size` runs over the warps of both axes, for the channels that the shader reads now and, in floats, for the
//! layout `factored`, which both decode to the same. What takes the fewest bytes is written as a recipe, and that
//! recipe is baked and measured: the numbers are those of the text that is printed.

use super::{PipelineError, Reached, Silent, size, table};
use crate::cancel::Cancel;
use crate::encode::code::reader::{self, Decode};
use crate::encode::{self, FileOption, Storage};
use crate::grid::provenance::Reconstruction;
use crate::grid::{Axis, Direction, Grid, Texel, Warp};
use crate::models::Params;
use crate::plan::{Output, Plan, PlannedTable, Sizing, TableRequest};
use crate::recipe::{self, Engine, Reader};
use crate::tables::ModelUse;
use crate::tables::default_axes::LEAST_ROUGHNESS;
use crate::tables::spec::Request;
use serde::Serialize;
use std::collections::BTreeMap;

/// Part of the error that integration may have.
const SHARE: f64 = 0.02;

/// What is taken where the engine's own storage is too coarse.
fn finer(channels: usize) -> Output {
    let half = Output::new(&encode::ktx2::Ktx2, Storage::Half);
    if channels == 3 { half.with(FileOption::Rgba) } else { half }
}

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Want {
    /// Largest error as a shader reads it.
    pub error: f64,
    /// Only where mu >= 0.05 and roughness >= 0.09?
    pub practical: bool,
    /// Longest axis to try.
    pub longest: usize,
}

/// A table, what it takes, and how it reads.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Size {
    /// Texels along the axes.
    pub texels: Vec<usize>,
    /// Container, storage and options.
    pub output: String,
    /// Bytes of the texels, before any supercompression.
    pub bytes: usize,
    /// Bytes of the file.
    pub file_bytes: u64,
    /// Largest and mean error over the whole domain of the table.
    pub whole: [f64; 2],
    /// The same where mu >= 0.05 and roughness >= 0.09.
    pub practical: Option<[f64; 2]>,
}

/// The table that was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SuggestedSize {
    /// What it takes and how it reads.
    pub size: Size,
    /// The recipe that bakes it.
    pub recipe: String,
    /// Language of the lines.
    pub language: &'static str,
    /// Lines that turn mu and roughness into texture coordinates, and the texel into values.
    pub lines: String,
}

/// What is suggested for one table of an engine.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Suggestion {
    /// Name of the table.
    pub table: String,
    /// The engine's own, baked by this program.
    pub own: Option<Size>,
    /// The table in its place.
    pub found: Option<SuggestedSize>,
    /// Why there is none; or what to know of it.
    pub notes: Vec<String>,
}

/// Suggestions for every table of an engine, in order. Nothing is written.
///
/// # Errors
/// [`PipelineError`] for a cancelled run or a table that cannot be baked. An error out of reach is no failure: the
/// suggestion then says what was reached.
pub fn suggest(
    engine: &Engine,
    plan: &Plan,
    want: Want,
    cancel: &Cancel,
) -> Result<Vec<Suggestion>, PipelineError> {
    suggest_within(engine, plan, want, &Ranges::new(), cancel)
}

/// The perceptual roughness that tables are read at, by their names.
pub type Ranges = BTreeMap<String, [f64; 2]>;

/// As [`suggest`], of tables that are read over a part of their roughness only: what a scene holds.
///
/// # Errors
/// As [`suggest`].
pub fn suggest_within(
    engine: &Engine,
    plan: &Plan,
    want: Want,
    ranges: &Ranges,
    cancel: &Cancel,
) -> Result<Vec<Suggestion>, PipelineError> {
    let one = |(i, planned): (usize, &PlannedTable)| {
        let range = ranges.get(planned.name()).copied();
        let mut found =
            suggested(engine, plan, planned, i, Search { planned, want, range, language: "", cancel })?;
        if let (Some([lo, hi]), Some(_)) = (range, &found.found) {
            found.notes.push(format!("it covers what is read at roughness [{lo}, {hi}], and clamps beyond"));
        }
        Ok(found)
    };
    plan.tables.iter().enumerate().map(one).collect()
}

fn suggested(
    engine: &Engine,
    plan: &Plan,
    planned: &PlannedTable,
    index: usize,
    search: Search<'_>,
) -> Result<Suggestion, PipelineError> {
    let Search { want, cancel, .. } = search;
    let mut result =
        Suggestion { table: planned.name().to_owned(), own: None, found: None, notes: Vec::new() };
    let language = match (engine.reader, planned.bound.spec.kind.id) {
        (Reader::Fixed(why), _) => {
            result.notes.push(format!("its reader cannot be told another axis: {why}"));
            return Ok(result);
        }
        (Reader::Shader(_), kind) if kind != "dfg" => {
            result.notes.push(format!("a table of kind {kind} has no error between texels to search by"));
            return Ok(result);
        }
        (Reader::Shader(language), _) => language,
    };
    let own = table::make(plan, planned, index, false, false, cancel, &Silent)?;
    result.own = measured(&own, planned);
    let search = Search { language, ..search };
    let output = planned.outputs.first().cloned().unwrap_or_else(Output::preset);
    let mut least = Reached::default();
    result.found = search.best(&output, &mut least)?;
    let float = matches!(output.storage, Storage::Half | Storage::Float | Storage::Double);
    if result.found.is_none() && !float {
        let finer = finer(planned.bound.spec.layout.channels.len());
        result.notes.push(format!("as {output}, {least}: stored as {finer} instead"));
        result.found = search.best(&finer, &mut least)?;
    }
    if result.found.is_none() {
        let domain = if want.practical { "practical" } else { "whole" };
        let (longest, error) = (want.longest, want.error);
        result.notes.push(format!(
            "no table with axes up to {longest} reads to within {error:e} over the {domain} domain; {least}"
        ));
    } else {
        if search.range.is_none() {
            result.notes.push(format!("roughness below {LEAST_ROUGHNESS} reads as {LEAST_ROUGHNESS}"));
        }
    }
    if let Some((own, found)) = result.own.as_ref().zip(result.found.as_ref())
        && found.size.bytes > own.bytes
    {
        result.notes.push("it takes more bytes than the engine's own".to_owned());
    }
    Ok(result)
}

#[derive(Clone, Copy)]
struct Search<'a> {
    planned: &'a PlannedTable,
    want: Want,
    /// The roughness that it is read at, if that is a part.
    range: Option<[f64; 2]>,
    language: &'static str,
    cancel: &'a Cancel,
}

impl Search<'_> {
    /// The smallest of all candidates; `least` becomes the least error of those that fail.
    fn best(&self, output: &Output, least: &mut Reached) -> Result<Option<SuggestedSize>, PipelineError> {
        let mut best: Option<SuggestedSize> = None;
        for (channels, decode) in candidates(self.planned, output) {
            let found = match self.sized(channels, output) {
                Ok(request) => self.bake(&request, decode)?,
                Err(PipelineError::Size { reached, .. }) => {
                    *least = least.nearer(reached);
                    continue;
                }
                Err(e) => return Err(e),
            };
            let Some(found) = found else { continue };
            if best.as_ref().is_none_or(|b| found.size.bytes < b.size.bytes) {
                best = Some(found);
            }
        }
        Ok(best)
    }

    /// A request of the size and with the warps that the search finds.
    fn sized(&self, channels: Vec<String>, output: &Output) -> Result<TableRequest, PipelineError> {
        let sizing = Sizing {
            error: self.want.error,
            practical: self.want.practical,
            warps: true,
            longest: self.want.longest,
            axes: vec![0, 1],
        };
        let mut request =
            TableRequest::new(self.planned.name().to_owned(), request(self.planned, channels, self.range));
        request.outputs = Some(vec![output.clone()]);
        request.tolerance = Some((SHARE * self.want.error).max(1e-12));
        let open = TableRequest { size: Some(sizing.clone()), ..request.clone() };
        let plan = Plan::from_requests("suggested", vec![open]).map_err(|e| self.fault(&e))?;
        let planned = plan.tables.first().ok_or_else(|| self.fault(&"no table"))?;
        let found = size::resolve(planned, &sizing, self.cancel)?;
        request.request.axes = Some(found.bound.spec.grid.axes().to_vec());
        Ok(request)
    }

    /// Bakes the text of a recipe; none if it reads worse than asked for after all.
    fn bake(&self, request: &TableRequest, decode: Decode) -> Result<Option<SuggestedSize>, PipelineError> {
        let text = recipe::text("suggested", std::slice::from_ref(request));
        let plan = recipe::parse(&text, "suggested.toml").map_err(|e| self.fault(&e))?;
        let planned = plan.tables.first().ok_or_else(|| self.fault(&"no table"))?;
        let made = table::make(&plan, planned, 0, false, false, self.cancel, &Silent)?;
        let Some(size) = measured(&made, planned) else { return Ok(None) };
        let reached = if self.want.practical { size.practical.unwrap_or(size.whole) } else { size.whole };
        if reached[0] > self.want.error {
            return Ok(None);
        }
        let spec = &planned.bound.spec;
        let channels: Vec<&str> = spec.layout.ids().collect();
        let lines = reader::lines(planned.name(), &spec.grid, &channels, decode, self.language)
            .map_err(|e| self.fault(&e))?;
        Ok(Some(SuggestedSize { size, recipe: text, language: self.language, lines }))
    }

    fn fault(&self, error: &dyn std::fmt::Display) -> PipelineError {
        PipelineError::SizeGrid { table: self.planned.name().to_owned(), message: error.to_string() }
    }
}

/// Channels to try: those that are read now, and in floats loss and rest in place of the first two.
fn candidates(planned: &PlannedTable, output: &Output) -> Vec<(Vec<String>, Decode)> {
    let own: Vec<String> = planned.bound.spec.layout.ids().map(str::to_owned).collect();
    let mut all = vec![(own.clone(), Decode::Plain)];
    let decode = match own.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["dfg.scale", "dfg.bias", ..] => Decode::ScaleBias,
        ["dfg.fc", "dfg.total", ..] => Decode::Multiscatter,
        _ => return all,
    };
    if !output.storage.is_bounded() && output.storage != Storage::Rgbd {
        let mut factored = own;
        factored.splice(0..2, ["dfg.loss", "dfg.rest"].map(str::to_owned));
        all.push((factored, decode));
    }
    all
}

/// The same integrals over the same quantities, on plain axes.
fn request(planned: &PlannedTable, channels: Vec<String>, range: Option<[f64; 2]>) -> Request {
    let spec = &planned.bound.spec;
    let axes = spec.grid.axes().iter().map(|axis| plain(axis, range)).collect();
    let mut params = spec.params.to_json(&spec.swept());
    let model = spec.model.as_ref().map(|(info, given)| {
        let defaults = Params::resolve(info.id, info.params, []).map(|p| p.to_json(&[])).unwrap_or_default();
        let split = matches!(spec.kind.model, ModelUse::Split(_));
        for (key, value) in given.to_json(&spec.swept()) {
            let fixed = split && ["f0", "f90"].contains(&key.as_str());
            if !fixed && defaults.get(&key) != Some(&value) {
                params.insert(key, value);
            }
        }
        info.id.to_owned()
    });
    Request {
        kind: spec.kind.id.to_owned(),
        layout: None,
        channels: Some(channels),
        model,
        params,
        axes: Some(axes),
    }
}

/// Where one roughness is read, the axis keeps so much on either side: two rows.
const BESIDE: f64 = 0.005;

/// The axis without warp, from the least roughness on or over a range of it.
fn plain(axis: &Axis, range: Option<[f64; 2]>) -> Axis {
    let mut plain = axis.clone();
    plain.warp = Warp::Linear;
    plain.texel = Texel::Endpoint;
    plain.direction = Direction::Ascending;
    (plain.offset, plain.clamp) = (0.0, None);
    let least = match axis.quantity.id {
        "roughness" => LEAST_ROUGHNESS,
        "alpha" => LEAST_ROUGHNESS * LEAST_ROUGHNESS,
        _ => axis.domain[0],
    };
    plain.domain[0] = plain.domain[0].max(least);
    if let Some([lo, hi]) = range {
        let (lo, hi) = (lo.clamp(LEAST_ROUGHNESS, 1.0), hi.clamp(LEAST_ROUGHNESS, 1.0));
        let beside = if hi - lo < 2.0 * BESIDE { BESIDE } else { 0.0 };
        let ends = [(lo - beside).max(LEAST_ROUGHNESS), (hi + beside).min(1.0)];
        match axis.quantity.id {
            "roughness" => plain.domain = ends,
            "alpha" => plain.domain = ends.map(|r| r * r),
            _ => {}
        }
    }
    plain
}

/// What a table takes, and how it reads; none if that was not measured.
fn measured(made: &table::Made, planned: &PlannedTable) -> Option<Size> {
    let record = made.record.files.first()?;
    let read: &Reconstruction = record.as_read.as_ref().or(record.reconstruction.as_ref())?;
    let output = planned.outputs.first()?;
    let grid: &Grid = &planned.bound.spec.grid;
    let components = planned.bound.spec.layout.channels.len() + record.encoding.fill.len();
    Some(Size {
        texels: made.record.size.clone(),
        output: output.to_string(),
        bytes: grid.len() * encode::texel_size(output.storage, components),
        file_bytes: record.bytes,
        whole: [read.whole.largest.value, read.whole.mean],
        practical: read.practical.as_ref().map(|p| [p.largest.value, p.mean]),
    })
}
