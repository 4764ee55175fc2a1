//! STD, Student's t distribution of slopes: GGX and Beckmann with everything between and beyond.
//!
//! γ = 2 is GGX, γ → ∞ Beckmann, 3/2 < γ < 2 has longer tails than GGX. At γ ≤ 3/2 the facets' mean slope is infinite
//! and so is the masking.

use super::smith::{ALPHA_FLOOR, Ndf, normal_or_z};
use crate::math::root::solve;
use crate::math::special::{FRAC_1_SQRT_PI, SQRT_PI, circle};
use crate::math::{frame, special};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_1_PI;

/// Student's t distribution with widths `alpha_x`, `alpha_y` and exponent `gamma`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StudentT {
    alpha_x: f64,
    alpha_y: f64,
    gamma: f64,
    /// γ − 1, half the degrees of freedom of the slopes in the plane.
    b: f64,
    /// Γ(γ − 1/2)/Γ(γ − 1).
    ratio: f64,
}

impl StudentT {
    /// Widths in (0, 2], γ in (3/2, 1e8]. Guard: widths as [`ALPHA_FLOOR`]; γ is clamped to [1.5 + 2⁻²⁰, 1e9].
    #[must_use]
    pub fn new(alpha_x: f64, alpha_y: f64, gamma: f64) -> Self {
        let gamma =
            if gamma > 1.5 { gamma.clamp(1.5 + 9.5367431640625e-7, 1e9) } else { 1.5 + 9.5367431640625e-7 };
        let b = gamma - 1.0;
        Self {
            alpha_x: alpha_x.max(ALPHA_FLOOR),
            alpha_y: alpha_y.max(ALPHA_FLOOR),
            gamma,
            b,
            ratio: special::gamma_half_ratio(b),
        }
    }

    /// The same width in all directions.
    #[must_use]
    pub fn isotropic(alpha: f64, gamma: f64) -> Self {
        Self::new(alpha, alpha, gamma)
    }

    /// Width along +x.
    #[must_use]
    pub fn alpha_x(&self) -> f64 {
        self.alpha_x
    }

    /// Width along +y.
    #[must_use]
    pub fn alpha_y(&self) -> f64 {
        self.alpha_y
    }

    /// The exponent γ.
    #[must_use]
    pub fn gamma(&self) -> f64 {
        self.gamma
    }

    /// The normal with slopes `slope`, given in units of the widths.
    fn normal(&self, slope: DVec2) -> DVec3 {
        normal_or_z(DVec3::new(self.alpha_x * slope.x, self.alpha_y * slope.y, 1.0))
    }

    /// `mu Λ` for a direction of cosine mu whose stretched sine has the square q.
    fn hidden(&self, mu: f64, q: f64) -> f64 {
        let root = (self.b * q).sqrt();
        let s = mu / root;
        let s2 = s * s;
        // Λ = R/√π ∫_s^∞ (u/s − 1)(1 + u²)^(−p) du, p = γ − 1/2; both terms carry (1 + s²)^(1−p).
        let p = self.gamma - 0.5;
        let power = libm::exp((1.0 - p) * libm::log1p(s2));
        if power <= 0.0 || !s2.is_finite() {
            return 0.0;
        }
        let first = root * power / (2.0 * p - 2.0);
        let scale = FRAC_1_SQRT_PI * self.ratio;
        if near_zero(s2, p) {
            return scale * first - mu * (0.5 - scale * power * s / (1.0 + s2) * series(s2, p));
        }
        let g = fraction(s2, p);
        scale * first * (1.0 + (2.0 * p - 1.0) * g) / ((2.0 * p - 1.0) * (1.0 + g))
    }
}

/// Where the series from the centre is used: within 1.5 widths, and while it converges at least like 2⁻ᵏ.
fn near_zero(s2: f64, p: f64) -> bool {
    s2 < 1.0 && s2 * p < 2.25
}

/// `₂F₁(1, p; 3/2; y)`, y = s²/(1 + s²): `∫₀ˢ (1 + u²)^(−p) du = s (1 + s²)^(−p)` times this. Positive terms.
fn series(s2: f64, p: f64) -> f64 {
    let y = s2 / (1.0 + s2);
    let (mut term, mut sum, mut k) = (1.0, 1.0, 0.0);
    while term > 1e-17 * sum {
        term *= y * (p + k) / (1.5 + k);
        sum += term;
        k += 1.0;
    }
    sum
}

/// G ≥ 0 with `∫_s^∞ (1 + u²)^(−p) du = (1 + s²)^(1−p)/(s (2p − 1)(1 + G))`.
///
/// 1/(1 + G) is ₂F₁(1, 1/2; p + 1/2; −1/s²) in Gauss's continued fraction, whose elements are all positive here; for
/// p → ∞ it becomes Laplace's fraction of erfc. Source: [DLMF](crate::cite::DLMF) Eq. 15.7.5, by Lentz's method.
fn fraction(s2: f64, p: f64) -> f64 {
    let c = p + 0.5;
    let first = 0.5 / (c * s2);
    // G = first/(1 + …): the tail 1 + e₂/(1 + e₃/(1 + …)) over s².
    let (mut tail, mut above, mut below) = (1.0, 1.0, 0.0);
    let mut m = 0.0;
    // At the edge of `near_zero` about 60 pairs are needed, 500 are allowed.
    for _ in 0..500 {
        m += 1.0;
        let even = m * (p + m - 1.0) / ((c + 2.0 * m - 2.0) * (c + 2.0 * m - 1.0));
        let odd = (m + 0.5) * (c - 1.0 + m) / ((c + 2.0 * m - 1.0) * (c + 2.0 * m));
        let before: f64 = tail;
        for e in [even, odd] {
            below = 1.0 / (1.0 + e / s2 * below);
            above = 1.0 + e / s2 / above;
            tail *= above * below;
        }
        if (tail - before).abs() <= f64::EPSILON * tail {
            break;
        }
    }
    first / tail
}

/// `∫_s^∞ (1 + u²)^(−p) du` over the whole line's integral: the upper tail probability, for any s.
fn upper_tail(s: f64, p: f64, ratio: f64) -> f64 {
    if s < 0.0 {
        return 1.0 - upper_tail(-s, p, ratio);
    }
    let s2 = s * s;
    let power = FRAC_1_SQRT_PI * ratio * libm::exp((1.0 - p) * libm::log1p(s2));
    if near_zero(s2, p) {
        0.5 - power * s / (1.0 + s2) * series(s2, p)
    } else if power > 0.0 {
        power / (s * (2.0 * p - 1.0) * (1.0 + fraction(s2, p)))
    } else {
        0.0
    }
}

impl Ndf for StudentT {
    /// Student's t distribution of normals.
    ///
    /// `D = (1 + X/(γ − 1))^(−γ)/(π αx αy cos⁴θ)`, X = ((x/αx)² + (y/αy)²)/z².
    /// Source: [Ribardiere2017](crate::cite::RIBARDIERE_2017) Eq. 18, by [appleseed](crate::cite::APPLESEED) `StdMDF::D`.
    /// Guard: `wm.z` ≤ 0 gives 0. For γ < 2 it grows without bound at the horizon, integrably.
    /// Accuracy: relative 1e-13 (`tests/terms.rs`).
    fn d(&self, wm: DVec3) -> f64 {
        if wm.z <= 0.0 {
            return 0.0;
        }
        let (x, y) = (wm.x / self.alpha_x, wm.y / self.alpha_y);
        let cos2 = wm.z * wm.z;
        let power = libm::exp(-self.gamma * libm::log1p((x * x + y * y) / (cos2 * self.b)));
        let area = self.alpha_x * self.alpha_y * cos2 * cos2;
        if area > 0.0 { FRAC_1_PI * power / area } else { 0.0 }
    }

    /// `P22 = (1 + ((x/αx)² + (y/αy)²)/(γ − 1))^(−γ)/(π αx αy)`; source as [`StudentT::d`].
    fn p22(&self, slope: DVec2) -> f64 {
        let (x, y) = (slope.x / self.alpha_x, slope.y / self.alpha_y);
        let power = libm::exp(-self.gamma * libm::log1p((x * x + y * y) / self.b));
        FRAC_1_PI * power / (self.alpha_x * self.alpha_y)
    }

    /// `mu Λ` without the cancellation of the published form.
    ///
    /// `Λ = R/√π ∫_s^∞ (u/s − 1)(1 + u²)^(1/2 − γ) du`, `R = Γ(γ − 1/2)/Γ(γ − 1)`, s = cot θ/(α(φ) √(γ − 1)): a power
    /// minus an incomplete beta function. Near s = 0 that is taken from the centre (a series of positive terms), else
    /// from infinity by a continued fraction 1/(1 + G) with G > 0, where the difference is again a product:
    /// `Λ ∝ (1 + s²)^(3/2 − γ) (1 + 2 (γ − 1) G)/(s (1 + G))`.
    /// Source: [Ribardiere2017](crate::cite::RIBARDIERE_2017) Eqs. 13 to 15, structure re-derived; their fit of it,
    /// good to 0.7 %, is not used. Accuracy: Λ to relative 5e-14 + 2e-15 a² for γ from 1.51 to 1e8 (`tests/terms.rs`).
    fn mu_lambda(&self, w: DVec3) -> f64 {
        let (x, y) = (self.alpha_x * w.x, self.alpha_y * w.y);
        let q = x * x + y * y;
        if q > 0.0 { self.hidden(frame::mu(w), q) } else { 0.0 }
    }

    /// tan²θm = α² (γ − 1) ((1 − u1)^(1/(1 − γ)) − 1) in stretched slopes, azimuth 2π u2.
    ///
    /// Source: [Ribardiere2017](crate::cite::RIBARDIERE_2017) Eqs. 16 and 17 (one width), 19 and 20, by
    /// [appleseed](crate::cite::APPLESEED) `StdMDF::sample`. Guard: u1 = 1 counts as
    /// 1 − 2⁻⁵³.
    fn sample_d(&self, u: DVec2) -> DVec3 {
        let log = -libm::log1p(-u.x.clamp(0.0, 1.0 - 0.5 * f64::EPSILON));
        let r = (self.b * libm::expm1(log / self.b)).sqrt();
        let (cos, sin) = circle(u.y);
        self.normal(DVec2::new(r * cos, r * sin))
    }

    /// A visible normal by inverting the marginal of the slope along `wo`, then that across it.
    ///
    /// In the frame of width 1, w = x/√(γ − 1) has the density ∝ (sin θ √(γ − 1) w + cos θ)(1 + w²)^(1/2 − γ), and
    /// y/√(γ − 1 + x²) given x the density ∝ (1 + w²)^(−γ). Both are inverted by Newton's method in t = asinh w, which
    /// makes power-law tails exponential ones.
    fn sample_visible(&self, wo: DVec3, u: DVec2) -> DVec3 {
        const END: f64 = 80.0;
        let v = normal_or_z(DVec3::new(self.alpha_x * wo.x, self.alpha_y * wo.y, wo.z));
        let (sin, cos) = (frame::sin_theta(v), v.z);
        let hidden = if sin > 0.0 { self.hidden(cos, sin * sin) } else { 0.0 };
        let target = u.x * (cos + hidden) - hidden;
        let root = self.b.sqrt();
        let (p, scale) = (self.gamma - 0.5, FRAC_1_SQRT_PI * self.ratio);
        let start = if sin > 0.0 { libm::asinh(-cos / (sin * root)).max(-END) } else { -END };
        let t = solve(start, END, |t| {
            let (w, cosh) = (libm::sinh(t), libm::cosh(t));
            let power = libm::exp(-2.0 * p * libm::log(cosh));
            let mean = scale * root * power * cosh * cosh / (2.0 * p - 2.0);
            let below = upper_tail(-w, p, self.ratio);
            (cos * below - sin * mean - target, (sin * root * w + cos) * scale * power * cosh)
        });
        let along = root * libm::sinh(t);
        let across_ratio = special::gamma_half_ratio(self.gamma - 0.5);
        let t = solve(-END, END, |t| {
            let power = libm::exp((1.0 - 2.0 * self.gamma) * libm::log(libm::cosh(t)));
            let below = upper_tail(-libm::sinh(t), self.gamma, across_ratio);
            (below - u.y, across_ratio / SQRT_PI * power)
        });
        let across = (self.b + along * along).sqrt() * libm::sinh(t);
        let (c, s) = if sin > 0.0 { (v.x / sin, v.y / sin) } else { (1.0, 0.0) };
        self.normal(DVec2::new(along * c - across * s, along * s + across * c))
    }
}
