//! The stopping rule: raise the level of a chart until two successive levels agree.
//!
//! With I_j the sum at level j, the error of the finer sum is estimated as `|I_j - I_(j-1)| / gain`, `gain >= 1` a
//! property of the chart: where the error falls by a factor g from level to level,
//! `|I_j - I| <= |I_j - I_(j-1)| / (g - 1)`, and `gain` is kept well below the smallest g - 1 measured.
//! A floor for rounding is added: 2^-50 of the largest sum of magnitudes.

use super::chart::Chart;
use super::nodes::Nodes;

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

/// Rounding floor relative to the magnitude summed.
pub const ROUNDING: f64 = 1.0 / (1u64 << 50) as f64;

/// First level for a tolerance: the one whose successor is expected to confirm it.
#[must_use]
pub fn first_level(tolerance: f64) -> usize {
    match tolerance {
        t if t >= 1e-5 => 0,
        t if t >= 1e-7 => 1,
        t if t >= 1e-9 => 2,
        _ => 3,
    }
}

/// Integrates `channels` channels over the hemisphere. `add` adds the contribution of a batch to the sums.
///
/// The result may miss the tolerance: its error then says so, and the caller decides.
pub fn integrate(
    chart: &Chart,
    mu_o: f64,
    channels: usize,
    tolerance: f64,
    add: &mut dyn FnMut(&Nodes, &mut Sums),
) -> Estimate {
    let mut evaluations = 0u32;
    let mut sum_at = |level: f64| {
        let mut sums = [0.0; MAX_CHANNELS];
        chart.visit(mu_o, level, &mut |nodes| {
            evaluations = evaluations.saturating_add(u32::try_from(nodes.len).unwrap_or(u32::MAX));
            add(nodes, &mut sums);
        });
        sums
    };
    let start = first_level(tolerance);
    let mut coarse = sum_at(LEVELS[start]);
    let mut error = [0.0; MAX_CHANNELS];
    for &level in &LEVELS[start + 1..] {
        let fine = sum_at(level);
        let mut done = true;
        for c in 0..channels {
            let scale = fine[c].abs().max(coarse[c].abs()).max(f64::MIN_POSITIVE);
            error[c] = (fine[c] - coarse[c]).abs() / chart.gain() + scale * ROUNDING;
            // NaN compares false and so never counts as done.
            done &= error[c] <= tolerance;
        }
        coarse = fine;
        if done {
            break;
        }
    }
    Estimate { value: coarse, error, evaluations }
}
