//! A baked table: grid, channels, a value and an error estimate for each channel of each texel.

use super::layout::{Grid, Point};
use super::lookup;
use crate::math::figures::short;
use serde::{Deserialize, Serialize};

/// One channel and what it means.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Channel {
    /// Name in files and reports: `dfg.scale`.
    pub id: String,
    /// What the number is, as a formula.
    pub meaning: String,
    /// The values that it can take; stored formats with a fixed range encode this interval.
    pub range: [f64; 2],
    /// What it is to a law, in words; empty where that is not known.
    #[serde(skip_serializing_if = "String::is_empty", default)]
    pub role: String,
}

/// A baked table. `values` and `errors` are `[texel][channel]`, channel fastest, axis 0 next.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// Where the texels are.
    pub grid: Grid,
    /// What they hold.
    pub channels: Vec<Channel>,
    /// The integrals, before any rounding to a stored format.
    pub values: Vec<f64>,
    /// Estimated integration error of each value (absolute).
    pub errors: Vec<f64>,
    /// Integrand evaluations of each texel.
    pub evaluations: Vec<u32>,
}

/// The largest of something, and where.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// Channel id.
    pub channel: String,
    /// Where: axis id and value, in the order of the axes.
    pub at: Vec<(String, f64)>,
}

impl Table {
    /// Channels of one texel.
    #[must_use]
    pub fn at(&self, texel: usize) -> &[f64] {
        let n = self.channels.len();
        &self.values[texel * n..(texel + 1) * n]
    }

    /// Reads between texels; see [`lookup::read`].
    pub fn read(&self, point: &Point, out: &mut [f64]) {
        lookup::read(&self.grid, &self.values, point, out);
    }

    /// Total integrand evaluations.
    #[must_use]
    pub fn total_evaluations(&self) -> u64 {
        self.evaluations.iter().map(|&n| u64::from(n)).sum()
    }

    /// The largest estimated integration error and where it lies.
    #[must_use]
    pub fn largest_error(&self) -> Extreme {
        let n = self.channels.len();
        let mut worst = 0;
        for (i, &e) in self.errors.iter().enumerate() {
            if e > self.errors[worst] {
                worst = i;
            }
        }
        Extreme {
            value: self.errors.get(worst).copied().unwrap_or(0.0),
            channel: self.channels[worst % n].id.clone(),
            at: self.coordinates(worst / n),
        }
    }

    /// Axis ids and values (in the axis' own quantity) of a texel.
    #[must_use]
    pub fn coordinates(&self, texel: usize) -> Vec<(String, f64)> {
        named(&self.grid, &self.grid.texel(texel))
    }
}

/// Axis ids and values (in the axis' own quantity) of a point.
#[must_use]
pub fn named(grid: &Grid, point: &Point) -> Vec<(String, f64)> {
    grid.axes()
        .iter()
        .zip(point.values())
        .map(|(axis, &v)| (axis.quantity.id.to_owned(), axis.quantity.from_base(v)))
        .collect()
}

/// Coordinates as text: `mu = 0.25, roughness = 0.5`.
#[must_use]
pub fn place(at: &[(String, f64)]) -> String {
    at.iter().map(|(id, v)| format!("{id} = {}", short(v))).collect::<Vec<_>>().join(", ")
}
