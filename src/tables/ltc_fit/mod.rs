//! The linearly transformed cosine that is nearest to a reflectance model at a view.
//!
//! What is made small is the error of Heitz et al. and of their fitter: `int |f mu_i / E - D|^3 dwi` over the whole sphere,
//! with E the exact albedo of the model, so that the fit has no say in the energy. Their fitter fixes the axis of the lobe to the
//! mean direction and searches three numbers; here all four of the matrix are free.
//!
//! The model is evaluated once a level at the nodes of its own [`Chart`](crate::integrate::Chart); the lobe below the horizon,
//! where the model is 0, is integrated in the space of the cosine. The search is Newton's, from the moments of the target, in rounds:
//! a lobe that went far from the one whose nodes it is judged on gets nodes of its own, or it would shrink between them to a lobe that
//! only they see. Then the level is raised until the matrices of three levels agree. Nothing depends on neighbouring texels.

mod newton;
mod objective;
mod pole;
mod proposal;
mod target;

pub use pole::has_pole;

use super::TexelError;
use crate::integrate::{Trust, View};
use crate::models::Brdf;
use crate::terms::ltc::Inverse;
use newton::Optimum;
use objective::Slices;
use target::Target;

/// Which matrices are searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// All that are even in y: four numbers.
    Even,
    /// Those of them with m31 = 0, whose lobes end at the horizon of the surface: three numbers.
    Level,
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
            Family::Level => &[[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]],
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
            Family::Level => Inverse { m31: 0.0, m33, ..*b },
            Family::Sheared => Inverse { m11: scale, m22: scale, m13: b.m13 / m33, m31: 0.0, m33: 1.0 },
            Family::Round => Inverse { m11: scale, m22: scale, ..Inverse::COSINE },
        }
    }
}

/// A fit and what it costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MatrixFit {
    /// The inverse matrix, its middle entry 1.
    pub inverse: Inverse,
    /// `(int |f mu_i / E - D|^3 / int (f mu_i / E)^3)^(1/3)`: 0 for a perfect fit.
    pub l3: f64,
    /// `1/2 int |f mu_i / E - D|`, the total variation distance of the two densities: 0 to 1.
    pub variation: f64,
    /// `int f mu_i dwi`.
    pub albedo: f64,
}

impl MatrixFit {
    /// Where nothing is reflected there is nothing to be far from.
    fn dark(inverse: Inverse) -> MatrixFit {
        MatrixFit { inverse, l3: 0.0, variation: 0.0, albedo: 0.0 }
    }
}

/// A fit with estimated numerical errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitted {
    /// At the finest level.
    pub fit: MatrixFit,
    /// Estimated errors: those of the entries are one number, the largest.
    pub error: FitError,
    /// Evaluations of model and lobe.
    pub evaluations: u32,
}

/// Estimated numerical errors of a [`MatrixFit`]: how well the best matrix is known, not how good it is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FitError {
    /// Of the entries of the inverse matrix over its middle one.
    pub entries: f64,
    /// Of [`MatrixFit::l3`].
    pub l3: f64,
    /// Of [`MatrixFit::variation`].
    pub variation: f64,
    /// Of [`MatrixFit::albedo`].
    pub albedo: f64,
}

/// How well a fit is known, as the one who asked for it sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Known {
    /// As well as it was asked for.
    Wholly,
    /// Its lobe is, the entries of its matrix are not: a broad lobe leaves them loose.
    Lobe,
    /// Not even its lobe.
    Neither,
}

/// Levels of the charts.
const LEVELS: [f64; 11] = [4.0, 5.6, 8.0, 11.0, 15.0, 20.0, 27.0, 38.0, 54.0, 76.0, 108.0];

/// As many of them are for the entries; the last ones, which cost eight times as much, only for lobes that are not known.
const FOR_ENTRIES: usize = 9;

/// Longest way of a search on the nodes of one lobe, and the most rounds: nodes see a lobe of half the width as well.
const REACH: f64 = 0.5;
const ROUNDS: u32 = 40;

/// Trust in them: the last two differences count alike, the last one twice.
const TRUST: Trust = Trust { gain: &[0.5], memory: &[0.5] };

/// Relative error below which Newton's method is needed in full at every level.
const NEARLY_PERFECT: f64 = 1e-3;

/// Fits the model at a view, with ever finer nodes until it is [`Known::Wholly`] or the levels end.
///
/// A surface that reflects nothing at this view gets the clamped cosine and no error: nothing is multiplied by it.
///
/// # Errors
/// [`TexelError::NoWidth`] for a mirror, [`TexelError::NotFinite`] where the model is not.
pub fn fit(
    model: &dyn Brdf,
    view: View,
    family: Family,
    known: impl Fn(&Fitted) -> Known,
) -> Result<Fitted, TexelError> {
    // along the normal every lobe of an isotropic surface is round
    let round = view.sine().abs() == 0.0 && !model.turns();
    let family = if round { Family::Round } else { family };
    let mut nodes = Slices::default();
    let mut evaluations = 0u32;
    let mut fits: Vec<MatrixFit> = Vec::new();
    let mut last: Option<(Optimum, f64)> = None;
    let mut best: Option<Fitted> = None;
    for level in LEVELS {
        let target = Target::new(model, view, level)?;
        if target.is_dark() {
            return Ok(Fitted {
                fit: MatrixFit::dark(Inverse::COSINE),
                error: FitError::default(),
                evaluations,
            });
        }
        let found = search(&target, family, last.as_ref(), &mut nodes);
        evaluations = evaluations.saturating_add(found.evaluations);
        let fit = MatrixFit {
            inverse: found.inverse,
            l3: libm::cbrt(found.at.value / target.cube),
            variation: target.variation(&found.inverse),
            albedo: target.albedo,
        };
        fits.push(fit);
        last = Some((Optimum { evaluations: 0, ..found }, fit.l3));
        let fitted = Fitted { fit, error: error(&fits), evaluations };
        if !(fit.l3 + fit.variation + difference(&fit, &fit).entries).is_finite() {
            return Err(TexelError::NotFinite { channel: 0, value: fit.l3 });
        }
        if fits.len() > 2 {
            let now = known(&fitted);
            if now == Known::Wholly {
                return Ok(fitted);
            }
            // where the levels end without content, the one whose lobe is known best
            let of_the_lobe = |f: &Fitted| f.error.l3.max(f.error.variation);
            if best.is_none_or(|b| of_the_lobe(&fitted) < of_the_lobe(&b)) {
                best = Some(fitted);
            }
            if now == Known::Lobe && fits.len() >= FOR_ENTRIES {
                break;
            }
        }
    }
    best.map(|b| Fitted { evaluations, ..b }).ok_or(TexelError::NoWidth)
}

/// The best matrix on the nodes of a level, from that of the level before (with its error) or from the moments.
fn search(target: &Target<'_>, family: Family, last: Option<&(Optimum, f64)>, nodes: &mut Slices) -> Optimum {
    let Some((last, l3)) = last else {
        return settle(target, family.nearest(&target.moments()), family, nodes);
    };
    // the Hessian of a nearly perfect fit vanishes with its error, and is that of no other nodes
    if *l3 > NEARLY_PERFECT {
        target.nodes_for(&last.inverse, nodes);
        if let Some(found) = newton::refine(nodes, last, family) {
            return found;
        }
    }
    settle(target, last.inverse, family, nodes)
}

/// The best matrix on nodes that were made for one like it.
fn settle(target: &Target<'_>, mut start: Inverse, family: Family, nodes: &mut Slices) -> Optimum {
    let mut evaluations = 0u32;
    let mut round = 0;
    loop {
        target.nodes_for(&start, nodes);
        let found = newton::minimise(nodes, start, family, REACH);
        evaluations = evaluations.saturating_add(found.evaluations);
        round += 1;
        if found.way <= REACH || round == ROUNDS {
            return Optimum { evaluations, ..found };
        }
        start = found.inverse;
    }
}

/// The error of the last fit from the last three: the kinks of `|r|^3` are met at random, so two levels may agree by chance.
///
/// As [`Trust`] says, with all of the difference before last remembered. Measured on GGX, 484 texels, against fits good to 3e-5: the
/// error of the entries is below it for 97 % of texels at 2.4e-4 and 1e-3, and for all but one at 1e-2; at most 10 times above.
fn error(fits: &[MatrixFit]) -> FitError {
    let [.., first, second, last] = fits else { return FitError::default() };
    let (before, now) = (difference(first, second), difference(second, last));
    let worse = |before: f64, now: f64| TRUST.error(fits.len() - 1, before, now);
    FitError {
        entries: worse(before.entries, now.entries),
        l3: worse(before.l3, now.l3),
        variation: worse(before.variation, now.variation),
        albedo: worse(before.albedo, now.albedo),
    }
}

fn difference(a: &MatrixFit, b: &MatrixFit) -> FitError {
    let (p, q) = (&a.inverse, &b.inverse);
    let entries = [p.m11 - q.m11, p.m13 - q.m13, p.m31 - q.m31, p.m33 - q.m33];
    FitError {
        entries: entries.iter().fold(0.0, |m, d| if d.is_nan() { *d } else { m.max(d.abs()) }),
        l3: (a.l3 - b.l3).abs(),
        variation: (a.variation - b.variation).abs(),
        albedo: (a.albedo - b.albedo).abs(),
    }
}

/// The sheared lobe that is nearest to a density on nodes `(direction, density, weight)`, whatever measure the weights are of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheared {
    /// a of `[[a, 0, b], [0, a, 0], [0, 0, 1]]`.
    pub a: f64,
    /// b of it.
    pub b: f64,
    /// `(sum w |p - D|^3 / sum w p^3)^(1/3)`.
    pub l3: f64,
    /// Evaluations of the lobe.
    pub evaluations: u32,
}

/// The nearest sheared lobe, the best of those found from `starts`, pairs of a and b; b stays 0 for `round` lobes.
///
/// `None` without starts.
#[must_use]
pub fn nearest_sheared(
    nodes: impl Iterator<Item = (glam::DVec3, f64, f64)>,
    starts: &[[f64; 2]],
    round: bool,
) -> Option<Sheared> {
    let mut slices = Slices::default();
    let mut cube = 0.0;
    for (w, lobe, weight) in nodes {
        cube += weight * lobe * lobe * lobe;
        slices.push(&target::Node { w, lobe, weight });
    }
    slices.pad();
    let family = if round { Family::Round } else { Family::Sheared };
    let search = |&[a, b]: &[f64; 2]| {
        let start = Inverse { m11: a, m13: b, m22: a, m31: 0.0, m33: 1.0 };
        newton::minimise(&slices, family.nearest(&start), family, f64::INFINITY)
    };
    let found: Vec<Optimum> = starts.iter().map(search).collect();
    let evaluations = found.iter().fold(0u32, |sum, f| sum.saturating_add(f.evaluations));
    let best = found.iter().min_by(|p, q| p.at.value.total_cmp(&q.at.value))?;
    let (a, b) = (best.inverse.m22 / best.inverse.m33, best.inverse.m13 / best.inverse.m33);
    Some(Sheared { a, b, l3: libm::cbrt(best.at.value / cube), evaluations })
}

/// The errors of a given matrix at a view, at a level of the charts (8 is good to about 1e-4 of them).
///
/// # Errors
/// As [`fit`].
pub fn judge(model: &dyn Brdf, view: View, inverse: &Inverse, level: f64) -> Result<MatrixFit, TexelError> {
    let target = Target::new(model, view, level)?;
    if target.is_dark() {
        return Ok(MatrixFit::dark(*inverse));
    }
    let mut nodes = Slices::default();
    target.nodes_for(inverse, &mut nodes);
    let at = objective::objective(&nodes, inverse);
    Ok(MatrixFit {
        inverse: *inverse,
        l3: libm::cbrt(at.value / target.cube),
        variation: target.variation(inverse),
        albedo: target.albedo,
    })
}

/// The errors of a given matrix at a view at the first two levels that tell the same, and how far apart those are.
///
/// # Errors
/// As [`fit`].
pub fn judged(model: &dyn Brdf, view: View, inverse: &Inverse) -> Result<(MatrixFit, f64), TexelError> {
    let apart = |a: &MatrixFit, b: &MatrixFit| (a.l3 - b.l3).abs().max((a.variation - b.variation).abs());
    let mut last = judge(model, view, inverse, JUDGED_AT[0])?;
    let mut off = f64::INFINITY;
    for level in &JUDGED_AT[1..] {
        let next = judge(model, view, inverse, *level)?;
        (off, last) = (apart(&last, &next), next);
        if off <= THE_SAME {
            break;
        }
    }
    Ok((last, off))
}

/// Levels of the charts at which [`judged`] looks, and what counts as the same.
const JUDGED_AT: [f64; 6] = [8.0, 11.0, 15.0, 20.0, 27.0, 38.0];
const THE_SAME: f64 = 5e-4;
