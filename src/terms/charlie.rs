//! Charlie, the sheen of Estevez and Kulla: a power of the sine, so that fibres stand up from the cloth.
//!
//! `roughness` 0.1 is a thin bright rim (satin back-lit), 0.5 velvet, 1 felt. Λ of the height-correlated masking is the
//! authors' fit, not an integral of D.

use super::smith::normal_or_z;
use crate::math::{frame, special};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_1_PI;

/// `D = (2 + 1/r) sin^(1/r) θm/(2π)`.
///
/// Source: [Estevez and Kulla 2017](crate::cite::ESTEVEZ_KULLA_2017) Eq. 2. Units: sr⁻¹.
/// Domain: roughness r in [0.07, 1] (production clamp; down to 1e-6 evaluates), `wm` unit. Range: ≥ 0, finite; 0 for
/// `wm.z` ≤ 0. Law: `∫ D cos θm dωm = 1`. Guard: sin θ = 0 gives 0; r below 1e-6 counts as 1e-6.
/// The power is exp(ln(x² + y²)/(2r)), and log1p(−cos²) near the horizon, where the sine is too close to 1.
/// Accuracy: relative 1e-14 (`tests/terms.rs`).
#[must_use]
pub fn d(roughness: f64, wm: DVec3) -> f64 {
    if wm.z <= 0.0 {
        return 0.0;
    }
    let exponent = 1.0 / roughness.max(1e-6);
    let sin2 = frame::sin2_theta(wm);
    0.5 * FRAC_1_PI * (2.0 + exponent) * special::cos_pow(sin2.sqrt(), frame::cos2_theta(wm), exponent)
}

/// The authors' fit of `Λ(mu)`.
///
/// `Λ = exp(L(mu))` for mu < 1/2, `exp(2 L(1/2) − L(1 − mu))` otherwise, `L(x) = a/(1 + b x^p) + d x + e`, with each
/// coefficient interpolated between two sets by (1 − r)².
/// Source: [Estevez and Kulla 2017](crate::cite::ESTEVEZ_KULLA_2017) Eq. 3 and its table.
/// Domain: mu = |cos θ| in [0, 1], roughness r in [0, 1]. Range: > 0, finite.
/// Infinite slope at 0 and 1 (x^p, p < 0.2) and a kink in the second derivative at 1/2: grade quadratures there.
/// Accuracy: relative 1e-14 as a fit; what it fits is not claimed here (`tests/terms.rs`).
#[must_use]
pub fn lambda(roughness: f64, mu: f64) -> f64 {
    let l = |x| fit(roughness, x);
    let mu = mu.clamp(0.0, 1.0);
    libm::exp(if mu < 0.5 { l(mu) } else { 2.0 * l(0.5) - l(1.0 - mu) })
}

/// L(x) of [`lambda`].
fn fit(roughness: f64, x: f64) -> f64 {
    const AT_0: [f64; 5] = [25.3245, 3.32435, 0.16801, -1.27393, -4.85967];
    const AT_1: [f64; 5] = [21.5473, 3.82987, 0.19823, -1.97760, -4.32054];
    let weight = (1.0 - roughness) * (1.0 - roughness);
    let at = |i: usize| weight * AT_0[i] + (1.0 - weight) * AT_1[i];
    at(0) / (1.0 + at(1) * libm::pow(x, at(2))) + at(3) * x + at(4)
}

/// Visibility `V = 1/(4 mu_o mu_i (1 + Λ_o + Λ_i))` with the fitted Λ.
///
/// Source: [Estevez and Kulla 2017](crate::cite::ESTEVEZ_KULLA_2017) §3. Range: ≥ 0, finite; 0 if a cosine is ≤ 0.
/// Symmetric to the bit. The BRDF `D V` keeps E < 1 for roughness ≥ 0.07 and mu ≥ 1e-5, and not elsewhere: the fitted Λ is
/// finite at the horizon.
#[must_use]
pub fn visibility(roughness: f64, mu_o: f64, mu_i: f64) -> f64 {
    visibility_of([mu_o, mu_i], [lambda(roughness, mu_o), lambda(roughness, mu_i)])
}

/// [`visibility`] of two cosines whose [`lambda`] is known: many directions share one.
#[must_use]
pub fn visibility_of([mu_o, mu_i]: [f64; 2], [lambda_o, lambda_i]: [f64; 2]) -> f64 {
    let product = 4.0 * (mu_o * mu_i);
    if mu_o > 0.0 && mu_i > 0.0 && product > 0.0 {
        1.0 / (product * (1.0 + (lambda_o + lambda_i)))
    } else {
        0.0
    }
}

/// Softened `Λ(mu)^(1 + 2 (1 − mu)⁸)` of the light direction, against the hard terminator of bump-mapped cloth.
///
/// Source: [Estevez and Kulla 2017](crate::cite::ESTEVEZ_KULLA_2017) Eq. 4. Applied to one direction only, so the BRDF
/// is then not reciprocal. Domain: as [`lambda`]. Range: > 0, finite.
#[must_use]
pub fn lambda_softened(roughness: f64, mu_i: f64) -> f64 {
    let m = (1.0 - mu_i.clamp(0.0, 1.0)) * (1.0 - mu_i.clamp(0.0, 1.0));
    let m4 = m * m;
    libm::pow(lambda(roughness, mu_i), 1.0 + 2.0 * m4 * m4)
}

/// A fibre normal with density `D cos θm`: `sin θm = u1^(r/(2r + 1))`, azimuth 2π u2.
///
/// Source: inverse of the integral of [`d`]. Domain: u in [0, 1]². For rendering, a uniform hemisphere of directions is
/// the better density: the lobe is broad.
#[must_use]
pub fn sample_d(roughness: f64, u: DVec2) -> DVec3 {
    let r = roughness.max(1e-6);
    let log_sin = libm::log(u.x.min(1.0)) * (r / (2.0 * r + 1.0));
    let sin = libm::exp(log_sin);
    let cos = (-libm::expm1(2.0 * log_sin)).max(0.0).sqrt();
    let (cos_phi, sin_phi) = special::circle(u.y);
    normal_or_z(DVec3::new(sin * cos_phi, sin * sin_phi, cos))
}
