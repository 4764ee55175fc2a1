//! Directions in the local frame: n = +z, tangent +x, bitangent +y.
//!
//! Sines come from x² + y², never from 1 − z²: near the normal the latter has no digits left.

use glam::DVec3;

/// `cos θ` of a unit direction, signed.
#[must_use]
pub fn cos_theta(w: DVec3) -> f64 {
    w.z
}

/// μ = |cos θ| of a unit direction, in [0, 1].
#[must_use]
pub fn mu(w: DVec3) -> f64 {
    w.z.abs()
}

/// `cos²θ` of a unit direction.
#[must_use]
pub fn cos2_theta(w: DVec3) -> f64 {
    w.z * w.z
}

/// `sin²θ = x² + y²` of a unit direction; relative accuracy 2⁻⁵² also near the normal.
#[must_use]
pub fn sin2_theta(w: DVec3) -> f64 {
    w.x * w.x + w.y * w.y
}

/// `sin θ` of a unit direction, ≥ 0.
#[must_use]
pub fn sin_theta(w: DVec3) -> f64 {
    sin2_theta(w).sqrt()
}

/// `tan²θ` of a unit direction; +∞ at the horizon, which is its value there.
#[must_use]
pub fn tan2_theta(w: DVec3) -> f64 {
    sin2_theta(w) / cos2_theta(w)
}

/// The angle from the normal, in [0, π] rad.
///
/// atan2(sin θ, cos θ), not acos: acos loses half the digits near the normal.
#[must_use]
pub fn theta(w: DVec3) -> f64 {
    libm::atan2(sin_theta(w), w.z)
}

/// The azimuth from +x, in [−π, π] rad; 0 at the normal.
#[must_use]
pub fn phi(w: DVec3) -> f64 {
    libm::atan2(w.y, w.x)
}

/// The unit direction at polar angle `theta` from +z and azimuth `phi` from +x, both in rad.
#[must_use]
pub fn spherical(theta: f64, phi: f64) -> DVec3 {
    let (sin_theta, cos_theta) = libm::sincos(theta);
    let (sin_phi, cos_phi) = libm::sincos(phi);
    DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
}

/// The unit direction with cosine `mu` to +z in the plane of +x: (√(1 − μ²), 0, μ).
///
/// Domain: |mu| ≤ 1, clamped. 1 − μ² is formed as (1 − μ)(1 + μ).
#[must_use]
pub fn from_mu(mu: f64) -> DVec3 {
    let mu = mu.clamp(-1.0, 1.0);
    DVec3::new(((1.0 - mu) * (1.0 + mu)).sqrt(), 0.0, mu)
}

/// True if both directions lie strictly on the upper side: the support of a reflection.
#[must_use]
pub fn both_above(wo: DVec3, wi: DVec3) -> bool {
    wo.z > 0.0 && wi.z > 0.0
}

/// Mirrors `wo` in the facet normal `wm`: 2 (wo·wm) wm − wo.
///
/// Both unit. Accuracy: the length is 1 within 4 ulp; `dω_i = 4 (wo·wm) dω_m`.
#[must_use]
pub fn reflect(wo: DVec3, wm: DVec3) -> DVec3 {
    2.0 * wo.dot(wm) * wm - wo
}

/// The half vector of two unit directions, with the cosine that both make with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfVector {
    /// normalize(wo + wi).
    pub wh: DVec3,
    /// wo·wh = wi·wh = |wo + wi|/2, in (0, 1]: the cosine of the angle of incidence on the facet.
    pub cos_d: f64,
    /// |wo + wi|² = 4 `cos_d`².
    pub length_squared: f64,
}

/// The half vector `wh = (wo + wi)/|wo + wi|` and `wo·wh = wi·wh = |wo + wi|/2`.
///
/// Source: [Walter2007](crate::cite::WALTER_2007) Eq. 13, for reflection.
/// The cosine is taken from the length, not from a dot product: it is then the same number, bit for bit, when the
/// directions change places, so a BRDF built on it is exactly reciprocal.
/// Guard: `None` if the directions are opposite to each other (|wo + wi| = 0); that is never so for two
/// directions above the surface.
#[must_use]
pub fn half_vector(wo: DVec3, wi: DVec3) -> Option<HalfVector> {
    let h = wo + wi;
    let length_squared = h.length_squared();
    let length = length_squared.sqrt();
    // Rounding may leave a length of 2 + 4e-16 for equal directions; a cosine above 1 is of no use to anyone.
    (length > 0.0).then(|| HalfVector { wh: h / length, cos_d: (0.5 * length).min(1.0), length_squared })
}
