//! The specular of skin in GPU Gems 3: Kelemen and Szirmay-Kalos with Beckmann facets.

use super::{kelemen, schlick};
use crate::math::frame;
use glam::DVec3;

/// Reflectance of skin at normal incidence in the chapter: index 1.4, rounded.
pub const F0: f64 = 0.028;

/// `PH F/|wo + wi|²` without strength and cosine: π times the BRDF.
///
/// Source: [d'Eon and Luebke 2007](crate::cite::DEON_LUEBKE_2007) §14.3; [Kelemen2001](crate::cite::KELEMEN_2001).
/// `PH` is π D, so the published lobe is π times a BRDF: right for lights whose intensity carries π.
/// Units: 1. Range: ≥ 0. Symmetric to the bit. 0 unless both directions are above the surface.
/// Accuracy: relative 1e-12 (`tests/functions.rs`).
#[must_use]
pub fn lobe(m: f64, f0: f64, wo: DVec3, wi: DVec3) -> f64 {
    match frame::half_vector(wo, wi) {
        Some(h) if frame::both_above(wo, wi) => {
            kelemen::distribution(h.wh.z, m) * schlick::schlick(f0, 1.0, h.cos_d) / h.length_squared
        }
        _ => 0.0,
    }
}

/// What the shader returns, `mu_i rho_s PH F/|wo + wi|²`: a shading value, not a BRDF.
#[must_use]
pub fn shading(m: f64, strength: f64, f0: f64, wo: DVec3, wi: DVec3) -> f64 {
    wi.z.max(0.0) * strength * lobe(m, f0, wo, wi)
}
