//! BC4, and half of BC5: 4 x 4 texels of one channel in 8 bytes, two endpoints of 8 bits and an index of 3 bits a texel.
//!
//! If the first endpoint is the larger one, a texel is one of eight evenly spaced numbers from one to the other. Otherwise
//! it is one of six, or the low or the high end of the range. Numbers are told in parts of 8925 = 255 * 7 * 5, in which all
//! of them are whole.
//!
//! Every pair of endpoints is tried, in both modes: no block has a smaller largest error, and among those with the same
//! one none a smaller sum of squares.
//!
//! Source: Khronos Data Format Specification 1.3, section 18 (RGTC). Decoding is exact, as the formulas are; a GPU may
//! interpolate in fewer bits.

use super::bc6h::TEXELS;

/// The code of the high end of the range.
pub(in super::super) const TOP: f64 = 8925.0;
/// The finest step, in codes: of a ramp between endpoints that are neighbours.
pub(in super::super) const STEP: f64 = 5.0;

/// Codes by index.
fn palette([a, b]: [u8; 2]) -> [f64; 8] {
    let [x, y] = [f64::from(a), f64::from(b)];
    let seventh = |i: f64| 5.0 * ((7.0 - i) * x + i * y);
    let fifth = |i: f64| 7.0 * ((5.0 - i) * x + i * y);
    if a > b {
        [0.0, 7.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0].map(seventh)
    } else {
        let [p, q, r, s, t, u] = [0.0, 5.0, 1.0, 2.0, 3.0, 4.0].map(fifth);
        [p, q, r, s, t, u, 0.0, TOP]
    }
}

/// The codes of a block.
pub(super) fn decode(bytes: [u8; 8]) -> [f64; TEXELS] {
    let palette = palette([bytes[0], bytes[1]]);
    let bits = u64::from_le_bytes(bytes) >> 16;
    let mut codes = [0.0; TEXELS];
    for (i, code) in codes.iter_mut().enumerate() {
        *code = palette[usize::try_from(bits >> (3 * i) & 7).unwrap_or(0)];
    }
    codes
}

/// Largest error and sum of squares.
type Errors = (f64, f64);

/// The block for these codes, real numbers in 0 ..= 8925.
pub(super) fn encode(codes: &[f64; TEXELS]) -> [u8; 8] {
    // extremes first: most pairs of endpoints fail there
    let mut sorted = *codes;
    sorted.sort_by(f64::total_cmp);
    let mut order = [0.0; TEXELS];
    for (i, slot) in order.iter_mut().enumerate() {
        *slot = if i % 2 == 0 { sorted[i / 2] } else { sorted[TEXELS - 1 - i / 2] };
    }
    let mut best = ((f64::INFINITY, f64::INFINITY), [0, 0]);
    let first = outside(sorted[0], sorted[TEXELS - 1]);
    if let Some(errors) = eight(&order, first, best.0) {
        best = (errors, [first[1], first[0]]);
    }
    for low in 0..=255u8 {
        if f64::from(low) * 35.0 > sorted[0] + best.0.0 {
            break;
        }
        for high in (low..=255).rev().take_while(|high| *high > low) {
            if f64::from(high) * 35.0 < sorted[TEXELS - 1] - best.0.0 {
                break;
            }
            if let Some(errors) = eight(&order, [low, high], best.0) {
                best = (errors, [high, low]);
            }
        }
    }
    six_of_all(&order, &mut best);
    with_indices(codes, best.1)
}

/// Tries all ramps of six numbers.
fn six_of_all(order: &[f64; TEXELS], best: &mut (Errors, [u8; 2])) {
    // what the ends of the range do not serve must lie in the ramp
    let left = || order.iter().copied().filter(|v| v.min(TOP - v) > best.0.0);
    let (least, most) = (left().fold(TOP, f64::min), left().fold(0.0, f64::max));
    for low in 0..=255u8 {
        if f64::from(low) * 35.0 > least + best.0.0 {
            break;
        }
        for high in (low..=255).rev() {
            if f64::from(high) * 35.0 < most - best.0.0 {
                break;
            }
            if let Some(errors) = six(order, [low, high], best.0) {
                *best = (errors, [low, high]);
            }
        }
    }
}

/// The narrowest pair of different endpoints round two codes.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
fn outside(low: f64, high: f64) -> [u8; 2] {
    let [a, b] = [(low / 35.0).floor() as u8, (high / 35.0).ceil() as u8];
    match (a, b) {
        (255, _) => [254, 255],
        (a, b) if a >= b => [a, a + 1],
        _ => [a, b],
    }
}

/// Errors of the ramp of eight, if they are smaller than the limit.
fn eight(order: &[f64; TEXELS], [low, high]: [u8; 2], limit: Errors) -> Option<Errors> {
    let (start, step) = (35.0 * f64::from(low), 5.0 * f64::from(high - low));
    let inverse = 1.0 / step;
    smaller(order, limit, |v| {
        let i = ((v - start) * inverse).round_ties_even().clamp(0.0, 7.0);
        (start + i * step - v).abs()
    })
}

/// Errors of the ramp of six with the ends of the range, if they are smaller than the limit.
fn six(order: &[f64; TEXELS], [low, high]: [u8; 2], limit: Errors) -> Option<Errors> {
    let (start, step) = (35.0 * f64::from(low), 7.0 * f64::from(high - low));
    let inverse = if high > low { 1.0 / step } else { 0.0 };
    smaller(order, limit, |v| {
        let i = ((v - start) * inverse).round_ties_even().clamp(0.0, 5.0);
        (start + i * step - v).abs().min(v).min(TOP - v)
    })
}

fn smaller(order: &[f64; TEXELS], limit: Errors, error: impl Fn(f64) -> f64) -> Option<Errors> {
    let (mut largest, mut squares) = (0.0, 0.0);
    for &v in order {
        let e = error(v);
        if e > limit.0 {
            return None;
        }
        largest = if e > largest { e } else { largest };
        squares += e * e;
    }
    (largest < limit.0 || squares < limit.1).then_some((largest, squares))
}

/// The bytes of a pair of endpoints: each texel takes the nearest number.
fn with_indices(codes: &[f64; TEXELS], ends: [u8; 2]) -> [u8; 8] {
    let palette = palette(ends);
    let mut bits = u64::from(ends[0]) | u64::from(ends[1]) << 8;
    for (texel, &v) in codes.iter().enumerate() {
        let (mut nearest, mut index) = (f64::INFINITY, 0u64);
        for (i, p) in (0..).zip(&palette) {
            let e = (p - v).abs();
            if e < nearest {
                (nearest, index) = (e, i);
            }
        }
        bits |= index << (16 + 3 * texel);
    }
    bits.to_le_bytes()
}
