//! The numbers of a texel in a row: diffuse albedo, residual, and for each lobe albedo, constant, C and the code of its exponent.

use crate::maps::sbrdf::curve::{Placed, Texel};
use crate::maps::sbrdf::{CosineLobe, exponent, exponent_code};

/// A level: its size, and the numbers of its texels.
pub(super) type Flat = ([usize; 2], Vec<f32>);

/// Where lobes begin.
const HEAD: usize = 4;

/// Numbers of a lobe.
const LOBE: usize = 8;

/// Place of the diffuse albedo, of the residual, and within a lobe of the albedo with its constant and of C with the exponent.
pub(super) const DIFFUSE: usize = 0;
pub(super) const RESIDUAL: usize = 3;
pub(super) const ALBEDO: usize = 0;
pub(super) const SHAPE: usize = 4;

/// Numbers of a texel with so many lobes.
pub(super) const fn stride(lobes: usize) -> usize {
    HEAD + LOBE * lobes
}

/// Where a lobe begins.
pub(super) const fn lobe(j: usize) -> usize {
    HEAD + LOBE * j
}

/// Writes a texel.
#[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
pub(super) fn put(texel: &Texel, slot: &mut [f32]) {
    let lobes = texel.lobes.iter().flat_map(|p| {
        let ([r, g, b], [x, y, z]) = (p.albedo, p.lobe.c);
        [r, g, b, p.constant, x, y, z, exponent_code(p.lobe.n)]
    });
    let [r, g, b] = texel.diffuse;
    let all = [r, g, b, texel.residual].into_iter().chain(lobes);
    slot.iter_mut().zip(all).for_each(|(s, v)| *s = v as f32);
}

/// The numbers of one texel.
pub(super) fn flat(texel: &Texel) -> Vec<f32> {
    let mut out = vec![0.0; stride(texel.lobes.len())];
    put(texel, &mut out);
    out
}

/// The texel of these numbers.
pub(super) fn get(values: &[f32]) -> Texel {
    let three = |s: &[f32]| [s[0], s[1], s[2]].map(f64::from);
    let lobe = |s: &[f32]| Placed {
        albedo: three(s),
        constant: f64::from(s[3]),
        lobe: CosineLobe { c: three(&s[SHAPE..]), n: exponent(f64::from(s[7])) },
    };
    Texel {
        diffuse: three(values),
        residual: f64::from(values[RESIDUAL]),
        lobes: values[HEAD..].chunks_exact(LOBE).map(lobe).collect(),
    }
}

/// A lobe like the last of a texel, with an albedo of 0.
pub(super) fn black(texel: &[f32], lobes: usize) -> Vec<f32> {
    let mut out = texel[lobe(lobes - 1)..][..LOBE].to_vec();
    out[ALBEDO..ALBEDO + 3].fill(0.0);
    out
}
