//! Phase functions of participating media.
//!
//! `cos_theta` is the cosine between the directions of *travel* before and after: +1 is forward, undeflected. (Some
//! renderers pass the cosine of two directions that both point away; their sign is the other one.)
//! All are densities: `∫ p dω = 1`, unit sr⁻¹.

use std::f64::consts::FRAC_1_PI;

/// 1/(4π).
const UNIFORM: f64 = 0.25 * FRAC_1_PI;

/// Isotropic, `p = 1/(4π)`.
#[must_use]
pub fn isotropic() -> f64 {
    UNIFORM
}

/// Rayleigh, `p = 3 (1 + cos²θ)/(16π)`: particles much smaller than the wavelength.
///
/// Source: [Born and Wolf 1999](crate::cite::BORN_WOLF_1999) §14.5. Domain: `cos_theta` in [−1, 1]. Range: [3/16π, 3/8π].
/// Accuracy: 2 ulp (`tests/terms.rs`).
#[must_use]
pub fn rayleigh(cos_theta: f64) -> f64 {
    0.75 * UNIFORM * (1.0 + cos_theta * cos_theta)
}

/// `cos θ` of a Rayleigh deflection, `2 sinh(asinh(2 (2u − 1))/3)`, u in [0, 1].
///
/// The root of cos³ + 3 cos = 4 (2u − 1), without a difference of cube roots. Accuracy: relative 1e-14 (`tests/terms.rs`).
#[must_use]
pub fn sample_rayleigh(u: f64) -> f64 {
    (2.0 * libm::sinh(libm::asinh(2.0 * (2.0 * u - 1.0)) / 3.0)).clamp(-1.0, 1.0)
}

/// Henyey-Greenstein, `p = (1 − g²)/(4π (1 + g² − 2 g cos θ)^{3/2})`.
///
/// Evaluated as (1 − g)(1 + g) over ((1 − g)² + 2g (1 − cos θ))^{3/2} for g ≥ 0 and mirrored for g < 0, so that no
/// digits are lost near the peak. Source: [Henyey and Greenstein 1941](crate::cite::HENYEY_GREENSTEIN_1941) Eq. 2.
/// Domain: |g| < 1 (clamped to 1 − 1e-12), `cos_theta` in [−1, 1]. Range: > 0, finite. Law: mean cosine g.
/// Accuracy: relative 1e-15 given 1 − cos θ (`tests/terms.rs`); see [`henyey_greenstein_at`] near the peak.
#[must_use]
pub fn henyey_greenstein(g: f64, cos_theta: f64) -> f64 {
    henyey_greenstein_at(g, 1.0 - cos_theta)
}

/// [`henyey_greenstein`] at `one_minus_cos = 1 − cos θ = 2 sin²(θ/2)`, which a narrow peak needs exactly.
#[must_use]
pub fn henyey_greenstein_at(g: f64, one_minus_cos: f64) -> f64 {
    const LIMIT: f64 = 1.0 - 1e-12;
    let width = 1.0 - g.abs().min(LIMIT);
    // p(−g, cos) = p(g, −cos), and 1 − (−cos) = 2 − (1 − cos).
    let from_peak = if g < 0.0 { 2.0 - one_minus_cos } else { one_minus_cos };
    let square = width * width + 2.0 * (1.0 - width) * from_peak.max(0.0);
    UNIFORM * width * (2.0 - width) / (square * square.sqrt())
}

/// `cos θ` of a Henyey-Greenstein deflection, u in [0, 1].
///
/// `cos θ = (2t (1 + g²) + g (3 + t²) − g³ (1 − t²))/(2 (1 + g t)²)`, t = 2u − 1; no division by g.
/// Source: the inverse of [Henyey and Greenstein 1941](crate::cite::HENYEY_GREENSTEIN_1941) Eq. 2, rearranged: the usual form
/// loses all digits as g → 0. Accuracy: 1e-15 absolute (`tests/terms.rs`).
#[must_use]
pub fn sample_henyey_greenstein(g: f64, u: f64) -> f64 {
    let t = 2.0 * u - 1.0;
    let below = 1.0 + g * t;
    let above = 2.0 * t * (1.0 + g * g) + g * (3.0 + t * t) - g * g * g * (1.0 - t) * (1.0 + t);
    if below > 0.0 { (above / (2.0 * below * below)).clamp(-1.0, 1.0) } else { -g.signum() }
}

/// Draine, `p = p_HG (1 + α cos²θ)/(1 + α (1 + 2g²)/3)`.
///
/// α = 0 is Henyey-Greenstein, g = 0 with α = 1 Rayleigh, α = 1 Cornette and Shanks.
/// Source: [Draine2003](crate::cite::DRAINE_2003) Eq. 5 (number recalled). Domain: |g| < 1, α ≥ 0. Range: > 0.
/// Accuracy: relative 1e-14 (`tests/terms.rs`).
#[must_use]
pub fn draine(g: f64, alpha: f64, cos_theta: f64) -> f64 {
    henyey_greenstein(g, cos_theta) * (1.0 + alpha * cos_theta * cos_theta)
        / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0)
}

/// Mean cosine of [`draine`], `g (1 + α (3 + 2g²)/5)/(1 + α (1 + 2g²)/3)`.
///
/// Source: [Draine2003](crate::cite::DRAINE_2003) Eq. 7 (number recalled); checked by quadrature (`tests/terms.rs`).
#[must_use]
pub fn draine_mean_cosine(g: f64, alpha: f64) -> f64 {
    let g2 = g * g;
    g * (1.0 + alpha * (3.0 + 2.0 * g2) / 5.0) / (1.0 + alpha * (1.0 + 2.0 * g2) / 3.0)
}

/// The fit of Mie scattering by water droplets, a mixture of Henyey-Greenstein and Draine.
///
/// Source: [Jendersie and d'Eon 2023](crate::cite::JENDERSIE_DEON_2023) Eqs. 7 to 10.
/// Domain: droplet diameter in [5, 50] µm, clamped; `cos_theta` in [−1, 1]. Range: > 0.
/// Accuracy: relative 1e-13 as a fit (`tests/terms.rs`); the fit itself is the authors'.
#[must_use]
pub fn fog(diameter_um: f64, cos_theta: f64) -> f64 {
    let d = diameter_um.clamp(5.0, 50.0);
    let g_hg = libm::exp(-0.0990567 / (d - 1.67154));
    let g_draine = libm::exp(-2.20679 / (d + 3.91029) - 0.428934);
    let alpha = libm::exp(3.62489 - 8.29288 / (d + 5.52825));
    let weight = libm::exp(-0.599085 / (d - 0.641583) - 0.665888);
    (1.0 - weight) * henyey_greenstein(g_hg, cos_theta) + weight * draine(g_draine, alpha, cos_theta)
}
