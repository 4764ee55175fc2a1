//! Lobes whose azimuth integrates in closed form round an axis of their own: powers of a cosine, fibres, and the plain hemisphere.

use crate::sweep::quad::{Setting, Sum, mark, sharp, sorted};
use std::f64::consts::{FRAC_PI_2, PI};

/// `cos^n` without the loss of digits that `1 - sin^2` has.
fn cos_pow(angle: f64, n: f64) -> f64 {
    if angle < 0.7 {
        let sin = angle.sin();
        (0.5 * n * (-sin * sin).ln_1p()).exp()
    } else {
        // also n = 0 at a right angle
        (n * angle.cos().max(f64::MIN_POSITIVE).ln()).exp()
    }
}

/// Weight of a cosine lobe.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Over {
    Nothing,
    Cosine,
}

/// `ln |C wo|` by the deviation of C from a reflection, and what its rounding comes to.
pub(crate) fn log_length(c: [f64; 3], wo: [f64; 3]) -> (f64, f64) {
    let excess = |k: usize| (c[k].abs() - 1.0) * (c[k].abs() + 1.0) * wo[k] * wo[k];
    let parts = [excess(0), excess(1), excess(2)];
    let sum: f64 = parts.iter().sum();
    let moved = parts.iter().map(|e| e.abs()).sum::<f64>() / (1.0 + sum);
    let log = 0.5 * sum.ln_1p();
    (log, 4e-16 * (moved + log.abs()))
}

/// `factor int max(0, v . wi)^n (mu_i or 1) dwi` over the upper hemisphere, v = C wo.
///
/// Round v, with a the angle to it and psi the azimuth from the meridian: `mu_i = cos a z + sin a s cos psi`. The horizon is at
/// `cos psi = -cot a z / s`, and the integral over psi is closed.
pub(crate) fn cosine(
    setting: &Setting,
    tolerance: f64,
    factor: f64,
    [c, wo]: [[f64; 3]; 2],
    n: f64,
    over: Over,
) -> Sum {
    let v: [f64; 3] = std::array::from_fn(|k| c[k] * wo[k]);
    let flat = v[0].hypot(v[1]);
    let length = flat.hypot(v[2]);
    if length <= 0.0 {
        return Sum::default();
    }
    let (z, s) = (v[2] / length, flat / length);
    let scale = factor * (n * log_length(c, wo).0).exp();
    // where the horizon begins, and the width of the lobe
    let meets = z.abs().atan2(s);
    let width = (2.0 / (n + 2.0)).sqrt();
    let breaks = sorted(
        mark(0.0),
        sharp(FRAC_PI_2),
        vec![sharp(meets), mark(width), mark(3.0 * width), mark(6.0 * width)],
    );
    let mut sum = setting.pieces(&breaks, tolerance / scale.max(1e-300), &mut |at, _, _| {
        let (sin, cos) = at.x.sin_cos();
        let power = cos_pow(at.x, n) * sin;
        // cos psi of the horizon
        let end = if sin * s > 0.0 { -(cos * z) / (sin * s) } else { -z * f64::INFINITY };
        let psi = end.clamp(-1.0, 1.0).acos();
        match over {
            Over::Cosine => power * 2.0 * psi,
            Over::Nothing => power * 2.0 * (psi * cos * z + sin * s * psi.sin()),
        }
    });
    sum.value *= scale;
    sum.error *= scale;
    sum
}

/// Banks: `int (kd s_i^p + ks max(0, cos(b + b_o))^q) mu_i dwi`, b the elevation over the plane across the fibre.
///
/// wi = (sin b, cos b cos x, cos b sin x): `mu_i dwi = cos^2 b sin x db dx`, whose integral over x is 2.
pub(crate) fn banks(setting: &Setting, tolerance: f64, along: f64, [kd, ks, p, q]: [f64; 4]) -> Sum {
    let mirror = -along.asin();
    let (wp, wq) = ((2.0 / (p + 2.0)).sqrt(), (2.0 / (q + 2.0)).sqrt());
    let mut breaks = vec![0.0, mirror];
    for k in [1.0, 3.0, 6.0] {
        breaks.extend([k * wp, -k * wp, mirror + k * wq, mirror - k * wq]);
    }
    breaks.extend([mirror + FRAC_PI_2, mirror - FRAC_PI_2]);
    let breaks = breaks.into_iter().map(mark).collect();
    let breaks = sorted(sharp(-FRAC_PI_2), sharp(FRAC_PI_2), breaks);
    setting.pieces(&breaks, tolerance, &mut |at, _, _| {
        let b = at.x;
        let off = (b - mirror).abs();
        let gloss = if off < FRAC_PI_2 { cos_pow(off, q) } else { 0.0 };
        2.0 * b.cos() * b.cos() * (kd * cos_pow(b.abs(), p) + ks * gloss)
    })
}

/// `int f(mu_i, sin_i, cos phi, sin phi) mu_i dwi` in plain spherical coordinates, f even in phi, breaks in mu_i given.
pub(crate) fn hemisphere(
    setting: &Setting,
    tolerance: f64,
    breaks: &[f64],
    f: &(dyn Fn(f64, f64, f64, f64) -> f64 + Sync),
) -> Sum {
    let azimuths = sorted(mark(0.0), mark(PI), vec![sharp(FRAC_PI_2)]);
    let heights = sorted(sharp(0.0), sharp(1.0), breaks.iter().map(|b| sharp(*b)).collect());
    let mut sum = setting.pieces(&azimuths, tolerance, &mut |at, tolerance, _| {
        let (mut sin, mut cos) = at.x.sin_cos();
        // near the quarter the distance is exact
        if at.x < FRAC_PI_2 && at.to < 0.1 {
            (sin, cos) = (at.to.cos(), at.to.sin());
        } else if at.x > FRAC_PI_2 && at.from < 0.1 {
            (sin, cos) = (at.from.cos(), -at.from.sin());
        }
        setting
            .pieces(&heights, tolerance, &mut |mu, _, i| {
                let below = if i + 2 == heights.len() { mu.to } else { 1.0 - mu.x };
                let s = (below * (1.0 + mu.x)).sqrt();
                mu.x * f(mu.x, s, cos, sin)
            })
            .value
    });
    sum.value *= 2.0;
    sum.error *= 2.0;
    sum
}
