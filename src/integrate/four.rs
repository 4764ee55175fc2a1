//! The stopping rule for four views at a time: each lane is judged as [`stop`](super::stop) judges a view alone, and all climb together.

use super::stop::{Estimate, MAX_CHANNELS, ROUNDING, Sums, Trust, share, unfinished};
use crate::math::lanes::{LANES, Lanes};
use std::ops::Range;

/// Panels of a chart that is integrated in lanes.
pub const PANELS: usize = 4;

/// The two sums of each panel at one level: `int f mu_i dwi`, and the same times `(1 - v)^5`.
pub type Panels = [[Lanes; 2]; PANELS];

/// A channel: its weights on the two sums.
pub type Channel = [Lanes; 2];

/// One channel of one lane of a panel.
fn part(panel: &[Lanes; 2], channel: &Channel, lane: usize) -> f64 {
    panel[0].0[lane] * channel[0].0[lane] + panel[1].0[lane] * channel[1].0[lane]
}

/// Differences of two levels and magnitudes of the finer one, of each channel of a lane.
fn apart(fine: &Panels, coarse: &Panels, channels: &[Channel], lane: usize) -> (Sums, Sums) {
    let (mut difference, mut magnitude) = ([0.0; MAX_CHANNELS], [0.0; MAX_CHANNELS]);
    for (c, channel) in channels.iter().enumerate() {
        for (f, g) in fine.iter().zip(coarse) {
            let value = part(f, channel, lane);
            difference[c] += (value - part(g, channel, lane)).abs();
            magnitude[c] += value.abs();
        }
    }
    share(&mut difference[..channels.len()]);
    (difference, magnitude)
}

/// Climbs through `levels` until every channel of every lane is within the tolerance; three levels at least.
///
/// `at` returns the sums of a level and the evaluations that a lane took. The result may miss the tolerance: its errors then say so.
pub fn climb(
    trust: Trust,
    levels: Range<usize>,
    channels: &[Channel],
    tolerance: f64,
    mut at: impl FnMut(usize) -> (Panels, u32),
) -> [Estimate; LANES] {
    let mut results = [Estimate::ZERO; LANES];
    for result in &mut results {
        result.error[..channels.len()].fill(f64::INFINITY);
    }
    let mut before = [[0.0; MAX_CHANNELS]; LANES];
    let mut coarse = [[Lanes::all(0.0); 2]; PANELS];
    let mut evaluations = 0u32;
    let first = levels.start;
    for j in levels {
        let (fine, more) = at(j);
        evaluations = evaluations.saturating_add(more);
        if j > first {
            for (lane, (result, before)) in results.iter_mut().zip(&mut before).enumerate() {
                let (difference, magnitude) = apart(&fine, &coarse, channels, lane);
                if j > first + 1 {
                    for c in 0..channels.len() {
                        result.error[c] = trust.error(j, before[c], difference[c]) + magnitude[c] * ROUNDING;
                    }
                }
                *before = difference;
            }
        }
        coarse = fine;
        // NaN compares false and so never counts as done
        let done = |result: &Estimate| result.error[..channels.len()].iter().all(|e| *e <= tolerance);
        if results.iter().all(done) {
            break;
        }
    }
    for (lane, result) in results.iter_mut().enumerate() {
        unfinished(&mut result.error[..channels.len()], tolerance);
        result.evaluations = evaluations;
        for (c, channel) in channels.iter().enumerate() {
            result.value[c] = coarse.iter().map(|panel| part(panel, channel, lane)).sum();
        }
    }
    results
}
