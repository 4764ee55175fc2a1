//! Numbers that have gone through a coarser storage all lie on its lattice, as rounded by their own.

use crate::encode::Storage;
use crate::encode::read::{Image, Plane};
use crate::grid::Provenance;

/// Numbers that must lie on a lattice, in steps of which there are [`COARSER`] finer ones: by chance all of them do once in 4^24.
const LEAST: usize = 24;
const COARSER: f64 = 4.0;

/// Storages that round each number by itself, the coarsest first.
const LATTICES: [Storage; 5] =
    [Storage::Unorm8, Storage::Rgb10a2, Storage::Half, Storage::Unorm16, Storage::Float];

/// The storage that a channel has gone through, in words.
pub(super) fn coarser(image: &Image, p: &Provenance) -> Option<String> {
    for plane in &image.channels {
        let Some(channel) = p.channels.iter().find(|c| c.id == plane.name) else { continue };
        let Some(own) =
            Storage::find(plane.sample.id()).filter(|s| !s.is_block() && s.most_channels().is_none())
        else {
            continue;
        };
        for lattice in LATTICES.into_iter().filter(|l| *l != own) {
            let ranges =
                if lattice.is_bounded() { vec![channel.range, [0.0, 1.0]] } else { vec![channel.range] };
            for range in ranges {
                if let Some(count) = on_lattice(plane, own, lattice, range) {
                    return Some(format!(
                        "all {count} distinct numbers of channel `{}` are those of {} over [{}, {}], rounded again as {}",
                        plane.name,
                        lattice.id(),
                        range[0],
                        range[1],
                        own.id()
                    ));
                }
            }
        }
    }
    None
}

/// How many distinct numbers show that the plane has gone through `lattice`; nothing if one does not lie on it.
fn on_lattice(plane: &Plane, own: Storage, lattice: Storage, range: [f64; 2]) -> Option<usize> {
    let mut seen: Vec<f64> = Vec::new();
    for &v in &plane.values {
        let through = lattice.quantise(v, range).ok().and_then(|q| own.quantise(q, plane.range).ok())?;
        if (through - v).abs() > 0.0 {
            return None;
        }
        // the ends of the range are on every lattice
        let ends = range.iter().any(|end| (v - end).abs() == 0.0);
        if lattice.ulp(v, range) >= COARSER * own.ulp(v, plane.range) && !ends {
            seen.push(v);
        }
    }
    seen.sort_by(f64::total_cmp);
    seen.dedup();
    (seen.len() >= LEAST).then_some(seen.len())
}
