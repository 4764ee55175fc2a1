//! What a table will cost, before it is baked: bytes of its files, and seconds by a few of its texels.

use crate::grid::axis::count as count_of;
use crate::plan::{Output, Plan, PlannedTable};
use std::time::Instant;

/// What a table costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Most bytes of its files.
    pub bytes: u64,
    /// Seconds on one core of this machine, as a few texels spread over the table took; encoding and laws not counted.
    pub seconds: f64,
}

/// Texels of a plan from which on it must be allowed.
pub const TEXELS: u64 = 100_000_000;

/// Bytes of its files from which on it must be allowed.
pub const BYTES: u64 = 4 << 30;

/// What a large plan costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Large {
    /// Texels of all tables; maps count with their levels.
    pub texels: u64,
    /// Most bytes of all files of tables.
    pub bytes: u64,
    /// Seconds on one core, as [`Cost::seconds`].
    pub seconds: f64,
}

impl std::fmt::Display for Large {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Large { texels, bytes, seconds } = self;
        let size = bytesize::ByteSize::b(*bytes).display().si();
        write!(
            f,
            "{texels} texels, up to {size} of files, and about {seconds:.0} s of one core (from {TEXELS} texels or "
        )?;
        write!(f, "{} on)", bytesize::ByteSize::b(BYTES))
    }
}

/// What a plan costs, if it is large. A size that is searched for counts as the one that the search begins with.
#[must_use]
pub fn large(plan: &Plan) -> Option<Large> {
    let number = |n: usize| u64::try_from(n).unwrap_or(u64::MAX);
    let of_tables = plan.tables.iter().map(|t| number(t.bound.spec.grid.len()));
    let of_maps = plan.maps.iter().map(|m| number(m.size[0]).saturating_mul(number(m.size[1])) / 3 * 4);
    let texels = of_tables.chain(of_maps).fold(0, u64::saturating_add);
    let bytes = plan.tables.iter().map(bytes).fold(0, u64::saturating_add);
    if texels < TEXELS && bytes < BYTES {
        return None;
    }
    Some(Large { texels, bytes, seconds: plan.tables.iter().map(|t| of_table(t).seconds).sum() })
}

/// Most bytes of the files of a table.
fn bytes(table: &PlannedTable) -> u64 {
    let grid = &table.bound.spec.grid;
    let channels = table.bound.spec.layout.channels.len();
    let most = |o: &Output| o.encoder.most_bytes(&o.shape(grid, channels));
    table.outputs.iter().map(|o| u64::try_from(most(o)).unwrap_or(u64::MAX)).fold(0, u64::saturating_add)
}

/// Texels that are tried.
const TRIED: usize = 16;

/// Tries a few texels of a table. Texels that have no value cost nothing here; the bake names them.
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below the number of texels")]
pub fn of_table(table: &PlannedTable) -> Cost {
    let grid = &table.bound.spec.grid;
    let bytes = bytes(table);
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
