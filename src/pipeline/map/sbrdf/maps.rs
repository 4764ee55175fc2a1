//! The maps of lobes: channels, levels, and what storing costs the lobes.

use super::super::MapError;
use super::super::output::{Map, channel, failed, pyramid};
use super::{Found, texels};
use crate::cancel::Cancel;
use crate::encode::mips::{self, MipLevel};
use crate::grid::Channel;
use crate::maps::sbrdf::curve::{Placed, Texel};
use crate::maps::sbrdf::{NORMALISATION, exponent, integral};
use crate::maps::{Level, signs};
use crate::plan::map::{Kind, Output};
use crate::verify::seeds::Seeds;
use rayon::prelude::*;

/// Texels whose storage is measured.
const MEASURED: usize = 48;

/// A map of lobes; none of another kind.
pub(in super::super) fn map(
    kind: Kind,
    found: &Found,
    constants: bool,
    levels: &[Level<'_>],
) -> Option<(Vec<Channel>, Vec<MipLevel>)> {
    Some(match kind {
        Kind::Diffuse => (found.colour("diffuse", texels::DIFFUSE), found.part(texels::DIFFUSE, 3)),
        Kind::Albedo(j) => {
            let at = texels::lobe(j) + texels::ALBEDO;
            let mut channels = found.colour("albedo", at);
            if constants {
                let most = found.largest(at + 3, 1);
                let meaning = "one over the largest integral of the lobe, 1/sr";
                channels.push(channel("constant", meaning, [0.0, most]));
            }
            let count = channels.len();
            (channels, found.part(at, count))
        }
        Kind::Shape(j) => {
            let c = |id: &str| channel(id, "diagonal element of C; max |C| = 1", [-1.0, 1.0]);
            let code = channel("exponent", "ln(n) over the logarithm of the largest exponent", [0.0, 1.0]);
            (vec![c("c.x"), c("c.y"), c("c.z"), code], found.part(texels::lobe(j) + texels::SHAPE, 4))
        }
        Kind::Tangent => {
            let signed = [-1.0, 1.0];
            let channels = vec![
                channel("tangent.x", "cosine of the angle of the first axis of C from the tangent", signed),
                channel("tangent.y", "its sine", signed),
            ];
            let directions = signs::directions(levels);
            let level = |(level, own): (&Level<'_>, &Vec<[f32; 2]>)| MipLevel {
                size: level.size,
                values: own.iter().flatten().copied().collect(),
            };
            (channels, levels.iter().zip(&directions).map(level).collect())
        }
        Kind::Residual => residual(found, levels),
        Kind::Normalisation => normalisation(),
        _ => return None,
    })
}

impl Found {
    /// The largest of some numbers of all texels, at least 1.
    fn largest(&self, at: usize, count: usize) -> f64 {
        let stride = texels::stride(self.lobes);
        let all = self.levels.iter().flat_map(|l| l.1.chunks_exact(stride));
        f64::from(all.fold(1.0f32, |m, t| t[at..at + count].iter().fold(m, |m, v| m.max(*v))))
    }

    fn colour(&self, what: &str, at: usize) -> Vec<Channel> {
        let range = [0.0, self.largest(at, 3)];
        ["r", "g", "b"].map(|c| channel(&format!("{what}.{c}"), "albedo, linear", range)).to_vec()
    }

    /// Some numbers of all texels of all levels.
    fn part(&self, at: usize, count: usize) -> Vec<MipLevel> {
        let stride = texels::stride(self.lobes);
        let level = |(size, values): &texels::Flat| MipLevel {
            size: *size,
            values: values.chunks_exact(stride).flat_map(|t| t[at..at + count].iter().copied()).collect(),
        };
        self.levels.iter().map(level).collect()
    }
}

fn residual(found: &Found, levels: &[Level<'_>]) -> (Vec<Channel>, Vec<MipLevel>) {
    let channels = vec![
        channel("residual", "of the lobes, relative, in the norm that the record tells", [0.0, 1.0]),
        channel("distance", "D of the filter: half the integral of |footprint - lobe| of GGX", [0.0, 1.0]),
    ];
    let stride = texels::stride(found.lobes);
    let error = |((size, values), level): (&texels::Flat, &Level<'_>)| MipLevel {
        size: *size,
        values: values
            .chunks_exact(stride)
            .zip(level.iter())
            .flat_map(|(t, own)| [t[texels::RESIDUAL].min(1.0), own.distance.clamp(0.0, 1.0)])
            .collect(),
    };
    (channels, found.levels.iter().zip(levels).map(error).collect())
}

/// u and n of a place of the table.
fn place(x: f64, y: f64) -> (f64, f64) {
    let [w, h] = NORMALISATION;
    let v = 2.0 * x / (w - 1) as f64 - 1.0;
    (v * v.abs(), exponent(y / (h - 1) as f64))
}

/// What the table holds at a place: N over that along the normal with the cosine and without, and its root of order n + 1.
fn entry(x: f64, y: f64) -> [f64; 3] {
    let (u, n) = place(x, y);
    let ratio = |inside| integral::integral(n, u, inside) / integral::along(n, inside);
    [ratio(true), ratio(false), integral::root(n, u, true)]
}

#[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
fn normalisation() -> (Vec<Channel>, Vec<MipLevel>) {
    let unit = [0.0, 1.0];
    let channels = vec![
        channel("ratio", "integral of the lobe with the cosine, over 2 pi/(n + 2)", unit),
        channel("ratio.plain", "integral of the lobe without the cosine, over 2 pi/(n + 1)", unit),
        channel("root", "ratio to the power 1/(n + 1): sqrt(1 - u^2) for large n below the horizon", unit),
    ];
    let [w, h] = NORMALISATION;
    let row = |y: usize| (0..w).flat_map(move |x| entry(x as f64, y as f64)).map(|v| v.min(1.0) as f32);
    let rows: Vec<Vec<f32>> = (0..h).into_par_iter().map(|y| row(y).collect()).collect();
    (channels, pyramid(NORMALISATION, 3, rows.concat()))
}

/// The largest error of the table half way between its texels, read linearly: of each channel.
pub(super) fn normalisation_error() -> [f64; 3] {
    let [w, h] = NORMALISATION;
    let cell = |y: usize| {
        (0..w - 1).fold([0.0f64; 3], |worst, x| {
            let (x, y) = (x as f64, y as f64);
            let corners = [(x, y), (x + 1.0, y), (x, y + 1.0), (x + 1.0, y + 1.0)].map(|(x, y)| entry(x, y));
            let truth = entry(x + 0.5, y + 0.5);
            std::array::from_fn(|c| {
                let read = corners.iter().map(|e| e[c]).sum::<f64>() / 4.0;
                worst[c].max((read - truth[c]).abs())
            })
        })
    };
    let rows: Vec<[f64; 3]> = (0..h - 1).into_par_iter().map(cell).collect();
    rows.iter().fold([0.0; 3], |m, r| std::array::from_fn(|c| m[c].max(r[c])))
}

/// Mean and largest difference between the lobes of the first level before and after storage in an output, relative as residuals are:
/// at seeded texels.
pub(super) fn storage_error(
    found: &Found,
    maps: &[Map],
    output: Output,
    cancel: &Cancel,
) -> Result<[f64; 2], MapError> {
    let Some((size, values)) = found.levels.first() else { return Ok([0.0; 2]) };
    let stride = texels::stride(found.lobes);
    let count = size[0] * size[1];
    let stored = stored(found, maps, output, cancel)?;
    let mut chosen: Vec<usize> = match count {
        n if n <= MEASURED => (0..n).collect(),
        n => (0..MEASURED as u64).map(|i| Seeds::new(i).index(n)).collect(),
    };
    chosen.sort_unstable();
    chosen.dedup();
    let one = |t: &usize| -> Result<f64, MapError> {
        cancel.check()?;
        let own = t * stride..(t + 1) * stride;
        let (a, b) = (texels::get(&values[own.clone()]), texels::get(&stored[own]));
        let problem = found.problems.at(*t);
        // the worst of the three colours
        let of = |t: &Texel, c: usize| {
            let lobes: Vec<_> = t.lobes.iter().map(|p| p.lobe).collect();
            // a reader takes the constant that is written
            let own = |p: &Placed| if found.constants { p.constant * p.lobe.largest() } else { 1.0 };
            let albedos: Vec<f64> =
                std::iter::once(t.diffuse[c]).chain(t.lobes.iter().map(|p| p.albedo[c] * own(p))).collect();
            (lobes, albedos)
        };
        let lost = |c: usize| {
            let ((la, wa), (lb, wb)) = (of(&a, c), of(&b, c));
            // a colour that reflects nothing loses nothing
            if wa.iter().all(|w| *w <= 0.0) { 0.0 } else { problem.difference((&la, &wa), (&lb, &wb)) }
        };
        Ok((0..3).map(lost).fold(0.0, f64::max))
    };
    let found: Result<Vec<f64>, MapError> = chosen.par_iter().map(one).collect();
    let found = found?;
    let mean = found.iter().sum::<f64>() / found.len().max(1) as f64;
    Ok([mean, found.iter().fold(0.0, |m, v| m.max(*v))])
}

/// The first level as a reader of the output finds it.
fn stored(found: &Found, maps: &[Map], output: Output, cancel: &Cancel) -> Result<Vec<f32>, MapError> {
    let stride = texels::stride(found.lobes);
    let mut out = found.levels.first().map_or_else(Vec::new, |l| l.1.clone());
    for map in maps {
        let place = match map.kind {
            Kind::Diffuse => texels::DIFFUSE,
            Kind::Albedo(j) => texels::lobe(j) + texels::ALBEDO,
            Kind::Shape(j) => texels::lobe(j) + texels::SHAPE,
            _ => continue,
        };
        let pyramid = map.mips(output.storage(map.kind), cancel);
        let read = mips::stored(&pyramid, 0).map_err(|e| failed(map.kind, e))?;
        for (t, own) in out.chunks_exact_mut(stride).zip(read.chunks_exact(map.channels.len())) {
            t[place..place + own.len()].copy_from_slice(own);
        }
    }
    Ok(out)
}
