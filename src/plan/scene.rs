//! From what a glTF scene needs to requests.
//!
//! A [`Need`] names a family of tables, and a family is a list of requests here: one line in [`FAMILIES`].
//!
//! ```
//! use brdfbake::{plan::scene as planning, scene};
//! let text = r#"{ "asset": { "version": "2.0" }, "materials": [ {} ],
//!     "meshes": [ { "primitives": [ { "attributes": {}, "material": 0 } ] } ] }"#;
//! let scene = scene::read_slice(text.as_bytes(), "plain.gltf", &scene::Limits::default())?;
//! let plan = planning::plan(&scene::analyse(&scene))?.ok_or("nothing to bake")?;
//! assert_eq!(plan.tables[0].name(), "ggx-dfg");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use super::request::TableRequest;
use super::resolve::{Plan, PlanError};
use crate::scene::{GGX, Need, Needs};
use crate::tables::spec::Request;

/// Why the needs of a scene make no plan.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScenePlanError {
    /// A family that nothing here bakes.
    #[error("nothing bakes the {family} tables that the scene needs; there is {allowed}")]
    Family {
        /// Id of the family.
        family: &'static str,
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
    pub requests: fn(&Need) -> Vec<TableRequest>,
}

/// Every family that is baked.
pub static FAMILIES: &[Family] = &[Family { id: GGX, requests: ggx }];

/// Name of the plan of a scene.
pub const NAME: &str = "scene";

/// What a scene asks for, in its order.
///
/// # Errors
/// [`ScenePlanError::Family`] for a need that nothing here meets.
pub fn requests(needs: &Needs) -> Result<Vec<TableRequest>, ScenePlanError> {
    let mut all = Vec::new();
    for need in &needs.needs {
        let family = FAMILIES.iter().find(|f| f.id == need.table).ok_or_else(|| {
            let allowed = FAMILIES.iter().map(|f| f.id).collect::<Vec<_>>().join(", ");
            ScenePlanError::Family { family: need.table, allowed }
        })?;
        all.extend((family.requests)(need));
    }
    Ok(all)
}

/// The plan of a scene; none if it needs no table.
///
/// # Errors
/// [`ScenePlanError`] as [`requests`], and for requests that do not resolve.
pub fn plan(needs: &Needs) -> Result<Option<Plan>, ScenePlanError> {
    let requests = requests(needs)?;
    if requests.is_empty() {
        return Ok(None);
    }
    Ok(Some(Plan::from_requests(NAME, requests)?))
}

/// Tolerance of albedos, which are divided by: a part in a million of white.
const ALBEDO_TOLERANCE: f64 = 1e-6;

/// Split sum, directional albedo, average albedo, on the axes of their kinds: the preset `ggx`.
fn ggx(_: &Need) -> Vec<TableRequest> {
    let table = |kind: &str, tolerance| TableRequest {
        tolerance,
        ..TableRequest::new(format!("ggx-{kind}"), Request { kind: kind.to_owned(), ..Request::default() })
    };
    vec![
        table("dfg", None),
        table("albedo", Some(ALBEDO_TOLERANCE)),
        table("average-albedo", Some(ALBEDO_TOLERANCE)),
    ]
}
