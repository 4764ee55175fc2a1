//! Gulbrandsen's mapping of the complex index of a metal: two numbers an artist can hold, r (reflectance at normal
//! incidence) and g (tint of the edge), to n and k and back.

/// `√r` and what bounds n: `(s, n_min, n_max − n_min)`.
fn bounds(r: f64) -> (f64, f64, f64) {
    let r = r.clamp(0.0, R_MAX);
    let s = r.sqrt();
    ((s), (1.0 - r) / (1.0 + r), 2.0 * s * (1.0 + s) / ((1.0 - s) * (1.0 + r)))
}

/// Largest r: n_max = (1 + √r)/(1 − √r) has no bound as r → 1.
pub const R_MAX: f64 = 0.999_999;

/// (n, k) of an edge tint: `n = g n_min + (1 − g) n_max`, `k² = (n_max − n)(n − 1/n_max)`.
///
/// n_min = (1 − r)/(1 + r), n_max = (1 + √r)/(1 − √r). The printed `k² = (r(n + 1)² − (n − 1)²)/(1 − r)` is the same,
/// but cancels; here both factors are sums of positive terms: n_max − n = gΔ and
/// n − 1/n_max = 2√r (1 − √r)/((1 + r)(1 + √r)) + (1 − g)Δ, Δ = n_max − n_min.
/// Source: [Gulbrandsen 2014](crate::cite::GULBRANDSEN_2014) Eq. 12 and Eq. 2 (numbers as implementations quote
/// them); the product form derived here.
/// Domain: r in [0, [`R_MAX`]], clamped; g in [0, 1]. Range: n in (0, 4e6), k ≥ 0; g = 0 gives k = 0, g = 1 |n + ik| = 1.
/// Accuracy: relative 1e-14 (`tests/terms.rs`).
#[must_use]
pub fn index(r: f64, g: f64) -> (f64, f64) {
    let (s, n_min, span) = bounds(r);
    let r = s * s;
    let above_least = 2.0 * s * (1.0 - s) / ((1.0 + r) * (1.0 + s)) + (1.0 - g) * span;
    (n_min + (1.0 - g) * span, (g * span * above_least).max(0.0).sqrt())
}

/// (r, g) of an index: the inverse of [`index`].
///
/// `r = ((n − 1)² + k²)/((n + 1)² + k²)`, `g = (n_max − n)/(n_max − n_min)`; for n ≥ 1 the difference is taken as
/// k²/(n − 1/n_max), for n < 1 as (1 − n + √r (1 + n))/(1 − √r), neither of which cancels.
/// Source: [Gulbrandsen 2014](crate::cite::GULBRANDSEN_2014) Eqs. 14 and 15 (numbers as implementations quote them).
/// Domain: n ≥ 0, k ≥ 0 with r ≤ [`R_MAX`]. Range: [0, 1] each; n = 1, k = 0 gives r = 0, where g is undefined and is 0.
/// Accuracy: relative 1e-12 for r ≤ 0.99 (`tests/terms.rs`).
#[must_use]
pub fn tint(n: f64, k: f64) -> (f64, f64) {
    let sum = (n + 1.0) * (n + 1.0) + k * k;
    let r = super::lazanyi::f0(n, k);
    let s = r.sqrt();
    if s == 0.0 {
        return (0.0, 0.0);
    }
    // 1 − √r = (1 − r)/(1 + √r), 1 − r = 4n/((n + 1)² + k²)
    let rest = 4.0 * n / sum / (1.0 + s);
    let span = 2.0 * s * (1.0 + s) / (rest * (1.0 + r));
    let from_top = if n >= 1.0 {
        k * k * (1.0 + s) / ((n - 1.0) + s * (n + 1.0))
    } else {
        ((1.0 - n) + s * (1.0 + n)) / rest
    };
    let g = from_top / span;
    (r, if g.is_nan() { 1.0 } else { g.clamp(0.0, 1.0) })
}
