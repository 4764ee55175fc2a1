//! Texels as bytes: little-endian, components interleaved, rows from the top; and back.

use super::blocks::Kind;
use super::coding::{self, RGB9E5, RGBE};
use super::read::{Claim, Plane, Sample};
use super::{EncodeError, EncodeInput, Storage};
use crate::cancel::Cancel;
use half::f16;

/// Storages that graphics processors read, in the order of lists.
pub(super) static ON_GPUS: &[Storage] = &[
    Storage::Half,
    Storage::Float,
    Storage::Unorm8,
    Storage::Unorm16,
    Storage::Rgb10a2,
    Storage::R11g11b10,
    Storage::Rgb9e5,
    Storage::Rgbd,
    Storage::Bc4,
    Storage::Bc5,
    Storage::Bc6h,
    Storage::Bc6hSigned,
];

/// Bytes of a texel, or of a block of texels.
pub(super) const fn size(storage: Storage, components: usize) -> usize {
    if let Some(kind) = Kind::of(storage) {
        return kind.block_bytes();
    }
    match storage {
        Storage::Half | Storage::Unorm16 => 2 * components,
        Storage::Float => 4 * components,
        Storage::Double => 8 * components,
        Storage::Unorm8 => components,
        _ => 4,
    }
}

/// Bytes of a picture; nothing if they cannot be counted.
pub(super) fn bytes(storage: Storage, components: usize, extent: [usize; 3]) -> Option<usize> {
    match Kind::of(storage) {
        Some(kind) => kind.bytes(extent),
        None => extent.iter().try_fold(size(storage, components), |n, side| n.checked_mul(*side)),
    }
}

/// Components of a pixel of a storage that packs them all into one word, or into one block.
pub(super) const fn packed(storage: Storage) -> Option<usize> {
    if let Some(kind) = Kind::of(storage) {
        return Some(kind.channels());
    }
    match storage {
        Storage::R11g11b10 | Storage::Rgb9e5 | Storage::Rgbe | Storage::Rgbd => Some(3),
        Storage::Rgb10a2 => Some(4),
        _ => None,
    }
}

/// The bytes of all texels with `components` components each; those without channel hold the fill values.
pub(super) fn pack(input: &EncodeInput<'_>, components: usize) -> Result<Vec<u8>, EncodeError> {
    if input.storage.is_block() {
        return Ok(input.blocks.to_vec());
    }
    let n = input.channels.len();
    let fill = input.shape().fill(components);
    let mut bytes = Vec::with_capacity(input.grid.len() * size(input.storage, components));
    let mut codes = vec![0.0; components];
    for (t, texel) in input.values.chunks_exact(n).enumerate() {
        input.cancel.check()?;
        for (c, code) in codes.iter_mut().enumerate() {
            *code = match texel.get(c) {
                Some(&v) => {
                    input.storage.code(v, input.channels[c].range).map_err(|_| input.not_quantised(t, c))?
                }
                None => top(input.storage, c) * fill[c - n],
            };
        }
        put(input.storage, &codes, &mut bytes);
    }
    Ok(bytes)
}

/// The code of 1.
const fn top(storage: Storage, component: usize) -> f64 {
    match storage {
        Storage::Unorm8 => 255.0,
        Storage::Unorm16 => 65535.0,
        Storage::Rgb10a2 if component == 3 => 3.0,
        Storage::Rgb10a2 => 1023.0,
        _ => 1.0,
    }
}

/// One texel. The codes are numbers of the storage (checked), so that all conversions are exact.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "codes are integers below 2^16 or floats of the storage"
)]
pub(super) fn put(storage: Storage, codes: &[f64], bytes: &mut Vec<u8>) {
    match storage {
        Storage::Half => codes.iter().for_each(|&v| bytes.extend(f16::from_f64(v).to_le_bytes())),
        Storage::Float => codes.iter().for_each(|&v| bytes.extend((v as f32).to_le_bytes())),
        Storage::Double => codes.iter().for_each(|&v| bytes.extend(v.to_le_bytes())),
        Storage::Unorm8 => codes.iter().for_each(|&v| bytes.push(v as u8)),
        Storage::Unorm16 => codes.iter().for_each(|&v| bytes.extend((v as u16).to_le_bytes())),
        Storage::Rgb10a2 => {
            let word = codes.iter().enumerate().fold(0, |w, (c, &v)| w | (v as u32) << (10 * c));
            bytes.extend(word.to_le_bytes());
        }
        Storage::R11g11b10 => {
            // the unsigned floats have the exponent of a half, and fewer bits of its mantissa
            let bits = |c: usize| u32::from(codes.get(c).map_or(0, |&v| f16::from_f64(v).to_bits()));
            let word = bits(0) >> 4 | bits(1) >> 4 << 11 | bits(2) >> 5 << 22;
            bytes.extend(word.to_le_bytes());
        }
        Storage::Rgb9e5 => {
            let (m, e) = RGB9E5.nearest(codes);
            let [r, g, b] = m.map(|m| m as u32);
            let word = r | g << 9 | b << 18 | ((e + 24) as u32) << 27;
            bytes.extend(word.to_le_bytes());
        }
        Storage::Rgbe => {
            let (m, e) = RGBE.nearest(codes);
            let zero = m.iter().all(|m| m.abs() == 0.0);
            let exponent = if zero { 0 } else { (e + 136) as u8 };
            bytes.extend(m.map(|m| m as u8));
            bytes.push(exponent);
        }
        Storage::Rgbd => {
            let (codes, d) = coding::rgbd_nearest(codes);
            bytes.extend(codes);
            bytes.push(d);
        }
        // their bytes are there already: see `pack`
        Storage::Bc4 | Storage::Bc5 | Storage::Bc6h | Storage::Bc6hSigned => {}
    }
}

/// The planes of a picture, until it is stopped, as components `R`, `G`, `B`, `A`. Unorm planes hold codes until [`finish`] decodes them.
pub(super) fn unpack(
    bytes: &[u8],
    storage: Storage,
    components: usize,
    extent: [usize; 3],
    cancel: &Cancel,
) -> Vec<Plane> {
    let sample = Sample::of(storage);
    let mut planes: Vec<Plane> = (0..components)
        .map(|c| Plane {
            name: component(c),
            sample,
            range: [0.0, 1.0],
            values: Vec::with_capacity(bytes.len() / size(storage, components).max(1)),
        })
        .collect();
    if let Some(kind) = Kind::of(storage) {
        for (plane, values) in planes.iter_mut().zip(kind.expand(bytes, extent)) {
            plane.values = values;
        }
        return planes;
    }
    let mut texel = vec![0.0; components];
    for word in bytes.chunks_exact(size(storage, components)).take_while(|_| !cancel.is_set()) {
        take(storage, word, &mut texel);
        for (plane, &v) in planes.iter_mut().zip(&texel) {
            plane.values.push(v);
        }
    }
    planes
}

/// Name of a component: a colour, or its number.
pub(super) fn component(c: usize) -> String {
    ["R", "G", "B", "A"].get(c).map_or_else(|| format!("c{c}"), |n| (*n).to_owned())
}

/// One texel; the slice is of the right size.
fn take(storage: Storage, bytes: &[u8], texel: &mut [f64]) {
    let word = || bytes.iter().rev().fold(0u32, |w, &b| w << 8 | u32::from(b));
    match storage {
        Storage::Half => each::<2>(bytes, texel, |b| f16::from_le_bytes(b).to_f64()),
        Storage::Float => each::<4>(bytes, texel, |b| f64::from(f32::from_le_bytes(b))),
        Storage::Double => each::<8>(bytes, texel, f64::from_le_bytes),
        Storage::Unorm8 => each::<1>(bytes, texel, |[b]| f64::from(b)),
        Storage::Unorm16 => each::<2>(bytes, texel, |b| f64::from(u16::from_le_bytes(b))),
        Storage::Rgb10a2 => {
            for (c, v) in texel.iter_mut().enumerate() {
                // the two bits of alpha are told on the scale of the others
                let code = word() >> (10 * c) & 0x3ff;
                *v = f64::from(if c == 3 { code * 341 } else { code });
            }
        }
        Storage::R11g11b10 => {
            let w = word();
            let bits = [(w & 0x7ff) << 4, (w >> 11 & 0x7ff) << 4, (w >> 22) << 5];
            for (v, b) in texel.iter_mut().zip(bits) {
                *v = f16::from_bits(u16::try_from(b).unwrap_or(0)).to_f64();
            }
        }
        Storage::Rgb9e5 => {
            let w = word();
            let step = coding::power_of_two(i32::try_from(w >> 27).unwrap_or(0) - 24);
            for (c, v) in texel.iter_mut().enumerate() {
                *v = f64::from(w >> (9 * c) & 0x1ff) * step;
            }
        }
        Storage::Rgbe => {
            let e = i32::from(bytes.get(3).copied().unwrap_or(0));
            let step = if e == 0 { 0.0 } else { coding::power_of_two(e - 136) };
            for (v, &m) in texel.iter_mut().zip(bytes) {
                *v = f64::from(m) * step;
            }
        }
        Storage::Rgbd => {
            let d = bytes.get(3).copied().unwrap_or(0);
            for (v, &code) in texel.iter_mut().zip(bytes) {
                *v = coding::rgbd(code, d);
            }
        }
        // not word by word: see `unpack`
        Storage::Bc4 | Storage::Bc5 | Storage::Bc6h | Storage::Bc6hSigned => {}
    }
}

fn each<const N: usize>(bytes: &[u8], texel: &mut [f64], f: impl Fn([u8; N]) -> f64) {
    for (v, b) in texel.iter_mut().zip(bytes.chunks_exact(N)) {
        if let Ok(b) = b.try_into() {
            *v = f(b);
        }
    }
}

/// Gives planes the names and ranges of the provenance, drops components that only hold fill values, and turns codes
/// into values. A component that is no fill was not written by this program and stays.
pub(super) fn finish(mut planes: Vec<Plane>, provenance: Option<&Claim>) -> Vec<Plane> {
    if let Some(Claim::Known(p)) = provenance {
        let encoding = p.encoding.as_ref();
        if encoding.is_some_and(|e| e.storage == Storage::Rgbd.id()) {
            planes = expand(planes);
        }
        name(&mut planes, p, encoding.map_or(&[], |e| &e.fill));
    }
    for plane in &mut planes {
        for v in &mut plane.values {
            *v = plane.sample.decode(*v, plane.range);
        }
    }
    planes
}

fn name(planes: &mut Vec<Plane>, p: &crate::grid::Provenance, told: &[f64]) {
    let n = p.channels.len();
    if n == 0 || planes.len() < n {
        return;
    }
    let filled = planes[n..].iter().enumerate().all(|(i, plane)| {
        let usual = if n + i == 3 { 1.0 } else { 0.0 };
        let value = told.get(i).copied().unwrap_or(usual);
        plane.values.iter().all(|&v| (plane.sample.decode(v, [0.0, 1.0]) - value).abs() == 0.0)
    });
    // more components than the writer gives a table of this many channels: another program wrote the file
    if !filled && planes.len() != n && !(n == 2 && planes.len() == 3) {
        return;
    }
    for (plane, channel) in planes.iter_mut().zip(&p.channels) {
        let [lo, hi] = channel.range;
        plane.name.clone_from(&channel.id);
        if lo < hi && (hi - lo).is_finite() {
            plane.range = [lo, hi];
        }
    }
    if filled {
        planes.truncate(n);
    }
}

/// Four planes of 8-bit codes as the three values of RGBD.
fn expand(mut planes: Vec<Plane>) -> Vec<Plane> {
    if planes.len() != 4 || planes.iter().any(|p| p.sample != Sample::Unorm8) {
        return planes;
    }
    let divisors = planes.pop().map(|p| p.values).unwrap_or_default();
    for plane in &mut planes {
        plane.sample = Sample::Rgbd;
        for (v, d) in plane.values.iter_mut().zip(&divisors) {
            *v = coding::rgbd(byte(*v), byte(*d));
        }
    }
    planes
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a code in 0 ..= 255")]
fn byte(code: f64) -> u8 {
    code as u8
}
