//! Light through a homogeneous medium: Beer and Lambert's law, emission of a slab, albedo of a half space.

/// Transmittance `T = exp(−σt d)`.
///
/// Source: [Chandrasekhar1960](crate::cite::CHANDRASEKHAR_1960) §7 (Bouguer, Lambert, Beer). Domain: `sigma_t` ≥ 0 in
/// 1/length, d ≥ 0 in the same length. Range: [0, 1]. Accuracy: relative 2e-16 (1 + σt d) (`tests/terms.rs`).
#[must_use]
pub fn transmittance(sigma_t: f64, d: f64) -> f64 {
    libm::exp(-sigma_t * d)
}

/// What is lost, `1 − T = −expm1(−σt d)`: keeps its digits in thin media.
///
/// Source, domain: as [`transmittance`]. Range: [0, 1]. Accuracy: relative 4e-16 (`tests/terms.rs`).
#[must_use]
pub fn loss(sigma_t: f64, d: f64) -> f64 {
    -libm::expm1(-sigma_t * d)
}

/// Radiance of a glowing slab, `L = (j/σt)(1 − exp(−σt d))`, j the emission per length; `j d` where nothing absorbs.
///
/// Source: [Chandrasekhar1960](crate::cite::CHANDRASEKHAR_1960) §7 (the formal solution), constant source function.
/// Units: those of j times length. Accuracy: relative 1e-15 (`tests/terms.rs`).
#[must_use]
pub fn slab_emission(j: f64, sigma_t: f64, d: f64) -> f64 {
    j * d * crate::math::special::exprel(-sigma_t * d)
}

/// Diffuse reflectance of a semi-infinite, index-matched medium by van de Hulst's fit.
///
/// `C = (1 − s)(1 − 0.139 s)/(1 + 1.17 s)`, `s = √((1 − α)/(1 − α g))`.
/// Source: [Kulla and Conty 2017](crate::cite::KULLA_CONTY_2017), after van de Hulst. Domain: single-scattering albedo α in
/// [0, 1], |g| < 1. Range: [0, 1]. Accuracy: as a fit, relative 1e-14 (`tests/terms.rs`).
#[must_use]
pub fn half_space_albedo(alpha: f64, g: f64) -> f64 {
    let s = ((1.0 - alpha) / (1.0 - alpha * g)).max(0.0).sqrt();
    (1.0 - s) * (1.0 - 0.139 * s) / (1.0 + 1.17 * s)
}

/// Single-scattering albedo from s of [`half_space_albedo`], `α = (1 − s²)/(1 − g s²)`.
fn single_scattering(s: f64, g: f64) -> f64 {
    let s = s.clamp(0.0, 1.0);
    (1.0 - s) * (1.0 + s) / (1.0 - g * s * s)
}

/// The exact inverse of [`half_space_albedo`] in α: `s = 2 (1 − C)/(b + √(b² − 0.556 (1 − C)))`, b = 1.139 + 1.17 C.
///
/// Source: the root of a quadratic, derived here in the form without cancellation. Domain: C in [0, 1], |g| < 1. Range: [0, 1].
/// Accuracy: relative 1e-14 (`tests/terms.rs`). 1 − α shrinks quadratically as C → 1: store s there.
#[must_use]
pub fn single_scattering_exact(c: f64, g: f64) -> f64 {
    let b = 1.139 + 1.17 * c;
    single_scattering(2.0 * (1.0 - c) / (b + (b * b - 0.556 * (1.0 - c)).sqrt()), g)
}

/// Kulla and Conty's fit of the same inverse, `s = 4.09712 + 4.20863 C − √(9.59217 + 41.6808 C + 17.7126 C²)`.
///
/// Source: [Kulla and Conty 2017](crate::cite::KULLA_CONTY_2017). s is clamped to [0, 1], which it leaves by 5e-6.
/// Within 5.2e-6 of [`single_scattering_exact`] in s. Range: [0, 1]. Accuracy: as a fit, 1e-13 (`tests/terms.rs`).
#[must_use]
pub fn single_scattering_kulla_conty(c: f64, g: f64) -> f64 {
    single_scattering(4.09712 + 4.20863 * c - (9.59217 + 41.6808 * c + 17.7126 * c * c).sqrt(), g)
}

/// Chiang and others' fit for isotropic scattering, `α = 1 − exp(−5.09406 A + 2.61188 A² − 4.31805 A³)`.
///
/// Source: [Chiang2016](crate::cite::CHIANG_2016). Domain: A in [0, 1]. Range: [0, 0.9989]. Accuracy: as a fit, relative
/// 1e-15 (`tests/terms.rs`).
#[must_use]
pub fn single_scattering_chiang(a: f64) -> f64 {
    -libm::expm1(a * (-5.09406 + a * (2.61188 - 4.31805 * a)))
}
