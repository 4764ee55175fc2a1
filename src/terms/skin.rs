//! Skin of GPU Gems 3: the diffusion profile as six Gaussians, and transmittance through thin parts by the same fit.
//!
//! Lengths in mm. Weights of a channel sum to 1: the profile is white, the albedo comes from a texture.

use std::f64::consts::PI;

/// Variances v_i, mm².
pub const VARIANCES: [f64; 6] = [0.0064, 0.0484, 0.187, 0.567, 1.99, 7.41];

/// Weights of red, green and blue for each variance.
pub const WEIGHTS: [[f64; 6]; 3] = [
    [0.233, 0.100, 0.118, 0.113, 0.358, 0.078],
    [0.455, 0.336, 0.198, 0.007, 0.004, 0.000],
    [0.649, 0.344, 0.000, 0.007, 0.000, 0.000],
];

/// A colour channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
}

impl Channel {
    /// Weights and variances of the channel.
    fn lobes(self) -> impl Iterator<Item = (f64, f64)> {
        WEIGHTS[self as usize].into_iter().zip(VARIANCES)
    }
}

/// Diffusion profile `R(r) = Σ w_i exp(−r²/(2 v_i))/(2π v_i)`.
///
/// Source: [d'Eon and Luebke 2007](crate::cite::DEON_LUEBKE_2007) Fig. 14-13 (the table of the fit).
/// Units: mm⁻². Domain: `r_mm` ≥ 0. Range: ≥ 0, finite. Law: 2π ∫ R r dr = 1. Accuracy: relative 1e-14 (`tests/terms.rs`).
#[must_use]
pub fn profile(channel: Channel, r_mm: f64) -> f64 {
    let r2 = r_mm * r_mm;
    channel.lobes().map(|(w, v)| w * libm::exp(-0.5 * r2 / v) / (2.0 * PI * v)).sum()
}

/// Part of the profile inside radius `r_mm`, `Σ w_i (1 − exp(−r²/(2 v_i)))`.
///
/// Source: integral of [`profile`]. Range: [0, 1]. Accuracy: relative 1e-14 (`tests/terms.rs`).
#[must_use]
pub fn inside(channel: Channel, r_mm: f64) -> f64 {
    let r2 = r_mm * r_mm;
    channel.lobes().map(|(w, v)| -w * libm::expm1(-0.5 * r2 / v)).sum()
}

/// Transmittance of skin of thickness `d_mm`, `Σ w_i exp(−d²/(2 v_i))`.
///
/// Source: [d'Eon and Luebke 2007](crate::cite::DEON_LUEBKE_2007) §14.5.6, the shader's inv_a = −1/(2a²), a = √v.
/// Range: (0, 1]; 1 at 0. See [`transmittance_jimenez`] for the other convention.
#[must_use]
pub fn transmittance(channel: Channel, d_mm: f64) -> f64 {
    let d2 = d_mm * d_mm;
    channel.lobes().map(|(w, v)| w * libm::exp(-0.5 * d2 / v)).sum()
}

/// Transmittance in the convention of Jimenez, `Σ w_i exp(−d²/v_i)`.
///
/// Source: [Jimenez2010](crate::cite::JIMENEZ_2010). Twice as thick in the exponent as [`transmittance`]: the two are not
/// interchangeable. Range: (0, 1].
#[must_use]
pub fn transmittance_jimenez(channel: Channel, d_mm: f64) -> f64 {
    let d2 = d_mm * d_mm;
    channel.lobes().map(|(w, v)| w * libm::exp(-d2 / v)).sum()
}
