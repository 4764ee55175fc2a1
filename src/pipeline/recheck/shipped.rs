//! A table that an engine ships, against the integrals that the engine's recipe says it holds, read as the engine reads it.

use crate::cancel::{Cancel, Cancelled};
use crate::encode::read::{self, Image, ReadError, Sample};
use crate::encode::{Storage, raw_rgbd};
use crate::grid::axis::count;
use crate::grid::provenance::Reconstruction;
use crate::grid::table::{Extreme, named};
use crate::grid::{Axis, Grid, Texel};
use crate::plan::{Plan, PlannedTable};
use crate::verify::reconstruction::Probe;
use crate::verify::seeds::Seeds;
use half::f16;
use rayon::prelude::*;
use serde::Serialize;

/// Points between the texels.
const POINTS: usize = 1 << 16;
/// Texels at which conventions are compared.
const TEXELS: usize = 512;
/// How many times nearer in the mean the numbers must be to those of another convention for that to be named.
const NEARER: f64 = 4.0;

/// What was found of a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shipped {
    /// Engine id.
    pub engine: String,
    /// Name of the table in the engine's recipe.
    pub table: String,
    /// blake3 of the file.
    pub blake3: String,
    /// Between the texels, as the engine reads them.
    pub read: Reconstruction,
    /// At the texels, which the engine's generator set out to compute.
    pub texels: Extreme,
    /// Mean over texels and channels.
    pub mean: f64,
    /// What its conventions are, where they are not those of its reader.
    pub conventions: Vec<String>,
}

/// Why a file was not compared.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ShippedError {
    /// It cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// No table of the engine has its size.
    #[error("{got} are not the size of a table of {engine}; there is {allowed}")]
    Size {
        /// Engine.
        engine: String,
        /// Numbers of the file.
        got: String,
        /// Tables with their sizes.
        allowed: String,
    },
    /// Stopped from outside.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// The numbers of a file: of a picture, or of a text with lists of numbers.
struct Numbers {
    /// Width and height of a picture.
    size: Option<[usize; 2]>,
    /// A list; components interleaved.
    values: Vec<f64>,
    components: usize,
    /// 8-bit codes: they may be RGBD.
    codes: bool,
}

/// Compares a file with the table of an engine that has its size; `table` names one where several have.
///
/// # Errors
/// [`ShippedError`].
pub fn compare(
    (engine, plan): (&str, &Plan),
    bytes: &[u8],
    table: Option<&str>,
    cancel: &Cancel,
) -> Result<Shipped, ShippedError> {
    let lists = numbers(bytes, cancel)?;
    let wanted = |p: &&PlannedTable| table.is_none_or(|name| p.name() == name);
    let mut found = None;
    for planned in plan.tables.iter().filter(wanted) {
        if let Some(values) = lists.iter().find_map(|list| fit(list, planned)) {
            found = Some((planned, values));
            break;
        }
    }
    let Some((planned, values)) = found else {
        let got = lists.iter().map(|l| match l.size {
            Some([w, h]) => format!("{w} x {h} texels of {} components", l.components),
            None => format!("{} numbers", l.values.len()),
        });
        let allowed = plan.tables.iter().filter(wanted).map(|p| {
            let size: Vec<String> = p.bound.spec.grid.axes().iter().map(|a| a.len.to_string()).collect();
            format!("{} ({} of {})", p.name(), size.join(" x "), p.bound.spec.layout.channels.len())
        });
        return Err(ShippedError::Size {
            engine: engine.to_owned(),
            got: got.collect::<Vec<_>>().join(", "),
            allowed: allowed.collect::<Vec<_>>().join(", "),
        });
    };
    let probe = Probe::until(cancel, &planned.bound, planned.tolerance, POINTS);
    let read = probe.measure_without_offset(&values).unwrap_or_else(|| probe.measure(&values));
    cancel.check()?;
    let (texels, mean) = at_texels(planned, &planned.bound.spec.grid, &values, |c| c, cancel);
    let conventions = conventions(planned, &values, mean, cancel);
    cancel.check()?;
    Ok(Shipped {
        engine: engine.to_owned(),
        table: planned.name().to_owned(),
        blake3: blake3::hash(bytes).to_hex().to_string(),
        read,
        texels,
        mean,
        conventions,
    })
}

fn numbers(bytes: &[u8], cancel: &Cancel) -> Result<Vec<Numbers>, ShippedError> {
    match read::read_bytes_until(cancel, bytes) {
        Ok(image) => Ok(vec![of_picture(&image)]),
        Err(unknown @ ReadError::Unknown(_)) => {
            let text = std::str::from_utf8(bytes).map_err(|_| unknown)?;
            let list = |values: Vec<f64>| Numbers { size: None, components: 1, codes: false, values };
            Ok(lists(text).into_iter().map(list).collect())
        }
        Err(e) => Err(e.into()),
    }
}

fn of_picture(image: &Image) -> Numbers {
    let n = image.channels.len();
    let value = |i: usize| image.channels[i % n].values[i / n];
    Numbers {
        size: Some([image.width, image.height]),
        values: (0..image.width * image.height * n).map(value).collect(),
        components: n,
        codes: n == 4 && image.channels.iter().all(|c| c.sample == Sample::Unorm8),
    }
}

/// Runs of numbers between commas, line by line: decimals, or the bits of halves in hexadecimal; and all of them as one.
fn lists(text: &str) -> Vec<Vec<f64>> {
    let number = |word: &str| match word.strip_prefix("0x") {
        Some(bits) => Some(f16::from_bits(u16::from_str_radix(bits, 16).ok()?).to_f64()),
        None => word.trim_end_matches(['f', 'F']).parse::<f64>().ok(),
    };
    let mut lists: Vec<Vec<f64>> = vec![Vec::new()];
    for line in text.lines() {
        let words =
            line.trim().trim_end_matches(',').split([',', ' ']).map(str::trim).filter(|w| !w.is_empty());
        match words.map(number).collect::<Option<Vec<f64>>>() {
            Some(line) => lists.last_mut().into_iter().for_each(|l| l.extend(&line)),
            None if lists.last().is_some_and(|l| !l.is_empty()) => lists.push(Vec::new()),
            None => {}
        }
    }
    lists.retain(|l| !l.is_empty());
    let all = lists.concat();
    if lists.len() > 1 {
        lists.push(all);
    }
    lists
}

/// The numbers as `[texel][channel]` of a table, if it has their size.
fn fit(numbers: &Numbers, planned: &PlannedTable) -> Option<Vec<f64>> {
    let grid = &planned.bound.spec.grid;
    let channels = &planned.bound.spec.layout.channels;
    let n = channels.len();
    let [w, h, d] = grid.extent();
    let storage = planned.outputs.first().map(|o| o.storage);
    match numbers.size {
        Some(size) if size != [w, h * d] => return None,
        // a list says nothing of its shape: as many numbers as the table has, or four components for its channels
        None if numbers.values.len() != grid.len() * n => return None,
        _ => {}
    }
    let components = if numbers.size.is_some() { numbers.components } else { n };
    if components < n {
        return None;
    }
    let texels = numbers.values.chunks_exact(components);
    if numbers.codes && storage == Some(Storage::Rgbd) {
        return Some(texels.flat_map(|t| raw_rgbd([t[0], t[1], t[2], t[3]]).into_iter().take(n)).collect());
    }
    let coded = storage.is_some_and(Storage::is_bounded);
    let value = |(c, v): (usize, &f64)| {
        let [lo, hi] = channels[c].range;
        if coded { lo + v * (hi - lo) } else { *v }
    };
    Some(texels.flat_map(|t| t[..n].iter().enumerate().map(value)).collect())
}

/// Largest and mean difference from integrals at the texels of a grid; `channel` is which channel a component is taken for.
fn at_texels(
    planned: &PlannedTable,
    grid: &Grid,
    values: &[f64],
    channel: impl Fn(usize) -> usize + Sync,
    cancel: &Cancel,
) -> (Extreme, f64) {
    let bound = &planned.bound;
    let ids: Vec<&str> = bound.spec.layout.ids().collect();
    let n = ids.len();
    let mut seeds = Seeds::new(0x5417);
    let chosen: Vec<usize> = match grid.len() <= TEXELS {
        true => (0..grid.len()).collect(),
        false => (0..TEXELS).map(|_| seeds.index(grid.len())).collect(),
    };
    let one = |texel: &usize| {
        cancel.check().ok()?;
        let made = bound.baker.texel(grid.texel(*texel).values(), planned.tolerance).ok()?;
        let off = |c: usize| (values[texel * n + c] - made.value[channel(c)]).abs();
        Some((*texel, (0..n).map(off).collect::<Vec<f64>>()))
    };
    let found: Vec<(usize, Vec<f64>)> = chosen.par_iter().filter_map(one).collect();
    let mut largest = Extreme::default();
    let mut sum = 0.0;
    for (texel, off) in &found {
        for (c, off) in off.iter().enumerate() {
            sum += off;
            if *off > largest.value {
                let at = named(grid, &grid.texel(*texel));
                largest = Extreme { value: *off, channel: ids[c].to_owned(), at };
            }
        }
    }
    (largest, sum / count((found.len() * n).max(1)))
}

/// Conventions under which the numbers are much nearer to integrals, and those of the recipe that the reader does not know of.
fn conventions(planned: &PlannedTable, values: &[f64], mean: f64, cancel: &Cancel) -> Vec<String> {
    let grid = &planned.bound.spec.grid;
    let axes = grid.axes();
    let mut told = Vec::new();
    for axis in axes.iter().filter(|a| a.offset.abs() > 0.0) {
        let id = axis.quantity.id;
        told.push(format!(
            "texels of {id} hold values {} texel further on than the reader takes them for",
            axis.offset
        ));
    }
    let mut best: Option<(f64, String)> = None;
    let mut consider = |off: f64, words: String| {
        if NEARER * off < mean && best.as_ref().is_none_or(|b| off < b.0) {
            best = Some((off, words));
        }
    };
    for (i, axis) in axes.iter().enumerate() {
        for (other, words) in others(axis) {
            let changed =
                axes.iter().enumerate().map(|(j, a)| if i == j { other.clone() } else { a.clone() });
            let Ok(grid) = Grid::new(changed.collect()) else { continue };
            let (_, off) = at_texels(planned, &grid, values, |c| c, cancel);
            consider(off, format!("{}: the numbers are those of an axis with {words}", axis.quantity.id));
        }
    }
    let n = planned.bound.spec.layout.channels.len();
    if n > 1 {
        let (_, off) = at_texels(planned, grid, values, |c| if c < 2 { 1 - c } else { c }, cancel);
        consider(off, "the first two channels have changed places".to_owned());
    }
    told.extend(best.map(|(_, words)| words));
    told
}

fn others(axis: &Axis) -> Vec<(Axis, String)> {
    let (texel, words) = match axis.texel {
        Texel::Center => (Texel::Endpoint, "texels on the ends"),
        Texel::Endpoint => (Texel::Center, "texels at centres"),
    };
    let direction = match axis.direction {
        crate::grid::Direction::Ascending => crate::grid::Direction::Descending,
        crate::grid::Direction::Descending => crate::grid::Direction::Ascending,
    };
    let mut all = vec![
        (Axis { texel, ..axis.clone() }, words.to_owned()),
        (Axis { direction, ..axis.clone() }, "the other direction".to_owned()),
    ];
    for offset in [-1.0, -0.5, 0.0, 0.5, 1.0] {
        if (axis.offset - offset).abs() > 0.0 {
            all.push((Axis { offset, ..axis.clone() }, format!("an offset of {offset} texels")));
        }
    }
    all
}
