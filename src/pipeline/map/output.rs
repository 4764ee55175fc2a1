//! The maps that are written: their channels, levels and files.

use super::input::Sources;
use super::{MapError, MapRequest};
use crate::cancel::Cancel;
use crate::encode::Storage;
use crate::encode::mips::{self, MipLevel, Mips};
use crate::functions::conversion::gltf_anisotropy;
use crate::grid::Channel;
use crate::maps::{Centre, Level, Shape, Texel, signs};
use crate::picture::shrink;

/// A container, and how each map is stored in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Output {
    /// Container id, of [`mips::CONTAINERS`].
    pub container: &'static str,
    /// Storage of the roughness and of what is packed with it.
    pub roughness: Storage,
    /// Storage of normals.
    pub normal: Storage,
    /// Storage of anisotropy.
    pub anisotropy: Storage,
    /// Storage of errors.
    pub error: Storage,
}

impl Output {
    /// The usual storages of a container: 8 bits for roughness and anisotropy, 16 for normals, halves for errors and in EXR.
    #[must_use]
    pub fn new(container: &'static str) -> Output {
        let (unorm8, unorm16) = (Storage::Unorm8, Storage::Unorm16);
        match container {
            "exr" => {
                let float = Storage::Float;
                Output { container, roughness: float, normal: float, anisotropy: float, error: Storage::Half }
            }
            "png" => {
                Output { container, roughness: unorm8, normal: unorm16, anisotropy: unorm8, error: unorm8 }
            }
            _ => {
                let error = Storage::Half;
                Output { container, roughness: unorm8, normal: unorm16, anisotropy: unorm8, error }
            }
        }
    }

    /// The storage of a map.
    pub(super) fn storage(&self, kind: Kind) -> Storage {
        match kind {
            Kind::Roughness => self.roughness,
            Kind::Normal => self.normal,
            Kind::Anisotropy => self.anisotropy,
            Kind::Error => self.error,
        }
    }
}

/// What a map holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Roughness,
    Normal,
    Anisotropy,
    Error,
}

impl Kind {
    pub(super) const fn id(self) -> &'static str {
        match self {
            Kind::Roughness => "roughness",
            Kind::Normal => "normal",
            Kind::Anisotropy => "anisotropy",
            Kind::Error => "error",
        }
    }
}

/// A map before it is rounded.
pub(super) struct Map {
    pub(super) kind: Kind,
    pub(super) channels: Vec<Channel>,
    pub(super) levels: Vec<MipLevel>,
}

/// A finished file.
pub(super) struct File {
    pub(super) name: String,
    pub(super) map: &'static str,
    pub(super) container: &'static str,
    pub(super) storage: Storage,
    pub(super) bytes: Vec<u8>,
}

fn channel(id: &str, meaning: &str, range: [f64; 2]) -> Channel {
    Channel { id: id.to_owned(), meaning: meaning.to_owned(), range, role: String::new() }
}

/// The kinds that a request writes.
fn kinds(request: &MapRequest) -> Vec<Kind> {
    let mut kinds = vec![Kind::Roughness];
    if request.filter.centre == Centre::Free {
        kinds.push(Kind::Normal);
    }
    if request.filter.shape == Shape::Anisotropic && request.filter.rule.anisotropic {
        kinds.push(Kind::Anisotropy);
    }
    kinds.push(Kind::Error);
    kinds
}

/// Every map of a request.
pub(super) fn plan(request: &MapRequest, sources: &Sources, levels: &[Level]) -> Vec<Map> {
    kinds(request).into_iter().map(|kind| map(kind, request, sources, levels)).collect()
}

fn map(kind: Kind, request: &MapRequest, sources: &Sources, levels: &[Level]) -> Map {
    let signed = [-1.0, 1.0];
    let unit = [0.0, 1.0];
    let (channels, levels) = match kind {
        Kind::Roughness => return roughness(sources, levels),
        Kind::Normal => {
            let down = request.normal.as_ref().is_some_and(|n| n.convention.green_down);
            let sense = if down { -1.0 } else { 1.0 };
            let block = request.outputs.iter().any(|o| o.normal == Storage::Bc5);
            let n = if block { 2 } else { 3 };
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
            let level = |(level, own): (&Level, &Vec<[f32; 2]>)| MipLevel {
                size: level.size,
                values: level.texels.iter().zip(own).flat_map(|(t, [x, y])| [*x, *y, strength(t)]).collect(),
            };
            (channels, levels.iter().zip(&directions).map(level).collect())
        }
        Kind::Error => {
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
    Map { kind, channels, levels }
}

fn each(levels: &[Level], values: impl Fn(&Texel) -> Vec<f32>) -> Vec<MipLevel> {
    let level = |l: &Level| MipLevel { size: l.size, values: l.texels.iter().flat_map(&values).collect() };
    levels.iter().map(level).collect()
}

/// Strength of `KHR_materials_anisotropy`.
#[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
fn strength(t: &Texel) -> f32 {
    let lobe = t.lobe();
    gltf_anisotropy([lobe.alpha_max, lobe.alpha_min]).1 as f32
}

/// The roughness, among the channels that it was packed with; those are shrunk by area.
fn roughness(sources: &Sources, levels: &[Level]) -> Map {
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
        let mut values = Vec::with_capacity(level.texels.len() * n);
        for (i, texel) in level.texels.iter().enumerate() {
            values.extend((0..n).map(|c| if c == *index { texel.roughness } else { planes[c][i] }));
        }
        out.push(MipLevel { size: level.size, values });
    }
    Map { kind: Kind::Roughness, channels: channels.collect(), levels: out }
}

/// The bytes of all files.
pub(super) fn files(
    request: &MapRequest,
    maps: &[Map],
    record: &super::MapRecord,
    cancel: &Cancel,
) -> Result<Vec<File>, MapError> {
    let mut out = Vec::new();
    for map in maps {
        let kind = map.kind;
        for output in &request.outputs {
            let storage = output.storage(kind);
            let provenance = record.of(kind.id(), &map.channels, storage);
            let pyramid = Mips {
                channels: &map.channels,
                levels: &map.levels,
                storage,
                provenance_json: &provenance,
                identity: &record.recipe.hash,
                cancel,
            };
            let failed = |source| match source {
                crate::encode::EncodeError::Cancelled(e) => MapError::from(e),
                source => MapError::Encode { map: kind.id().to_owned(), source },
            };
            for (end, bytes) in mips::encode(output.container, &pyramid).map_err(failed)? {
                let name = format!("{}.{}{end}", request.name, kind.id());
                out.push(File { name, map: kind.id(), container: output.container, storage, bytes });
            }
        }
    }
    Ok(out)
}
