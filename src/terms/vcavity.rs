//! Masking and shadowing of symmetric V-shaped grooves (Torrance and Sparrow; Cook and Torrance).
//!
//! Each facet is one side of a long groove whose other side mirrors it. Exact for that geometry, energy conserving,
//! and independent of the distribution of normals; its kinks show as edges in renderings and in tables.

use glam::DVec3;

/// `G2 = min(1, 2 (n·m)(n·wo)/(wo·m), 2 (n·m)(n·wi)/(wi·m))`.
///
/// Source: [Cook and Torrance 1982](crate::cite::COOK_TORRANCE_1982) §"geometrical attenuation"; with wo·m = wi·m =
/// `cos_d` for the half vector. Domain: `wo`, `wi` above the surface, `wm` their half vector. Range: [0, 1].
/// Guard: `cos_d` ≤ 0 gives 0. Symmetric to the bit. Kinks: where the arguments of min cross; in slopes (x along the
/// incidence azimuth, T = tan θ) at x = 1/T and on (3 + T x)(1 + r²) = 4 (1 + T x).
#[must_use]
pub fn g2(wo: DVec3, wi: DVec3, wm: DVec3, cos_d: f64) -> f64 {
    g1(wo, wm, cos_d).min(g1(wi, wm, cos_d))
}

/// Masking alone, `G1 = min(1, 2 (n·m)(n·w)/(w·m))`; `cos_d` = w·m.
///
/// Source: [Heitz2014](crate::cite::HEITZ_2014) §4.2. Range: [0, 1].
/// Law: `∫ G1 D max(0, w·m) dωm = n·w`, as for Smith's.
#[must_use]
pub fn g1(w: DVec3, wm: DVec3, cos_d: f64) -> f64 {
    if cos_d > 0.0 && wm.z > 0.0 && w.z > 0.0 { (2.0 * wm.z * (w.z / cos_d)).min(1.0) } else { 0.0 }
}
