//! Schlick's approximation of the Fresnel factor, its generalisations and their averages.
//!
//! Two or three colours and a power: what game materials store instead of (n, k). None of these is an oracle for
//! [`fresnel`](super::fresnel): the largest error of the plain form is 0.060 at eta = 1.33, 0.036 at 1.5, 0.082 at 2.5.
//!
//! Subscripts are angles in degrees: `f0` at normal incidence, `f90` at grazing, `f82` near 82 (cosine 1/7).

/// Cosine at which the F82 tint is read.
pub const MU_82: f64 = 1.0 / 7.0;

/// `1 / (c (1 − c)⁶)` at that cosine, its largest value: 823543/46656.
pub const F82_SCALE: f64 = 823_543.0 / 46_656.0;

/// `(1 − c)⁵` by multiplication; 0 for a cosine that rounding has put above 1.
///
/// The weight of `f90` in [`schlick`], and the integrand of the bias of split-sum tables.
/// Domain: `cos_i` in [0, 1]. Range: [0, 1]. Accuracy: 3 ulp of the result for exact `cos_i`.
#[must_use]
pub fn weight(cos_i: f64) -> f64 {
    let m = (1.0 - cos_i).max(0.0);
    let m2 = m * m;
    m2 * m2 * m
}

/// Schlick's Fresnel factor `F = f0 + (f90 − f0)(1 − c)⁵`.
///
/// Source: [Schlick1994](crate::cite::SCHLICK_1994) (the approximation of F), with its 1 written as `f90`.
/// Domain: `cos_i` = wi·wm in [0, 1], `f0` and `f90` in [0, 1]. Range: between `f0` and `f90`.
/// Accuracy: 4e-16 absolute (`tests/terms.rs`).
#[must_use]
pub fn schlick(f0: f64, f90: f64, cos_i: f64) -> f64 {
    f0 + (f90 - f0) * weight(cos_i)
}

/// Schlick's factor with a free exponent, `F = f0 + (f90 − f0)(1 − c)^p`.
///
/// Source: [Hoffman2019](crate::cite::HOFFMAN_2019). Domain: as [`schlick`], exponent > 0. Range: between `f0` and
/// `f90`. Accuracy: relative 1e-15 (`tests/terms.rs`); the exponent 5 gives [`schlick`] bit for bit.
#[must_use]
pub fn schlick_generalised(f0: f64, f90: f64, exponent: f64, cos_i: f64) -> f64 {
    let fifth = (exponent - 5.0).abs() < f64::EPSILON;
    let weight = if fifth { weight(cos_i) } else { libm::pow((1.0 - cos_i).max(0.0), exponent) };
    f0 + (f90 - f0) * weight
}

/// The coefficient `b` of the F82-tint dip: `b = F_schlick(1/7) (1 − tint)/(1/7 (6/7)⁶)`.
///
/// Source: [Kutz2021](crate::cite::KUTZ_2021). Domain: `f0` and `tint` in [0, 1]. Range: [0, 17.7).
/// A baker computes it once per material, not once per direction.
#[must_use]
pub fn f82_dip(f0: f64, tint: f64) -> f64 {
    schlick(f0, 1.0, MU_82) * (1.0 - tint) * F82_SCALE
}

/// The tint of a material that reflects `f0` at normal incidence and `f82` at cosine 1/7: `f82` over Schlick's value there.
///
/// Source: [Kutz2021](crate::cite::KUTZ_2021). Range: above 1 where the material reflects more than Schlick's curve.
#[must_use]
pub fn tint_of(f0: f64, f82: f64) -> f64 {
    f82 / schlick(f0, 1.0, MU_82)
}

/// The F82-tint factor, not clamped: `F = F_schlick(c) − b c (1 − c)⁶` with b of [`f82_dip`].
///
/// `tint` is the colour by which Schlick's value is multiplied at c = 1/7, where metals dip.
/// Source: [Kutz2021](crate::cite::KUTZ_2021), after [Hoffman2019](crate::cite::HOFFMAN_2019).
/// Domain: `f0` and `tint` in [0, 1]. Range: ≤ 1, but NOT ≥ 0: with `f0 = tint = 0` it is negative for
/// c in (1/7, 6/7), −0.1268 at 0.261; at `f0 = 0.04`, `tint = 0` the minimum is −0.112.
/// [`f82_tint`] clamps; a table must say which one it holds. Accuracy: 1e-15 absolute (`tests/terms.rs`).
#[must_use]
pub fn f82_tint_unclamped(f0: f64, tint: f64, cos_i: f64) -> f64 {
    let weight = weight(cos_i);
    f0 + (1.0 - f0) * weight - f82_dip(f0, tint) * cos_i * weight * (1.0 - cos_i)
}

/// The F82-tint factor clamped to [0, 1], as renderers use it; see [`f82_tint_unclamped`].
#[must_use]
pub fn f82_tint(f0: f64, tint: f64, cos_i: f64) -> f64 {
    f82_tint_unclamped(f0, tint, cos_i).clamp(0.0, 1.0)
}

/// Hemispherical average `2 ∫ F c dc` of [`schlick`]: `f0 + (f90 − f0)/21`.
///
/// Source: integrated here, B(2, 6) = 1/42; [Kulla and Conty 2017](crate::cite::KULLA_CONTY_2017) has the case `f90` = 1.
/// Accuracy: 2 ulp (`tests/terms.rs`).
#[must_use]
pub fn schlick_average(f0: f64, f90: f64) -> f64 {
    f0 + (f90 - f0) / 21.0
}

/// Hemispherical average of [`schlick_generalised`]: `f0 + (f90 − f0) · 2/((p + 1)(p + 2))`.
///
/// Source: integrated here, 2 B(2, p + 1). Domain: exponent > 0. Accuracy: 3 ulp (`tests/terms.rs`).
#[must_use]
pub fn schlick_generalised_average(f0: f64, f90: f64, exponent: f64) -> f64 {
    f0 + (f90 - f0) * 2.0 / ((exponent + 1.0) * (exponent + 2.0))
}

/// Hemispherical average of [`f82_tint_unclamped`]: `f0 + (1 − f0)/21 − b/126`.
///
/// Source: integrated here, 2 B(3, 7) = 1/126. Not the average of the clamped curve where that one is clamped.
/// Accuracy: relative 1e-15 (`tests/terms.rs`).
#[must_use]
pub fn f82_tint_average(f0: f64, tint: f64) -> f64 {
    schlick_average(f0, 1.0) - f82_dip(f0, tint) / 126.0
}
