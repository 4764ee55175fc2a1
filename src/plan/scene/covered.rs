//! Which texels of an image meshes cover: their texture coordinates, read from accessors without trust.

use crate::picture::{CoverError, Covered};
use crate::scene::{Accessor, Component, Geometry, Primitive, Reading, Source, View};
use std::borrow::Cow;

/// Gives a part of a buffer: first byte, and how many.
pub(super) type Bytes<'a> = dyn Fn(&'a Source, [u64; 2]) -> Result<Cow<'a, [u8]>, String> + 'a;

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
        Numbers::new(accessor, geometry, bytes)
    };
    let Some(set) = primitive.sets.get(&reading.tex_coord) else { return Ok(()) };
    let coordinates = numbers(set)?;
    let indices = primitive.indices.as_ref().map(numbers).transpose()?;
    let all = coordinates.accessor.count;
    let corner = |k: u64| {
        let vertex = indices.as_ref().map_or(k, |i| i.index(k));
        if vertex >= all {
            return Err(format!("index {vertex}, and there are {all} texture coordinates"));
        }
        Ok(reading.place(coordinates.pair(vertex)))
    };
    let count = indices.as_ref().map_or(all, |i| i.accessor.count);
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

/// The elements of an accessor.
struct Numbers<'a> {
    accessor: &'a Accessor,
    /// From its first element on; zeros if none.
    bytes: Option<Cow<'a, [u8]>>,
    stride: u64,
    /// Which elements are replaced, rising, and by what.
    sparse: Option<(Vec<u64>, Cow<'a, [u8]>)>,
}

impl<'a> Numbers<'a> {
    fn new(accessor: &'a Accessor, geometry: &'a Geometry, bytes: &Bytes<'a>) -> Result<Numbers<'a>, String> {
        let size = accessor.component.size() * accessor.numbers;
        let part = |view: &View, offset: u64, count: u64, stride: u64, size: u64| {
            if let Some(name) = view.compressed {
                return Err(format!("compressed by {name}, which is not decoded"));
            }
            let length = count.checked_sub(1).map_or(Some(0), |n| n.checked_mul(stride)?.checked_add(size));
            let end = length.and_then(|length| length.checked_add(offset));
            let (Some(length), true) = (length, end.is_some_and(|end| end <= view.length)) else {
                return Err(format!(
                    "{count} elements of an accessor do not fit into the {} bytes of a buffer view",
                    view.length
                ));
            };
            let source = geometry.buffers.get(&view.buffer).ok_or("a buffer that is not there")?;
            bytes(source, [view.offset.saturating_add(offset), length])
        };
        let stride = accessor.view.as_ref().and_then(|v| v.stride).unwrap_or(size);
        let view = accessor.view.as_ref();
        let own = view.map(|v| part(v, accessor.offset, accessor.count, stride, size)).transpose()?;
        let replaced = |s: &crate::scene::Sparse| {
            let (view, offset, component) = &s.indices;
            let at = part(view, *offset, s.count, component.size(), component.size())?;
            let step = usize::try_from(component.size()).unwrap_or(1);
            let which: Vec<u64> = at.chunks_exact(step).map(|c| whole(*component, c)).collect();
            if !which.is_sorted_by(|a, b| a < b) || which.last().is_some_and(|last| *last >= accessor.count) {
                return Err("the indices of a sparse accessor do not rise, or lead out of it".to_owned());
            }
            Ok((which, part(&s.values.0, s.values.1, s.count, size, size)?))
        };
        let sparse = accessor.sparse.as_ref().map(replaced).transpose()?;
        Ok(Numbers { accessor, bytes: own, stride, sparse })
    }

    /// The bytes of an element; none where it is zero.
    fn element(&self, i: u64) -> Option<&[u8]> {
        let (size, from, bytes) = self.place(i)?;
        let from = usize::try_from(from).ok()?;
        bytes.get(from..from.checked_add(usize::try_from(size).ok()?)?)
    }

    fn place(&self, i: u64) -> Option<(u64, u64, &[u8])> {
        let size = self.accessor.component.size() * self.accessor.numbers;
        if let Some((which, values)) = &self.sparse
            && let Ok(place) = which.binary_search(&i)
        {
            return Some((size, place as u64 * size, values));
        }
        Some((size, i * self.stride, self.bytes.as_deref()?))
    }

    /// A number that stands for an index.
    fn index(&self, i: u64) -> u64 {
        self.element(i).map_or(0, |bytes| whole(self.accessor.component, bytes))
    }

    /// Texture coordinates.
    fn pair(&self, i: u64) -> [f64; 2] {
        let Some(bytes) = self.element(i) else { return [0.0; 2] };
        let (first, second) = bytes.split_at(bytes.len() / 2);
        [first, second].map(|bytes| self.number(bytes))
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_possible_wrap, reason = "of the size of the type")]
    fn number(&self, bytes: &[u8]) -> f64 {
        let code = whole(self.accessor.component, bytes);
        let (value, most) = match self.accessor.component {
            Component::F32 => return f64::from(f32::from_bits(code as u32)),
            Component::I8 => (f64::from(code as u8 as i8), 127.0),
            Component::U8 => (code as f64, 255.0),
            Component::I16 => (f64::from(code as u16 as i16), 32767.0),
            Component::U16 | Component::U32 => (code as f64, 65535.0),
        };
        if self.accessor.normalized { (value / most).max(-1.0) } else { value }
    }
}

/// Bytes as an unsigned number, the lowest first.
fn whole(component: Component, bytes: &[u8]) -> u64 {
    let size = usize::try_from(component.size()).unwrap_or(4);
    bytes.iter().take(size).rev().fold(0, |all, byte| all << 8 | u64::from(*byte))
}
