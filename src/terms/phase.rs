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
/// With `q = (1 − g)(1 − u) + (1 + g) u`: `1 + cos θ = (1 + g)² u (1 + (1 − g)/q)/q` and `1 − cos θ = (1 − g)² (1 − u) (1 + (1 + g)/q)/q`,
/// sums of positive terms without a division by g; the smaller of the two gives the cosine.
/// Source: the inverse of [Henyey and Greenstein 1941](crate::cite::HENYEY_GREENSTEIN_1941) Eq. 2, rearranged: the usual form
/// loses all digits as g → 0, and half of them as |g| → 1. Accuracy: 1e-15 absolute (`tests/terms.rs`).
#[must_use]
pub fn sample_henyey_greenstein(g: f64, u: f64) -> f64 {
    let (less, more, rest) = (1.0 - g, 1.0 + g, 1.0 - u);
    let q = less * rest + more * u;
    if q <= 0.0 {
        return -g.signum();
    }
    let from_back = more * more * u * (1.0 + less / q) / q;
    let from_front = less * less * rest * (1.0 + more / q) / q;
    if from_back < from_front { from_back - 1.0 } else { 1.0 - from_front }
}

/// Draine, `p = p_HG (1 + α cos²θ)/(1 + α (1 + 2g²)/3)`.
///
/// α = 0 is Henyey-Greenstein, g = 0 with α = 1 Rayleigh, α = 1 Cornette and Shanks.
/// Source: [Draine2003](crate::cite::DRAINE_2003) ; [Jendersie and d'Eon 2023](crate::cite::JENDERSIE_DEON_2023) use the same. Domain: |g| < 1, α ≥ 0. Range: > 0.
/// Accuracy: relative 1e-14 (`tests/terms.rs`).
#[must_use]
pub fn draine(g: f64, alpha: f64, cos_theta: f64) -> f64 {
    draine_at(g, alpha, 1.0 - cos_theta)
}

/// [`draine`] at `one_minus_cos = 1 − cos θ = 2 sin²(θ/2)`, which a narrow peak needs exactly.
#[must_use]
pub fn draine_at(g: f64, alpha: f64, one_minus_cos: f64) -> f64 {
    let cos = 1.0 - one_minus_cos;
    henyey_greenstein_at(g, one_minus_cos) * (1.0 + alpha * cos * cos)
        / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0)
}

/// `cos θ` of a Draine deflection, u in [0, 1].
///
/// Newton's method in a bracket on the integral of [`draine`], as a function of t = 2u_HG − 1, the number from which
/// [`sample_henyey_greenstein`] would make the same cosine: its slope is (1 + α cos²θ)/(2 + 2α (1 + 2g²)/3), flat whatever g.
/// Source: the integral is elementary in w = √(1 + g² − 2g cos θ); below |g| = 0.3, where that form cancels, it is summed
/// in Legendre polynomials. [Jendersie and d'Eon 2023](crate::cite::JENDERSIE_DEON_2023) give the root of a cubic instead,
/// which loses its digits as g or α → 0. Domain: |g| < 1, α ≥ 0. Accuracy: 1e-14 absolute in the integral (`tests/terms.rs`).
#[must_use]
pub fn sample_draine(g: f64, alpha: f64, u: f64) -> f64 {
    let u = u.clamp(0.0, 1.0);
    if g < 0.0 {
        return -sample_draine(-g, alpha, 1.0 - u);
    }
    let g = g.min(1.0 - 1e-12);
    let norm = 1.0 / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
    let t = crate::math::root::solve(-1.0, 1.0, |t| {
        let c = sample_henyey_greenstein(g, 0.5 * (1.0 + t));
        let square = if g < 0.3 { second_moment_series(g, c) } else { second_moment(g, t) };
        (norm * (0.5 * (1.0 + t) + alpha * square) - u, 0.5 * norm * (1.0 + alpha * c * c))
    });
    sample_henyey_greenstein(g, 0.5 * (1.0 + t))
}

/// `2π ∫₋₁ᶜ x² p_HG dx` for c = the Henyey-Greenstein cosine of t, g not small.
fn second_moment(g: f64, t: f64) -> f64 {
    let (base, start) = (1.0 + g * g, 1.0 + g);
    let w = (1.0 - g) * start / (1.0 + g * t);
    // start − w, and the difference of B²/w + 2Bw − w³/3 divided by it
    let step = start * g * (1.0 + t) / (1.0 + g * t);
    let bracket = base * base / (w * start) - 2.0 * base + (w * w + w * start + start * start) / 3.0;
    (1.0 - g) * start * step * bracket / (8.0 * g * g * g)
}

/// The same by `p_HG = Σ (2l + 1) gˡ P_l/(4π)`, for g below 0.3.
fn second_moment_series(g: f64, c: f64) -> f64 {
    const TERMS: usize = 34;
    let degree = |l: usize| l as f64;
    let mut coefficients = [0.0; TERMS + 4];
    let mut power = 1.0;
    for (l, out) in coefficients.iter_mut().enumerate().take(TERMS) {
        *out = (2.0 * degree(l) + 1.0) * power;
        power *= g;
    }
    // x P_l = ((l + 1) P_{l+1} + l P_{l−1})/(2l + 1), twice
    for _ in 0..2 {
        let mut times_x = [0.0; TERMS + 4];
        for l in 0..TERMS + 2 {
            let weight = coefficients[l] / (2.0 * degree(l) + 1.0);
            times_x[l + 1] += (degree(l) + 1.0) * weight;
            if l > 0 {
                times_x[l - 1] += degree(l) * weight;
            }
        }
        coefficients = times_x;
    }
    // ∫₋₁ᶜ P_l = (P_{l+1} − P_{l−1})/(2l + 1)
    let (mut before, mut here) = (1.0, c);
    let mut sum = coefficients[0] * (1.0 + c);
    for (l, coefficient) in coefficients.iter().enumerate().take(TERMS + 3).skip(1) {
        let next = ((2.0 * degree(l) + 1.0) * c * here - degree(l) * before) / (degree(l) + 1.0);
        sum += coefficient * (next - before) / (2.0 * degree(l) + 1.0);
        (before, here) = (here, next);
    }
    0.5 * sum
}

/// Mean cosine of [`draine`], `g (1 + α (3 + 2g²)/5)/(1 + α (1 + 2g²)/3)`.
///
/// Source: [Draine2003](crate::cite::DRAINE_2003) ; checked by quadrature (`tests/terms.rs`).
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
    fog_at(diameter_um, 1.0 - cos_theta)
}

/// [`fog`] at `one_minus_cos = 1 − cos θ = 2 sin²(θ/2)`, which its narrow peak needs exactly.
#[must_use]
pub fn fog_at(diameter_um: f64, one_minus_cos: f64) -> f64 {
    let f = Fog::new(diameter_um);
    (1.0 - f.weight) * henyey_greenstein_at(f.g_hg, one_minus_cos)
        + f.weight * draine_at(f.g_draine, f.alpha, one_minus_cos)
}

/// `cos θ` of a deflection by [`fog`]: u.x chooses the lobe, u.y the angle.
#[must_use]
pub fn sample_fog(diameter_um: f64, u: glam::DVec2) -> f64 {
    let f = Fog::new(diameter_um);
    if u.x < f.weight {
        sample_draine(f.g_draine, f.alpha, u.y)
    } else {
        sample_henyey_greenstein(f.g_hg, u.y)
    }
}

/// `cos θ` below which the part u of the light scattered by [`fog`] lies: the inverse of its cumulative distribution.
///
/// Newton's method in a bracket on `(1 − w) C_HG + w C_Draine`, in the variable t = 2u − 1 of the Henyey-Greenstein lobe.
/// Source: the distributions of [`sample_henyey_greenstein`] and [`sample_draine`], added. Domain: u in [0, 1]. Range:
/// [−1, 1]; rises with u. Accuracy: 1e-13 absolute in the distribution (`tests/tables_skin.rs`).
#[must_use]
pub fn fog_quantile(diameter_um: f64, u: f64) -> f64 {
    // at the ends the root would be known to the rounding of the distribution only
    if u <= 0.0 || u >= 1.0 {
        return if u <= 0.0 { -1.0 } else { 1.0 };
    }
    let f = Fog::new(diameter_um);
    let draine_norm = 1.0 / (1.0 + f.alpha * (1.0 + 2.0 * f.g_draine * f.g_draine) / 3.0);
    let t = crate::math::root::solve(-1.0, 1.0, |t| {
        let c = sample_henyey_greenstein(f.g_hg, 0.5 * (1.0 + t));
        let s = t_of_cosine(f.g_draine, c);
        let square =
            if f.g_draine < 0.3 { second_moment_series(f.g_draine, c) } else { second_moment(f.g_draine, s) };
        let draine_part = draine_norm * (0.5 * (1.0 + s) + f.alpha * square);
        let value = (1.0 - f.weight) * 0.5 * (1.0 + t) + f.weight * draine_part - u.clamp(0.0, 1.0);
        // dc/dt is 1/(4π p_HG)
        let ratio = draine(f.g_draine, f.alpha, c) / henyey_greenstein(f.g_hg, c);
        (value, 0.5 * ((1.0 - f.weight) + f.weight * ratio))
    });
    sample_henyey_greenstein(f.g_hg, 0.5 * (1.0 + t))
}

/// The t = 2u − 1 from which [`sample_henyey_greenstein`] makes a cosine: `((1 − g²)/w − 1)/g`, w = √(1 + g² − 2gc), g not small.
fn t_of_cosine(g: f64, c: f64) -> f64 {
    let width = 1.0 - g;
    let w = (width * width + 2.0 * g * (1.0 - c)).sqrt();
    ((width * (1.0 + g) / w - 1.0) / g).clamp(-1.0, 1.0)
}

/// Parameters of [`fog`].
struct Fog {
    g_hg: f64,
    g_draine: f64,
    alpha: f64,
    /// Share of Draine's lobe.
    weight: f64,
}

impl Fog {
    fn new(diameter_um: f64) -> Self {
        let d = diameter_um.clamp(5.0, 50.0);
        Self {
            g_hg: libm::exp(-0.0990567 / (d - 1.67154)),
            g_draine: libm::exp(-2.20679 / (d + 3.91029) - 0.428934),
            alpha: libm::exp(3.62489 - 8.29288 / (d + 5.52825)),
            weight: libm::exp(-0.599085 / (d - 0.641583) - 0.665888),
        }
    }
}
