//! Are the axes of a request those that its table depends on, each number once?

use super::spec::axis_ids;
use super::{BindError, ModelUse, TableInfo};
use crate::grid::quantity::QUANTITIES;
use crate::grid::{Grid, Quantity};
use crate::models::{self, ModelInfo, Param, Params};
use serde_json::{Map, Value as Json};

/// Refuses axes that are missing, idle or twice.
///
/// # Errors
/// [`BindError`] names the axis and what there can be.
pub(super) fn check_axes(
    kind: &'static TableInfo,
    grid: &Grid,
    model: Option<&(&'static ModelInfo, Params)>,
    given: &Map<String, Json>,
) -> Result<(), BindError> {
    let bases: Vec<&'static str> = grid.axes().iter().map(|a| a.quantity.base_id()).collect();
    // a coordinate that is a parameter of the model may be given as one: the table is a row of it
    let fixed = |needed: &str| {
        let param = model.and_then(|(info, _)| info.measured(needed));
        param.is_some_and(|p| given.keys().any(|key| p.is_called(key)))
    };
    // both widths stand for the one that they follow, swept or given
    let followed = |needed: &str| {
        let Some((info, _)) = model else { return false };
        let told = |id: &str| bases.contains(&id) || given.keys().any(|key| key == id);
        let mut followers = info.measured(needed).into_iter().flat_map(|p| info.followers(p.id)).peekable();
        followers.peek().is_some() && followers.all(told)
    };
    for needed in kind.coordinates {
        if !bases.contains(needed) && !fixed(needed) && !followed(needed) {
            let got = axis_ids(grid);
            return Err(BindError::MissingAxis { kind: kind.id, needed, got });
        }
    }
    let numbers: Vec<&Param> = model
        .iter()
        .flat_map(|(info, _)| info.params)
        .chain(kind.params)
        .filter(|p| matches!(p.kind, models::Kind::Number { .. }))
        // where the Fresnel factor is split off, F is 1
        .filter(|p| !(matches!(kind.model, ModelUse::Split(_)) && ["f0", "f90"].contains(&p.id)))
        .collect();
    let azimuth = turned(kind, &bases, model, given)?;
    for (axis, base) in grid.axes().iter().zip(&bases) {
        let number = numbers.iter().find(|p| p.is_measured_by(base));
        if !kind.coordinates.contains(base) && number.is_none() && !azimuth.contains(base) {
            let allowed = sweepable(&[kind.coordinates, &azimuth].concat(), &numbers);
            return Err(BindError::IdleAxis { kind: kind.id, axis: axis.quantity.id, allowed });
        }
        let same = |key: &&String| key.as_str() == *base || number.is_some_and(|p| p.is_called(key));
        if let Some(key) = given.keys().find(same) {
            return Err(BindError::Both { kind: kind.id, key: key.clone() });
        }
    }
    for (i, axis) in grid.axes().iter().enumerate() {
        let same = |p: &&&Param| p.is_measured_by(bases[i]);
        let Some(param) = numbers.iter().find(same).filter(|_| !kind.coordinates.contains(&bases[i])) else {
            continue;
        };
        if let Some(other) = bases[..i].iter().position(|b| param.is_measured_by(b)) {
            let axes = [grid.axes()[other].quantity.id, axis.quantity.id];
            return Err(BindError::OneParam { kind: kind.id, axes, param: param.id });
        }
    }
    Ok(())
}

/// What a view has besides its cosine: an azimuth; glTF's strength and rotation of anisotropy, where the model has two widths that
/// neither an axis nor a parameter sets.
fn turned(
    kind: &'static TableInfo,
    bases: &[&'static str],
    model: Option<&(&'static ModelInfo, Params)>,
    given: &Map<String, Json>,
) -> Result<Vec<&'static str>, BindError> {
    let Some((info, _)) = model.filter(|_| kind.coordinates.contains(&"mu")) else { return Ok(Vec::new()) };
    if !WIDTHS.iter().all(|id| info.followers("alpha").any(|f| f == *id)) {
        return Ok(vec!["phi"]);
    }
    if bases.contains(&"anisotropy") {
        for param in WIDTHS {
            if bases.contains(&param) {
                return Err(BindError::OneParam { kind: kind.id, axes: ["anisotropy", param], param });
            }
            if given.contains_key(param) {
                return Err(BindError::Both { kind: kind.id, key: param.to_owned() });
            }
        }
    }
    Ok(vec!["phi", "anisotropy", "rotation"])
}

/// Widths along both tangents.
const WIDTHS: [&str; 2] = ["alpha_x", "alpha_y"];

/// The axes that there are for these base quantities and parameters, by the names that a recipe has for them.
fn sweepable(bases: &[&str], numbers: &[&Param]) -> String {
    let measures = |base: &str| bases.contains(&base) || numbers.iter().any(|p| p.is_measured_by(base));
    let known = QUANTITIES.iter().filter(|q| {
        measures(q.base_id())
            || (Quantity::own(q.id).is_some() && numbers.iter().any(|p| p.is_measured_by(q.id)))
    });
    let ids: Vec<&str> = known.map(|q| q.id).collect();
    if ids.is_empty() { "nothing".to_owned() } else { ids.join(", ") }
}
