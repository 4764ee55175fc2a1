//! The grid of a table: its axes, fastest first, with their couplings resolved.

use super::axis::{Axis, AxisError, count};

/// Most axes a table can have.
pub const MAX_AXES: usize = 4;

/// Entry n of the product of lists, one an axis, the first fastest; axes without a list hold the default.
///
/// Every list has an entry.
#[must_use]
pub fn combination<T: Copy + Default>(lists: &[Vec<T>], mut n: usize) -> [T; MAX_AXES] {
    let mut chosen = [T::default(); MAX_AXES];
    for (chosen, list) in chosen.iter_mut().zip(lists) {
        *chosen = list[n % list.len()];
        n /= list.len();
    }
    chosen
}

/// Axes of a table, fastest first: axis 0 is the texture's x, axis 1 its y, axis 2 its z.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    axes: Vec<Axis>,
    /// Evaluation order: axes that couple to another one come after it.
    order: Vec<usize>,
    /// For each axis the index of the axis that it couples to.
    coupled: Vec<Option<usize>>,
}

/// What can be wrong with a set of axes.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GridError {
    /// One axis is wrong in itself.
    #[error(transparent)]
    Axis(#[from] AxisError),
    /// None, or too many.
    #[error("a table has 1 to {MAX_AXES} axes, got {0}")]
    Count(usize),
    /// Two axes measure the same base quantity.
    #[error("two axes measure {0}")]
    Twice(&'static str),
    /// A warp couples to a quantity that is on no other axis.
    #[error("axis {id}: its warp couples to `{to}`, which is on no other axis")]
    Coupling {
        /// Axis id.
        id: &'static str,
        /// The missing quantity.
        to: String,
    },
    /// Warps that couple to each other.
    #[error("axis {0}: its warp couples to an axis that itself couples to another")]
    Chain(&'static str),
    /// More texels than one table may have.
    #[error("{0} texels in one table; at most 2^26 are allowed")]
    Size(usize),
}

/// Base values at one point of a grid, in the order of its axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    values: [f64; MAX_AXES],
    len: usize,
}

impl Point {
    /// Base values, one an axis.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values[..self.len]
    }
}

impl Grid {
    /// Checks the axes and resolves their couplings.
    ///
    /// # Errors
    /// [`GridError`] names the axis at fault.
    pub fn new(axes: Vec<Axis>) -> Result<Grid, GridError> {
        if axes.is_empty() || axes.len() > MAX_AXES {
            return Err(GridError::Count(axes.len()));
        }
        for (i, axis) in axes.iter().enumerate() {
            axis.check()?;
            let base = axis.quantity.base_id();
            if axes[..i].iter().any(|a| a.quantity.base_id() == base) {
                return Err(GridError::Twice(base));
            }
        }
        let mut coupled = Vec::new();
        for (i, axis) in axes.iter().enumerate() {
            coupled.push(match axis.warp.couples_to() {
                None => None,
                Some(to) => match axes.iter().position(|a| a.quantity.base_id() == to) {
                    Some(j) if j != i && axes[j].warp.couples_to().is_none() => Some(j),
                    Some(j) if j != i => return Err(GridError::Chain(axis.quantity.id)),
                    _ => return Err(GridError::Coupling { id: axis.quantity.id, to: to.to_owned() }),
                },
            });
        }
        let (free, bound): (Vec<usize>, Vec<usize>) = (0..axes.len()).partition(|&i| coupled[i].is_none());
        let size = axes.iter().try_fold(1usize, |n, a| n.checked_mul(a.len)).unwrap_or(usize::MAX);
        if size > 1 << 26 {
            return Err(GridError::Size(size));
        }
        Ok(Grid { axes, order: [free, bound].concat(), coupled })
    }

    /// The grid as a reader takes it that knows nothing of offsets; none if no axis has one.
    #[must_use]
    pub fn without_offset(&self) -> Option<Grid> {
        let offset = self.axes.iter().any(|a| a.offset.abs() > 0.0);
        let axes = self.axes.iter().map(|a| Axis { offset: 0.0, ..a.clone() }).collect();
        offset.then(|| Grid { axes, ..self.clone() })
    }

    /// The axes, fastest first.
    #[must_use]
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Number of texels.
    #[must_use]
    pub fn len(&self) -> usize {
        self.axes.iter().map(|a| a.len).product()
    }

    /// A grid has at least one texel.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Index on each axis of a texel number.
    #[must_use]
    pub fn unravel(&self, mut texel: usize) -> [usize; MAX_AXES] {
        let mut index = [0; MAX_AXES];
        for (slot, axis) in index.iter_mut().zip(&self.axes) {
            *slot = texel % axis.len;
            texel /= axis.len;
        }
        index
    }

    /// Base values at a texel.
    #[must_use]
    pub fn texel(&self, texel: usize) -> Point {
        let index = self.unravel(texel);
        self.at(|i, axis, coupled| axis.value(index[i], coupled))
    }

    /// Base values at axis coordinates in [0, 1].
    #[must_use]
    pub fn at_coordinates(&self, x: &[f64]) -> Point {
        self.at(|i, axis, coupled| axis.value_at(x[i], coupled))
    }

    fn at(&self, value: impl Fn(usize, &Axis, f64) -> f64) -> Point {
        let mut values = [0.0; MAX_AXES];
        for &i in &self.order {
            let coupled = self.coupled[i].map_or(0.0, |j| values[j]);
            values[i] = self.axes[i].quantity.to_base(value(i, &self.axes[i], coupled));
        }
        Point { values, len: self.axes.len() }
    }

    /// Fractional index on each axis at which a reader finds the base values of `point`.
    #[must_use]
    pub fn index(&self, point: &Point) -> [f64; MAX_AXES] {
        let mut index = [0.0; MAX_AXES];
        for (i, axis) in self.axes.iter().enumerate() {
            let coupled = self.coupled[i].map_or(0.0, |j| point.values[j]);
            index[i] = axis.index(axis.quantity.from_base(point.values[i]), coupled);
        }
        index
    }

    /// A point from base values in the order of the axes.
    #[must_use]
    pub fn point(&self, base_values: &[f64]) -> Option<Point> {
        let mut values = [0.0; MAX_AXES];
        if base_values.len() != self.axes.len() {
            return None;
        }
        values[..base_values.len()].copy_from_slice(base_values);
        Some(Point { values, len: base_values.len() })
    }

    /// Width, height, depth (1 where there is no such axis; a fourth axis is folded into the depth).
    #[must_use]
    pub fn extent(&self) -> [usize; 3] {
        let len = |i: usize| self.axes.get(i).map_or(1, |a| a.len);
        [len(0), len(1), len(2) * len(3)]
    }

    /// Axis coordinates of the corners and middles of all cells on axis `i`: where a reader interpolates worst.
    ///
    /// For a centre axis the half cells before the first and after the last texel are included: there a reader clamps.
    #[must_use]
    pub fn between(&self, i: usize) -> Vec<f64> {
        let axis = &self.axes[i];
        let cells = match axis.texel {
            super::Texel::Center => axis.len,
            super::Texel::Endpoint => axis.len - 1,
        };
        match axis.texel {
            super::Texel::Center => (0..=cells).map(|j| count(j) / count(cells)).collect(),
            super::Texel::Endpoint => (0..cells).map(|j| (count(j) + 0.5) / count(cells)).collect(),
        }
    }
}
