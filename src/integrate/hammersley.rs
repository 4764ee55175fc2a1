//! Hammersley's point set, as most bakers of lookup tables use it.
//!
//! Here to reproduce and to measure their tables, not to make ours: N is fixed beforehand, there is one set and so no
//! error estimate, and its first point sits in the corner (0, 0).

use glam::DVec2;

/// The base-2 radical inverse: the bits of `i` mirrored at the binary point.
///
/// Range: [0, 1 − 2⁻³²], exact. Source: [Hammersley1960](crate::cite::HAMMERSLEY_1960).
#[must_use]
pub fn radical_inverse(i: u32) -> f64 {
    f64::from(i.reverse_bits()) / TWO_32
}

/// 2³².
const TWO_32: f64 = 4_294_967_296.0;

/// Point `i` of the set of `n` points: (i/n, radical inverse of i).
///
/// Source: [Hammersley1960](crate::cite::HAMMERSLEY_1960). Domain: i < n. Range: [0, 1)². Guard: n = 0 counts as 1.
#[must_use]
pub fn point(i: u32, n: u32) -> DVec2 {
    DVec2::new(f64::from(i) / f64::from(n.max(1)), radical_inverse(i))
}

/// All `n` points in order.
pub fn points(n: u32) -> impl Iterator<Item = DVec2> {
    (0..n).map(move |i| point(i, n))
}
