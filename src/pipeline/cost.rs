//! What a table will cost, before it is baked: bytes of its files, and seconds by a few of its texels.

use crate::grid::axis::count as count_of;
use crate::plan::PlannedTable;
use std::time::Instant;

/// What a table costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Most bytes of its files.
    pub bytes: u64,
    /// Seconds on one core of this machine, as a few texels spread over the table took; encoding and laws not counted.
    pub seconds: f64,
}

/// Texels that are tried.
const TRIED: usize = 16;

/// Tries a few texels of a table. Texels that have no value cost nothing here; the bake names them.
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below the number of texels")]
pub fn of(table: &PlannedTable) -> Cost {
    let grid = &table.bound.spec.grid;
    let channels = table.bound.spec.layout.channels.len();
    let most = |o: &crate::plan::Output| o.encoder.most_bytes(&o.shape(grid, channels));
    let bytes =
        table.outputs.iter().map(|o| u64::try_from(most(o)).unwrap_or(u64::MAX)).fold(0, u64::saturating_add);
    let count = grid.len().min(TRIED);
    // spread by the golden ratio, so that no axis is tried at one place only; the value is not wanted
    let texel = |i: usize| {
        let place = (count_of(i) + 0.5) * 0.618_033_988_749_895;
        ((place.fract() * count_of(grid.len())) as usize).min(grid.len().saturating_sub(1))
    };
    let try_out = |i: usize| {
        let _ = table.bound.baker.texel(grid.texel(texel(i)).values(), table.tolerance);
    };
    // the first one makes rules that all others share
    try_out(count / 2);
    let start = Instant::now();
    (0..count).for_each(try_out);
    let each = start.elapsed().as_secs_f64() / count_of(count.max(1));
    Cost { bytes, seconds: each * count_of(grid.len()) }
}
