//! SGGX: a volume of ellipsoidal flakes or fibres, here the upright fibres behind the sheen of Zeltner and others.
//!
//! S = diag(1, 1, σ²): σ < 1 are fibres along the normal. σ = 0.1 stands on end like velvet, 1 is isotropic dust.

use super::smith::ALPHA_FLOOR;
use crate::math::frame;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Projected area of the fibres per volume, `√(x² + y² + σ² z²)`.
///
/// Source: [Heitz2015](crate::cite::HEITZ_2015) Eq. 10. Domain: `w` unit, sigma in (0, 1]. Range: [σ, 1].
#[must_use]
pub fn projected_area(sigma: f64, w: DVec3) -> f64 {
    (frame::sin2_theta(w) + sigma * sigma * w.z * w.z).sqrt()
}

/// Distribution of normals over the whole sphere, `D = 1/(π σ (x² + y² + z²/σ²)²)`.
///
/// Source: [Heitz2015](crate::cite::HEITZ_2015) Eq. 11. Units: sr⁻¹. Law: `∫ D max(0, w·m) dω_m` = [`projected_area`].
/// Guard: sigma below [`ALPHA_FLOOR`] counts as that. Accuracy: relative 1e-14 (`tests/terms.rs`).
#[must_use]
pub fn d(sigma: f64, wm: DVec3) -> f64 {
    let sigma = sigma.max(ALPHA_FLOOR);
    // (σ² (x² + y²) + z²)/σ², so that nothing overflows
    let square = sigma * sigma * frame::sin2_theta(wm) + wm.z * wm.z;
    FRAC_1_PI * sigma * sigma * sigma / (square * square)
}

/// Single scattering of a layer of unit depth and unit albedo of specular fibres.
///
/// `f = D(wh)/4 · (1 − exp(−(l_i + l_o)))/((l_i + l_o) mu_i mu_o)`, l = σ(w)/mu.
/// Source: [Zeltner2022](crate::cite::ZELTNER_2022) §3 with the phase function of [Heitz2015](crate::cite::HEITZ_2015) Eq. 13.
/// Units: sr⁻¹. Domain: both directions above the surface. Range: ≥ 0, finite. Symmetric to the bit.
/// (l_i + l_o) `mu_i mu_o` is formed as σ_i `mu_o` + σ_o `mu_i`, which is not 0·∞ at the horizon.
/// Accuracy: relative 1e-13 (`tests/functions.rs`).
#[must_use]
pub fn single_scattering(sigma: f64, wo: DVec3, wi: DVec3) -> f64 {
    let Some(h) = frame::half_vector(wo, wi) else { return 0.0 };
    if !frame::both_above(wo, wi) {
        return 0.0;
    }
    let area = projected_area(sigma, wi) * wo.z + projected_area(sigma, wo) * wi.z;
    let depth = area / (wo.z * wi.z);
    0.25 * d(sigma, h.wh) * -libm::expm1(-depth) / area
}
