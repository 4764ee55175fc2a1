//! Lazanyi and Szirmay-Kalos' correction of Schlick's factor for metals, which dip before grazing.
//!
//! `a` and the exponent `q` are fitted for each metal: a = 0 is Schlick with the metal's own F0; aluminium needs about
//! a = 1.5, q = 6.

/// Reflectance at normal incidence of the complex index n + ik, `((n − 1)² + k²)/((n + 1)² + k²)`.
///
/// Source: [Born and Wolf 1999](crate::cite::BORN_WOLF_1999) §14.2. Domain: n ≥ 0, k ≥ 0. Range: [0, 1].
/// Guard: n = k = 0 gives 1, as does an index that overflows. Accuracy: 4 ulp (`tests/terms.rs`).
#[must_use]
pub fn f0(n: f64, k: f64) -> f64 {
    let (below, above) = (libm::hypot(n - 1.0, k), libm::hypot(n + 1.0, k));
    let ratio = below / above;
    if ratio.is_nan() { 1.0 } else { ratio * ratio }
}

/// `F = F0 + (1 − F0)(1 − c)⁵ − a c (1 − c)^q`, F0 of [`f0`].
///
/// Source: [Lazanyi and Szirmay-Kalos 2005](crate::cite::LAZANYI_2005), whose
/// ((n − 1)² + 4n (1 − c)⁵ + k²)/((n + 1)² + k²) is the same first two terms.
/// Domain: `cos_i` in [0, 1], a ≥ 0, q > 0. Range: ≤ 1, but NOT ≥ 0 for large a: the fit promises nothing there.
/// Accuracy: 1e-15 absolute (`tests/terms.rs`).
#[must_use]
pub fn lazanyi(n: f64, k: f64, a: f64, exponent: f64, cos_i: f64) -> f64 {
    let dip = a * cos_i * libm::pow((1.0 - cos_i).max(0.0), exponent);
    super::schlick::schlick(f0(n, k), 1.0, cos_i) - dip
}

/// Hemispherical average `2 ∫ F c dc` of [`lazanyi`]: `F0 + (1 − F0)/21 − 4a/((q + 1)(q + 2)(q + 3))`.
///
/// Source: integrated here, 2 B(3, q + 1). Accuracy: 4 ulp of the larger term (`tests/terms.rs`).
#[must_use]
pub fn average(n: f64, k: f64, a: f64, exponent: f64) -> f64 {
    let q = exponent;
    super::schlick::schlick_average(f0(n, k), 1.0) - 4.0 * a / ((q + 1.0) * (q + 2.0) * (q + 3.0))
}
