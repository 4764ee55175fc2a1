//! Normalised diffusion (Christensen and Burley): two exponentials that follow brute-force subsurface scattering.

use std::f64::consts::PI;

/// How `s` follows from the albedo, and what the length `l` then is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShapeFit {
    /// Searchlight: a perpendicular beam; l is the mean free path. `s = 1.85 − A + 7 |A − 0.8|³`.
    Searchlight,
    /// Diffuse surface transmission; l is the mean free path. `s = 1.9 − A + 3.5 (A − 0.8)²`.
    Diffuse,
    /// Searchlight in diffuse mean free paths: l is that. `s = 3.5 + 100 (A − 0.33)⁴`.
    DiffuseMeanFreePath,
}

/// The scale `s(A)`; the profile falls like exp(−s r/(3 l)).
///
/// Source: [Christensen and Burley 2015](crate::cite::CHRISTENSEN_BURLEY_2015) Eqs. 5, 6 and 8.
/// Domain: albedo A in [0, 1]. Range: (0.8, 25).
#[must_use]
pub fn scale(fit: ShapeFit, albedo: f64) -> f64 {
    let square = |x: f64| x * x;
    match fit {
        ShapeFit::Searchlight => {
            let x = (albedo - 0.8).abs();
            1.85 - albedo + 7.0 * x * x * x
        }
        ShapeFit::Diffuse => 1.9 - albedo + 3.5 * square(albedo - 0.8),
        ShapeFit::DiffuseMeanFreePath => 3.5 + 100.0 * square(square(albedo - 0.33)),
    }
}

/// Profile `R(r) = A (s/l)(exp(−x) + exp(−x/3))/(8π r)`, x = s r/l.
///
/// Source: [Christensen and Burley 2015](crate::cite::CHRISTENSEN_BURLEY_2015) Eq. 3. Units: 1/length².
/// Domain: r > 0, l > 0. Range: > 0; grows as 1/r towards 0, so bake r R. Guard: r ≤ 0 counts as 1e-300 l, which is finite.
/// Law: 2π ∫ R r dr = A exactly. Accuracy: relative 1e-14 (`tests/terms.rs`).
#[must_use]
pub fn profile(fit: ShapeFit, albedo: f64, length: f64, r: f64) -> f64 {
    let r = r.max(1e-300 * length);
    let x = scale(fit, albedo) * (r / length);
    albedo * (scale(fit, albedo) / length) * (libm::exp(-x) + libm::exp(-x / 3.0)) / (8.0 * PI * r)
}

/// Part of the profile inside x = s r/l: `1 − exp(−x)/4 − 3 exp(−x/3)/4`, without the difference near 0.
///
/// Source: [Christensen and Burley 2015](crate::cite::CHRISTENSEN_BURLEY_2015) Eq. 11 (number as MoonRay quotes it). Domain: x ≥ 0. Range: [0, 1].
/// Accuracy: relative 1e-15 (`tests/terms.rs`).
#[must_use]
pub fn cdf(x: f64) -> f64 {
    -0.25 * (libm::expm1(-x) + 3.0 * libm::expm1(-x / 3.0))
}

/// The x at which [`cdf`] is xi, in closed form.
///
/// With t = exp(−x/3) the equation is t³ + 3t = 4 (1 − ξ), so `t = 2 sinh(asinh(2 (1 − ξ))/3)` and x = −3 ln t.
/// For ξ < 1/2 one Newton step on [`cdf`] restores the digits that ln t loses near t = 1.
/// Source: derived here; renderers invert by iteration. Domain: xi in [0, 1], clamped to 1 − 2⁻⁵³. Range: [0, 112).
/// Accuracy: relative 2e-15 (`tests/terms.rs`).
#[must_use]
pub fn cdf_inverse(xi: f64) -> f64 {
    let rest = (1.0 - xi).clamp(0.5 * f64::EPSILON, 1.0);
    // Below 1e-8 the logarithm has only rounding; there cdf(x) = x/2 to first order.
    let x = if xi < 1e-8 {
        2.0 * xi
    } else {
        -3.0 * libm::log((2.0 * libm::sinh(libm::asinh(2.0 * rest) / 3.0)).min(1.0))
    };
    if xi >= 0.5 || xi <= 0.0 {
        return x.max(0.0);
    }
    let density = 0.25 * (libm::exp(-x) + libm::exp(-x / 3.0));
    (x - (cdf(x) - xi) / density).max(0.0)
}
