//! The clear coat of Disney's principled model of 2012: a long-tailed lobe with masking of its own width.

use super::{gtr, schlick};
use crate::math::frame;
use glam::DVec3;

/// Width of the masking, whatever the gloss.
const MASKING_ALPHA: f64 = 0.25;

/// Reflectance at normal incidence of a coat of index 1.5.
pub const F0: f64 = 0.04;

/// Width of the lobe, `α = 0.1 + gloss (0.001 − 0.1)`.
///
/// Source: [Burley2012](crate::cite::BURLEY_2012) §5.4 and App. B. Domain: gloss in [0, 1]. Range: [0.001, 0.1].
#[must_use]
pub fn alpha(gloss: f64) -> f64 {
    0.1 * (1.0 - gloss) + 0.001 * gloss
}

/// Masking over twice the cosine, `G1/(2 mu) = 1/(mu + √(a² + mu² − a² mu²))`, a = 0.25: GGX's.
///
/// Source: [Burley2012](crate::cite::BURLEY_2012) §5.6, as in the published code (`smithG_GGX`). Range: [0.5, 4].
#[must_use]
pub fn g(mu: f64) -> f64 {
    let a2 = MASKING_ALPHA * MASKING_ALPHA;
    1.0 / (mu + (mu * mu + a2 * (1.0 - mu) * (1.0 + mu)).sqrt())
}

/// The lobe at full weight, `f = D_GTR1(wh; α) F(wo·wh) g(mu_i) g(mu_o)/4` with F0 = 0.04.
///
/// Source: [Burley2012](crate::cite::BURLEY_2012) §5.4 and App. B. g holds the 1/(4 `mu_o mu_i`): do not divide again; the
/// quarter is the published strength. Units: sr⁻¹. Range: ≥ 0, finite. Symmetric to the bit.
/// Accuracy: relative 1e-12 (`tests/functions.rs`).
#[must_use]
pub fn value(gloss: f64, wo: DVec3, wi: DVec3) -> f64 {
    match frame::half_vector(wo, wi) {
        Some(h) if frame::both_above(wo, wi) => {
            let lobe = gtr::d(alpha(gloss), 1.0, h.wh) * schlick::schlick(F0, 1.0, h.cos_d);
            0.25 * lobe * (g(wo.z) * g(wi.z))
        }
        _ => 0.0,
    }
}
