//! Schlick's rational masking, as split-sum tables of game engines use it with GGX.

/// How k follows from the width.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum K {
    /// `k = α/2`: image-based lighting.
    Ibl,
    /// `k = (r + 1)²/8`, r = √α: analytic lights.
    Analytic,
    /// `k = α √(2/π)`: Schlick's own, fitted to Beckmann.
    Schlick,
}

/// k of a width.
///
/// Source: [Karis2013](crate::cite::KARIS_2013) Eq. 4 and the remark after it; [Schlick1994](crate::cite::SCHLICK_1994)
/// (its own k). Domain: alpha in [0, 2]. Range: [0, 1.6].
#[must_use]
pub fn k(kind: K, alpha: f64) -> f64 {
    match kind {
        K::Ibl => 0.5 * alpha,
        K::Analytic => {
            let r = alpha.sqrt() + 1.0;
            0.125 * r * r
        }
        K::Schlick => alpha * (2.0 * std::f64::consts::FRAC_1_PI).sqrt(),
    }
}

/// `G1 = mu/(mu (1 − k) + k)`.
///
/// Source: [Schlick1994](crate::cite::SCHLICK_1994) (the rational form of G1). Range: [0, 1] for k in [0, 1]. Guard: k = 0 at
/// the horizon gives 1. It does not fulfil the weak white furnace of any distribution.
#[must_use]
pub fn g1(k: f64, mu: f64) -> f64 {
    let sum = facing(k, mu);
    if sum > 0.0 { mu / sum } else { 1.0 }
}

/// Visibility `V = 1/(4 (mu_o (1 − k) + k)(mu_i (1 − k) + k))`: no division by a cosine.
#[must_use]
pub fn visibility(k: f64, mu_o: f64, mu_i: f64) -> f64 {
    let product = facing(k, mu_o) * facing(k, mu_i);
    if product > 0.0 { 0.25 / product } else { 0.0 }
}

/// `mu/G1`.
fn facing(k: f64, mu: f64) -> f64 {
    mu * (1.0 - k) + k
}
