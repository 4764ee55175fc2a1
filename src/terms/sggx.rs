//! SGGX: a volume of ellipsoidal flakes or fibres, here the upright fibres behind the sheen of Zeltner and others.
//!
//! S = diag(1, 1, σ²): σ < 1 are fibres along the normal. σ = 0.1 stands on end like velvet, 1 is isotropic dust.

use super::smith::ALPHA_FLOOR;
use crate::math::frame;
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI};

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

/// Fourier coefficients `K_m = 1/(2π) ∫ K cos(mφ) dφ` of what the fibres scatter per length and sr, `K = D(h)/4`.
///
/// `from` and `to` are the polar angles of the directions of travel, 0 to π, φ is between their azimuths, h the unit vector along the
/// difference of the two; `difference` is `to − from` without rounding. In closed form: with `z = (cos − cos')²`,
/// `c = σ²(sin² + sin'²) + z`, `d = 2σ² sin sin'`, `Q = sin² + sin'² + z` and `b = 2 sin sin'`,
/// `K = σ³/(4π) ((Q − b cos φ)/(c − d cos φ))²`, and `1/(c − d cos φ)` has the coefficients `r^m/√(c² − d²)`,
/// `r = d/(c + √(c² − d²))`.
/// Source: [Heitz2015](crate::cite::HEITZ_2015) Eq. 11 and 13 for K. Law: `2π ∫ K_0 sin = ` [`projected_area`].
/// Guard: equal angles give the limit `1/(4πσ)`. Near them K is a constant less two small terms, and is formed so.
/// Accuracy: absolute 1e-13 of `K_0` (`tests/sheen.rs`).
pub fn kernel_modes(sigma: f64, from: f64, to: f64, difference: f64, modes: &mut [f64]) {
    let (s2, half, mean) = (sigma * sigma, libm::sin(0.5 * difference), 0.5 * (from + to));
    let (sin, other) = (libm::sin(from), libm::sin(to));
    let (up, out) = (2.0 * libm::sin(mean) * half, 2.0 * libm::cos(mean) * half);
    let (z, sum) = (up * up, sin + other);
    let (low, high) = (s2 * out * out + z, s2 * sum * sum + z);
    let root = (low * high).sqrt();
    let flat = 0.25 * FRAC_1_PI / sigma;
    if root <= 0.0 {
        modes.fill(0.0);
        modes.iter_mut().take(1).for_each(|m| *m = flat);
        return;
    }
    let (c, b) = (0.5 * (low + high), 2.0 * sin * other);
    let (g, r) = (1.0 / root, s2 * b / (c + root));
    let ratio = c * g;
    if z * g < 0.5 && r > 0.5 {
        let u = (1.0 - s2) * z * g;
        let mut power = 1.0;
        for (m, mode) in modes.iter_mut().enumerate() {
            let constant = if m == 0 { 1.0 } else { 0.0 };
            *mode = flat * (constant - 2.0 * u * power + u * u * power * (m as f64 + ratio));
            power *= r;
        }
        return;
    }
    // coefficients of 1/(c - d cos phi)^2, times (Q - b cos phi)^2
    let q = sin * sin + other * other + z;
    let mut power = r * r;
    let square = |m: f64, power: f64| g * g * power * (m + ratio);
    let mut h = [square(2.0, power), square(1.0, r), square(0.0, 1.0), square(1.0, r), square(2.0, power)];
    let scale = s2 * sigma / (4.0 * PI);
    for (m, mode) in modes.iter_mut().enumerate() {
        *mode = scale * (q * q * h[2] - q * b * (h[1] + h[3]) + 0.25 * b * b * (h[0] + 2.0 * h[2] + h[4]));
        power *= r;
        h.rotate_left(1);
        h[4] = square(m as f64 + 3.0, power);
    }
}
