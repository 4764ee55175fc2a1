//! Prefiltered environments for all lobes of all maps: one set, filtered with cosine powers, looked up along C·i at a level that
//! the exponent tells.
//!
//! Level k is filtered with the power n₀ 4⁻ᵏ. A lobe between two powers is read as a mixture of the two levels beside it, of which D,
//! half the integral of the absolute difference of the unit lobes, is least.

use super::{EXPONENTS, exponent};
use serde::{Deserialize, Serialize};

/// Ratio of the powers of neighbouring levels.
pub const RATIO: f64 = 4.0;

/// Codes of the table, from 0 to 1.
pub const CODES: usize = 65;

/// The powers of the levels, the largest first.
#[must_use]
pub fn powers() -> Vec<f64> {
    let [lo, hi] = EXPONENTS;
    let mut out = vec![hi];
    while let Some(last) = out.last().copied()
        && last > lo
    {
        out.push((last / RATIO).max(lo));
    }
    out
}

/// Where an exponent is read, and how far that is from its own lobe.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rung {
    /// The exponent.
    pub exponent: f64,
    /// Level, with the part of the next one.
    pub level: f64,
    /// D.
    pub distance: f64,
}

/// The level of an exponent.
#[must_use]
pub fn level(n: f64) -> Rung {
    let powers = powers();
    let k = powers.iter().rposition(|p| *p >= n).unwrap_or(0);
    let Some(next) = powers.get(k + 1).filter(|_| powers[k] > n) else {
        return Rung { exponent: n, level: k as f64, distance: 0.0 };
    };
    let d = |w: f64| distance(n, [powers[k], *next], w);
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    let (mut a, mut b) = (0.0, 1.0);
    for _ in 0..30 {
        let (c, e) = (b - ratio * (b - a), a + ratio * (b - a));
        if d(c) < d(e) { b = e } else { a = c }
    }
    let w = 0.5 * (a + b);
    Rung { exponent: n, level: k as f64 + w, distance: d(w) }
}

/// D between the lobe of power n and the mixture of two: over x = cos^(n+1), in which the density of the first is 1; x = t⁴ takes the
/// growth of the broader power at x = 0 away.
fn distance(n: f64, powers: [f64; 2], w: f64) -> f64 {
    const STEPS: usize = 512;
    let density = |p: f64, log: f64| (p + 1.0) / (n + 1.0) * libm::exp(log * (p - n) / (n + 1.0));
    let difference = |i: usize| {
        let t = (i as f64 + 0.5) / STEPS as f64;
        let log = 4.0 * libm::log(t);
        let mixed = (1.0 - w) * density(powers[0], log) + w * density(powers[1], log);
        (1.0 - mixed).abs() * 4.0 * t * t * t
    };
    0.5 * (0..STEPS).map(difference).sum::<f64>() / STEPS as f64
}

/// The table over the codes of exponents.
#[must_use]
pub fn table() -> Vec<Rung> {
    (0..CODES).map(|i| level(exponent(i as f64 / (CODES - 1) as f64))).collect()
}
