//! How much memory a map takes, before it is made; see [`memory`](super::memory).
//!
//! An upper bound, as for tables: its images as they are decoded and as planes, the surface, the lobes of all levels, the numbers of
//! every kind of map on every level, and the bytes of all files, of which one more copy is held while it is written.

use crate::maps::sbrdf::NORMALISATION;
use crate::plan::PlannedMap;
use crate::plan::map::{Kind, SbrdfRequest};

/// Bytes of a number of an image: as it is decoded, as a plane, in another size.
const DECODED: u64 = 20;

/// Bytes of a texel of the surface: normal, roughness, stretch, residual, and the costs of a conversion.
const SURFACE: u64 = 48;

/// Bytes of a texel of the levels behind the first, a third of its number, and of the footprints that are kept of them.
const LEVELS: u64 = 20 + 12;

/// Bytes of a number of lobes: on all levels, with room for the roughness that they were fitted for.
const LOBES: u64 = 6;

/// Bytes that all levels of a texel take for one of the first.
const fn pyramid(bytes: u64) -> u64 {
    bytes + bytes / 3 + 1
}

/// Most bytes that a map takes, but for what the program takes for anything.
pub(super) fn map(planned: &PlannedMap) -> u64 {
    let texels = bytes(planned.size[0]).saturating_mul(bytes(planned.size[1]));
    let kinds = planned.asked.kinds();
    let (mut numbers, mut files, mut writing) = (0_u64, 0_u64, 0_u64);
    for kind in kinds {
        let count = match kind {
            Kind::Normalisation => bytes(NORMALISATION[0] * NORMALISATION[1]),
            _ => texels,
        };
        let channels = bytes(planned.channels(kind));
        numbers = numbers.saturating_add(count.saturating_mul(pyramid(4 * channels)));
        for output in &planned.asked.outputs {
            let storage = output.storage(kind);
            // components of four bytes at most; what is compressed may grow a little, and blocks are found from positions
            let file =
                count.saturating_mul(pyramid(4 * channels.next_power_of_two())).saturating_add(1 << 16);
            let blocks = if storage.is_block() { count.saturating_mul(pyramid(64)) } else { 0 };
            files = files.saturating_add(file);
            writing = writing.max(file.saturating_mul(3).saturating_add(blocks));
        }
    }
    let lobes = planned.asked.sbrdf.as_ref().map_or(0, of_lobes);
    let each = SURFACE + LEVELS + lobes;
    planned
        .numbers
        .saturating_mul(DECODED)
        .saturating_add(texels.saturating_mul(each))
        .saturating_add(numbers)
        .saturating_add(files)
        .saturating_add(writing)
}

/// Bytes of a texel: six planes of colours with a smaller level, and the numbers of the lobes.
fn of_lobes(sbrdf: &SbrdfRequest) -> u64 {
    let numbers = 4 + 8 * bytes(sbrdf.lobes);
    36 + numbers * LOBES
}

fn bytes(n: usize) -> u64 {
    u64::try_from(n).unwrap_or(u64::MAX)
}
