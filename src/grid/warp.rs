//! Warps: how a value is spread over its axis. A warp maps a value to `w` in [0, 1] and back.
//!
//! The forward map is what a shader does to get its texture coordinate; the inverse is where the baker integrates.
//! A coupled warp depends on the value of another axis, which is how the corner (mu, alpha) -> (0, 0) of a GGX albedo
//! is opened up.

use super::scalar::Scalar;
use crate::math::figures::exact;
use serde::{Deserialize, Serialize};

/// How a value in [0, 1] (the axis domain, normalised) is spread over its axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Warp {
    /// `w = v`.
    Linear,
    /// `w = v^p`, p > 0. `sqrt` is p = 1/2, `square` is p = 2.
    Power(f64),
    /// `w = 1 - (1 - v)^p`, p > 0: fine near v = 1 for p < 1. The LTC axis `sqrt(1 - mu)` is p = 1/2 with a descending direction.
    OneMinusPower(f64),
    /// `w^p = v (1 + c) / (v + c)` with `c = scale * a^exponent`, `a` the base value of the axis `to`.
    ///
    /// With p = 2, c = alpha this is `x^2 = mu (1 + alpha) / (mu + alpha)`, in which the white GGX albedo is smooth.
    Coupled {
        /// Id of the base quantity that the warp depends on.
        to: String,
        /// The power p.
        power: f64,
        /// Factor of the coupling.
        scale: f64,
        /// Exponent of the coupling.
        exponent: f64,
    },
}

impl Warp {
    /// Value in [0, 1] to warped coordinate. `coupled` is the base value of the axis named by [`Warp::couples_to`].
    #[must_use]
    pub fn forward<S: Scalar>(&self, v: S, coupled: S) -> S {
        let one = || S::number(1.0);
        match self {
            Warp::Linear => v,
            Warp::Power(p) => v.power(*p),
            Warp::OneMinusPower(p) => one().minus(one().minus(v).power(*p)),
            Warp::Coupled { power, scale, exponent, .. } => {
                let c = S::number(*scale).times(coupled.at_least(0.0).power(*exponent));
                // v = c = 0 is 0
                let ratio = v.clone().times(one().plus(c.clone())).over(v.plus(c).at_least(S::LEAST));
                ratio.power(1.0 / power)
            }
        }
    }

    /// Warped coordinate to value; the inverse of [`Warp::forward`].
    #[must_use]
    pub fn inverse(&self, w: f64, coupled: f64) -> f64 {
        match self {
            Warp::Linear => w,
            Warp::Power(p) => w.power(1.0 / p),
            Warp::OneMinusPower(p) => 1.0 - (1.0 - w).power(1.0 / p),
            Warp::Coupled { power, scale, exponent, .. } => {
                let c = scale * coupled.at_least(0.0).power(*exponent);
                let y = w.power(*power);
                if y >= 1.0 {
                    return 1.0;
                }
                c * y / (1.0 + c - y)
            }
        }
    }

    /// The base quantity that a coupled warp depends on.
    #[must_use]
    pub fn couples_to(&self) -> Option<&str> {
        match self {
            Warp::Coupled { to, .. } => Some(to),
            _ => None,
        }
    }

    /// What is wrong with the numbers of this warp, if anything.
    #[must_use]
    pub fn fault(&self) -> Option<String> {
        let bad = |name: &str, p: f64| {
            (!(p.is_finite() && (1e-3..=1e3).contains(&p)))
                .then(|| format!("{name} = {} outside [0.001, 1000]", exact(p)))
        };
        match self {
            Warp::Linear => None,
            Warp::Power(p) | Warp::OneMinusPower(p) => bad("power", *p),
            Warp::Coupled { power, scale, exponent, .. } => {
                bad("power", *power).or_else(|| bad("scale", *scale)).or_else(|| bad("exponent", *exponent))
            }
        }
    }
}
