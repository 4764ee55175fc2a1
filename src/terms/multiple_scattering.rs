//! Energy that single scattering loses, given back: factors of Kulla-Conty, Turquin and Fdez-Aguera.
//!
//! E is the directional albedo of the white (F = 1) lobe, E_avg its cosine-weighted mean, F_avg that of the Fresnel factor.

use std::f64::consts::FRAC_1_PI;

/// The lobe of Kulla and Conty for white facets, `f_ms = (1 − E(mu_o))(1 − E(mu_i))/(π (1 − E_avg))`.
///
/// Takes the missing energy itself, 1 − E, which has digits where E is 1 to rounding.
/// Source: [Kulla and Conty 2017](crate::cite::KULLA_CONTY_2017), after [Kelemen2001](crate::cite::KELEMEN_2001).
/// Units: sr⁻¹. Range: ≥ 0. Law: ∫ f_ms mu_i dω_i = 1 − E(mu_o) if `missing_avg` is the mean of the same E.
/// Guard: `missing_avg` = 0 (nothing is lost) gives 0.
#[must_use]
pub fn kulla_conty(missing_o: f64, missing_i: f64, missing_avg: f64) -> f64 {
    if missing_avg > 0.0 { FRAC_1_PI * missing_o * missing_i / missing_avg } else { 0.0 }
}

/// Colour of [`kulla_conty`] as on the slides, `F_ms = F_avg E_avg/(1 − F_avg (1 − E_avg))`.
///
/// Source: [Kulla and Conty 2017](crate::cite::KULLA_CONTY_2017). It lacks a factor F_avg against [`colour_series`].
/// Domain: both in [0, 1]. Range: [0, 1]. Guard: 0/0 (F_avg = 1, E_avg = 0) gives 1. Accuracy: 4 ulp (`tests/functions.rs`).
#[must_use]
pub fn colour_slides(f_avg: f64, e_avg: f64) -> f64 {
    let rest = 1.0 - f_avg * (1.0 - e_avg);
    if rest > 0.0 { f_avg * e_avg / rest } else { 1.0 }
}

/// Colour of [`kulla_conty`] by the series of bounces, `F_ms = F_avg² E_avg/(1 − F_avg (1 − E_avg))`.
///
/// Source: [Hill2018](crate::cite::HILL_2018); the light that leaves after the first bounce is already in the single
/// scattering, so the series starts with two. Domain, range, guard: as [`colour_slides`].
#[must_use]
pub fn colour_series(f_avg: f64, e_avg: f64) -> f64 {
    f_avg * colour_slides(f_avg, e_avg)
}

/// Turquin's factor of the single-scattering lobe, `1 + F0 (1 − E(mu_o))/E(mu_o)`.
///
/// Source: [Turquin2019](crate::cite::TURQUIN_2019) Eq. 16, as [MaterialX](crate::cite::MATERIALX) `mx_ggx_energy_compensation` quotes it. View side only, so not reciprocal. Domain: E in
/// (0, 1], F0 in [0, 1]. Range: ≥ 1. Guard: E = 0 gives 1.
#[must_use]
pub fn turquin(f0: f64, e_mu: f64) -> f64 {
    if e_mu > 0.0 { 1.0 + f0 * (1.0 - e_mu) / e_mu } else { 1.0 }
}

/// What Fdez-Aguera's split sum adds to the specular lobe and leaves for the diffuse one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FdezAguera {
    /// Single scattering, `F_ss E_ss = F0 A + B`.
    pub single: f64,
    /// Multiple scattering, `F_ms E_ms`: weight of the irradiance.
    pub multiple: f64,
    /// What is left, `1 − F_ss E_ss − F_ms E_ms`: weight of the diffuse albedo times the irradiance.
    pub rest: f64,
}

/// Multiple scattering from the two channels of a split-sum table.
///
/// `F_ms = F_ss E_ss F_avg/(1 − F_avg E_ms)`, `E_ms = 1 − (A + B)`, `F_avg = F0 + (1 − F0)/21`.
/// Source: [FdezAguera2019](crate::cite::FDEZ_AGUERA_2019) (the split sum; `F_brdf_multi_scatter` of Blender's EEVEE is the same). A widely read page prints
/// `1 − FssEss + FmsEms` for the rest, which adds energy. Domain: A, B ≥ 0 with A + B ≤ 1, F0 in [0, 1].
/// Law: F0 = 1 gives single + multiple = 1. Range: each in [0, 1].
#[must_use]
pub fn fdez_aguera(f0: f64, scale: f64, bias: f64) -> FdezAguera {
    let single = f0 * scale + bias;
    let missing = 1.0 - (scale + bias);
    let f_avg = super::schlick::schlick_average(f0, 1.0);
    let multiple = single * f_avg / (1.0 - f_avg * missing) * missing;
    FdezAguera { single, multiple, rest: 1.0 - single - multiple }
}
