//! Blinn-Phong: a power of the cosine between facet and normal, as a distribution of normals.
//!
//! `n` = 1 is nearly matte, 10 satin, 100 plastic, 1e4 a polished ball. Close to Beckmann with `alpha² = 2/(n + 2)`.

use super::smith::normal_or_z;
use crate::math::{frame, special};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_1_PI;

/// `D = (n + 2)/(2π) cosⁿθm`, so that `∫ D cos θm dωm = 1`.
///
/// Source: [Walter2007](crate::cite::WALTER_2007) (the Phong distribution; [BBM](crate::cite::BBM) `ndf/phong.h` has the same form); Blinn's lobe with the norm of a
/// distribution of normals, which is not the norm of a BRDF (that one is near (n + 8)/8π).
/// Units: sr⁻¹. Domain: n in [0, 1e7], `wm` unit. Range: ≥ 0, finite; 0 for `wm.z` ≤ 0.
/// Accuracy: relative 1e-15 (1 + n |ln cos θ|) (`tests/terms.rs`).
#[must_use]
pub fn d(n: f64, wm: DVec3) -> f64 {
    if wm.z <= 0.0 {
        return 0.0;
    }
    0.5 * FRAC_1_PI * (n + 2.0) * special::cos_pow(wm.z, frame::sin2_theta(wm), n)
}

/// Beckmann's width of equal peak, `alpha = √(2/(n + 2))`.
///
/// Source: [Walter2007](crate::cite::WALTER_2007) §5.2: the two peaks of D agree. Domain: n ≥ 0. Range: (0, 1].
#[must_use]
pub fn equivalent_alpha(n: f64) -> f64 {
    (2.0 / (n + 2.0)).sqrt()
}

/// A facet normal with density `D cos θm`: `cos θm = u1^(1/(n + 2))`, azimuth 2π u2.
///
/// Source: [Walter2007](crate::cite::WALTER_2007) (the Phong distribution; [BBM](crate::cite::BBM) `ndf/phong.h` draws the same). Domain: u in [0, 1]².
/// The sine is −expm1 of twice the logarithm: it keeps its digits for n = 1e7. u1 = 0 gives the horizon.
#[must_use]
pub fn sample_d(n: f64, u: DVec2) -> DVec3 {
    let log_cos = libm::log(u.x.min(1.0)) / (n + 2.0);
    let sin = (-libm::expm1(2.0 * log_cos)).max(0.0).sqrt();
    let (cos_phi, sin_phi) = special::circle(u.y);
    normal_or_z(DVec3::new(sin * cos_phi, sin * sin_phi, libm::exp(log_cos)))
}
