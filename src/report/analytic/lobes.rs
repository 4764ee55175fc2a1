//! Formulas whose results are the parameters of a lobe are judged by the lobe, not by the parameters: how far it is from the model.

use super::{FittedFormula, single};
use crate::cancel::{Cancel, Cancelled};
use crate::tables::Bound;
use rayon::prelude::*;

/// Most points at which lobes are measured: each is an integral or two.
const POINTS: usize = 600;

/// How far lobes are from the model: `(int |f mu_i / E - D|^3 / int (f mu_i / E)^3)^(1/3)` and `int |f mu_i / E - D|`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lobes {
    /// L3 error, L1 error.
    pub errors: [Error; 2],
}

/// One of the errors over all points.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Error {
    /// Largest of the lobes of the formula.
    pub fitted: f64,
    /// Largest of the nearest lobes.
    pub nearest: f64,
    /// Mean of the lobes of the formula.
    pub mean: f64,
    /// The most by which a lobe of the formula is further away than the nearest one.
    pub added: f64,
}

/// A point: base values, the function's arguments, the exact parameters, whether it is in the practical domain.
pub(super) struct Place {
    pub(super) at: Vec<f64>,
    pub(super) arguments: Vec<f64>,
    pub(super) want: Vec<f64>,
    pub(super) practical: bool,
}

/// The errors of the lobes over the whole and the practical domain; none for tables whose numbers are no lobe's.
///
/// A formula whose numbers are no lobe at all is infinitely far.
pub(super) fn measure(
    cancel: &Cancel,
    bound: &Bound,
    fit: &FittedFormula,
    places: &[Place],
) -> Result<Option<[Lobes; 2]>, Cancelled> {
    if places.first().and_then(|p| bound.baker.distance(&p.at, &p.want)).is_none() {
        return Ok(None);
    }
    let step = places.len().div_ceil(POINTS).max(1);
    let one = |place: &Place| {
        cancel.check()?;
        let got: Vec<f64> = fit.evaluate(&single(&place.arguments)).into_iter().map(f64::from).collect();
        let far = [f64::INFINITY; 2];
        let of = |values: &[f64]| bound.baker.distance(&place.at, values).unwrap_or(far);
        Ok((of(&got), of(&place.want), place.practical))
    };
    let all: Vec<_> = places.par_iter().step_by(step).map(one).collect::<Result<_, Cancelled>>()?;
    let over = |inside: &dyn Fn(bool) -> bool| {
        let mut lobes = Lobes::default();
        let chosen: Vec<_> = all.iter().filter(|(.., practical)| inside(*practical)).collect();
        for (k, e) in lobes.errors.iter_mut().enumerate() {
            for (got, want, _) in &chosen {
                e.fitted = e.fitted.max(got[k]);
                e.nearest = e.nearest.max(want[k]);
                e.added = e.added.max(got[k] - want[k]);
                e.mean += got[k] / chosen.len() as f64;
            }
        }
        lobes
    };
    Ok(Some([over(&|_| true), over(&|practical| practical)]))
}

impl Lobes {
    /// What a formula adds to the L3 error of the nearest lobes, at most: what it is judged by.
    #[must_use]
    pub fn added(&self) -> f64 {
        self.errors[0].added
    }

    pub(super) fn line(&self, mark: &str, domain: &str) -> String {
        let one = |name: &str, e: &Error| {
            format!(
                "{name} {:.2e} at most (nearest lobes {:.2e}, the formula adds {:.2e}), mean {:.2e}",
                e.fitted, e.nearest, e.added, e.mean
            )
        };
        format!("{mark} Lobes, {domain}: {}; {}\n", one("L3", &self.errors[0]), one("L1", &self.errors[1]))
    }
}
