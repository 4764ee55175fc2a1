//! GTR, Burley's generalised Trowbridge-Reitz distribution: the tail has a free exponent γ.
//!
//! γ = 1 has the longest tail (Berry's; the clear coat of 2012), γ = 2 is GGX, larger γ approach a Gaussian. Isotropic.
//! No closed masking is known for γ other than 1 and 2; the clear coat of 2012 uses GGX's with its own width.

use super::smith::{ALPHA_FLOOR, normal_or_z};
use crate::math::frame;
use crate::math::special::{circle, exprel};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_1_PI;

/// `D = c/(1 + (α² − 1) cos²θm)^γ`, `c = (γ − 1)(α² − 1)/(π (1 − α^(2(1 − γ))))`.
///
/// The norm is 0/0 at γ = 1 and at α = 1; it is formed as `c = φ(L)/(π φ((1 − γ) L))`, φ(t) = (eᵗ − 1)/t, L = ln α²,
/// which is regular at both. The base is α² cos²θ + sin²θ, without cancellation for small α.
/// Source: [Burley2012](crate::cite::BURLEY_2012) App. B.2; Eq. 4 is the limit at γ = 1, Eq. 13 with two widths at γ = 2 is GGX.
/// Units: sr⁻¹. Domain: α in (0, 2], γ in (0, 10], `wm` unit. Range: ≥ 0, finite; 0 for `wm.z` ≤ 0.
/// Guard: α below [`ALPHA_FLOOR`] counts as that. Law: `∫ D cos θm dωm = 1`.
/// Accuracy: relative 1e-13 (`tests/terms.rs`).
#[must_use]
pub fn d(alpha: f64, gamma: f64, wm: DVec3) -> f64 {
    if wm.z <= 0.0 {
        return 0.0;
    }
    let alpha = alpha.max(ALPHA_FLOOR);
    let log_square = 2.0 * libm::log(alpha);
    let norm = FRAC_1_PI * exprel(log_square) / exprel((1.0 - gamma) * log_square);
    let base = alpha * alpha * wm.z * wm.z + frame::sin2_theta(wm);
    norm * libm::pow(base, -gamma)
}

/// A facet normal with density `D cos θm` from (u1, u2); azimuth 2π u2.
///
/// `cos²θ = (1 − [α^(2(1−γ))(1 − u1) + u1]^(1/(1−γ)))/(1 − α²)`, for γ = 1 `(1 − α^(2(1−u1)))/(1 − α²)`.
/// Source: [Burley2012](crate::cite::BURLEY_2012) App. B.2, in one form for all γ and α:
/// with L = ln α², x = (1 − γ)L, ρ = log1p((eˣ − 1)(1 − u1))/x and τ = 1 − ρ = −log1p((e⁻ˣ − 1) u1)/x,
/// `cos²θ = ρ φ(ρL)/φ(L)` and `sin²θ = e^(ρL) τ φ(τL)/φ(L)`, so neither is a difference.
/// Domain: u in [0, 1]². Guard: as [`d`].
#[must_use]
pub fn sample_d(alpha: f64, gamma: f64, u: DVec2) -> DVec3 {
    let log_square = 2.0 * libm::log(alpha.max(ALPHA_FLOOR));
    let x = (1.0 - gamma) * log_square;
    let (rho, tau) = if x == 0.0 {
        (1.0 - u.x, u.x)
    } else {
        (libm::log1p(libm::expm1(x) * (1.0 - u.x)) / x, -libm::log1p(libm::expm1(-x) * u.x) / x)
    };
    // At the ends of [0, 1] a logarithm may reach −∞ by rounding.
    let (rho, tau) = (rho.clamp(0.0, 1.0), tau.clamp(0.0, 1.0));
    let norm = exprel(log_square);
    let cos2 = rho * exprel(rho * log_square) / norm;
    let sin2 = libm::exp(rho * log_square) * tau * exprel(tau * log_square) / norm;
    let (cos_phi, sin_phi) = circle(u.y);
    let sin = sin2.max(0.0).sqrt();
    normal_or_z(DVec3::new(sin * cos_phi, sin * sin_phi, cos2.max(0.0).sqrt()))
}
