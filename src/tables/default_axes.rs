//! The axes of a table whose recipe gives none: those of the kind for its channels, made to fit the model.
//!
//! A kind names the axes that read best for the model that it takes by itself. Another model may have no parameter for one of
//! them (a Lambertian surface has no roughness), another range, or another word for it: then the axis is left out, ends where
//! the model does, or becomes the one that the model names ([`Param::sweep`](crate::models::Param)).

use super::{ModelUse, Selection, TableInfo};
use crate::grid::{Axis, Direction, Quantity, Texel, Warp};
use crate::models::{ModelInfo, Param};
use serde_json::{Map, Value as Json};

/// What default axes are chosen for.
#[derive(Debug, Clone, Copy)]
pub struct Setting<'a> {
    /// The channels.
    pub layout: &'a Selection,
    /// The model, for kinds that have one.
    pub model: Option<&'static ModelInfo>,
    /// The parameters that are given.
    pub given: Option<&'a Map<String, Json>>,
}

impl Setting<'_> {
    /// Does the table hold this channel?
    #[must_use]
    pub fn holds(&self, channel: &str) -> bool {
        self.layout.ids().any(|id| id == channel)
    }

    /// The word that is given for a choice.
    #[must_use]
    pub fn chosen(&self, id: &str) -> Option<&str> {
        self.given?.get(id)?.as_str()
    }
}

impl TableInfo {
    /// The axes of a table of these channels and this model, if its recipe gives none.
    #[must_use]
    pub fn default_axes(&self, setting: Setting<'_>) -> Vec<Axis> {
        let own = (self.axes)(&setting);
        let mut axes: Vec<Axis> = match setting.model {
            None => own,
            Some(model) => {
                let mut replaced = false;
                own.into_iter().filter_map(|axis| self.fit(axis, model, &mut replaced)).collect()
            }
        };
        // what a model measures by two names is swept once
        let measured = |a: &Axis| {
            let base = a.quantity.base_id();
            setting.model.and_then(|m| m.measured(base)).map_or(base, |p| p.id)
        };
        let mut seen = Vec::new();
        axes.retain(|a| {
            let id = measured(a);
            let new = !seen.contains(&id);
            seen.push(id);
            new
        });
        uncouple(&mut axes);
        axes
    }

    /// The axis for a model; none if it would sweep nothing. One axis at most is `replaced` by that of the model.
    fn fit(&self, axis: Axis, model: &'static ModelInfo, replaced: &mut bool) -> Option<Axis> {
        let base = axis.quantity.base_id();
        let of_the_kind = self.params.iter().any(|p| p.is_measured_by(base));
        if of_the_kind {
            return Some(axis);
        }
        let axis = of_model(axis, model);
        let base = axis.quantity.base_id();
        if let Some(param) = model.measured(base) {
            return Some(within(axis, param));
        }
        if self.coordinates.contains(&base) {
            return Some(axis);
        }
        if *replaced {
            return None;
        }
        let other = swept(axis, model)?;
        *replaced = true;
        // a split part has its Fresnel factor outside the table
        let idle = matches!(self.model, ModelUse::Split(_)) && other.quantity.id == "f0";
        (!idle).then_some(other)
    }
}

/// Warps that follow an axis which is not there become one of their own.
pub(crate) fn uncouple(axes: &mut [Axis]) {
    let bases: Vec<&str> = axes.iter().map(|a| a.quantity.base_id()).collect();
    for axis in axes {
        if axis.warp.couples_to().is_some_and(|to| !bases.contains(&to)) {
            // the best that needs no other axis: a grazing view changes fastest
            axis.warp = Warp::Power(0.5);
        }
    }
}

/// The axis with the quantity that the model has under the name of the axis.
pub(super) fn of_model(mut axis: Axis, model: &'static ModelInfo) -> Axis {
    let own = Quantity::own(axis.quantity.id).filter(|q| model.measured(q.id).is_some());
    axis.quantity = own.unwrap_or(axis.quantity);
    axis
}

/// The axis over no more than the model takes, or is of use over.
fn within(mut axis: Axis, param: &'static Param) -> Axis {
    let Some(range) = param.range() else { return axis };
    let mut allowed = axis.quantity.interval_from_base(range);
    if let Some((sweep, quantity)) = param.sweep.and_then(|s| Some((s, Quantity::find(s.quantity)?))) {
        let own = if axis.quantity.id == sweep.quantity {
            sweep.domain
        } else {
            axis.quantity.interval_from_base(sweep.domain.map(|v| quantity.to_base(v)))
        };
        allowed = [allowed[0].max(own[0]), allowed[1].min(own[1])];
    }
    let inside = |[lo, hi]: [f64; 2]| [lo.max(allowed[0]), hi.min(allowed[1])];
    match &mut axis.clamp {
        Some(clamp) => *clamp = inside(*clamp),
        None => axis.domain = inside(axis.domain),
    }
    axis
}

/// The axis that the model names in the place of one that it has nothing for.
fn swept(axis: Axis, model: &'static ModelInfo) -> Option<Axis> {
    let (param, sweep) = model.params.iter().find_map(|p| Some((p, p.sweep?)))?;
    let quantity = Quantity::own(sweep.quantity)
        .filter(|q| param.is_measured_by(q.id))
        .or_else(|| Quantity::find(sweep.quantity))?;
    let even = (sweep.power - 1.0).abs() <= f64::EPSILON;
    Some(Axis {
        quantity,
        domain: sweep.domain,
        warp: if even { Warp::Linear } else { Warp::Power(sweep.power) },
        direction: Direction::Ascending,
        clamp: None,
        ..axis
    })
}

/// The axis of a quantity on endpoints; none for an id that is no quantity.
pub(super) fn axis(id: &str, len: usize, domain: [f64; 2], warp: Warp) -> Option<Axis> {
    Quantity::find(id).map(|q| Axis::new(q, len, Texel::Endpoint).over(domain).warped(warp))
}

/// `w^power = v (1 + c) / (v + c)`, `c = scale alpha^exponent`.
pub(super) fn coupled(power: f64, scale: f64, exponent: f64) -> Warp {
    Warp::Coupled { to: "alpha".to_owned(), power, scale, exponent }
}

/// Where roughness begins on axes that follow the dip beside mu = roughness = 0, those of `--suggest` too: alpha = 1e-4, a mirror to the
/// eye. Shaders clamp there or above.
pub const LEAST_ROUGHNESS: f64 = 0.01;

/// The view cosine with a coupled warp, and roughness, 64 x 64: what integrals of microfacets are read best from.
pub(super) fn view_and_roughness(view: Warp, roughness: Warp) -> Vec<Axis> {
    let axes = [axis("mu", 64, [0.0, 1.0], view), axis("roughness", 64, [LEAST_ROUGHNESS, 1.0], roughness)];
    axes.into_iter().flatten().collect()
}

/// The axes of a split sum, 64 x 64: square roots to a shader, `c = 3 sqrt(roughness)`. Of all powers, scales and exponents that
/// were tried (to 0.1 in each) none that needs no more reads scale and bias better: to 0.0029.
pub(super) fn split_sum() -> Vec<Axis> {
    view_and_roughness(coupled(4.0, 3.0, 0.25), Warp::Power(0.5))
}

/// The axes of a white albedo, 64 x 64: read to 1.9e-4.
pub(super) fn white_albedo() -> Vec<Axis> {
    view_and_roughness(coupled(3.0, 4.0, 1.0), Warp::Linear)
}
