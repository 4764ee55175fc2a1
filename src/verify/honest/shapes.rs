//! Distributions without a rule of slopes that fits all widths, by their printed formulas, and what they hide by the polar angle of the facets.

use super::quad;
use std::f64::consts::{FRAC_1_PI, FRAC_PI_2};

/// Roundings of a value in closed form.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Accuracy that is asked of an integral.
const TARGET: f64 = 1e-13;

/// How near to its removable poles the printed constant of GTR is not used.
const POLE: f64 = 1e-2;

/// Which.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    StudentT,
    Gtr,
    BlinnPhong,
    Charlie,
    Velvet,
    VelvetOnFloor,
    Fibres,
}

impl Shape {
    pub(super) fn named(word: &str) -> Option<Shape> {
        Some(match word {
            "student-t" => Shape::StudentT,
            "gtr" => Shape::Gtr,
            "blinn-phong" => Shape::BlinnPhong,
            "charlie" => Shape::Charlie,
            "velvet-2000" => Shape::Velvet,
            "velvet-2007" => Shape::VelvetOnFloor,
            "sggx" => Shape::Fibres,
            _ => return None,
        })
    }

    /// The cosine at which relative values are 1.
    pub(super) fn unit_at(self) -> f64 {
        match self {
            Shape::StudentT | Shape::Gtr | Shape::BlinnPhong => 1.0,
            _ => 0.0,
        }
    }

    /// D and its relative error, by logarithms where there is a power.
    pub(super) fn density(self, mu: f64, width: f64, gamma: f64) -> Option<(f64, f64)> {
        let (cos2, sin2) = (mu * mu, (1.0 - mu) * (1.0 + mu));
        let power = |log: f64, factor: f64| Some((factor * libm::exp(log), ROUNDING * (1.0 + log.abs())));
        let bell = |width: f64| {
            let x = cos2 / (sin2 * width * width);
            if x < 700.0 { (libm::exp(-x) / (sin2 * sin2), x) } else { (0.0, 0.0) }
        };
        match self {
            Shape::StudentT if cos2 * cos2 > 0.0 => {
                let tail = gamma * libm::log1p(sin2 / (cos2 * width * width * (gamma - 1.0)));
                let (v, e) = power(-tail - 2.0 * libm::log(cos2), FRAC_1_PI / (width * width))?;
                Some((v, e + ROUNDING * tail))
            }
            Shape::StudentT => None,
            Shape::Gtr => {
                let a2 = width * width;
                let norm = if (a2 - 1.0).abs() < POLE {
                    return None;
                } else if (gamma - 1.0).abs() <= f64::EPSILON {
                    (a2 - 1.0) / libm::log(a2)
                } else if (gamma - 1.0).abs() < POLE {
                    return None;
                } else {
                    (gamma - 1.0) * (a2 - 1.0) / (1.0 - libm::pow(a2, 1.0 - gamma))
                };
                let (v, e) = power(-gamma * libm::log(sin2 + a2 * cos2), norm * FRAC_1_PI)?;
                Some((v, e + ROUNDING * (10.0 + gamma) / POLE))
            }
            Shape::BlinnPhong => {
                let factor = 0.5 * FRAC_1_PI * (width + 2.0);
                if width <= 0.0 {
                    return Some((factor, ROUNDING));
                }
                power(if mu > 0.0 { width * libm::log1p(mu - 1.0) } else { f64::NEG_INFINITY }, factor)
                    .map(|(v, e)| if v > 0.0 { (v, e + f64::EPSILON * width) } else { (0.0, 0.0) })
            }
            Shape::Charlie if sin2 <= 0.0 => Some((0.0, 0.0)),
            Shape::Charlie => power(0.5 * libm::log(sin2) / width, 0.5 * FRAC_1_PI * (2.0 + 1.0 / width)),
            Shape::Velvet if sin2 <= 0.0 => Some((0.0, 0.0)),
            Shape::Velvet => {
                let (v, x) = bell(width);
                Some((v * FRAC_1_PI / (width * width), ROUNDING * (1.0 + x)))
            }
            Shape::VelvetOnFloor => {
                let (v, x) = if sin2 > 0.0 { bell(width) } else { (0.0, 0.0) };
                Some((FRAC_1_PI * (1.0 + 4.0 * v) / (1.0 + 4.0 * width * width), ROUNDING * (1.0 + x)))
            }
            Shape::Fibres => {
                let square = sin2 + cos2 / (width * width);
                Some((FRAC_1_PI / (width * square * square), ROUNDING))
            }
        }
    }

    /// `mu Lambda` and its error: over the polar angles of the facets that a direction can see from behind, from asin(mu) on,
    /// `2 D sin (sqrt(b^2 - a^2) - a acos(a / b))`, `a = mu cos`, `b = s sin`, `b^2 - a^2 = sin^2 - mu^2`.
    pub(super) fn hidden(self, mu: f64, width: f64, gamma: f64) -> (f64, f64) {
        if mu >= 1.0 {
            return (0.0, 0.0);
        }
        let from = libm::asin(mu);
        let fine = if self == Shape::BlinnPhong { (2.0 / (width + 2.0)).sqrt() } else { width };
        let mut breaks = vec![from, FRAC_PI_2];
        let mut step = 0.3 * fine.min(1.0);
        for _ in 0..12 {
            breaks.extend([step, from + step, FRAC_PI_2 - step]);
            step *= 3.0;
        }
        breaks.retain(|x| (from..=FRAC_PI_2).contains(x));
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        let area = if self == Shape::Fibres { width } else { 1.0 };
        let mut admitted = 0.0f64;
        let (value, error) = quad::integral(&breaks, TARGET, &mut |theta| {
            let (sin, cos) = libm::sincos(theta);
            let Some((d, relative)) = self.density(cos.max(0.0), width, gamma) else { return f64::NAN };
            admitted = admitted.max(relative);
            let a = mu * cos;
            let root = ((sin - mu) * (sin + mu)).max(0.0).sqrt();
            2.0 * d * sin * (root - a * libm::atan2(root, a)) / area
        });
        (value, error + value * admitted)
    }
}
