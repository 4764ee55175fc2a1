//! Digits that rounding inside a formula loses, seen from outside.

use super::{ALLOWED, STENCIL};

/// Digits of f64.
pub(super) const MOST_DIGITS: f64 = 15.95;

/// Distance of the inputs of the stencil, relative to the scale of the input: 64 rounding steps at 1.
const NEAR: f64 = 64.0 * f64::EPSILON;

/// Distances at which a slope is taken; the steepest counts, so that a narrow peak is not passed by.
const SLOPES: [f64; 5] = [1e-12, 1e-10, 1e-8, 1e-6, 1e-4];

/// Values below this are what is left of a vanished tail.
const NEGLIGIBLE: f64 = 1e-250;

/// Digits kept of `f` near `x`, whose rounding step is that of numbers of size `scale`. Nothing where it vanishes or has no value.
pub(super) fn digits(f: impl Fn(f64) -> Option<f64>, x: f64, scale: f64) -> Option<f64> {
    let near: Vec<f64> = (0..STENCIL).map(|i| f(x + NEAR * scale * i as f64)).collect::<Option<_>>()?;
    let value = near.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    if value < NEGLIGIBLE || !value.is_finite() {
        return None;
    }
    let bend = near.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).abs()).fold(0.0, f64::max);
    let mut slope = 0.0_f64;
    for step in SLOPES {
        if let (Some(a), Some(b)) = (f(x + step * scale), f(x + 2.0 * step * scale)) {
            slope = slope.max((b - a).abs() / step).max((a - near[0]).abs() / step);
        }
    }
    let condition = 1.0 + slope / value;
    let explained = ALLOWED * condition * 0.5 * f64::EPSILON;
    let noise = 0.5 * bend / value;
    if noise <= explained {
        return Some(MOST_DIGITS);
    }
    // relative to the noise that conditioning explains
    Some((MOST_DIGITS - libm::log10(noise / explained)).max(0.0))
}
