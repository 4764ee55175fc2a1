//! Distributions of normals by their slopes, and Smith's masking by the integral that defines it, not by its closed form.

use super::quad;
use super::shapes::Shape;
use super::{Asked, Truth};
use crate::tables::Role;
use std::f64::consts::{FRAC_1_PI, PI};

/// Roundings of a value in closed form.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Accuracy that is asked of an integral.
const TARGET: f64 = 1e-13;

/// Which distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Normals {
    Ggx,
    Beckmann,
    /// Schlick's rational masking, with its k.
    Rational(f64),
    /// Another distribution, with its exponent of the tail.
    Other(Shape, f64),
}

impl Normals {
    fn of(asked: &Asked<'_>, alpha: f64) -> Option<Normals> {
        let roughness = alpha.sqrt();
        Some(match asked.spec.params.choice("distribution").ok()? {
            "ggx" => Normals::Ggx,
            "beckmann" => Normals::Beckmann,
            "schlick-ibl" => Normals::Rational(0.5 * alpha),
            "schlick-analytic" => Normals::Rational((roughness + 1.0) * (roughness + 1.0) / 8.0),
            "schlick" => Normals::Rational(alpha * (2.0 * FRAC_1_PI).sqrt()),
            word => Normals::Other(Shape::named(word)?, asked.number("gamma")?),
        })
    }

    /// D in units of its peak 1 / (pi alpha^2), and its relative error.
    fn relative(self, mu: f64, alpha: f64) -> Option<(f64, f64)> {
        let (cos2, sin2) = (mu * mu, (1.0 - mu) * (1.0 + mu));
        let slope = sin2 / (alpha * alpha);
        match self {
            // cos^4 (1 + tan^2 / a^2)^2
            Normals::Ggx => Some((libm::pow(cos2 + slope, -2.0), ROUNDING)),
            Normals::Beckmann if cos2 > 0.0 => {
                let x = slope / cos2;
                Some((libm::exp(-x) / (cos2 * cos2), ROUNDING * (1.0 + x)))
            }
            Normals::Beckmann => Some((0.0, 0.0)),
            Normals::Rational(_) => None,
            Normals::Other(shape, gamma) => {
                let (value, error) = shape.density(mu, alpha, gamma)?;
                Some((value * PI * alpha * alpha, error))
            }
        }
    }

    /// `mu Lambda(mu)`, Lambda the integral of the slopes that hide: `Lambda = int_c^inf (q - c) P(q) dq / c`, c the cotangent, P the
    /// density of slopes along one direction. Finite at the horizon.
    fn hidden(self, mu: f64, alpha: f64) -> (f64, f64) {
        let sin = ((1.0 - mu) * (1.0 + mu)).sqrt();
        let scale = alpha * sin;
        if scale <= 0.0 {
            return (0.0, 0.0);
        }
        let from = mu / scale;
        // x = from + y / (1 - y)
        let (value, error) = quad::integral(&[0.0, 0.5, 1.0], TARGET, &mut |y| {
            let rest = 1.0 - y;
            let step = y / rest;
            let x = from + step;
            let density = match self {
                Normals::Beckmann => libm::exp(-x * x) / PI.sqrt(),
                _ => 0.5 * libm::pow(1.0 + x * x, -1.5),
            };
            step * density / (rest * rest)
        });
        (scale * value, scale * error)
    }

    /// `mu / G1` and its error.
    fn over_masking(self, mu: f64, alpha: f64) -> (f64, f64) {
        match self {
            Normals::Rational(k) => (mu * (1.0 - k) + k, ROUNDING),
            Normals::Other(shape, gamma) => {
                let (hidden, error) = shape.hidden(mu, alpha, gamma);
                (mu + hidden, error + ROUNDING * (mu + hidden))
            }
            _ => {
                let (hidden, error) = self.hidden(mu, alpha);
                (mu + hidden, error + ROUNDING * (mu + hidden))
            }
        }
    }
}

/// Roles of this file.
pub(super) fn truth(role: Role, asked: &Asked<'_>) -> Option<Truth> {
    let spec = asked.spec;
    let at = |id: &str| spec.axis(id).map(|i| asked.at[i]);
    if spec.params.choice("distribution") == Ok("vcavity") {
        return grooves(role, asked);
    }
    let width = if spec.params.choice("distribution") == Ok("blinn-phong") { "n" } else { "alpha" };
    let alpha = || asked.number(width);
    match role {
        Role::Distribution { relative } => {
            let (mu, alpha) = (at("mu_m")?, alpha()?);
            let normals = Normals::of(asked, alpha)?;
            let (value, error) = normals.relative(mu, alpha)?;
            let peak = match normals {
                Normals::Other(shape, gamma) if relative => {
                    let (unit, of) = shape.density(shape.unit_at(), alpha, gamma)?;
                    let value = value * FRAC_1_PI / (alpha * alpha) / unit;
                    return Some(Truth { value, error: (error + of) * value });
                }
                _ if relative => 1.0,
                _ => FRAC_1_PI / (alpha * alpha),
            };
            Some(Truth { value: value * peak, error: error * value * peak })
        }
        Role::DistributionRoot => {
            let (mu, m) = (at("mu_m")?, at("m")?);
            let (value, error) = Normals::Beckmann.relative(mu, m)?;
            let root = 0.5 * libm::pow(value / (m * m), 0.1);
            Some(Truth { value: root, error: root * (0.1 * error + ROUNDING) })
        }
        Role::Masking => {
            let (mu, alpha) = (at("mu")?, alpha()?);
            let (over, error) = Normals::of(asked, alpha)?.over_masking(mu, alpha);
            Some(quotient(mu, over, error))
        }
        Role::MaskingShadowing | Role::Visibility => pair(role, asked, [at("mu")?, at("mu_i")?], alpha()?),
        _ => None,
    }
}

impl Asked<'_> {
    /// A number of the kind, on an axis or fixed.
    fn number(&self, id: &str) -> Option<f64> {
        self.spec.number(id, self.at).ok()
    }
}

/// V-shaped grooves by the sums of cosines: `h.z / (w . h) = (mu_o + mu_i) / (1 + wo . wi)`.
fn grooves(role: Role, asked: &Asked<'_>) -> Option<Truth> {
    let (mu, phi) = (asked.number("mu").or_else(|| axis(asked, "mu"))?, asked.number("phi")?);
    let sine = |mu: f64| ((1.0 - mu) * (1.0 + mu)).sqrt();
    let together = |other: f64| mu * other + sine(mu) * sine(other) * libm::cos(phi);
    let truth = |value: f64, room: f64| Truth { value, error: value * ROUNDING * (1.0 + 1.0 / room) };
    if role == Role::Masking {
        let mu_m = asked.number("mu_m")?;
        let cosine = together(mu_m);
        let seen = if cosine > 0.0 { (2.0 * mu_m * mu / cosine).min(1.0) } else { 0.0 };
        // at the edge of what is seen a rounding decides
        return (cosine.abs() > 1e-9).then(|| truth(seen, cosine.abs()));
    }
    let other = axis(asked, "mu_i")?;
    let room = 1.0 + together(other);
    let g2 = (2.0 * mu.min(other) * (mu + other) / room).min(1.0);
    let both = mu * other;
    match role {
        Role::Visibility if both > 0.0 => Some(truth(0.25 * g2 / both, room)),
        Role::MaskingShadowing if room > 1e-9 => Some(truth(g2, room)),
        _ => None,
    }
}

/// The base value of an axis.
fn axis(asked: &Asked<'_>, id: &str) -> Option<f64> {
    asked.spec.axis(id).map(|i| asked.at[i])
}

/// `above / below` where the latter has an error; 0 / 0 is 0.
fn quotient(above: f64, below: f64, error: f64) -> Truth {
    if below <= 0.0 {
        return Truth { value: 0.0, error: 0.0 };
    }
    let value = above / below;
    Truth { value, error: value.abs() * (error / below + ROUNDING) }
}

/// Masking and shadowing, or the visibility made of it.
fn pair(role: Role, asked: &Asked<'_>, [o, i]: [f64; 2], alpha: f64) -> Option<Truth> {
    let normals = Normals::of(asked, alpha)?;
    let ([over_o, e_o], [over_i, e_i]) =
        (<[f64; 2]>::from(normals.over_masking(o, alpha)), <[f64; 2]>::from(normals.over_masking(i, alpha)));
    let rational = matches!(normals, Normals::Rational(_));
    let correlated = asked.spec.params.choice("masking").is_ok_and(|word| word == "correlated") && !rational;
    // 1 / (1 + L_o + L_i) over mu_o mu_i, or the product of both G1 over them: the denominators
    let (below, error) = if correlated {
        let (hidden_o, hidden_i) = (over_o - o, over_i - i);
        (o * i + i * hidden_o + o * hidden_i, i * e_o + o * e_i)
    } else {
        (over_o * over_i, over_i * e_o + over_o * e_i)
    };
    let above = if role == Role::Visibility { 0.25 } else { o * i };
    // in the horizon twice there is no reflection, and the correlated form counts as 0
    Some(quotient(above, below, error))
}
