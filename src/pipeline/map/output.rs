//! The maps that are written: their channels, levels and files.

use super::MapError;
use super::input::Sources;
use super::sbrdf::{self, Found};
use crate::cancel::Cancel;
use crate::encode::mips::{self, MipLevel, Mips};
use crate::encode::{EncodeError, Storage};
use crate::functions::conversion::gltf_anisotropy;
use crate::grid::Channel;
use crate::maps::{Level, Texel, signs};
use crate::picture::{halved, shrink};
use crate::plan::map::{self, Kind, MapRequest, PlannedMap};

/// A map before it is rounded.
pub(super) struct Map {
    pub(super) kind: Kind,
    pub(super) channels: Vec<Channel>,
    pub(super) levels: Vec<MipLevel>,
    /// The bytes of each level in each storage of blocks that is asked for.
    blocks: Vec<(Storage, Vec<Vec<u8>>)>,
}

impl Map {
    /// As it is stored; in blocks that are compressed once.
    pub(super) fn mips<'a>(&'a self, storage: Storage, cancel: &'a Cancel) -> Mips<'a> {
        let blocks = self.blocks.iter().find(|(s, _)| *s == storage).map_or(&[][..], |(_, b)| b);
        let (channels, levels) = (&self.channels, &self.levels);
        Mips { channels, levels, storage, blocks, provenance_json: "", identity: "", cancel }
    }

    /// With the blocks of every storage that a request asks for.
    fn compressed(mut self, request: &MapRequest, cancel: &Cancel) -> Result<Map, MapError> {
        for output in &request.outputs {
            let storage = output.storage(self.kind);
            if storage.is_block() && !self.blocks.iter().any(|(s, _)| *s == storage) {
                let made = mips::blocks(&self.mips(storage, cancel)).map_err(|e| failed(self.kind, e))?;
                self.blocks.push((storage, made));
            }
        }
        Ok(self)
    }
}

pub(super) fn failed(kind: Kind, source: EncodeError) -> MapError {
    match source {
        EncodeError::Cancelled(e) => MapError::from(e),
        source => MapError::Encode { map: kind.id().to_owned(), source },
    }
}

/// A finished file.
pub(super) struct File {
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) level: Option<usize>,
    pub(super) container: &'static str,
    pub(super) storage: Storage,
    pub(super) channels: Vec<String>,
    pub(super) bytes: Vec<u8>,
}

pub(super) fn channel(id: &str, meaning: &str, range: [f64; 2]) -> Channel {
    Channel { id: id.to_owned(), meaning: meaning.to_owned(), range, role: String::new() }
}

/// Every map of a request.
pub(super) fn plan(
    request: &MapRequest,
    sources: &Sources,
    levels: &[Level<'_>],
    lobes: Option<&Found>,
    cancel: &Cancel,
) -> Result<Vec<Map>, MapError> {
    let constants = request.sbrdf.as_ref().is_some_and(|s| s.constants());
    let one = |kind| {
        let of_lobes = lobes.and_then(|found| sbrdf::map(kind, found, constants, levels));
        let made = match of_lobes {
            Some((channels, levels)) => Map { kind, channels, levels, blocks: Vec::new() },
            None => map(kind, request, sources, levels),
        };
        made.compressed(request, cancel)
    };
    request.kinds().into_iter().map(one).collect()
}

/// All levels of a picture of some channels: means of areas.
pub(super) fn pyramid(size: [usize; 2], channels: usize, values: Vec<f32>) -> Vec<MipLevel> {
    let mut planes: Vec<Vec<f32>> =
        (0..channels).map(|c| values.iter().skip(c).step_by(channels).copied().collect()).collect();
    let mut out = vec![MipLevel { size, values }];
    for pair in halved(size[0], size[1]).windows(2) {
        planes.iter_mut().for_each(|p| *p = shrink(p, pair[0], pair[1]));
        let texel = |i: usize| planes.iter().map(move |p| p[i]);
        out.push(MipLevel { size: pair[1], values: (0..pair[1][0] * pair[1][1]).flat_map(texel).collect() });
    }
    out
}

fn map(kind: Kind, request: &MapRequest, sources: &Sources, levels: &[Level<'_>]) -> Map {
    let signed = [-1.0, 1.0];
    let unit = [0.0, 1.0];
    let (channels, levels) = match kind {
        Kind::Roughness => return roughness(sources, levels),
        Kind::Normal => {
            let down = request.normal.as_ref().is_some_and(|n| n.convention.green_down);
            let sense = if down { -1.0 } else { 1.0 };
            let n = if request.drops_z() { 2 } else { 3 };
            let meanings = ["n.x, along the tangent", "n.y, along the bitangent", "n.z, along the normal"];
            let ids = ["normal.x", "normal.y", "normal.z"];
            let channels = (0..n).map(|c| channel(ids[c], meanings[c], signed)).collect();
            let values = |t: &Texel| [t.normal[0], sense * t.normal[1], t.normal[2]][..n].to_vec();
            (channels, each(levels, values))
        }
        Kind::Anisotropy => {
            let channels = vec![
                channel("direction.x", "cosine of the angle of alpha_max from the tangent", signed),
                channel("direction.y", "its sine", signed),
                channel("strength", "sqrt((alpha_max - alpha_min)/(1 - alpha_min))", unit),
            ];
            let directions = signs::directions(levels);
            let level = |(level, own): (&Level<'_>, &Vec<[f32; 2]>)| MipLevel {
                size: level.size,
                values: level.iter().zip(own).flat_map(|(t, [x, y])| [*x, *y, strength(&t)]).collect(),
            };
            (channels, levels.iter().zip(&directions).map(level).collect())
        }
        Kind::Wide => {
            let channels = vec![
                channel("wide.roughness", "r = sqrt(alpha) of the wide lobe about the same normal", unit),
                channel(
                    "wide.weight",
                    "its share w of the density: (1 - w) D(roughness) + w D(wide.roughness)",
                    unit,
                ),
            ];
            (channels, each(levels, |t| t.wide.to_vec()))
        }
        Kind::Conversion => {
            sources.certificate.as_ref().map_or_else(|| (Vec::new(), Vec::new()), |c| c.map())
        }
        _ => {
            let channels = vec![
                channel(
                    "distance",
                    "D: half the integral of |footprint - lobe|, 0 the same, 1 disjoint",
                    unit,
                ),
                channel("doubt", "how far D may be wrong", unit),
            ];
            (channels, each(levels, |t| vec![t.distance.clamp(0.0, 1.0), t.doubt.min(1.0)]))
        }
    };
    Map { kind, channels, levels, blocks: Vec::new() }
}

fn each(levels: &[Level<'_>], values: impl Fn(&Texel) -> Vec<f32>) -> Vec<MipLevel> {
    let level =
        |l: &Level<'_>| MipLevel { size: l.size, values: l.iter().flat_map(|t| values(&t)).collect() };
    levels.iter().map(level).collect()
}

/// Strength of `KHR_materials_anisotropy`.
#[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
fn strength(t: &Texel) -> f32 {
    let lobe = t.lobe();
    gltf_anisotropy([lobe.alpha_max, lobe.alpha_min]).1 as f32
}

/// The roughness, among the channels that it was packed with; those are shrunk by area.
fn roughness(sources: &Sources, levels: &[Level<'_>]) -> Map {
    let own = channel(
        "roughness",
        "r = sqrt(alpha) of the lobe; of an anisotropic one that of alpha_min",
        [0.0, 1.0],
    );
    let Some((picture, index)) = &sources.packed else {
        return Map {
            kind: Kind::Roughness,
            channels: vec![own],
            levels: each(levels, |t| vec![t.roughness]),
            blocks: Vec::new(),
        };
    };
    let channels = picture.planes.iter().enumerate().map(|(c, plane)| match c {
        c if c == *index => own.clone(),
        _ => channel(&plane.name, "as in the image; means of the areas of texels", [0.0, 1.0]),
    });
    let n = picture.planes.len();
    let mut planes: Vec<Vec<f32>> = picture.planes.iter().map(|p| p.values.clone()).collect();
    let mut out: Vec<MipLevel> = Vec::with_capacity(levels.len());
    let mut before = [picture.width, picture.height];
    for level in levels {
        if level.size != before {
            for (_, plane) in planes.iter_mut().enumerate().filter(|(c, _)| c != index) {
                *plane = shrink(plane, before, level.size);
            }
            before = level.size;
        }
        let mut values = Vec::with_capacity(level.len() * n);
        for (i, texel) in level.iter().enumerate() {
            values.extend((0..n).map(|c| if c == *index { texel.roughness } else { planes[c][i] }));
        }
        out.push(MipLevel { size: level.size, values });
    }
    Map { kind: Kind::Roughness, channels: channels.collect(), levels: out, blocks: Vec::new() }
}

/// The bytes of all files.
pub(super) fn files(
    planned: &PlannedMap,
    maps: &[Map],
    record: &super::MapRecord,
    cancel: &Cancel,
) -> Result<Vec<File>, MapError> {
    let mut out = Vec::new();
    for map in maps {
        let kind = map.kind;
        for output in &planned.asked.outputs {
            let storage = output.storage(kind);
            let provenance = record.of(kind.id(), &map.channels, storage);
            let (provenance_json, identity) = (provenance.as_str(), planned.identity.as_str());
            let pyramid = Mips { provenance_json, identity, ..map.mips(storage, cancel) };
            let files = mips::encode(output.encoder, &pyramid).map_err(|e| failed(kind, e))?;
            let each = files.len() > 1 || !output.encoder.holds_all_levels();
            for (k, (end, bytes)) in files.into_iter().enumerate() {
                let (name, level) = (map::file(planned.name(), kind, &end), each.then_some(k));
                let channels = map.channels.iter().map(|c| c.id.clone()).collect();
                out.push(File {
                    name,
                    kind,
                    level,
                    container: output.encoder.id(),
                    storage,
                    channels,
                    bytes,
                });
            }
        }
    }
    Ok(out)
}
