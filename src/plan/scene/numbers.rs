//! The elements of accessors, read without trust.

use crate::scene::{Accessor, Component, Source, View};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Gives a part of a buffer: first byte, and how many.
pub(super) type Bytes<'a> = dyn Fn(&'a Source, [u64; 2]) -> Result<Cow<'a, [u8]>, String> + 'a;

/// The elements of an accessor.
pub(super) struct Numbers<'a> {
    accessor: &'a Accessor,
    /// From its first element on; zeros if none.
    bytes: Option<Cow<'a, [u8]>>,
    stride: u64,
    /// Which elements are replaced, rising, and by what.
    sparse: Option<(Vec<u64>, Cow<'a, [u8]>)>,
}

impl<'a> Numbers<'a> {
    /// The elements, of which all are there.
    ///
    /// # Errors
    /// Why they cannot be read.
    pub(super) fn new(
        accessor: &'a Accessor,
        buffers: &'a BTreeMap<usize, Source>,
        bytes: &Bytes<'a>,
    ) -> Result<Numbers<'a>, String> {
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
            let source = buffers.get(&view.buffer).ok_or("a buffer that is not there")?;
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

    /// How many there are.
    pub(super) fn len(&self) -> u64 {
        self.accessor.count
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
    pub(super) fn index(&self, i: u64) -> u64 {
        self.element(i).map_or(0, |bytes| whole(self.accessor.component, bytes))
    }

    /// Texture coordinates.
    pub(super) fn pair(&self, i: u64) -> [f64; 2] {
        self.several(i)
    }

    /// A position or a normal.
    pub(super) fn triple(&self, i: u64) -> [f64; 3] {
        self.several(i)
    }

    fn several<const N: usize>(&self, i: u64) -> [f64; N] {
        let mut out = [0.0; N];
        let Some(bytes) = self.element(i) else { return out };
        for (slot, bytes) in out.iter_mut().zip(bytes.chunks_exact((bytes.len() / N).max(1))) {
            *slot = self.number(bytes);
        }
        out
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
