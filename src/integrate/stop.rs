//! The one stopping rule: raise the level of a rule until three levels show that it has converged.
//!
//! With `d_j = sum over panels |I_j - I_(j-1)|` (in magnitude, so that errors of opposite sign do not hide each other), the error
//! of the finest sum is estimated from the last two differences,
//!
//! ```text
//! e_j = max(d_j, memory d_(j-1)) / gain_j + rounding + what the integrand itself may be off by.
//! ```
//! One difference may be small by chance: two low orders that agree prove nothing. `memory` is the decay that a level is known
//! to bring at least, so that a difference which fell faster than that counts for no more. `gain` is how much smaller than that the
//! error is. Both belong to the coordinates of a rule: they are measured by a seeded sweep and recorded beside it as a [`Trust`].

use super::nodes::MAX_PANELS;

/// Most channels integrated in one pass.
pub const MAX_CHANNELS: usize = 8;

/// One number for each channel.
pub type Sums = [f64; MAX_CHANNELS];

/// Rounding floor relative to the magnitude summed: a few hundred additions.
pub const ROUNDING: f64 = 1.0 / (1u64 << 47) as f64;

/// What the differences count for at the last level if they still miss the tolerance: gains are measured where a rule converges.
const UNFINISHED: f64 = 2.0;

/// Share of the differences of all channels that is added to each, so that one that agrees by chance does not pass.
const SHARED: f64 = 0.1;

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
    /// Nothing, without error: what sums of estimates start from.
    pub const ZERO: Estimate =
        Estimate { value: [0.0; MAX_CHANNELS], error: [0.0; MAX_CHANNELS], evaluations: 0 };

    /// A value known in closed form, with a few ulps of rounding as its error.
    #[must_use]
    pub fn exact(value: Sums) -> Estimate {
        let mut error = [0.0; MAX_CHANNELS];
        for (e, v) in error.iter_mut().zip(&value) {
            *e = v.abs() * ROUNDING;
        }
        Estimate { value, error, evaluations: 1 }
    }

    /// The same of one channel.
    #[must_use]
    pub fn exact_one(value: f64) -> Estimate {
        let mut all = [0.0; MAX_CHANNELS];
        all[0] = value;
        Estimate::exact(all)
    }

    /// Adds `weight` times another estimate: values and errors add.
    pub fn add(&mut self, weight: f64, other: &Estimate) {
        for (t, v) in self.value.iter_mut().zip(&other.value) {
            *t += weight * v;
        }
        for (t, v) in self.error.iter_mut().zip(&other.error) {
            *t += weight.abs() * v;
        }
        self.evaluations = self.evaluations.saturating_add(other.evaluations);
    }

    /// The largest error of the channels.
    #[must_use]
    pub fn largest_error(&self) -> f64 {
        self.error.iter().copied().fold(0.0, f64::max)
    }
}

/// How far the differences of a rule can be trusted; measured by the sweep of `tests/honesty`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trust {
    /// How much smaller than the differences the error is, for the step to level `j`; the last entry holds for all later steps.
    pub gain: &'static [f64],
    /// Share of the difference before last that counts as one of the last, for the step to level `j` in the same way: coarse levels
    /// agree by chance, fine ones have converged.
    pub memory: &'static [f64],
}

impl Trust {
    /// The error left after two differences of levels, the last of which reached level `j`.
    #[must_use]
    pub fn error(&self, j: usize, before: f64, now: f64) -> f64 {
        let at = |table: &[f64]| table[j.clamp(1, table.len()) - 1];
        let gain = at(self.gain);
        // NaN must stay NaN: `max` would drop it
        let remembered = at(self.memory) * before;
        (if now >= remembered { now } else { remembered + 0.0 * now }) / gain
    }
}

/// What a rule gives at one level.
#[derive(Debug, Clone)]
pub struct Level {
    /// Sums of the panels, those in use first.
    pub panels: [Sums; MAX_PANELS],
    /// Panels in use.
    pub used: usize,
    /// What the integrand itself may be off by: errors of inner integrals, of curves and tables.
    pub inner: Sums,
    /// Evaluations spent.
    pub evaluations: u32,
}

impl Level {
    fn empty() -> Level {
        Level {
            panels: [[0.0; MAX_CHANNELS]; MAX_PANELS],
            used: 0,
            inner: [0.0; MAX_CHANNELS],
            evaluations: 0,
        }
    }

    fn clear(&mut self) {
        self.panels[..self.used].fill([0.0; MAX_CHANNELS]);
        (self.used, self.inner) = (0, [0.0; MAX_CHANNELS]);
    }

    /// The sums of a panel, which is in use from now on.
    pub fn panel(&mut self, panel: usize) -> &mut Sums {
        self.used = self.used.max(panel + 1);
        &mut self.panels[panel]
    }

    /// Counts evaluations.
    pub fn count(&mut self, evaluations: usize) {
        self.evaluations = self.evaluations.saturating_add(u32::try_from(evaluations).unwrap_or(u32::MAX));
    }

    fn total(&self) -> Sums {
        let mut sums = [0.0; MAX_CHANNELS];
        for panel in &self.panels[..self.used] {
            for (s, p) in sums.iter_mut().zip(panel) {
                *s += p;
            }
        }
        sums
    }

    /// Differences to another level, and magnitudes, of each channel.
    fn difference(&self, other: &Level, channels: usize) -> (Sums, Sums) {
        let (mut difference, mut magnitude) = ([0.0; MAX_CHANNELS], [0.0; MAX_CHANNELS]);
        let used = self.used.max(other.used);
        for (f, g) in self.panels[..used].iter().zip(&other.panels) {
            for c in 0..channels {
                difference[c] += (f[c] - g[c]).abs();
                magnitude[c] += f[c].abs();
            }
        }
        share(&mut difference[..channels]);
        (difference, magnitude)
    }
}

/// Adds to the difference of each channel its share of all of them.
pub(super) fn share(difference: &mut [f64]) {
    let shared = SHARED * difference.iter().sum::<f64>();
    difference.iter_mut().for_each(|d| *d += shared);
}

/// Raises the errors of the channels that miss the tolerance after the last level.
pub(super) fn unfinished(error: &mut [f64], tolerance: f64) {
    error.iter_mut().filter(|e| **e > tolerance).for_each(|e| *e *= UNFINISHED);
}

/// Climbs through `levels` (numbers of steps, passed to `at`) until every channel is within the tolerance, absolute; three levels at least.
///
/// `at` fills a cleared [`Level`]. The result may miss the tolerance: its error then says so, and the caller decides.
///
/// # Errors
/// Those of `at`.
pub fn climb<E>(
    trust: Trust,
    levels: std::ops::Range<usize>,
    channels: usize,
    tolerance: f64,
    mut at: impl FnMut(usize, &mut Level) -> Result<(), E>,
) -> Result<Estimate, E> {
    let (mut coarse, mut fine) = (Level::empty(), Level::empty());
    let mut before: Option<Sums> = None;
    let mut error = [f64::INFINITY; MAX_CHANNELS];
    error[channels..].fill(0.0);
    let first = levels.start;
    for j in levels {
        fine.clear();
        at(j, &mut fine)?;
        if j > first {
            let (difference, magnitude) = fine.difference(&coarse, channels);
            if let Some(before) = &before {
                for c in 0..channels {
                    error[c] =
                        trust.error(j, before[c], difference[c]) + magnitude[c] * ROUNDING + fine.inner[c];
                }
            }
            before = Some(difference);
        }
        std::mem::swap(&mut coarse, &mut fine);
        // NaN compares false and so never counts as done
        if error[..channels].iter().all(|e| *e <= tolerance) {
            break;
        }
    }
    unfinished(&mut error[..channels], tolerance);
    let evaluations = coarse.evaluations.saturating_add(fine.evaluations);
    Ok(Estimate { value: coarse.total(), error, evaluations })
}

/// [`climb`] of a rule that cannot fail.
pub fn climb_sure(
    trust: Trust,
    levels: std::ops::Range<usize>,
    channels: usize,
    tolerance: f64,
    mut at: impl FnMut(usize, &mut Level),
) -> Estimate {
    let sure = climb::<std::convert::Infallible>(trust, levels, channels, tolerance, |j, level| {
        at(j, level);
        Ok(())
    });
    match sure {
        Ok(estimate) => estimate,
        Err(never) => match never {},
    }
}
