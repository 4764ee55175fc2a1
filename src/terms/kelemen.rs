//! Kelemen and Szirmay-Kalos' visibility, and the Beckmann texture of GPU Gems 3 chapter 14.
//!
//! Skin shaders look up `PH(u, m) = exp(−tan²θ/m²)/(m² u⁴)`, u = cos θ of the half vector, from an 8-bit texture that
//! stores `0.5 PH^0.1`. `PH` is π D: the published code leaves the 1/π out, which is right for point lights whose
//! intensity already carries π and wrong by π for radiance. This module returns what the texture holds.

use glam::DVec3;

/// Geometry over cosines, `G/(4 mu_o mu_i) ≈ 1/|wo + wi|² = 1/(4 (wi·wh)²)`.
///
/// Source: [Kelemen2001](crate::cite::KELEMEN_2001) (the visibility of a half vector). Units: 1. Range: [1/4, ∞).
/// Symmetric to the bit. Guard: opposite directions, |wo + wi| = 0, give 0; two directions above the surface are not.
#[must_use]
pub fn visibility(wo: DVec3, wi: DVec3) -> f64 {
    let length_squared = (wo + wi).length_squared();
    if length_squared > 0.0 { 1.0 / length_squared } else { 0.0 }
}

/// What the texture encodes, `PH(u, m) = exp(−tan²θ/m²)/(m² u⁴)`: π times Beckmann's D.
///
/// Source, guard: as [`encode`]. Range: ≥ 0; finite for m ≥ 1e-150. Accuracy: relative 1e-14 + 4e-16 tan²θ/m²
/// (`tests/functions.rs`).
#[must_use]
pub fn distribution(u: f64, m: f64) -> f64 {
    if u <= 0.0 || m <= 0.0 {
        return 0.0;
    }
    let u = u.min(1.0);
    let tan_over_m = ((1.0 - u) * (1.0 + u)).sqrt() / u / m;
    let exponent = tan_over_m * tan_over_m;
    // Before the division: u⁴ may underflow.
    if exponent < 746.0 { libm::exp(-exponent) / (m * m * u * u * u * u) } else { 0.0 }
}

/// The value of a texel, `0.5 PH(u, m)^0.1`, before quantisation and not clipped.
///
/// `u = cos θ_h` (columns), `m` = Beckmann's α (rows). Logarithmic:
/// `0.5 exp(0.1 (−tan²θ/m² − 2 ln m − 4 ln u))`, `tan²θ = (1 − u)(1 + u)/u²`; `PH` itself overflows for small m.
/// Source: [d'Eon and Luebke 2007](crate::cite::DEON_LUEBKE_2007) §14.3, functions `PHBeckmann` and `KSTextureCompute`.
/// Domain: u in [0, 1], m in [0, 1]. Range: ≥ 0, finite; above 1 (clipped by a unorm texture) where `PH` > 1024,
/// which at u = 1 means m < 1/32.
/// Guard: u ≤ 0 and m ≤ 0 give 0, their common limit off the peak, where the listing has 0·∞.
/// Accuracy: relative 1e-14 (`tests/terms.rs`).
#[must_use]
pub fn encode(u: f64, m: f64) -> f64 {
    if u <= 0.0 || m <= 0.0 {
        return 0.0;
    }
    let u = u.min(1.0);
    let tan_over_m = ((1.0 - u) * (1.0 + u)).sqrt() / u / m;
    let log_ph = -tan_over_m * tan_over_m - 2.0 * libm::log(m) - 4.0 * libm::log(u);
    0.5 * libm::exp(0.1 * log_ph)
}

/// `PH = (2 texel)¹⁰`, the shader's inverse of [`encode`].
///
/// Source: [d'Eon and Luebke 2007](crate::cite::DEON_LUEBKE_2007) §14.3. Domain: texel ≥ 0. Range: [0, 1024] for a
/// unorm texel. Accuracy: 10 ulp. One 8-bit step is worth 10/(510 texel) relative: 3.9 % at 0.5, 20 % at 0.1.
#[must_use]
pub fn decode(texel: f64) -> f64 {
    let x = 2.0 * texel;
    let x2 = x * x;
    let x4 = x2 * x2;
    x4 * x4 * x2
}
