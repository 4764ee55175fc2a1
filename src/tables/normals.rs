//! Distributions of normals over the axes of a table: what the tables of D, of masking and of visibility share.

use super::{BindError, Source, Spec};
use crate::models::normals::{self, NORMALS, Normals, Shape};
use crate::models::{DefaultValue, Param, ParamError, Params};

/// The numbers of the distributions.
pub(super) const ALPHA: Param = Param::number(
    "alpha",
    "alpha",
    "width; of charlie the r of its paper, of velvet-2000 and sggx their sigma",
    [0.0, 2.0],
    DefaultValue::Value(0.25),
);
/// Of GTR and Student's t.
pub(super) const GAMMA: Param = Param::number(
    "gamma",
    "gamma",
    "of student-t (above 1.5) and gtr (up to 10): exponent of the tail; 2 is GGX",
    [0.0, 1e8],
    DefaultValue::Value(2.0),
);
/// Of Blinn-Phong.
pub(super) const EXPONENT: Param =
    Param::number("n", "n", "of blinn-phong: exponent of the cosine", [0.0, 1e7], DefaultValue::Value(64.0));

/// Ids of the numbers.
const NUMBERS: [&str; 3] = [ALPHA.id, GAMMA.id, EXPONENT.id];

/// The sources of D.
pub(super) const SOURCES: [Source; NORMALS.len()] = {
    let mut all = [Source::new(NORMALS[0].source.0, ""); NORMALS.len()];
    let mut i = 0;
    while i < all.len() {
        let n = &NORMALS[i];
        all[i] = Source::new(n.source.0, n.source.1).when("distribution", std::slice::from_ref(&n.id));
        i += 1;
    }
    all
};

/// A distribution whose numbers follow the axes of a grid.
#[derive(Debug, Clone)]
pub struct Swept {
    normals: &'static Normals,
    params: Params,
    /// Number of the axis, and what it sweeps.
    axes: Vec<(usize, &'static str)>,
}

impl Swept {
    /// The distribution that a spec names; none for masking that belongs to none.
    ///
    /// # Errors
    /// [`BindError::IdleAxis`] for an axis of a number that the distribution does not have, [`BindError::Param`] where it refuses the
    /// numbers that are fixed.
    pub fn new(spec: &Spec) -> Result<Option<Swept>, BindError> {
        let Some(normals) = normals::find(spec.params.choice("distribution")?) else { return Ok(None) };
        let own: Vec<&str> =
            [Some(normals.width), normals.gamma.map(|_| GAMMA.id)].into_iter().flatten().collect();
        refuse_idle(spec, &NUMBERS, &own)?;
        let swept = |id: &'static str| spec.axis(id).map(|i| (i, id));
        let axes: Vec<_> = NUMBERS.into_iter().filter_map(swept).collect();
        let swept = Swept { normals, params: spec.params.clone(), axes };
        if swept.axes.is_empty() {
            swept.shape(&[])?;
        }
        Ok(Some(swept))
    }

    /// The distribution.
    #[must_use]
    pub fn normals(&self) -> &'static Normals {
        self.normals
    }

    /// The axes that sweep its numbers.
    #[must_use]
    pub fn axes(&self) -> &[(usize, &'static str)] {
        &self.axes
    }

    /// Its numbers at a point.
    ///
    /// # Errors
    /// [`ParamError::Range`] where it does not take them.
    pub fn shape(&self, at: &[f64]) -> Result<Shape, ParamError> {
        let number = |id: &str| match self.axes.iter().find(|(_, of)| *of == id) {
            Some((axis, _)) => Ok(at[*axis]),
            None => self.params.number(id),
        };
        let shape = Shape { width: number(self.normals.width)?, gamma: number(GAMMA.id)? };
        self.normals.check(shape)?;
        Ok(shape)
    }
}

/// Refuses axes of those numbers that are not among its own.
///
/// # Errors
/// [`BindError::IdleAxis`].
pub(super) fn refuse_idle(spec: &Spec, numbers: &[&'static str], own: &[&str]) -> Result<(), BindError> {
    let idle = numbers.iter().find(|id| spec.axis(id).is_some() && !own.contains(id));
    let Some(axis) = idle else { return Ok(()) };
    let allowed = spec.kind.coordinates.iter().chain(own).copied().collect::<Vec<_>>().join(", ");
    Err(BindError::IdleAxis { kind: spec.kind.id, axis, allowed })
}

/// The number that the width of a distribution is swept by in default axes: `alpha`, or `n` of Blinn-Phong.
pub(super) fn width_of(setting: &super::Setting<'_>) -> &'static str {
    setting.chosen("distribution").and_then(normals::find).map_or(ALPHA.id, |n| n.width)
}
