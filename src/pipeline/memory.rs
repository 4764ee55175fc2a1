//! How much memory a plan takes, before it is baked.
//!
//! Tables are baked one after the other, and a file goes to the disk when it is finished, so a plan takes what its largest table
//! does, and the parts of files that tables share. An estimate is an upper bound of what the program asks the allocator for: a table in 64-bit floats
//! with its errors, what is fitted to it, its rounded values, its files, and what a container needs to write one
//! ([`Encoder::most_memory`]). `tests/memory.rs` measures bakes against it.

use super::{PipelineError, memory_map};
use crate::encode::{Encoder, FileOption, Shape, Storage};
use crate::grid::Grid;
use crate::integrate::MAX_CHANNELS;
use crate::plan::{Plan, PlannedMap, PlannedTable};

/// What a bake may take if nothing else is said, where the machine has as much: the same plans are refused on every
/// machine that is larger.
pub const MEMORY: u64 = 4 << 30;

/// What the program takes for anything: code, threads, curves that models keep, points between texels.
const FIXED: u64 = 96 << 20;

/// What Zstandard takes at level 19 apart from its input and output: windows and tables of matches.
const ZSTD: u64 = 128 << 20;

/// Bytes that a process may still take: what the machine has available, less where a limit of its group or of the process itself is
/// lower. None if the system does not tell.
#[must_use]
pub fn available() -> Option<u64> {
    let mut system = sysinfo::System::new();
    system.refresh_memory();
    let known = system.total_memory() > 0;
    let machine = known.then(|| system.available_memory()).filter(|n| *n > 0);
    // what a group has left counts the cache of its files, which is given back when memory is asked for
    let group = known.then(|| system.cgroup_limits()).flatten().map(|g| g.total_memory.saturating_sub(g.rss));
    [machine, group, process_limit()].into_iter().flatten().min()
}

/// The limit of the address space (`ulimit -v`), of which threads and the allocator's reserves take a part.
#[cfg(unix)]
fn process_limit() -> Option<u64> {
    use rustix::process::{Resource, getrlimit};
    getrlimit(Resource::As).current.map(|n| n / 8 * 7)
}

#[cfg(not(unix))]
fn process_limit() -> Option<u64> {
    None
}

/// Refuses a plan that takes more than `limit`, or, without one, more than [`MEMORY`] or what is available.
pub(super) fn check(plan: &Plan, limit: Option<u64>) -> Result<(), PipelineError> {
    let shared = shared(plan);
    let need = |t: &PlannedTable| table(t).saturating_add(shared);
    let limit = limit.unwrap_or_else(|| available().map_or(MEMORY, |n| n.min(MEMORY)));
    if let Some(largest) = plan.tables.iter().rev().max_by_key(|t| need(t))
        && need(largest) > limit
    {
        return Err(PipelineError::Memory { table: largest.name().to_owned(), needed: need(largest), limit });
    }
    if let Some(largest) = plan.maps.iter().rev().max_by_key(|m| map(m))
        && map(largest) > limit
    {
        return Err(PipelineError::MapMemory { map: largest.name().to_owned(), needed: map(largest), limit });
    }
    Ok(())
}

/// Most bytes that a plan takes.
#[must_use]
pub fn plan(plan: &Plan) -> u64 {
    let tables = plan.tables.iter().map(table).max().unwrap_or(0).saturating_add(shared(plan));
    // maps are made when all tables are on the disk
    plan.maps.iter().map(map).fold(tables, u64::max)
}

/// Most bytes that a map takes.
#[must_use]
pub fn map(planned: &PlannedMap) -> u64 {
    memory_map::map(planned).saturating_add(FIXED)
}

/// Parts of files that several tables share: they are held until the last one is there, and joined.
fn shared(plan: &Plan) -> u64 {
    let named = |t: &&PlannedTable| {
        t.asked.file.is_some()
            && plan.tables.iter().filter(|other| other.asked.file == t.asked.file).count() > 1
    };
    let part = |t: &PlannedTable| {
        let (grid, channels) = (grid(t), t.bound.spec.layout.channels.len());
        let file: u64 = outputs(t, &grid).map(|(e, s)| bytes(e.most_bytes(&s))).sum();
        file.saturating_mul(JOINED).saturating_add(bytes(grid.len() * channels).saturating_mul(8))
    };
    plan.tables.iter().filter(named).map(part).fold(0, u64::saturating_add)
}

/// Times that the bytes of a part are held while a file is put together, besides its numbers: packed, behind those of others, compressed,
/// and in the file; a block storage has its blocks besides.
const JOINED: u64 = 5;

/// Most bytes that a table takes.
#[must_use]
pub fn table(planned: &PlannedTable) -> u64 {
    let grid = grid(planned);
    let texels = bytes(grid.len());
    let channels = bytes(planned.bound.spec.layout.channels.len());
    // values and errors, and the number of evaluations
    let table = texels.saturating_mul(16 * channels + 4);
    let values = texels.saturating_mul(8 * channels);
    let fitted = if planned.asked.texels.are_exact() { [0; 2] } else { fit(&grid, channels) };
    let candidates = if planned.asked.texels.are_exact() { 1 } else { 4 };
    let mut files = 0_u64;
    let mut writing = 0_u64;
    for (encoder, shape) in outputs(planned, &grid) {
        let rounded = values.saturating_add(blocks(shape.storage, texels)).saturating_mul(candidates);
        let copy = if candidates > 1 { table.saturating_add(values) } else { 0 };
        let zstd = if shape.has(FileOption::Zstd) { ZSTD } else { 0 };
        let file = bytes(encoder.most_bytes(&shape));
        let encode = bytes(encoder.most_memory(&shape)).saturating_sub(file).saturating_add(zstd);
        let checked = blocks(shape.storage, texels);
        let most = encode.max(checked).max(copy);
        writing = writing.max(rounded.saturating_add(most));
        files = files.saturating_add(file);
    }
    let [fitting, kept] = fitted;
    let after = files.saturating_add(writing).saturating_add(kept);
    table.saturating_add(fitting.max(after)).saturating_add(FIXED)
}

/// The grid of a table; where its size is searched for, the largest that can be tried.
fn grid(planned: &PlannedTable) -> Grid {
    let grid = &planned.bound.spec.grid;
    let Some(size) = planned.asked.size.as_ref().filter(|_| planned.found.is_none()) else {
        return grid.clone();
    };
    let mut axes = grid.axes().to_vec();
    for i in &size.axes {
        if let Some(axis) = axes.get_mut(*i) {
            axis.len = size.longest;
        }
    }
    // more texels than a table can have are not tried
    Grid::new(axes).unwrap_or_else(|_| grid.clone())
}

/// The outputs of a table, as they are on a grid.
fn outputs<'a>(
    planned: &'a PlannedTable,
    grid: &'a Grid,
) -> impl Iterator<Item = (&'static dyn Encoder, Shape<'a>)> {
    let channels = planned.bound.spec.layout.channels.len();
    planned.outputs.iter().map(move |o| (o.encoder, o.shape(grid, channels)))
}

/// Blocks of texels: positions, blocks as they are found, and what they decode to, by channel and by texel.
fn blocks(storage: Storage, texels: u64) -> u64 {
    if storage.is_block() { texels.saturating_mul(64) } else { 0 }
}

/// What fitting takes, and what is kept of it: the truth at many points for each texel, which texels each of them reads, and for each
/// channel, all at once, the vectors of a solution.
fn fit(grid: &Grid, channels: u64) -> [u64; 2] {
    let points = bytes(super::fit::points(grid));
    let corners = 1_u64 << grid.axes().len();
    let truth = 56 + 8 * bytes(MAX_CHANNELS);
    let reads = 2 * 16 * corners + 24;
    let solution = 96 * channels;
    let texels = bytes(grid.len()).saturating_mul(112 * channels);
    let fitting = points.saturating_mul(160 + 2 * truth + reads + solution).saturating_add(texels);
    let kept = points.saturating_mul(truth + reads + 32 + 16 * channels).saturating_add(texels);
    [fitting, kept]
}

fn bytes(n: usize) -> u64 {
    u64::try_from(n).unwrap_or(u64::MAX)
}
