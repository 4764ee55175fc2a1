//! The stopping rule: raise the level of a chart until two successive levels agree.
//!
//! With I_j the sum of a panel at level j, the error of the finer sum is estimated as `|I_j - I_(j-1)| / gain`, `gain`
//! a property of the chart: where the error falls by a factor g from level to level,
//! `|I_j - I| <= |I_j - I_(j-1)| / (g - 1)`, and `gain` is kept well below the smallest g - 1 measured. The estimates
//! of the panels are added in magnitude, so that errors of opposite sign do not hide each other.
//! A floor for rounding is added: 2^-47 of the sum of magnitudes.

use super::chart::Chart;
use super::nodes::{MAX_PANELS, Nodes};
use super::view::View;

/// Most channels integrated in one pass.
pub const MAX_CHANNELS: usize = 8;

/// One number for each channel.
pub type Sums = [f64; MAX_CHANNELS];

/// Levels of the ladder. Successive ratios of about 1.4 double the cost.
pub const LEVELS: [f64; 9] = [2.0, 2.8, 4.0, 5.6, 8.0, 11.0, 15.0, 20.0, 27.0];

/// Values with their estimated errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The integral of each channel.
    pub value: Sums,
    /// Estimated absolute error of each channel.
    pub error: Sums,
    /// Number of integrand evaluations spent.
    pub evaluations: u32,
}

impl Estimate {
    /// A value known in closed form, with a few ulps of rounding as its error.
    #[must_use]
    pub fn exact(value: Sums) -> Estimate {
        let mut error = [0.0; MAX_CHANNELS];
        for (e, v) in error.iter_mut().zip(&value) {
            *e = v.abs() * ROUNDING;
        }
        Estimate { value, error, evaluations: 1 }
    }

    /// The largest error of the channels.
    #[must_use]
    pub fn largest_error(&self) -> f64 {
        self.error.iter().copied().fold(0.0, f64::max)
    }
}

/// Rounding floor relative to the magnitude summed: a few hundred additions.
pub const ROUNDING: f64 = 1.0 / (1u64 << 47) as f64;

/// First level for a tolerance: the one that its successor is expected to confirm at the median texel.
#[must_use]
pub fn first_level(tolerance: f64) -> usize {
    match tolerance {
        t if t >= 5e-3 => 0,
        t if t >= 1e-5 => 1,
        t if t >= 1e-7 => 2,
        t if t >= 1e-10 => 3,
        _ => 4,
    }
}

/// Integrates `channels` channels over the hemisphere. `add` adds the contribution of a batch to the sums.
///
/// The result may miss the tolerance: its error then says so, and the caller decides.
pub fn integrate(
    chart: &Chart,
    view: View,
    channels: usize,
    tolerance: f64,
    add: &mut dyn FnMut(&Nodes, &mut Sums),
) -> Estimate {
    let mut evaluations = 0u32;
    let mut sums_at = |level: f64| {
        let mut sums = [[0.0; MAX_CHANNELS]; MAX_PANELS];
        chart.visit(view, level, &mut |nodes| {
            evaluations = evaluations.saturating_add(u32::try_from(nodes.len).unwrap_or(u32::MAX));
            add(nodes, &mut sums[nodes.panel]);
        });
        sums
    };
    let start = first_level(tolerance);
    let mut coarse = sums_at(LEVELS[start]);
    let mut error = [0.0; MAX_CHANNELS];
    for (j, &level) in LEVELS.iter().enumerate().skip(start + 1) {
        let fine = sums_at(level);
        error = differences(&fine, &coarse, channels, chart.gain(j));
        coarse = fine;
        // NaN compares false and so never counts as done.
        if error[..channels].iter().all(|e| *e <= tolerance) {
            break;
        }
    }
    Estimate { value: total(&coarse), error, evaluations }
}

type Panels = [Sums; MAX_PANELS];

fn total(panels: &Panels) -> Sums {
    let mut sums = [0.0; MAX_CHANNELS];
    for panel in panels {
        for (s, p) in sums.iter_mut().zip(panel) {
            *s += p;
        }
    }
    sums
}

/// For each channel the sum over panels of the absolute differences, with a tenth of that of all channels (so that
/// one channel that agrees by chance does not pass), over the gain, plus the rounding floor.
fn differences(fine: &Panels, coarse: &Panels, channels: usize, gain: f64) -> Sums {
    let mut difference = [0.0; MAX_CHANNELS];
    let mut error = [0.0; MAX_CHANNELS];
    for c in 0..channels {
        let mut magnitude = 0.0;
        for (f, g) in fine.iter().zip(coarse) {
            difference[c] += (f[c] - g[c]).abs();
            magnitude += f[c].abs();
        }
        error[c] = magnitude * ROUNDING;
    }
    let shared = 0.1 * difference.iter().sum::<f64>();
    for (e, d) in error.iter_mut().zip(&difference).take(channels) {
        *e += (d + shared) / gain;
    }
    error
}
