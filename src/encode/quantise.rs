//! Rounding of whole tables: texel by texel, or block by block.

use super::Storage;
use super::blocks::Kind;
use super::storage::QuantiseError;
use crate::cancel::{Cancel, Cancelled};
use crate::grid::Table;
use crate::grid::table::{Extreme, place};

/// A table as a reader will see it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Quantised {
    /// Stored values, `[texel][channel]`.
    pub values: Vec<f64>,
    /// The bytes that decode to them, if the storage is made of blocks; empty otherwise.
    pub blocks: Vec<u8>,
    /// Largest |stored - integral| and where it lies.
    pub largest_error: Extreme,
}

/// A value of a table that its storage cannot hold, and where it is.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("channel {channel} at {}: {fault}", place(.at))]
pub struct RangeFault {
    /// Texel number.
    pub texel: usize,
    /// Channel id.
    pub channel: String,
    /// Axis ids and values.
    pub at: Vec<(String, f64)>,
    /// The value and its limit.
    #[source]
    pub fault: QuantiseError,
}

/// Why a table has no stored form.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Unstored {
    /// A value that the storage cannot hold.
    #[error(transparent)]
    Range(#[from] RangeFault),
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The end of the range for a value beyond it by no more than its own integration error: as good an estimate, and better.
fn within_its_error(v: f64, [lo, hi]: [f64; 2], error: f64) -> f64 {
    let kept = v.clamp(lo.min(hi), hi.max(lo));
    if (v - kept).abs() <= error { kept } else { v }
}

/// Rounds every value of a table to its stored form. In a storage that encodes a range, a value beyond it by no more than
/// its own integration error counts as the end of the range; one further out is an error, as everywhere.
///
/// # Errors
/// [`RangeFault`] for the first value (in file order) that `storage` cannot hold.
pub fn quantise_table(table: &Table, storage: Storage) -> Result<Quantised, RangeFault> {
    match quantise_table_until(&Cancel::new(), table, storage) {
        Ok(quantised) => Ok(quantised),
        Err(Unstored::Range(fault)) => Err(fault),
        // nobody else has the token
        Err(Unstored::Cancelled(Cancelled)) => Ok(Quantised::default()),
    }
}

/// [`quantise_table`], until it is stopped: storages made of blocks search for seconds.
///
/// # Errors
/// [`Unstored`].
pub fn quantise_table_until(cancel: &Cancel, table: &Table, storage: Storage) -> Result<Quantised, Unstored> {
    let n = table.channels.len();
    let range = |c: usize| table.channels[c].range;
    let mut values = table.values.clone();
    for (t, texel) in values.chunks_exact_mut(n.max(1)).enumerate() {
        if storage.is_bounded() {
            for (c, v) in texel.iter_mut().enumerate() {
                *v = within_its_error(*v, range(c), table.errors[t * n + c]);
            }
        }
        let rounded = if storage.is_block() {
            storage.check_texel(texel, range)
        } else {
            storage.quantise_texel(texel, range)
        };
        rounded.map_err(|(c, fault)| RangeFault {
            texel: t,
            channel: table.channels.get(c).map_or_else(String::new, |c| c.id.clone()),
            at: table.coordinates(t),
            fault,
        })?;
    }
    let extent = table.grid.extent();
    let blocks = storage.compress(cancel, &values, extent, n, range)?;
    if storage.is_block() {
        values = storage.expand(&blocks, extent, n, range);
    }
    let largest_error = largest_error(table, &values);
    Ok(Quantised { values, blocks, largest_error })
}

/// Largest |stored - integral|, the first one in file order.
fn largest_error(table: &Table, stored: &[f64]) -> Extreme {
    let n = table.channels.len().max(1);
    let (mut largest, mut worst) = (0.0, 0);
    for (i, (stored, integral)) in stored.iter().zip(&table.values).enumerate() {
        let error = (stored - integral).abs();
        if error > largest {
            (largest, worst) = (error, i);
        }
    }
    let channel = table.channels.get(worst % n).map_or_else(String::new, |c| c.id.clone());
    Extreme { value: largest, channel, at: table.coordinates(worst / n) }
}

impl Storage {
    /// Checks the channels of a texel of a block; an excess of rounding noise is taken off.
    fn check_texel(
        self,
        texel: &mut [f64],
        range: impl Fn(usize) -> [f64; 2],
    ) -> Result<(), (usize, QuantiseError)> {
        let count = texel.len();
        self.check_written().map_err(|e| (0, e))?;
        if let Some(limit) = self.most_channels().filter(|&limit| count > limit) {
            return Err((limit, QuantiseError::Channels { count, limit, storage: self.id() }));
        }
        for (c, v) in texel.iter_mut().enumerate() {
            let rounded = self.round(*v, c, range(c)).map_err(|e| (c, e))?;
            *v = if *v < 0.0 && rounded.abs() == 0.0 { 0.0 } else { *v };
        }
        Ok(())
    }

    /// The blocks of checked values, `[texel][channel]`; none if the storage has no blocks.
    fn compress(
        self,
        cancel: &Cancel,
        values: &[f64],
        extent: [usize; 3],
        n: usize,
        range: impl Fn(usize) -> [f64; 2],
    ) -> Result<Vec<u8>, Cancelled> {
        let Some(kind) = Kind::of(self) else { return Ok(Vec::new()) };
        // checked, so that every value has a position
        let position = |(i, v): (usize, &f64)| self.position(*v, range(i % n.max(1))).unwrap_or(*v);
        let positions: Vec<f64> = values.iter().enumerate().map(position).collect();
        kind.compress(cancel, &positions, n, extent)
    }

    /// What blocks decode to, `[texel][channel]`, in the first `n` channels.
    pub(crate) fn expand(
        self,
        blocks: &[u8],
        extent: [usize; 3],
        n: usize,
        range: impl Fn(usize) -> [f64; 2],
    ) -> Vec<f64> {
        let planes = Kind::of(self).map(|kind| kind.expand(blocks, extent)).unwrap_or_default();
        let texels = 0..extent.iter().product::<usize>();
        let at = |t: usize, c: usize| {
            let code = planes.get(c).and_then(|p| p.get(t)).copied().unwrap_or(0.0);
            self.coding(c).decode(code, range(c))
        };
        let mut values = Vec::with_capacity(texels.len() * n);
        texels.for_each(|t| values.extend((0..n).map(|c| at(t, c))));
        values
    }
}
