//! Beckmann: normally distributed slopes.
//!
//! The surface of a Gaussian random field. α is √2 times the RMS slope, and is the `m` of Cook and Torrance. The peak
//! is as high as that of GGX at equal α, the tail falls like a Gaussian: highlights end where those of GGX glow on.

use super::smith::{ALPHA_FLOOR, Ndf, normal_or_z};
use crate::math::frame;
use crate::math::root::solve;
use crate::math::special::{self, FRAC_1_SQRT_PI, erfcx_tail};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_1_PI;

/// exp(−x) is 0 in f64 from here on.
const UNDERFLOW: f64 = 746.0;

/// Beyond this many widths a Gaussian slope has no probability left in f64 (erfc(6.5) = 4e-20).
const SLOPE_END: f64 = 6.5;

/// Beckmann's distribution with widths `alpha_x`, `alpha_y` of the slopes along +x and +y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beckmann {
    alpha_x: f64,
    alpha_y: f64,
}

impl Beckmann {
    /// Widths in (0, 2]. Guard: a smaller one than [`ALPHA_FLOOR`], or NaN, counts as that floor.
    #[must_use]
    pub fn new(alpha_x: f64, alpha_y: f64) -> Self {
        Self { alpha_x: alpha_x.max(ALPHA_FLOOR), alpha_y: alpha_y.max(ALPHA_FLOOR) }
    }

    /// The same width in all directions.
    #[must_use]
    pub fn isotropic(alpha: f64) -> Self {
        Self::new(alpha, alpha)
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

    /// The normal with slopes `slope`, given in units of the widths.
    fn normal(&self, slope: DVec2) -> DVec3 {
        normal_or_z(DVec3::new(self.alpha_x * slope.x, self.alpha_y * slope.y, 1.0))
    }
}

impl Ndf for Beckmann {
    /// Beckmann's normal distribution.
    ///
    /// `D = exp(−X)/(π αx αy cos⁴θ)`, X = ((x/αx)² + (y/αy)²)/z².
    /// Source: [Cook and Torrance 1982](crate::cite::COOK_TORRANCE_1982), there without π;
    /// [Walter2007](crate::cite::WALTER_2007) Eq. 25 (isotropic).
    /// Guard: `wm.z` ≤ 0 gives 0; X is tested before the division by z⁴, which may underflow.
    /// Accuracy: relative 1e-13 + 4e-16 X against reference values (`tests/terms.rs`); 0 where X > 746.
    fn d(&self, wm: DVec3) -> f64 {
        if wm.z <= 0.0 {
            return 0.0;
        }
        let (x, y) = (wm.x / self.alpha_x, wm.y / self.alpha_y);
        let cos2 = wm.z * wm.z;
        let exponent = (x * x + y * y) / cos2;
        // Written so that a NaN exponent (0/0 after underflow) counts as beyond the end.
        if exponent < UNDERFLOW {
            FRAC_1_PI * libm::exp(-exponent) / (self.alpha_x * self.alpha_y * cos2 * cos2)
        } else {
            0.0
        }
    }

    /// `P22 = exp(−(x/αx)² − (y/αy)²)/(π αx αy)`; source as [`Beckmann::d`].
    fn p22(&self, slope: DVec2) -> f64 {
        let (x, y) = (slope.x / self.alpha_x, slope.y / self.alpha_y);
        FRAC_1_PI * libm::exp(-(x * x + y * y)) / (self.alpha_x * self.alpha_y)
    }

    /// `mu Λ = √q exp(−a²) K(a)/(2√π (a + K(a)))`, q = (αx x)² + (αy y)², a = mu/√q, K of [`erfcx_tail`].
    ///
    /// Source: [Heitz2014](crate::cite::HEITZ_2014) §5.2, `Λ = (exp(−a²)/(a√π) − erfc(a))/2`. The two terms agree in
    /// ever more digits as a grows (all of them above a = 1e8); with erfcx(a) = 1/(√π (a + K)) their difference is
    /// one product. So there is neither a rational fit nor an asymptotic series in here.
    /// Accuracy: Λ to relative 1e-14 + 4e-16 a² at every a, checked down to Λ = 1e-145 (`tests/terms.rs`).
    fn mu_lambda(&self, w: DVec3) -> f64 {
        let (x, y) = (self.alpha_x * w.x, self.alpha_y * w.y);
        let q = x * x + y * y;
        let mu = frame::mu(w);
        let a_squared = mu * mu / q;
        // Also false for the NaN of q = 0 and mu = 0, and for q = 0 alone: nothing is hidden from the normal.
        if a_squared < UNDERFLOW {
            let root = q.sqrt();
            let a = mu / root;
            let k = erfcx_tail(a);
            0.5 * FRAC_1_SQRT_PI * root * libm::exp(-a_squared) * k / (a + k)
        } else {
            0.0
        }
    }

    /// tan²θm = −α² ln(1 − u1) in stretched slopes, azimuth 2π u2.
    ///
    /// Source: [Walter2007](crate::cite::WALTER_2007) Eq. 28. Guard: u1 = 1 counts as 1 − 2⁻⁵³.
    fn sample_d(&self, u: DVec2) -> DVec3 {
        let (cos, sin) = special::circle(u.y);
        let r = (-libm::log1p(-u.x.clamp(0.0, 1.0 - 0.5 * f64::EPSILON))).sqrt();
        self.normal(DVec2::new(r * cos, r * sin))
    }

    /// A visible normal: slopes along and across the azimuth of `wo`, in the frame of width 1, are independent.
    ///
    /// Along: density ∝ (x sin θ + cos θ) exp(−x²) for x > −cot θ, whose integral
    /// `cos θ (1 + erf x)/2 − sin θ exp(−x²)/(2√π) + mu Λ` is inverted by Newton's method in a bracket.
    /// Across: a Gaussian, inverted the same way.
    /// Source: [Heitz and d'Eon 2014](crate::cite::HEITZ_DEON_2014) supplemental, with the inversion made exact.
    fn sample_visible(&self, wo: DVec3, u: DVec2) -> DVec3 {
        let v = normal_or_z(DVec3::new(self.alpha_x * wo.x, self.alpha_y * wo.y, wo.z));
        let (sin, cos) = (frame::sin_theta(v), v.z);
        let hidden = Self::isotropic(1.0).mu_lambda(v);
        let target = u.x * (cos + hidden) - hidden;
        // −cot θ, or the end of the Gaussian before that.
        let start = if cos < SLOPE_END * sin { -cos / sin } else { -SLOPE_END };
        let along = solve(start, SLOPE_END, |x| {
            let gauss = FRAC_1_SQRT_PI * libm::exp(-x * x);
            // (1 + erf x)/2 as erfc(−x)/2 keeps its digits in the left tail.
            (0.5 * (cos * special::erfc(-x) - sin * gauss) - target, (x * sin + cos) * gauss)
        });
        let across = solve(-SLOPE_END, SLOPE_END, |y| {
            (0.5 * special::erfc(-y) - u.y, FRAC_1_SQRT_PI * libm::exp(-y * y))
        });
        let (c, s) = if sin > 0.0 { (v.x / sin, v.y / sin) } else { (1.0, 0.0) };
        self.normal(DVec2::new(along * c - across * s, along * s + across * c))
    }
}
