//! Ashikhmin's velvet distributions: an inverted Gaussian of the slopes, and the same above a floor.

use super::smith::ALPHA_FLOOR;
use crate::math::frame;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Inverted Gaussian, `D = exp(−cot²θm/σ²)/(π σ² sin⁴θm)`.
///
/// Source: [Ashikhmin2000](crate::cite::ASHIKHMIN_2000) §5.1, normalised. Units: sr⁻¹.
/// Domain: sigma in (0, 2], `wm` unit. Range: ≥ 0, finite; 0 for `wm.z` ≤ 0. Law: `∫ D cos θm dωm = 1`.
/// Guard: the exponent is tested before the division by sin⁴, which it beats. Goes with V-cavity masking.
/// Accuracy: relative 1e-14 + 4e-16 cot²/σ² (`tests/terms.rs`).
#[must_use]
pub fn d_2000(sigma: f64, wm: DVec3) -> f64 {
    let sigma = sigma.max(ALPHA_FLOOR);
    if wm.z > 0.0 { FRAC_1_PI * inverted_gaussian(sigma, wm) / (sigma * sigma) } else { 0.0 }
}

/// Inverted Gaussian on a floor, `D = (1 + 4 exp(−cot²θm/α²)/sin⁴θm)/(π (1 + 4α²))`.
///
/// Source: [Ashikhmin and Premoze 2007](crate::cite::ASHIKHMIN_PREMOZE_2007); norm of
/// [Neubelt and Pettineo 2013](crate::cite::NEUBELT_PETTINEO_2013). A widely copied line lacks the sin⁴.
/// Units: sr⁻¹. Domain: alpha in (0, 1], `wm` unit. Range: > 0 for `wm.z` > 0, finite. Law: `∫ D cos θm dωm = 1`.
/// Accuracy: relative 1e-14 (`tests/terms.rs`).
#[must_use]
pub fn d_2007(alpha: f64, wm: DVec3) -> f64 {
    let alpha = alpha.max(ALPHA_FLOOR);
    if wm.z > 0.0 {
        FRAC_1_PI * (1.0 + 4.0 * inverted_gaussian(alpha, wm)) / (1.0 + 4.0 * alpha * alpha)
    } else {
        0.0
    }
}

/// Visibility of cloth without masking, `V = 1/(4 (mu_o + mu_i − mu_o mu_i))`.
///
/// Source: [Neubelt and Pettineo 2013](crate::cite::NEUBELT_PETTINEO_2013). Range: ≥ 1/4. Guard: both cosines 0 give 0.
/// Symmetric to the bit. Not bounded by energy: with Charlie's D the albedo reaches 1.56 at grazing.
#[must_use]
pub fn visibility_neubelt(mu_o: f64, mu_i: f64) -> f64 {
    let sum = (mu_o + mu_i) - mu_o * mu_i;
    if sum > 0.0 { 0.25 / sum } else { 0.0 }
}

/// `exp(−cot²θ/width²)/sin⁴θ`, 0 at the normal.
fn inverted_gaussian(width: f64, wm: DVec3) -> f64 {
    let sin2 = frame::sin2_theta(wm);
    let cot = wm.z / width;
    let exponent = cot * cot / sin2;
    if exponent < 746.0 { libm::exp(-exponent) / (sin2 * sin2) } else { 0.0 }
}
