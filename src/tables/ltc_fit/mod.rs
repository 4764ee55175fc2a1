//! The linearly transformed cosine that is nearest to a reflectance model at a view.
//!
//! What is made small is the error of Heitz et al. and of their fitter: `int |f mu_i / E - D|^3 dwi` over the whole sphere,
//! with E the exact albedo of the model, so that the fit has no say in the energy. Their fitter fixes the axis of the lobe to the
//! mean direction and searches three numbers; here all four of the matrix are free.
//!
//! The model is evaluated once a level at the nodes of its own [`Chart`](crate::integrate::Chart); the lobe below the horizon,
//! where the model is 0, is integrated in the space of the cosine. The search is Newton's, from the moments of the target. Then the
//! level is raised until the matrices of two levels agree. Nothing depends on neighbouring texels.

mod newton;
mod objective;
mod proposal;
mod target;

use super::TexelError;
use crate::integrate::View;
use crate::models::Brdf;
use crate::terms::ltc::Inverse;
use target::Target;

/// Which matrices are searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// All that are even in y: four numbers.
    Even,
    /// `[[a, 0, b], [0, a, 0], [0, 0, 1]]`: two numbers, as for sheen.
    Sheared,
    /// `[[a, 0, 0], [0, a, 0], [0, 0, 1]]`: round lobes, for a view along the normal.
    Round,
}

impl Family {
    /// The directions that a step may take, in the numbers d1 to d4 of [`objective`].
    fn basis(self) -> &'static [[f64; 4]] {
        match self {
            Family::Even => {
                &[[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
            }
            Family::Sheared => &[[1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]],
            Family::Round => &[[1.0, 1.0, 0.0, 0.0]],
        }
    }

    /// The member nearest to a matrix, to start from.
    fn nearest(self, b: &Inverse) -> Inverse {
        // no lobe of the smaller families leans below the horizon
        let m33 = b.m33.max(0.05);
        let scale = b.m22 / m33;
        match self {
            Family::Even => *b,
            Family::Sheared => Inverse { m11: scale, m22: scale, m13: b.m13 / m33, m31: 0.0, m33: 1.0 },
            Family::Round => Inverse { m11: scale, m22: scale, ..Inverse::COSINE },
        }
    }
}

/// A fit and what it costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// The inverse matrix, its middle entry 1.
    pub inverse: Inverse,
    /// `(int |f mu_i / E - D|^3 / int (f mu_i / E)^3)^(1/3)`: 0 for a perfect fit.
    pub l3: f64,
    /// `1/2 int |f mu_i / E - D|`, the total variation distance of the two densities: 0 to 1.
    pub variation: f64,
    /// `int f mu_i dwi`.
    pub albedo: f64,
}

/// A fit with estimated numerical errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitted {
    /// At the finest level.
    pub fit: Fit,
    /// At the level before: the difference is the error estimate.
    pub coarse: Fit,
    /// Evaluations of model and lobe.
    pub evaluations: u32,
}

/// Levels of the charts.
const LEVELS: [f64; 6] = [5.6, 8.0, 11.0, 15.0, 20.0, 27.0];

/// Fits the model at a view, until the entries of the matrix over its middle one are good to `tolerance`.
///
/// A surface that reflects nothing at this view gets the clamped cosine and no error: nothing is multiplied by it.
///
/// # Errors
/// [`TexelError::NoWidth`] for a mirror, [`TexelError::NotFinite`] where the model is not.
pub fn fit(model: &dyn Brdf, view: View, family: Family, tolerance: f64) -> Result<Fitted, TexelError> {
    // along the normal every lobe of an isotropic surface is round
    let round = view.sine().abs() == 0.0 && !model.turns();
    let family = if round { Family::Round } else { family };
    let mut nodes = Vec::new();
    let mut evaluations = 0u32;
    let mut last: Option<Fit> = None;
    let mut result = None;
    for level in LEVELS {
        let target = Target::new(model, view, level)?;
        if target.albedo <= f64::MIN_POSITIVE {
            let dark = Fit { inverse: Inverse::COSINE, l3: 0.0, variation: 0.0, albedo: 0.0 };
            return Ok(Fitted { fit: dark, coarse: dark, evaluations });
        }
        let start = last.map_or_else(|| family.nearest(&target.moments()), |f| f.inverse);
        target.nodes_for(&start, &mut nodes);
        let optimum = newton::minimise(&nodes, start, family);
        evaluations = evaluations.saturating_add(optimum.evaluations);
        let fit = Fit {
            inverse: optimum.inverse,
            l3: libm::cbrt(optimum.value / target.cube),
            variation: objective::variation(&nodes, &optimum.inverse),
            albedo: target.albedo,
        };
        let coarse = last.unwrap_or(fit);
        result = Some(Fitted { fit, coarse, evaluations });
        if last.is_some() && difference(&fit.inverse, &coarse.inverse) <= tolerance {
            break;
        }
        last = Some(fit);
    }
    result.ok_or(TexelError::NoWidth)
}

/// The errors of a given matrix at a view, at a level of the charts (8 is good to about 1e-4 of them).
///
/// # Errors
/// As [`fit`].
pub fn judge(model: &dyn Brdf, view: View, inverse: &Inverse, level: f64) -> Result<Fit, TexelError> {
    let target = Target::new(model, view, level)?;
    let mut nodes = Vec::new();
    target.nodes_for(inverse, &mut nodes);
    let at = objective::objective(&nodes, inverse);
    Ok(Fit {
        inverse: *inverse,
        l3: libm::cbrt(at.value / target.cube),
        variation: objective::variation(&nodes, inverse),
        albedo: target.albedo,
    })
}

/// Largest difference of the entries.
fn difference(a: &Inverse, b: &Inverse) -> f64 {
    [a.m11 - b.m11, a.m13 - b.m13, a.m31 - b.m31, a.m33 - b.m33].iter().fold(0.0, |m, d| f64::max(m, d.abs()))
}
