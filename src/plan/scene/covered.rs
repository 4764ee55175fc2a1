//! Which texels of an image meshes cover: their texture coordinates, read from accessors without trust.

use super::numbers::{Bytes, Numbers};
use crate::picture::{CoverError, Covered};
use crate::scene::{Accessor, Geometry, Primitive, Reading};

/// Marks what a reading reads.
///
/// # Errors
/// Why that is not known.
pub(super) fn cover<'a>(
    geometry: &'a Geometry,
    reading: &Reading,
    bytes: &Bytes<'a>,
    covered: &mut Covered,
) -> Result<(), String> {
    if reading.moves {
        return Err("its KHR_texture_transform is animated".to_owned());
    }
    for place in geometry.of_material.get(&reading.material).into_iter().flatten() {
        let Some(primitive) = geometry.primitives.get(*place) else { continue };
        mark(geometry, primitive, reading, bytes, covered)
            .map_err(|why| format!("{}: {why}", primitive.at))?;
        if covered.is_full() {
            break;
        }
    }
    if covered.is_empty() { Err("no mesh covers a texel".to_owned()) } else { Ok(()) }
}

fn mark<'a>(
    geometry: &'a Geometry,
    primitive: &'a Primitive,
    reading: &Reading,
    bytes: &Bytes<'a>,
    covered: &mut Covered,
) -> Result<(), String> {
    let numbers = |accessor: &'a Result<Accessor, String>| {
        let accessor = accessor.as_ref().map_err(Clone::clone)?;
        if primitive.draco && accessor.view.is_none() {
            return Err("compressed by KHR_draco_mesh_compression, which is not decoded".to_owned());
        }
        Numbers::new(accessor, &geometry.buffers, bytes)
    };
    let Some(set) = primitive.sets.get(&reading.tex_coord) else { return Ok(()) };
    let coordinates = numbers(set)?;
    let indices = primitive.indices.as_ref().map(numbers).transpose()?;
    let all = coordinates.len();
    let corner = |k: u64| {
        let vertex = indices.as_ref().map_or(k, |i| i.index(k));
        if vertex >= all {
            return Err(format!("index {vertex}, and there are {all} texture coordinates"));
        }
        Ok(reading.place(coordinates.pair(vertex)))
    };
    let count = indices.as_ref().map_or(all, Numbers::len);
    let (figures, of) = figures(primitive.mode, count)?;
    if !covered.affords(figures) {
        return Err(CoverError::Work.to_string());
    }
    for figure in 0..figures {
        let (corners, n) = of(figure);
        let mut placed = [[0.0; 2]; 3];
        for (to, k) in placed.iter_mut().zip(&corners[..n]) {
            *to = corner(*k % count)?;
        }
        covered.mark(&placed[..n]).map_err(|e| e.to_string())?;
        if covered.is_full() {
            break;
        }
    }
    Ok(())
}

/// The corners of a figure, and how many there are.
type Figure = ([u64; 3], usize);

/// How many figures there are, and the corners of each.
type Figures = (u64, fn(u64) -> Figure);

/// How many points, lines or triangles so many vertices make, and the corners of each (glTF 2.0 §3.7.2.1).
fn figures(mode: u64, count: u64) -> Result<Figures, String> {
    Ok(match mode {
        0 => (count, |k| ([k, 0, 0], 1)),
        1 => (count / 2, |k| ([2 * k, 2 * k + 1, 0], 2)),
        // the last one of a loop goes back to its first vertex
        2 => (count, |k| ([k, k + 1, 0], 2)),
        3 => (count.saturating_sub(1), |k| ([k, k + 1, 0], 2)),
        4 => (count / 3, |k| ([3 * k, 3 * k + 1, 3 * k + 2], 3)),
        5 => (count.saturating_sub(2), |k| ([k, k + 1, k + 2], 3)),
        6 => (count.saturating_sub(2), |k| ([0, k + 1, k + 2], 3)),
        other => return Err(format!("mode {other}, and there are 0 to 6")),
    })
}
