//! What is asked for: the keys of a table, whoever asks.
//!
//! A key is a field here and a line in its reader (`recipe/document.rs` for TOML). What the field is serialised to is the canonical
//! form, from which the text of a recipe and the identity of the table follow. A key whose default depends on others is an
//! `Option`; [`PlannedTable`](super::PlannedTable) holds what it comes to.

use super::output::Output;
use super::sizing::Sizing;
use crate::grid::fit::Texels;
use crate::grid::provenance::Waiver;
use crate::tables::driver::OnMiss;
use crate::tables::spec::Request;
use serde::{Serialize, Serializer};

/// A table that is asked for.
///
/// ```
/// use brdfbake::plan::{Output, Plan, TableRequest};
/// use brdfbake::tables::spec::Request;
///
/// let table = TableRequest {
///     outputs: Some(vec![Output::parse("exr:float")?]),
///     tolerance: Some(1e-6),
///     ..TableRequest::new("ggx-dfg", Request { kind: "dfg".into(), ..Request::default() })
/// };
/// let plan = Plan::from_requests("mine", vec![table])?;
/// assert_eq!(plan.tables[0].bound.spec.grid.len(), 64 * 64);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct TableRequest {
    /// Stem of its file names: portable, and unique in a plan without regard to case.
    #[serde(skip)]
    pub name: String,
    /// Kind, layout, model, parameters, axes.
    #[serde(skip)]
    pub request: Request,
    /// Name of its one file, in place of `name` and an extension. Tables that name the same file follow each other in it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Text before the numbers of that file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub before: Option<String>,
    /// Text behind them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub after: Option<String>,
    /// Absolute tolerance of each channel, within [`TOLERANCE`](super::TOLERANCE); half a step near 1 of the finest storage if none,
    /// or what the kind reaches if that is more.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f64>,
    /// Files to write: at least one, none twice; EXR in half floats if none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub outputs: Option<Vec<Output>>,
    /// What to do with a texel that misses the tolerance.
    pub on_miss: OnMiss,
    /// Measure the error of a reader between texels? If none: where texels are blended.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "switch")]
    pub reconstruction: Option<bool>,
    /// What its size must achieve, if that is to be found. With axes in the request, [`Sizing::axes`] are those whose lengths stand
    /// in; the others are kept.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<Sizing>,
    /// What its texels hold.
    #[serde(skip_serializing_if = "are_exact", serialize_with = "texels")]
    pub texels: Texels,
    /// Laws that it may break; in a plan in the order of [`LAWS`](crate::verify::LAWS).
    #[serde(rename = "waive", skip_serializing_if = "Vec::is_empty")]
    pub waivers: Vec<Waiver>,
}

impl TableRequest {
    /// A request with the defaults of a recipe.
    #[must_use]
    pub fn new(name: impl Into<String>, request: Request) -> TableRequest {
        TableRequest { name: name.into(), request, ..TableRequest::default() }
    }
}

#[allow(clippy::ref_option, reason = "the signature that serde asks for")]
fn switch<S: Serializer>(on: &Option<bool>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(if *on == Some(true) { "on" } else { "off" })
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn texels<S: Serializer>(texels: &Texels, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(texels.id())
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "the signature that serde asks for")]
fn are_exact(texels: &Texels) -> bool {
    texels.are_exact()
}

/// A request as its asker could read it. What could not be read, and was complained about there, is not judged.
#[derive(Debug, Default)]
pub(crate) struct Draft {
    pub(crate) request: TableRequest,
    pub(crate) holes: Holes,
}

/// The keys of a request that could not be read, or not whole.
#[derive(Debug, Default, Clone, Copy)]
#[allow(clippy::struct_excessive_bools, reason = "a set of four keys")]
pub(crate) struct Holes {
    pub(crate) kind: bool,
    pub(crate) name: bool,
    pub(crate) outputs: bool,
    pub(crate) axes: bool,
}

impl From<TableRequest> for Draft {
    fn from(request: TableRequest) -> Draft {
        Draft { request, holes: Holes::default() }
    }
}
