//! Phase functions and transmittances from their formulas; quantiles by adding up the density that they promise to sample.

use super::{Asked, Truth, quad};
use crate::tables::Role;
use std::f64::consts::{FRAC_1_PI, PI};

/// Roundings of a value in closed form.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Accuracy of a distribution whose whole is 1.
const TARGET: f64 = 1e-14;

/// A phase function by its numbers.
#[derive(Debug, Clone, Copy)]
enum Phase {
    Isotropic,
    Rayleigh,
    Draine {
        g: f64,
        alpha: f64,
    },
    /// Henyey and Greenstein, Draine, and the share of the latter.
    Mixture {
        g: f64,
        other: [f64; 2],
        share: f64,
    },
}

impl Phase {
    fn of(asked: &Asked<'_>) -> Option<Phase> {
        let number = |id: &str| asked.spec.number(id, asked.at).ok();
        let g = asked.spec.number("g", asked.at).ok()?;
        Some(match asked.spec.params.choice("phase").ok()? {
            "isotropic" => Phase::Isotropic,
            "rayleigh" => Phase::Rayleigh,
            "draine" => Phase::Draine { g, alpha: number("draine_alpha")? },
            "fog" => {
                // Jendersie and d'Eon 2023, Eq. 7 to 10
                let d = number("diameter")?.clamp(5.0, 50.0);
                Phase::Mixture {
                    g: libm::exp(-0.0990567 / (d - 1.67154)),
                    other: [
                        libm::exp(-2.20679 / (d + 3.91029) - 0.428934),
                        libm::exp(3.62489 - 8.29288 / (d + 5.52825)),
                    ],
                    share: libm::exp(-0.599085 / (d - 0.641583) - 0.665888),
                }
            }
            _ => Phase::Draine { g, alpha: 0.0 },
        })
    }

    /// The density, 1/sr, by the squares of the sine and the cosine of half the deflection.
    fn at(self, sine2: f64, cosine2: f64) -> f64 {
        let cos = cosine2 - sine2;
        match self {
            Phase::Isotropic => 0.25 * FRAC_1_PI,
            Phase::Rayleigh => 3.0 * (1.0 + cos * cos) / (16.0 * PI),
            Phase::Draine { g, alpha } => draine(g, alpha, sine2, cosine2),
            Phase::Mixture { g, other: [h, alpha], share } => {
                share * draine(h, alpha, sine2, cosine2) + (1.0 - share) * draine(g, 0.0, sine2, cosine2)
            }
        }
    }

    /// `2 pi int p dcos` from the direction `forward` (or from the one behind) to where the sine (cosine) of half the deflection is
    /// `end`: dcos = 4 h dh.
    fn part(self, forward: bool, end: f64) -> (f64, f64) {
        let mut breaks = vec![0.0];
        breaks.extend([1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5].into_iter().filter(|b| *b < end));
        breaks.push(end);
        quad::integral(&breaks, TARGET, &mut |h| {
            let (near, far) = (h * h, (1.0 - h) * (1.0 + h));
            8.0 * PI * h * if forward { self.at(near, far) } else { self.at(far, near) }
        })
    }

    /// Does most light go on?
    fn is_forward(self) -> bool {
        self.at(0.0, 1.0) >= self.at(1.0, 0.0)
    }
}

/// Draine's function; alpha = 0 is that of Henyey and Greenstein. The square is `(1 - g)^2 + 4 g sin^2` or `(1 + g)^2 - 4 g cos^2`.
fn draine(g: f64, alpha: f64, sine2: f64, cosine2: f64) -> f64 {
    let square = if g >= 0.0 {
        (1.0 - g) * (1.0 - g) + 4.0 * g * sine2
    } else {
        (1.0 + g) * (1.0 + g) - 4.0 * g * cosine2
    };
    let cos = cosine2 - sine2;
    let more = (1.0 + alpha * cos * cos) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0);
    0.25 * FRAC_1_PI * (1.0 - g) * (1.0 + g) * more * libm::pow(square, -1.5)
}

/// Roles of this file.
pub(super) fn truth(role: Role, asked: &Asked<'_>, c: usize) -> Option<Truth> {
    let at = |id: &str| asked.spec.axis(id).map(|i| asked.at[i]);
    match role {
        Role::Phase { relative } => {
            let phase = Phase::of(asked)?;
            let (sin, cos) = libm::sincos(0.5 * at("deflection")?);
            let peak = if relative { phase.at(0.0, 1.0).max(phase.at(1.0, 0.0)) } else { 1.0 };
            let value = phase.at(sin * sin, cos * cos) / peak;
            Some(Truth { value, error: ROUNDING * value })
        }
        Role::PhaseQuantile { angle } => quantile(Phase::of(asked)?, at("u")?, asked.baked[c], angle),
        Role::Passed(band) | Role::Lost(band) => {
            let id = ["sigma_r", "sigma_g", "sigma_b"][band.index()];
            let sigma = asked.spec.number(id, asked.at).ok()?;
            let depth = sigma * at("path")?;
            // e^-x = (e^(-x / 2))^2, and 1 - e^-x = 2 sinh(x / 2) e^(-x / 2)
            let half = libm::exp(-0.5 * depth);
            let lost = if depth < 1.0 { 2.0 * libm::sinh(0.5 * depth) * half } else { 1.0 - half * half };
            let value = if matches!(role, Role::Lost(_)) { lost } else { half * half };
            Some(Truth { value, error: ROUNDING * (1.0 + depth.min(700.0)) * value.max(f64::MIN_POSITIVE) })
        }
        _ => None,
    }
}

/// One step of Newton's method from the baked quantile on the distribution that its density adds up to.
fn quantile(phase: Phase, u: f64, baked: f64, angle: bool) -> Option<Truth> {
    let (sine2, cosine2) = if angle {
        let (sin, cos) = libm::sincos(0.5 * baked);
        (sin * sin, cos * cos)
    } else {
        (0.5 * (1.0 - baked), 0.5 * (1.0 + baked))
    };
    // the part beyond, from the side of the peak
    let forward = phase.is_forward();
    let (miss, error) = if forward {
        let (part, error) = phase.part(true, sine2.max(0.0).sqrt());
        ((1.0 - u) - part, error)
    } else {
        let (part, error) = phase.part(false, cosine2.max(0.0).sqrt());
        (part - u, error)
    };
    let density = 2.0 * PI * phase.at(sine2, cosine2);
    let slope = if angle { -density * 2.0 * (sine2 * cosine2).max(0.0).sqrt() } else { density };
    let lost = if forward { 1.0 - u } else { u };
    let loose = error + f64::EPSILON * (1.0 + lost);
    // at the poles the distribution rises with the square of the angle
    let pole = ((miss.abs() + loose) / (0.5 * density)).sqrt();
    if angle && (slope.abs() <= 0.0 || pole < loose / slope.abs()) {
        return Some(Truth { value: baked, error: pole + ROUNDING });
    }
    let step = miss / slope;
    // what the density changes over the step is of second order
    let moved = if angle { step.abs() } else { step.abs() / 2.0 };
    let change = |a: f64, b: f64| {
        (phase.at(a.clamp(0.0, 1.0), b.clamp(0.0, 1.0)) / phase.at(sine2, cosine2) - 1.0).abs()
    };
    let bend = change(sine2 + moved, cosine2 - moved).max(change(sine2 - moved, cosine2 + moved));
    let rounding = loose / slope.abs() + ROUNDING * baked.abs();
    Some(Truth { value: baked - step, error: rounding + bend * step.abs() })
}
