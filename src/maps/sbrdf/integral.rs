//! The integral of a cosine lobe over the hemisphere, which has no closed form where its axis is off the normal.

use crate::integrate::gauss;
use std::f64::consts::{PI, TAU};

/// Nodes of a panel.
const ORDER: usize = 32;

/// I(n, u) = ∫ max(0, a·r)ⁿ (n·r) dr over the hemisphere, u the cosine between the axis a and the normal; without the cosine n·r if
/// `inside` is false.
///
/// About the axis the integral over the azimuth is elementary: the horizon cuts the circle a·r = y at the angle φ with cos φ = −u y/(s √(1 − y²)),
/// s = √(1 − u²). Circles with y > s lie above it whole (u > 0), or below it (u < 0). What is left runs over
/// y = s (1 − v²), which takes the root at y = s away. On the normal I = 2π/(n + 2), and 2π/(n + 1) without the cosine.
/// Domain: n ≥ 0, u in [−1, 1]. Accuracy: relative 1e-9 (`tests/sbrdf.rs`).
#[must_use]
pub fn integral(n: f64, u: f64, inside: bool) -> f64 {
    let u = u.clamp(-1.0, 1.0);
    let s = ((1.0 - u) * (1.0 + u)).sqrt();
    let m = if inside { n + 2.0 } else { n + 1.0 };
    let whole = if u > 0.0 {
        let part = 1.0 - libm::pow(s, m);
        TAU * part / m * if inside { u } else { 1.0 }
    } else {
        0.0
    };
    let share = libm::pow(s, n + 1.0);
    // beside the whole circles, less than the last digit
    if share < 1e-18 * whole { whole } else { whole + share * cut(n, u, s, inside) }
}

/// The part of the circles that the horizon cuts, over s^(n+1).
fn cut(n: f64, u: f64, s: f64, inside: bool) -> f64 {
    if s <= 0.0 {
        return 0.0;
    }
    let value = |v: f64| {
        let x = 1.0 - v * v;
        let y = s * x;
        // 1 - y^2, with its digits where u is small
        let sin = (u * u + s * s * v * v * (2.0 - v * v)).sqrt();
        let turn = (-u * x / sin).clamp(-1.0, 1.0);
        let phi = libm::acos(turn);
        let around =
            if inside { 2.0 * (u * y * phi + s * sin * (1.0 - turn * turn).sqrt()) } else { 2.0 * phi };
        libm::pow(x, n) * around * 2.0 * v
    };
    // beyond, x^n is below e^-45
    let end = if n > 45.0 { (45.0 / n).sqrt() } else { 1.0 };
    let knee = u.abs().min(end);
    let rule = gauss::rule(ORDER);
    let middle = (knee * end).sqrt().max(0.25 * end);
    let first = if knee > 0.0 { rule.integrate(0.0, knee, value) } else { 0.0 };
    first
        + if middle > knee {
            rule.integrate(knee, middle, value) + rule.integrate(middle, end, value)
        } else {
            rule.integrate(knee, end, value)
        }
}

/// (I(n, u)/I(n, 1))^(1/(n+1)): what the table of the normalisation holds, since it is smooth in both.
///
/// Range: [0, 1]. For large n it comes to 1 above the horizon and to √(1 − u²) below it, where the lobe is what its tail leaves
/// above the horizon; at u = −1 it is 0, and the lobe is black.
#[must_use]
pub fn root(n: f64, u: f64, inside: bool) -> f64 {
    let u = u.clamp(-1.0, 1.0);
    let m = if inside { n + 2.0 } else { n + 1.0 };
    if u > 0.0 {
        return libm::pow(integral(n, u, inside) * m / TAU, 1.0 / (n + 1.0)).min(1.0);
    }
    let s = ((1.0 - u) * (1.0 + u)).sqrt();
    s * libm::pow((cut(n, u, s, inside) * m / TAU).max(0.0), 1.0 / (n + 1.0))
}

/// Solid angle of the lobe along the normal, I(n, 1).
#[must_use]
pub fn along(n: f64, inside: bool) -> f64 {
    2.0 * PI / if inside { n + 2.0 } else { n + 1.0 }
}
