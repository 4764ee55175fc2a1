//! Special functions of one real variable.
//!
//! `erf` and `erfc` are those of `libm`. The scaled complement `erfcx` and its continued-fraction remainder are
//! made here, because `exp(x²) erfc(x)` overflows and because differences of `erfc` and `exp` cancel.

use std::f64::consts::PI;

/// 1/√π.
pub const FRAC_1_SQRT_PI: f64 = std::f64::consts::FRAC_2_SQRT_PI / 2.0;

/// √π.
pub const SQRT_PI: f64 = 1.772_453_850_905_516;

/// The error function `erf(x) = 2/√π ∫₀ˣ exp(−t²) dt`.
///
/// Source: [DLMF](crate::cite::DLMF) Eq. 7.2.1. Domain: all reals. Range: [−1, 1]. Accuracy: that of `libm`, < 1 ulp.
#[must_use]
pub fn erf(x: f64) -> f64 {
    libm::erf(x)
}

/// The complementary error function `erfc(x) = 1 − erf(x)`.
///
/// Source: [DLMF](crate::cite::DLMF) Eq. 7.2.2. Domain: all reals; underflows above 26.6. Range: [0, 2].
/// Accuracy: that of `libm`, < 1 ulp where normal.
#[must_use]
pub fn erfc(x: f64) -> f64 {
    libm::erfc(x)
}

/// The scaled complementary error function `erfcx(x) = exp(x²) erfc(x)`.
///
/// erfcx(x) = 1 / (√π (x + K(x))) for x ≥ 0, with K of [`erfcx_tail`]; erfcx(x) = 2 exp(x²) − erfcx(−x) for x < 0.
/// Source: [DLMF](crate::cite::DLMF) §7.9 (continued fractions).
/// Domain: x > −26.6 (2 exp(x²) overflows below). Range: > 0.
/// Accuracy: relative 1e-15 on [0, ∞) (`tests/math.rs`); below 0 the rounding of x² adds 2⁻⁵²·x².
#[must_use]
pub fn erfcx(x: f64) -> f64 {
    if x < 0.0 {
        return 2.0 * libm::exp(x * x) - erfcx(-x);
    }
    FRAC_1_SQRT_PI / (x + erfcx_tail(x))
}

/// The remainder `K(x)` of the continued fraction of `erfcx` after its first term.
///
/// K(x) = (1/2)/(x + (2/2)/(x + (3/2)/(x + …))) = 1/(√π erfcx(x)) − x
/// Source: [DLMF](crate::cite::DLMF) §7.9. Domain: x ≥ 0 (a negative x counts as 0).
/// Range: (0, 1/√π]; K(0) = 1/√π, K → 1/(2x).
///
/// Differences such as 1/(x√π) − erfcx(x) = K/(√π x (x + K)) then have no subtraction left; the
/// masking of Beckmann surfaces needs exactly that one.
///
/// Method: 2 (x + 1) K(x) is smooth in t = (x − c)/(x + c), c = 2.75, on the whole half line, including infinity;
/// its Chebyshev series in t is cut at |coefficient| < 1e-17. Coefficients from 40-digit arithmetic:
/// `c_j = 2/60 Σ_k g(cos π(k+½)/60) cos(jπ(k+½)/60)` (half of it for j = 0), g = 2 (x + 1) K(x).
/// Accuracy: relative 1e-15 (`tests/math.rs`).
#[must_use]
pub fn erfcx_tail(x: f64) -> f64 {
    const C: f64 = 2.75;
    if x > 1e16 {
        return 0.5 / x;
    }
    let x = x.max(0.0);
    let t = (x - C) / (x + C);
    0.5 * chebyshev(&TAIL, t) / (x + 1.0)
}

/// Clenshaw's recurrence for `Σ c_j T_j(t)`.
fn chebyshev(coefficients: &[f64], t: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    for &c in coefficients.iter().skip(1).rev() {
        (b1, b2) = (2.0 * t * b1 - b2 + c, b1);
    }
    t * b1 - b2 + coefficients.first().copied().unwrap_or(0.0)
}

const TAIL: [f64; 29] = [
    1.1481611596428554,
    -0.09831772336389068,
    -0.08067328350989574,
    0.035667776529495064,
    -0.0037700638469857803,
    -0.0015800435707242202,
    0.0005103438829678788,
    3.9014403136712546e-05,
    -4.121627468306155e-05,
    1.7287132015174924e-06,
    2.806153209796668e-06,
    -3.7182698906505107e-07,
    -1.715954081796365e-07,
    3.855372533513972e-08,
    9.55502965641229e-09,
    -3.2056512435527223e-09,
    -4.793462893967105e-10,
    2.3457387974463354e-10,
    2.064337033155654e-11,
    -1.5514330702162582e-11,
    -6.276810758790445e-13,
    9.277357013355215e-13,
    -6.092632841709016e-15,
    -4.910224043783039e-14,
    3.505390061090777e-15,
    2.1704704034919436e-15,
    -4.3961310240109764e-16,
    -6.694447114787399e-17,
    4.286353462764321e-17,
];

/// `(eˣ − 1)/x`, with its limit 1 at x = 0.
///
/// Domain: all reals below 709. Range: > 0. Guard: x = 0 gives 1; elsewhere `expm1` has no cancellation.
/// Accuracy: relative 4e-16 (`tests/math.rs`).
#[must_use]
pub fn exprel(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { libm::expm1(x) / x }
}

/// `Γ(z + 1/2)/Γ(z)`, which differences of logarithms of gamma functions lose for large z.
///
/// √z times an asymptotic series in 1/z for z ≥ 32; below, up the recurrence `R(z) = R(z + 1) z/(z + 1/2)`.
/// Source: [DLMF](crate::cite::DLMF) Eq. 5.11.13. Domain: z ≥ 0. Range: ≥ 0, finite.
/// Accuracy: relative 1e-14 (`tests/math.rs`).
#[must_use]
pub fn gamma_half_ratio(z: f64) -> f64 {
    /// Coefficients of z⁻¹, z⁻², …: 1 − 1/8z + 1/128z² + 5/1024z³ − 21/32768z⁴ − …
    const SERIES: [f64; 7] = [
        -1.0 / 8.0,
        1.0 / 128.0,
        5.0 / 1024.0,
        -21.0 / 32_768.0,
        -399.0 / 262_144.0,
        869.0 / 4_194_304.0,
        39_325.0 / 33_554_432.0,
    ];
    let (mut z, mut factor) = (z.max(0.0), 1.0);
    while z < 32.0 {
        factor *= z / (z + 0.5);
        z += 1.0;
    }
    let series = SERIES.iter().rev().fold(0.0, |sum, c| (sum + c) / z);
    factor * z.sqrt() * (1.0 + series)
}

/// `cosⁿθ` from cos θ and sin²θ, for exponents up to 1e7 and beyond.
///
/// exp(n/2 log1p(−sin²θ)) near the normal, where the cosine itself has too few digits to be raised to n, and
/// exp(n log cos θ) elsewhere. Domain: cos θ in [0, 1], sin²θ formed from x² + y², n ≥ 0. Range: [0, 1].
/// Guard: n = 0 gives 1 also at cos θ = 0; a cosine ≤ 0 gives 0 otherwise.
/// Accuracy: relative 3e-16 (1 + n |ln cos θ|) (`tests/math.rs`).
#[must_use]
pub fn cos_pow(cos_theta: f64, sin2_theta: f64, n: f64) -> f64 {
    if n == 0.0 {
        1.0
    } else if cos_theta <= 0.0 {
        0.0
    } else if sin2_theta < 0.5 {
        libm::exp(0.5 * n * libm::log1p(-sin2_theta))
    } else {
        libm::exp(n * libm::log(cos_theta))
    }
}

/// `cos(2πu)` and `sin(2πu)`, in this order.
///
/// The azimuth of a sample. Domain: u in [0, 1]. Accuracy: 3e-16 absolute; exact at the quarters.
#[must_use]
pub fn circle(u: f64) -> (f64, f64) {
    // Reducing to a quarter first keeps the argument small and the axes exact; 4u and its rounding are exact.
    let quarter = (4.0 * u).round();
    let (sin, cos) = libm::sincos(0.5 * PI * (4.0 * u - quarter));
    match quarter.rem_euclid(4.0) {
        q if q < 0.5 => (cos, sin),
        q if q < 1.5 => (-sin, cos),
        q if q < 2.5 => (-cos, -sin),
        _ => (sin, -cos),
    }
}
