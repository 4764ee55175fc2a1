//! Terms in single precision: the forms that shaders should use, kept beside their f64 counterparts.
//!
//! Each is the cancellation-free form of its namesake in f64, so that no step loses more digits than the input has lost
//! already. `tests/single.rs` compares both precisions with 60-digit values at the stiff ends (alpha 1e-7 and anisotropy
//! 1:1000, exponents to 1e7, mu from 1e-8, eta from 1e-3 to 1e3, k to 1e3): the largest relative error is 2e-6 here where the
//! textbook forms lose every digit. What was rearranged, and why:
//!
//! * D from `(x/α)² + (y/α)² + z²`: `z²(α² − 1) + 1` is a difference of nearly equal numbers for small α.
//! * Λ as `t/(2(1 + √(1 + t)))`: `√(1 + t) − 1` has no digits left for t below 1e-7.
//! * Fresnel by products with the conjugate: `(c − g)/(c + g)` cancels as eta → 1, `1 − R` as k → ∞.
//! * `cosⁿ` as `exp(n/2 log1p(−sin²))`: the cosine itself has too few digits to be raised to 1e6.
//! * Henyey-Greenstein from `1 − cos` and `(1 − g)²`: the usual denominator is 0/0 near the peak.
//!
//! Smith's Λ of Beckmann is not here: shaders use a rational fit, whose own error of 0.3 % is far above any rounding.

use glam::Vec3;
use std::f32::consts::{FRAC_1_PI, PI};

/// GGX normal distribution, as [`super::ggx::Ggx`]'s. Units: sr⁻¹. 0 for `wm.z` ≤ 0.
#[must_use]
pub fn ggx_d(alpha_x: f32, alpha_y: f32, wm: Vec3) -> f32 {
    if wm.z <= 0.0 {
        return 0.0;
    }
    let (x, y) = (wm.x / alpha_x, wm.y / alpha_y);
    let square = x * x + y * y + wm.z * wm.z;
    FRAC_1_PI / (alpha_x * square) / (alpha_y * square)
}

/// `mu Λ` of GGX, finite at the horizon: [`super::smith::Ndf::mu_lambda`].
#[must_use]
pub fn ggx_mu_lambda(alpha_x: f32, alpha_y: f32, w: Vec3) -> f32 {
    let (x, y) = (alpha_x * w.x, alpha_y * w.y);
    let q = x * x + y * y;
    let sum = w.z + (w.z * w.z + q).sqrt();
    if sum > 0.0 { 0.5 * q / sum } else { 0.0 }
}

/// Height-correlated visibility `G2/(4 mu_o mu_i)` of GGX without a division by a cosine. Range: ≥ 0, finite; 0 if both
/// cosines are 0.
#[must_use]
pub fn ggx_visibility(alpha_x: f32, alpha_y: f32, wo: Vec3, wi: Vec3) -> f32 {
    let hidden = |w| ggx_mu_lambda(alpha_x, alpha_y, w);
    let area = wo.z * wi.z + (wo.z * hidden(wi) + wi.z * hidden(wo));
    if area > 0.0 { 0.25 / area } else { 0.0 }
}

/// Beckmann's normal distribution, as [`super::beckmann::Beckmann`]'s. 0 where the exponent is above 87, the end of normal
/// numbers of 32 bits, so that processors that flush smaller ones agree with those that do not.
#[must_use]
pub fn beckmann_d(alpha_x: f32, alpha_y: f32, wm: Vec3) -> f32 {
    if wm.z <= 0.0 {
        return 0.0;
    }
    let (x, y) = (wm.x / alpha_x, wm.y / alpha_y);
    let cos2 = wm.z * wm.z;
    let exponent = (x * x + y * y) / cos2;
    if exponent < 87.0 {
        FRAC_1_PI * libm::expf(-exponent) / (alpha_x * cos2) / (alpha_y * cos2)
    } else {
        0.0
    }
}

/// Blinn-Phong normal distribution `(n + 2)/(2π) cosⁿ`, as [`super::blinn_phong::d`].
#[must_use]
pub fn blinn_phong_d(n: f32, wm: Vec3) -> f32 {
    if wm.z <= 0.0 {
        return 0.0;
    }
    (n + 2.0) / (2.0 * PI) * cos_pow(wm.z, wm.x * wm.x + wm.y * wm.y, n)
}

/// GTR, as [`super::gtr::d`]: `φ(L) / (π φ((γ − 1) L)) t²` with L = ln α², φ(x) = (eˣ − 1)/x and
/// `t = (cos²θ + sin²θ/α²)^(−γ/2)/α`, which overflows nowhere: the power and the norm do where alpha is small and gamma large.
#[must_use]
pub fn gtr_d(alpha: f32, gamma: f32, wm: Vec3) -> f32 {
    if wm.z <= 0.0 {
        return 0.0;
    }
    let log_square = 2.0 * libm::logf(alpha);
    let exprel = |x: f32| if x == 0.0 { 1.0 } else { libm::expm1f(x) / x };
    let norm = FRAC_1_PI * exprel(log_square) / exprel((gamma - 1.0) * log_square);
    let (x, y) = (wm.x / alpha, wm.y / alpha);
    let t = libm::powf(wm.z * wm.z + (x * x + y * y), -0.5 * gamma) / alpha;
    norm * t * t
}

/// Charlie, as [`super::charlie::d`].
#[must_use]
pub fn charlie_d(roughness: f32, wm: Vec3) -> f32 {
    if wm.z <= 0.0 {
        return 0.0;
    }
    let exponent = 1.0 / roughness;
    let sine = (wm.x * wm.x + wm.y * wm.y).sqrt();
    (2.0 + exponent) / (2.0 * PI) * cos_pow(sine, wm.z * wm.z, exponent)
}

/// Schlick's Fresnel factor with f90 = 1.
#[must_use]
pub fn schlick(f0: f32, cos_i: f32) -> f32 {
    let m = (1.0 - cos_i).clamp(0.0, 1.0);
    let m2 = m * m;
    f0 + (1.0 - f0) * (m2 * m2 * m)
}

/// Unpolarised reflectance of a dielectric seen from above, as [`super::fresnel::dielectric`] for `cos_i` ≥ 0. eta below 1
/// is the view from the denser side; 1 under total internal reflection.
#[must_use]
pub fn dielectric(cos_i: f32, eta: f32) -> f32 {
    let contrast = (eta - 1.0) * (eta + 1.0);
    if contrast == 0.0 {
        return 0.0;
    }
    let sin2 = (1.0 - cos_i) * (1.0 + cos_i);
    let square = if 2.0 * cos_i * cos_i > 1.0 { eta * eta - sin2 } else { contrast + cos_i * cos_i };
    if square <= 0.0 {
        return 1.0;
    }
    let g = square.sqrt();
    let dense = eta * eta * cos_i;
    let (sum_s, sum_p) = (cos_i + g, dense + g);
    let s = contrast / sum_s / sum_s;
    let p = contrast / sum_p * ((dense * cos_i - sin2) / sum_p);
    (0.5 * (s * s + p * p)).min(1.0)
}

/// Reflectance and absorptance of a conductor, unpolarised: [`super::fresnel::conductor`] and
/// [`super::fresnel::conductor_absorptance`] in one pass.
#[must_use]
pub fn conductor(cos_i: f32, n: f32, k: f32) -> [f32; 2] {
    let c = cos_i.clamp(0.0, 1.0);
    let sin2 = (1.0 - c) * (1.0 + c);
    let (re, im) = ((n - k) * (n + k), 2.0 * n * k);
    let real = if c * c > sin2 { re - sin2 } else { (n - 1.0) * (n + 1.0) - k * k + c * c };
    let modulus = libm::hypotf(real, im);
    let (a, b) = if modulus == 0.0 {
        (0.0, 0.0)
    } else if real >= 0.0 {
        let a = (0.5 * (modulus + real)).sqrt();
        (a, n * k / a)
    } else {
        let b = (0.5 * (modulus - real)).sqrt();
        (n * k / b, b)
    };
    let square = |x: f32| x * x;
    let contrast = (square(n - 1.0) + k * k) * (square(n + 1.0) + k * k);
    if contrast == 0.0 {
        return [0.0, 1.0];
    }
    let sum_s = square(c + a) + b * b;
    let sum_p = square(re * c + a) + square(im * c + b);
    let brewster = square(re * c * c - sin2) + square(im * c * c);
    let s = contrast / sum_s / sum_s;
    let p = contrast / sum_p * (brewster / sum_p);
    let lost = |r: f32| 4.0 * a * (c / r);
    let absorbed = 0.5 * (lost(sum_s) + lost(sum_p) * (modulus + sin2));
    [(0.5 * (s + p)).min(1.0), absorbed.min(1.0)]
}

/// Henyey-Greenstein at `one_minus_cos = 1 − cos θ`, as [`super::phase::henyey_greenstein_at`].
#[must_use]
pub fn henyey_greenstein_at(g: f32, one_minus_cos: f32) -> f32 {
    let width = 1.0 - g.abs();
    let from_peak = if g < 0.0 { 2.0 - one_minus_cos } else { one_minus_cos };
    let square = width * width + 2.0 * g.abs() * from_peak.max(0.0);
    0.25 * FRAC_1_PI * width * (1.0 + g.abs()) / (square * square.sqrt())
}

/// [`crate::math::special::cos_pow`].
fn cos_pow(cos: f32, sin2: f32, n: f32) -> f32 {
    if n == 0.0 {
        1.0
    } else if cos <= 0.0 {
        0.0
    } else if sin2 < 0.5 {
        libm::expf(0.5 * n * libm::log1pf(-sin2))
    } else {
        libm::expf(n * libm::logf(cos))
    }
}
