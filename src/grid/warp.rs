//! Warps: how a value is spread over its axis. A warp maps a value to `w` in [0, 1] and back.
//!
//! The forward map is what a shader does to get its texture coordinate; the inverse is where the baker integrates.
//! A coupled warp depends on the value of another axis, which is how the corner (mu, alpha) -> (0, 0) of a GGX albedo
//! is opened up.

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
    /// Value to warped coordinate. `coupled` is the base value of the axis named by [`Warp::couples_to`].
    #[must_use]
    pub fn forward(&self, v: f64, coupled: f64) -> f64 {
        match self {
            Warp::Linear => v,
            Warp::Power(p) => pow(v, *p),
            Warp::OneMinusPower(p) => 1.0 - pow(1.0 - v, *p),
            Warp::Coupled { power, scale, exponent, .. } => {
                let c = scale * pow(coupled, *exponent);
                if v <= 0.0 {
                    return 0.0;
                }
                pow(v * (1.0 + c) / (v + c), 1.0 / power)
            }
        }
    }

    /// Warped coordinate to value; the inverse of [`Warp::forward`].
    #[must_use]
    pub fn inverse(&self, w: f64, coupled: f64) -> f64 {
        match self {
            Warp::Linear => w,
            Warp::Power(p) => pow(w, 1.0 / p),
            Warp::OneMinusPower(p) => 1.0 - pow(1.0 - w, 1.0 / p),
            Warp::Coupled { power, scale, exponent, .. } => {
                let c = scale * pow(coupled, *exponent);
                let y = pow(w, *power);
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

    /// The forward map as a formula in `symbol`, for reports and shader comments.
    #[must_use]
    pub fn formula(&self, symbol: &str) -> String {
        format!("{}{}", self.expression(symbol), self.words())
    }

    /// What the names in [`Warp::expression`] stand for, to be written behind the whole formula.
    pub(super) fn words(&self) -> String {
        let Warp::Coupled { to, scale, exponent, .. } = self else { return String::new() };
        let c = match (same(*scale, 1.0), same(*exponent, 1.0)) {
            (true, true) => to.clone(),
            (false, true) => format!("{} {to}", exact(scale)),
            (true, false) => format!("{to}^{}", exact(exponent)),
            (false, false) => format!("{} {to}^{}", exact(scale), exact(exponent)),
        };
        format!(", c = {c}")
    }

    /// The formula without what its names stand for: it may be a part of a larger one.
    pub(super) fn expression(&self, symbol: &str) -> String {
        match self {
            Warp::Linear => symbol.to_owned(),
            Warp::Power(p) if same(*p, 0.5) => format!("sqrt({symbol})"),
            Warp::Power(p) => format!("{symbol}^{}", exact(p)),
            Warp::OneMinusPower(p) if same(*p, 0.5) => format!("1 - sqrt(1 - {symbol})"),
            Warp::OneMinusPower(p) => format!("1 - (1 - {symbol})^{}", exact(p)),
            Warp::Coupled { power, .. } => {
                format!("({symbol} (1 + c) / ({symbol} + c))^(1/{})", exact(power))
            }
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

/// `x^p` for x >= 0, exact where a root or a product does.
fn pow(x: f64, p: f64) -> f64 {
    let x = x.max(0.0);
    if same(p, 1.0) {
        x
    } else if same(p, 2.0) {
        x * x
    } else if same(p, 0.5) {
        x.sqrt()
    } else if same(p, 4.0) {
        (x * x) * (x * x)
    } else if same(p, 0.25) {
        x.sqrt().sqrt()
    } else {
        libm::pow(x, p)
    }
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() == 0.0
}
