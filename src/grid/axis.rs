//! One axis of a table: a value of the recipe, shared by baker, reader, metadata and reports.
//!
//! From texel to value: index `i` -> axis coordinate `x` in [0, 1] -> warped `w` -> value.
//!
//! * centre: `x = (i + offset + 1/2) / len`; endpoint: `x = (i + offset) / (len - 1)`; clamped to [0, 1].
//! * descending: `x -> 1 - x`, so that index 0 holds the high end of the domain.
//! * `value = lo + (hi - lo) inverse_warp(x)`, then clamped to `clamp` if one is given.

use super::expression::{Expression, PlainText};
use super::quantity::{Quantity, by_id};
use super::scalar::{Scalar, Slope};
use super::warp::Warp;
use crate::math::figures::exact;
use serde::{Deserialize, Serialize};

/// Where in its cell a texel samples the axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Texel {
    /// Texel `i` sits at `(i + 1/2) / len`: the texture coordinate is the warped value itself.
    Center,
    /// Texel 0 and `len - 1` sit on the ends: the shader remaps by `(x (len - 1) + 1/2) / len`.
    Endpoint,
}

/// Which end of the domain texel 0 holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Direction {
    /// Texel 0 holds the low end.
    Ascending,
    /// Texel 0 holds the high end.
    Descending,
}

/// One axis of a table. See the module for the maps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// What it measures.
    #[serde(rename = "id", with = "by_id")]
    pub quantity: &'static Quantity,
    /// First and last value.
    pub domain: [f64; 2],
    /// Spread of the values.
    pub warp: Warp,
    /// Texel convention.
    pub texel: Texel,
    /// Which end comes first.
    pub direction: Direction,
    /// Shift in texels (0 for everyone but readers with an off-by-one to reproduce).
    pub offset: f64,
    /// Values are clamped to this interval before they are used, as some generators do at singular ends.
    pub clamp: Option<[f64; 2]>,
    /// Number of texels.
    pub len: usize,
}

/// What can be wrong with an axis.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AxisError {
    /// The domain is empty, not finite, or outside that of the quantity.
    #[error(
        "axis {id}: domain [{}, {}] must be increasing and inside [{}, {}], or clamped to it",
        exact(.lo),
        exact(.hi),
        exact(.min),
        exact(.max)
    )]
    Domain {
        /// Axis id.
        id: &'static str,
        /// Given low end.
        lo: f64,
        /// Given high end.
        hi: f64,
        /// Allowed low end.
        min: f64,
        /// Allowed high end.
        max: f64,
    },
    /// Too few or too many texels.
    #[error("axis {id}: length {len} outside [{min}, 16384]")]
    Length {
        /// Axis id.
        id: &'static str,
        /// Given length.
        len: usize,
        /// Least length for this texel convention.
        min: usize,
    },
    /// A bad number in a warp.
    #[error("axis {id}: warp {fault}")]
    Warp {
        /// Axis id.
        id: &'static str,
        /// What is wrong.
        fault: String,
    },
    /// The clamp interval is not inside the domain.
    #[error("axis {id}: clamp [{}, {}] must be increasing and inside the domain", exact(.lo), exact(.hi))]
    Clamp {
        /// Axis id.
        id: &'static str,
        /// Given low end.
        lo: f64,
        /// Given high end.
        hi: f64,
    },
    /// The offset is not a small finite number.
    #[error("axis {id}: offset {} texels outside [-2, 2]", exact(.offset))]
    Offset {
        /// Axis id.
        id: &'static str,
        /// Given offset.
        offset: f64,
    },
}

impl Axis {
    /// A linear ascending axis over the whole domain of the quantity.
    #[must_use]
    pub fn new(quantity: &'static Quantity, len: usize, texel: Texel) -> Axis {
        Axis {
            quantity,
            domain: quantity.domain,
            warp: Warp::Linear,
            texel,
            direction: Direction::Ascending,
            offset: 0.0,
            clamp: None,
            len,
        }
    }

    /// The same axis with another warp.
    #[must_use]
    pub fn warped(mut self, warp: Warp) -> Axis {
        self.warp = warp;
        self
    }

    /// The same axis over another domain.
    #[must_use]
    pub fn over(mut self, domain: [f64; 2]) -> Axis {
        self.domain = domain;
        self
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`AxisError`] names the first field that is out of its range.
    pub fn check(&self) -> Result<(), AxisError> {
        let id = self.quantity.id;
        let [lo, hi] = self.domain;
        let [min, max] = self.quantity.domain;
        // values that are clamped before use may be spread over more than the quantity has
        let inside = |[lo, hi]: [f64; 2]| lo >= min && hi <= max;
        let held = inside(self.domain) || self.clamp.is_some_and(inside);
        if !(lo.is_finite() && hi.is_finite() && lo < hi && held) {
            return Err(AxisError::Domain { id, lo, hi, min, max });
        }
        let shortest = if self.texel == Texel::Endpoint { 2 } else { 1 };
        if self.len < shortest || self.len > 16384 {
            return Err(AxisError::Length { id, len: self.len, min: shortest });
        }
        if let Some(fault) = self.warp.fault() {
            return Err(AxisError::Warp { id, fault });
        }
        if let Some([a, b]) = self.clamp
            && !(a <= b && a >= lo && b <= hi)
        {
            return Err(AxisError::Clamp { id, lo: a, hi: b });
        }
        if self.offset.is_nan() || self.offset.abs() > 2.0 {
            return Err(AxisError::Offset { id, offset: self.offset });
        }
        Ok(())
    }

    /// Axis coordinate in [0, 1] of a (fractional) index.
    #[must_use]
    pub fn coordinate(&self, index: f64) -> f64 {
        let x = match self.texel {
            Texel::Center => (index + self.offset + 0.5) / count(self.len),
            Texel::Endpoint => (index + self.offset) / count(self.len - 1),
        };
        x.clamp(0.0, 1.0)
    }

    /// Value at an axis coordinate; `coupled` as in [`Warp::forward`].
    #[must_use]
    pub fn value_at(&self, x: f64, coupled: f64) -> f64 {
        let x = if self.direction == Direction::Descending { 1.0 - x } else { x };
        let [lo, hi] = self.domain;
        let v = lo + (hi - lo) * self.warp.inverse(x, coupled);
        let [lo, hi] = self.clamp.unwrap_or(self.domain);
        v.clamp(lo, hi)
    }

    /// Value at a texel.
    #[must_use]
    pub fn value(&self, index: usize, coupled: f64) -> f64 {
        self.value_at(self.coordinate(count(index)), coupled)
    }

    /// Axis coordinate in [0, 1] of a value, clamped to the domain: the inverse of [`Axis::value_at`].
    #[must_use]
    pub fn coordinate_of<S: Scalar>(&self, value: S, coupled: S) -> S {
        let [lo, hi] = self.domain;
        let v = value.minus(S::number(lo)).over(S::number(hi - lo));
        self.spread(v.at_least(0.0).at_most(1.0), coupled)
    }

    /// Axis coordinate of a value over the domain.
    fn spread<S: Scalar>(&self, v: S, coupled: S) -> S {
        let x = self.warp.forward(v, coupled);
        if self.direction == Direction::Descending { S::number(1.0).minus(x) } else { x }
    }

    /// Fractional index of an axis coordinate; not clamped to the texels.
    #[must_use]
    pub fn index_at<S: Scalar>(&self, x: S) -> S {
        match self.texel {
            Texel::Center => {
                x.times(S::number(count(self.len))).minus(S::number(0.5)).minus(S::number(self.offset))
            }
            Texel::Endpoint => x.times(S::number(count(self.len - 1))).minus(S::number(self.offset)),
        }
    }

    /// Fractional index at which a reader finds `value`: the inverse of [`Axis::value`], not clamped to the texels.
    #[must_use]
    pub fn index(&self, value: f64, coupled: f64) -> f64 {
        self.index_at(self.coordinate_of(value, coupled))
    }

    /// Texels per unit of the quantity at a value: the derivative of [`Axis::index`].
    #[must_use]
    pub fn slope(&self, value: f64, coupled: f64) -> f64 {
        self.index_at(self.coordinate_of(Slope { value, slope: 1.0 }, Slope::number(coupled))).slope
    }

    /// Operations of the texture coordinate, as [`Axis::coordinate_formula`] has it.
    #[must_use]
    pub fn operations(&self) -> usize {
        self.place().operations()
    }

    /// The texture coordinate that a shader computes from a value of the domain, as a formula in the ids of this quantity and of the
    /// base quantity of a coupling; see [`PlainText`]. A reader clamps it to [0, 1].
    #[must_use]
    pub fn coordinate_formula(&self) -> String {
        self.place().write(&PlainText, true)
    }

    fn place(&self) -> Expression {
        let [lo, hi] = self.domain;
        let number = Expression::number;
        let v = Expression::name(self.quantity.id).minus(number(lo)).over(number(hi - lo));
        let coupled = Expression::name(self.warp.couples_to().unwrap_or_default());
        let x = self.spread(v, coupled);
        let len = count(self.len);
        match self.texel {
            Texel::Center => x.minus(number(self.offset / len)),
            Texel::Endpoint => x.times(number(len - 1.0)).plus(number(0.5 - self.offset)).over(number(len)),
        }
    }
}

/// A count as f64; tables are far below 2^53 texels.
#[must_use]
pub fn count(n: usize) -> f64 {
    n as f64
}
