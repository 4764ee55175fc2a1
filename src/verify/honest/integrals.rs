//! Integrals of a lobe at a view, mirrors and sums of lobes included, and their means over the hemisphere.

use super::hemisphere::{BUDGET, Flux, Wanted};
use super::quad::{self, WIDE};
use super::weight::weight;
use super::{Route, Truth};
use crate::integrate::View;
use crate::models::Brdf;
use crate::tables::integral::Functional;
use std::cell::Cell;
use std::f64::consts::FRAC_PI_2;

/// Rounding of a value in closed form.
pub(super) const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// How an integral is to be found.
#[derive(Debug, Clone, Copy)]
pub(super) struct How {
    /// Error to aim at.
    pub(super) aim: f64,
    pub(super) route: Route,
    /// Relative index of an interface; NaN where there is none.
    pub(super) eta: f64,
}

/// `2 int E mu dmu` in the root of mu.
pub(super) fn mean(model: &dyn Brdf, flux: Flux, how: How) -> Option<Truth> {
    let mut breaks = vec![0.0, 1.0];
    if how.eta < 1.0 {
        // an albedo has a kink at the critical angle
        breaks.push(((1.0 - how.eta) * (1.0 + how.eta)).sqrt().sqrt());
    }
    if how.route == Route::Second {
        breaks.push(0.3);
    }
    breaks.sort_by(f64::total_cmp);
    let mut failed = false;
    let inner = How { aim: 0.6 * how.aim, ..how };
    let mut albedo =
        |mu: f64, phi: f64| match integrate(model, View { mu, phi }, flux, &[Functional::One], inner) {
            Some(t) => quad::Sum::known(t[0].value, t[0].error),
            None => {
                failed = true;
                quad::Sum::ZERO
            }
        };
    let target = [0.3 * how.aim; WIDE];
    let sum = quad::integrate(&breaks, 1, &target, 24, &mut |s| {
        let mu = s * s;
        let mut row = if model.turns() {
            // both tangents are lines of symmetry
            quad::integrate(&[0.0, FRAC_PI_2], 1, &target, 12, &mut |phi| {
                let mut e = albedo(mu, phi);
                e.scale(1.0 / FRAC_PI_2);
                e
            })
        } else {
            albedo(mu, 0.0)
        };
        row.scale(4.0 * s * mu);
        row
    });
    (!failed).then_some(Truth { value: sum.value[0], error: sum.error[0] })
}

/// The directional albedo of a lobe by the rule of this law, for other laws.
pub(in crate::verify) fn albedo(model: &dyn Brdf, view: View, aim: f64) -> Option<Truth> {
    let how = How { aim, route: Route::First, eta: f64::NAN };
    integrate(model, view, Flux::Reflected, &[Functional::One], how)?.first().copied()
}

/// Integrals of a lobe at a view; nothing where it has no rule.
pub(super) fn integrate(
    model: &dyn Brdf,
    view: View,
    flux: Flux,
    functionals: &[Functional],
    how: How,
) -> Option<Vec<Truth>> {
    let How { aim, route, eta } = how;
    if let Some(reflected) = model.mirror(view.mu) {
        let one = |value: f64| Truth { value, error: ROUNDING };
        return Some(match flux {
            Flux::Reflected => functionals.iter().map(|g| one(reflected * weight(*g, view.mu))).collect(),
            Flux::Drawn => functionals.iter().map(|g| one(weight(*g, view.mu))).collect(),
            // a smooth interface takes nothing
            Flux::Crossing => vec![one(1.0 - reflected)],
        });
    }
    let whole = [(1.0, model)];
    let parts = model.parts().filter(|_| route == Route::Second && flux == Flux::Reflected);
    let mut truths = vec![Truth { value: 0.0, error: 0.0 }; functionals.len()];
    // a lobe that turns is added up over four quarters, and is steep in both tangents
    let budget = Cell::new(if model.turns() { 4 * BUDGET } else { BUDGET });
    for &(factor, part) in parts.as_deref().unwrap_or(&whole) {
        if factor <= 0.0 {
            continue;
        }
        let share = aim / factor / parts.as_ref().map_or(1.0, |p| p.len() as f64);
        let wanted = Wanted { model: part, view, flux, functionals, eta, target: share, budget: &budget };
        let sum = match (part.mirror(view.mu), route) {
            (Some(_), _) => {
                let known = integrate(part, view, flux, functionals, How { aim: share, ..how })?;
                known.iter().enumerate().fold(quad::Sum::ZERO, |mut sum, (c, t)| {
                    (sum.value[c], sum.error[c]) = (t.value, t.error);
                    sum
                })
            }
            (None, Route::First) => wanted.sum(false),
            (None, Route::Second) => wanted.sum(true),
            (None, Route::Drawn) => wanted.drawn(0x0d4a),
        };
        for (c, t) in truths.iter_mut().enumerate() {
            t.value += factor * sum.value[c];
            t.error += factor * sum.error[c] + ROUNDING * (factor * sum.value[c]).abs();
        }
    }
    Some(truths)
}
