//! The contact sheet of parameter maps: every channel as a picture with its histogram, and the worst texels as lit spheres.

use crate::encode::read::{Claim, Image, Plane};
use crate::maps::{Facet, Lobe, reflected};
use crate::picture::{PictureError, Space, write_png};
use glam::{DVec2, DVec3};
use serde_json::Value;

/// Pixels of a tile, and between tiles.
const TILE: usize = 160;
const GAP: usize = 8;

/// Tiles of a row.
const ROW: usize = 4;

/// Columns of a histogram.
const BINS: usize = 32;

/// A square of codes, RGB.
type Tile = Vec<[u8; 3]>;

/// The sheet of these files as PNG: for each of their channels the first level, and below it its histogram; then, for the worst texels that the
/// first file with any tells of, what the texel stands for (left half) and what is written (right half) as spheres under a light at 30°.
///
/// Channels of `distance`, `doubt`, `residual` and `energy` are drawn in false colour, black to white by way of red and yellow.
///
/// # Errors
/// [`PictureError`] for a sheet of no tiles.
pub fn sheet(images: &[Image]) -> Result<Vec<u8>, PictureError> {
    let channels = images.iter().flat_map(|i| i.channels.iter().map(move |c| (i, c)));
    let mut tiles: Vec<Vec<Tile>> = Vec::new();
    let all: Vec<[Tile; 2]> = channels.map(|(i, c)| [picture(i, c), histogram(c)]).collect();
    for row in all.chunks(ROW) {
        tiles.push(row.iter().map(|t| t[0].clone()).collect());
        tiles.push(row.iter().map(|t| t[1].clone()).collect());
    }
    let worst = images.iter().map(pictured).find(|p| !p.is_empty()).unwrap_or_default();
    for row in worst.chunks(ROW) {
        tiles.push(row.iter().map(sphere).collect());
    }
    put_together(&tiles)
}

fn put_together(tiles: &[Vec<Tile>]) -> Result<Vec<u8>, PictureError> {
    let columns = tiles.iter().map(Vec::len).max().unwrap_or(0);
    let size = [columns, tiles.len()].map(|n| n * (TILE + GAP) + GAP);
    let mut codes = vec![40u8; size[0] * size[1] * 3];
    for (row, line) in tiles.iter().enumerate() {
        for (column, tile) in line.iter().enumerate() {
            let [x0, y0] = [column, row].map(|k| GAP + k * (TILE + GAP));
            for (y, pixels) in tile.chunks(TILE).enumerate() {
                let at = 3 * ((y0 + y) * size[0] + x0);
                codes[at..at + 3 * pixels.len()].copy_from_slice(pixels.as_flattened());
            }
        }
    }
    if tiles.is_empty() {
        return Err(PictureError::Pixels { width: 0, height: 0 });
    }
    write_png(size, 3, &codes)
}

/// The part of a range where a value lies.
fn part(v: f64, [lo, hi]: [f64; 2]) -> f64 {
    if hi > lo && v.is_finite() { ((v - lo) / (hi - lo)).clamp(0.0, 1.0) } else { 0.0 }
}

/// What a channel is drawn over: its own range of codes, or [0, 1]; errors over [0, their largest].
fn range(plane: &Plane) -> [f64; 2] {
    let s = plane.statistics();
    if is_error(plane) {
        return [0.0, s.max.max(1e-9)];
    }
    let low = plane.range[0].min(if s.finite > 0 { s.min } else { 0.0 });
    [if low < 0.0 { low.min(-1.0) } else { 0.0 }, s.max.max(1.0)]
}

fn is_error(plane: &Plane) -> bool {
    ["distance", "doubt", "residual", "energy"].contains(&plane.name.as_str())
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "held within a byte")]
fn byte(v: f64) -> u8 {
    (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

fn picture(image: &Image, plane: &Plane) -> Tile {
    let range = range(plane);
    let (w, h) = (image.width.max(1), image.height.max(1));
    // whole texels, the longer side fills the tile
    let longer = w.max(h);
    let pixel = |x: usize, y: usize| {
        let [tx, ty] = [x * longer / TILE, y * longer / TILE];
        if tx >= w || ty >= h {
            return [40; 3];
        }
        let v = part(plane.values[ty * w + tx], range);
        if is_error(plane) { [v * 3.0, v * 3.0 - 1.0, v * 3.0 - 2.0].map(byte) } else { [byte(v); 3] }
    };
    (0..TILE * TILE).map(|i| pixel(i % TILE, i / TILE)).collect()
}

/// How many values lie in each of `bins` parts of the range.
pub(super) fn counts(plane: &Plane, range: [f64; 2], bins: usize) -> Vec<usize> {
    let mut out = vec![0; bins];
    for v in plane.values.iter().filter(|v| v.is_finite()) {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "held within the bins")]
        let bin = ((part(*v, range) * bins as f64) as usize).min(bins - 1);
        out[bin] += 1;
    }
    out
}

fn histogram(plane: &Plane) -> Tile {
    let counts = counts(plane, range(plane), BINS);
    let most = counts.iter().copied().max().unwrap_or(0).max(1);
    let pixel = |x: usize, y: usize| {
        let bar = counts[x * BINS / TILE] * TILE / most;
        if TILE - y <= bar { [200; 3] } else { [60; 3] }
    };
    (0..TILE * TILE).map(|i| pixel(i % TILE, i / TILE)).collect()
}

/// Facets and lobe of a worst texel.
struct Pictured {
    facets: Vec<Facet>,
    lobe: Lobe,
    /// The wide lobe beside it: width and share.
    wide: Option<[f64; 2]>,
}

/// The worst texels that a file tells of.
fn pictured(image: &Image) -> Vec<Pictured> {
    let Some(Claim::Unknown { text, .. }) = &image.provenance else { return Vec::new() };
    let Ok(json) = serde_json::from_str::<Value>(text) else { return Vec::new() };
    told(&json).into_iter().map(|(_, p)| p).collect()
}

/// The worst texels of a record as spheres: what each is, the side of its picture, and the pixels.
#[cfg(feature = "report")]
pub(super) fn worst_spheres(record: &Value) -> Vec<(String, usize, Vec<[u8; 3]>)> {
    told(record).iter().map(|(name, p)| (name.clone(), TILE, sphere(p))).collect()
}

/// The worst texels of a record with their names.
fn told(json: &Value) -> Vec<(String, Pictured)> {
    let numbers =
        |v: &Value| -> Vec<f64> { v.as_array().into_iter().flatten().filter_map(Value::as_f64).collect() };
    let one = |v: &Value| {
        let facet = |f: &Value| match numbers(f)[..] {
            [x, y, alpha, weight] if alpha > 0.0 => Some(Facet::from_slope(DVec2::new(x, y), alpha, weight)),
            _ => None,
        };
        let facets: Vec<Facet> = v["facets"].as_array()?.iter().filter_map(facet).collect();
        let [x, y, z, alpha_max, alpha_min, angle] = numbers(&v["lobe"])[..] else { return None };
        let normal = DVec3::new(x, y, z).try_normalize()?;
        let wide = match numbers(&v["wide"])[..] {
            [alpha, share] => Some([alpha, share]),
            _ => None,
        };
        let whole = |key: &str| v[key].as_u64().unwrap_or(0);
        let name = format!("level {} ({}, {})", whole("level"), whole("x"), whole("y"));
        Some((name, Pictured { facets, lobe: Lobe { normal, alpha_max, alpha_min, angle }, wide }))
    };
    json["pictured"].as_array().into_iter().flatten().filter_map(one).collect()
}

/// A sphere: on the left what the texel stands for, on the right what is written.
fn sphere(worst: &Pictured) -> Tile {
    let light = DVec3::new(-0.35, 0.35, 0.87).normalize();
    let pixel = |i: usize| {
        let [x, y] = [i % TILE, i / TILE].map(|k| (k as f64 + 0.5) / TILE as f64 * 2.1 - 1.05);
        let square = x * x + y * y;
        if square >= 1.0 {
            return [40; 3];
        }
        let n = DVec3::new(x, -y, (1.0 - square).sqrt());
        let t = (DVec3::X - n * n.x).normalize_or(DVec3::Y);
        let b = n.cross(t);
        let local = |w: DVec3| DVec3::new(t.dot(w), b.dot(w), n.dot(w));
        let (v, l) = (local(DVec3::Z), local(light));
        let radiance = if x < 0.0 {
            worst.facets.iter().map(|f| f.weight * reflected::light(&f.lobe(), v, l)).sum()
        } else {
            let narrow = reflected::light(&worst.lobe, v, l);
            worst.wide.map_or(narrow, |[alpha, share]| {
                let wide = reflected::light(&Lobe::isotropic(worst.lobe.normal, alpha), v, l);
                (1.0 - share) * narrow + share * wide
            })
        };
        [byte(Space::Srgb.encode(radiance / (1.0 + radiance))); 3]
    };
    (0..TILE * TILE).map(pixel).collect()
}
