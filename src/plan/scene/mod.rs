//! From what glTF scenes need to requests.
//!
//! A [`Need`] names a family of tables, and a family is a file here and a line in [`FAMILIES`]: it turns the ranges of the need into
//! requests. Ranges trim axes: a number that takes one value is a parameter of the table and no axis.
//!
//! ```
//! use brdfbake::{plan::scene as planning, scene};
//! let text = r#"{ "asset": { "version": "2.0" }, "materials": [ { "pbrMetallicRoughness": { "roughnessFactor": 0.5 } } ],
//!     "meshes": [ { "primitives": [ { "attributes": {}, "material": 0 } ] } ] }"#;
//! let scene = scene::read_slice(text.as_bytes(), "plain.gltf", &scene::Limits::default())?;
//! let plan = planning::plan(&scene::analyse(&scene))?.ok_or("nothing to bake")?;
//! assert_eq!(plan.tables[0].name(), "ggx-dfg");
//! // one roughness: a row
//! assert_eq!(plan.tables[0].bound.spec.grid.axes().len(), 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod anisotropic;
mod area_light;
mod axes;
mod coat;
mod covered;
mod film;
mod fuzz;
mod ggx;
mod glass;
mod kept;
mod maps;
mod mesh;
mod numbers;
mod phase;
mod pictures;
mod reasons;
mod rough_diffuse;
mod sheen;
mod subsurface;
mod survey;

use super::request::TableRequest;
use super::resolve::{Plan, PlanError};
use super::table::PlannedTable;
use crate::scene::{Need, Needs};
use axes::Draft;
use serde::Serialize;

pub use kept::Kept;
pub use maps::{AskedMap, KINDS, MapAsker, SceneMaps, maps};
pub use mesh::Triangle;
pub use pictures::{PIXELS, Pictures, bytes_of};
pub use reasons::reasons;
pub use survey::{Survey, SurveyOptions, Surveyed, Texels, survey, survey_with};

/// Why the needs of a scene make no plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScenePlanError {
    /// A family that nothing here bakes.
    #[error("nothing bakes the {family} tables that the scene needs; there is {allowed}")]
    Family {
        /// Id of the family.
        family: String,
        /// The families there are.
        allowed: String,
    },
    /// Requests that do not resolve: a fault of this program.
    #[error(transparent)]
    Plan(#[from] PlanError),
}

/// Tables that are asked for together.
#[derive(Debug, Clone, Copy)]
pub struct Family {
    /// Id, as [`Need::table`] names it.
    pub id: &'static str,
    /// What they are asked with, for a need.
    requests: fn(&Need) -> Vec<Draft>,
    /// Kinds and models of tables, of engines too, that serve it; any model if none.
    pub serves: &'static [(&'static str, Option<&'static str>)],
}

/// Every family that is baked.
pub static FAMILIES: &[Family] = &[
    ggx::FAMILY,
    coat::FAMILY,
    glass::FAMILY,
    sheen::FAMILY,
    fuzz::FAMILY,
    film::FAMILY,
    anisotropic::FAMILY,
    rough_diffuse::FAMILY,
    phase::FAMILY,
    subsurface::FAMILY,
    area_light::FAMILY,
];

/// Name of the plan of a scene.
pub const NAME: &str = "scene";

/// A table that a scene asks for, with its reasons.
#[derive(Debug, Clone)]
pub struct Asked {
    /// What is asked for.
    pub request: TableRequest,
    /// Id of the family that it belongs to.
    pub family: &'static str,
    /// Where the table stops short of what the scenes hold, or is less than it could be: its lookups clamp.
    pub notes: Vec<Note>,
}

/// Where a table stops short of a range.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Note {
    /// The quantity.
    pub quantity: &'static str,
    /// What the scenes hold.
    pub asked: [f64; 2],
    /// What the table covers.
    pub covered: [f64; 2],
    /// Why.
    pub why: &'static str,
    /// Is what it makes of the rest another picture? If not, nobody sees it.
    pub seen: bool,
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let ([a, b], [lo, hi]) = (self.asked, self.covered);
        write!(f, "{} [{a}, {b}] is read at [{lo}, {hi}]: {}", self.quantity, self.why)
    }
}

/// What scenes ask for, in their order.
///
/// # Errors
/// [`ScenePlanError::Family`] for a need that nothing here meets.
pub fn asked(needs: &Needs) -> Result<Vec<Asked>, ScenePlanError> {
    let mut all = Vec::new();
    for need in &needs.needs {
        let family = FAMILIES.iter().find(|f| f.id == need.table).ok_or_else(|| {
            let allowed = FAMILIES.iter().map(|f| f.id).collect::<Vec<_>>().join(", ");
            ScenePlanError::Family { family: need.table.to_string(), allowed }
        })?;
        all.extend((family.requests)(need).into_iter().map(|draft| draft.finish(family.id)));
    }
    Ok(all)
}

/// What scenes ask for, as requests, in their order.
///
/// # Errors
/// As [`asked`].
pub fn requests(needs: &Needs) -> Result<Vec<TableRequest>, ScenePlanError> {
    Ok(asked(needs)?.into_iter().map(|a| a.request).collect())
}

/// The plan of scenes; none if they need no table.
///
/// # Errors
/// [`ScenePlanError`] as [`requests`], and for requests that do not resolve.
pub fn plan(needs: &Needs) -> Result<Option<Plan>, ScenePlanError> {
    plan_of(&asked(needs)?)
}

/// The plan of what scenes asked for; none if that is nothing.
///
/// # Errors
/// [`ScenePlanError::Plan`] for requests that do not resolve.
pub fn plan_of(asked: &[Asked]) -> Result<Option<Plan>, ScenePlanError> {
    if asked.is_empty() {
        return Ok(None);
    }
    Ok(Some(Plan::from_requests(NAME, asked.iter().map(|a| a.request.clone()).collect())?))
}

/// The families that a table serves, by its kind and model.
pub fn served(table: &PlannedTable) -> impl Iterator<Item = &'static str> {
    let spec = &table.bound.spec;
    let (kind, model) = (spec.kind.id, spec.model.as_ref().map(|(info, _)| info.id));
    let serves = move |f: &&Family| {
        f.serves.iter().any(|(k, m)| *k == kind && m.is_none_or(|m| model.is_none_or(|model| m == model)))
    };
    FAMILIES.iter().filter(serves).map(|f| f.id)
}

/// Tolerance of albedos, which are divided by: a part in a million of white.
const ALBEDO_TOLERANCE: f64 = 1e-6;
