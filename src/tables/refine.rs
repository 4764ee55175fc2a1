//! Channels that are quotients of integrals magnify their errors: the integrals are asked for again, with more digits.

use super::TexelError;
use crate::integrate::Estimate;

/// How often.
const REFINEMENTS: usize = 3;

/// How much more is asked for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Refinement {
    /// What the texel is to be known to.
    pub(super) tolerance: f64,
    /// What its integrals are asked for at first.
    pub(super) first: f64,
    /// Part of what the magnification leaves that is asked for next.
    pub(super) share: f64,
    /// The least that is asked for.
    pub(super) least: f64,
}

/// Computes a texel from integrals to the tolerance that `texel` is given, until the largest of the errors that `error` finds in it
/// is good enough. All evaluations are counted.
pub(super) fn refined(
    how: Refinement,
    texel: impl Fn(f64) -> Result<Estimate, TexelError>,
    error: impl Fn(&Estimate) -> f64,
) -> Result<Estimate, TexelError> {
    let Refinement { tolerance, first, share, least } = how;
    let mut inner = first;
    let mut all = texel(inner)?;
    for _ in 0..REFINEMENTS {
        let largest = error(&all);
        if largest <= tolerance || largest.is_nan() {
            break;
        }
        inner = (share * inner * tolerance / largest).max(least);
        let before = all.evaluations;
        all = texel(inner)?;
        all.evaluations = all.evaluations.saturating_add(before);
    }
    Ok(all)
}

/// The largest error of the first `channels`.
pub(super) fn largest(estimate: &Estimate, channels: usize) -> f64 {
    estimate.error[..channels].iter().copied().fold(0.0, f64::max)
}
