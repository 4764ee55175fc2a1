//! What the files of a map say of themselves: inputs, rule, and how far every level is from the texels that it stands for.

use super::RoughnessInput;
use super::certificate::{Certificate, CertificateRecord};
use super::check::Measured;
use super::input::Sources;
use super::output::File;
use super::pictured::{self, Pictured};
use super::sbrdf::SbrdfRecord;
use crate::encode::Storage;
use crate::grid::Channel;
use crate::maps::Level;
use crate::plan::map::sbrdf::{BASE, ColourInput, METALLIC, NumberInput, Origin};
use crate::plan::map::{MapRequest, PlannedMap, words};
use serde::{Deserialize, Serialize};

/// Version of this layout.
const SCHEMA: u32 = 1;

/// D from which a lobe says little of its footprint: such texels are counted, and the worst of them listed.
pub(super) const HOPELESS: f32 = 0.5;

/// Texels that are listed.
const LISTED: usize = 20;

/// A map and its certificate. No clock, host or path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapRecord {
    /// Version of this layout.
    pub schema: u32,
    /// Program and version.
    pub tool: String,
    /// Name of the job and hash of what it was asked.
    pub recipe: Job,
    /// How the names of its files begin.
    pub name: String,
    /// What was read.
    pub inputs: Vec<InputRecord>,
    /// Factor of the roughness that is inside the map: the material has 1.
    pub factor: f64,
    /// Id of the rule.
    pub rule: String,
    /// Its formula.
    pub formula: String,
    /// `mean` or `fit`.
    pub normals: String,
    /// y of written normals points down.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub green_down: bool,
    /// `isotropic` or `anisotropic`.
    pub shape: String,
    /// `fast` or `exact`.
    pub effort: String,
    /// `normals` or `reflected`: what the fit makes small, and what `distance` is.
    pub objective: String,
    /// Levels, the largest first.
    pub levels: Vec<LevelRecord>,
    /// Texels that the lobe is farthest from, of all levels.
    pub worst: Vec<Place>,
    /// What the first of them stand for, as a contact sheet draws it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pictured: Vec<Pictured>,
    /// What the conversion of lobes of another kind costs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub conversion: Option<CertificateRecord>,
    /// Lobes that are written in place of the roughness.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sbrdf: Option<SbrdfRecord>,
}

/// Name and hash, as tables have them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Job {
    /// Name.
    pub name: String,
    /// Identity of the map: hash of what was asked, and of the inputs.
    pub hash: String,
}

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputRecord {
    /// `normal`, `roughness`; of lobes `base`, `metallic`, `brdf`.
    pub role: String,
    /// Its name, without the folder; the number, if it is one.
    pub file: String,
    /// blake3 of its bytes; empty for a number.
    pub blake3: String,
}

/// A texel that the lobe is far from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// Level.
    pub level: usize,
    /// Column.
    pub x: usize,
    /// Row.
    pub y: usize,
    /// D.
    pub distance: f32,
    /// A lobe wider than alpha = 1 would be nearer.
    pub at_limit: bool,
}

/// What is known of a level.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LevelRecord {
    /// Width and height in texels.
    pub size: [usize; 2],
    /// Least and largest roughness.
    pub roughness: [f32; 2],
    /// Mean of D.
    pub mean: f64,
    /// Largest D.
    pub largest: f32,
    /// Largest doubt of D.
    pub doubt: f32,
    /// Texels that want a lobe wider than alpha = 1.
    pub at_limit: usize,
    /// Texels with D of 0.5 and more: no lobe tells what is there.
    pub hopeless: usize,
    /// What a measurement against the texels of the maps came to; none for the first level.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub measured: Option<Measured>,
}

impl MapRecord {
    /// The text of one file.
    pub(super) fn of(&self, map: &str, channels: &[Channel], storage: Storage) -> String {
        let short = self.sbrdf.as_ref().map(SbrdfRecord::short);
        let mut value = serde_json::to_value(self).unwrap_or_default();
        if let Some(fields) = value.as_object_mut() {
            if let Some(short) = short {
                fields.insert("sbrdf".to_owned(), serde_json::to_value(short).unwrap_or_default());
            }
            fields.insert("map".to_owned(), map.into());
            fields.insert("channels".to_owned(), serde_json::to_value(channels).unwrap_or_default());
            fields.insert("storage".to_owned(), storage.id().into());
        }
        value.to_string()
    }

    /// The entry of the manifest.
    pub(super) fn with(self, files: &[File]) -> MapEntry {
        let file = |f: &File| MapFile {
            file: f.name.clone(),
            map: f.kind.id().to_owned(),
            level: f.level,
            container: f.container.to_owned(),
            bytes: f.bytes.len() as u64,
            blake3: blake3::hash(&f.bytes).to_hex().to_string(),
            storage: f.storage.id().to_owned(),
            channels: f.channels.clone(),
        };
        MapEntry { record: self, files: files.iter().map(file).collect() }
    }
}

/// A map in the manifest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MapEntry {
    /// What every file of it says of itself.
    #[serde(flatten)]
    pub record: MapRecord,
    /// The files.
    pub files: Vec<MapFile>,
}

/// A file of a map.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct MapFile {
    /// Name, relative to the manifest.
    pub file: String,
    /// Kind of map: `roughness`, `normal`, `lobe1.shape`.
    pub map: String,
    /// Its level, in containers with a file a level.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub level: Option<usize>,
    /// Container id.
    pub container: String,
    /// Size in bytes.
    pub bytes: u64,
    /// blake3 of the bytes.
    pub blake3: String,
    /// Storage id.
    pub storage: String,
    /// Ids of its channels.
    pub channels: Vec<String>,
}

pub(super) fn record(
    plan: &str,
    planned: &PlannedMap,
    sources: &Sources,
    levels: &[Level<'_>],
    measured: Vec<Option<Measured>>,
) -> MapRecord {
    let request = &planned.asked;
    let filter = &request.filter;
    let mut inputs: Vec<InputRecord> = sources
        .files
        .iter()
        .map(|(role, file, blake3)| InputRecord {
            role: (*role).to_owned(),
            file: file.clone(),
            blake3: blake3.clone(),
        })
        .collect();
    if let RoughnessInput::Constant(r) = &request.roughness {
        let (role, file) = ("roughness".to_owned(), r.to_string());
        if !request.sbrdf.as_ref().is_some_and(|s| matches!(s.origin, Origin::Tabulated(_))) {
            inputs.push(InputRecord { role, file, blake3: String::new() });
        }
    }
    inputs.extend(numbers(request));
    let listed = worst(levels);
    MapRecord {
        schema: SCHEMA,
        tool: crate::pipeline::manifest::tool(),
        recipe: Job { name: plan.to_owned(), hash: planned.identity.clone() },
        name: request.name.clone(),
        inputs,
        factor: request.factor,
        rule: filter.rule.id.to_owned(),
        formula: filter.rule.formula.to_owned(),
        normals: words::of(&words::CENTRES, &filter.centre).to_owned(),
        green_down: request.normal.as_ref().is_some_and(|n| n.convention.green_down),
        shape: words::of(&words::SHAPES, &filter.shape).to_owned(),
        effort: words::of(&words::EFFORTS, &filter.effort).to_owned(),
        objective: words::of(&words::OBJECTIVES, &filter.objective).to_owned(),
        levels: levels.iter().zip(measured).map(|(l, m)| level(l, m)).collect(),
        pictured: pictured::pictured(&sources.surface, levels, &listed),
        worst: listed,
        conversion: sources.certificate.as_ref().map(Certificate::record),
        sbrdf: None,
    }
}

/// Colours of lobes that are numbers.
fn numbers(request: &MapRequest) -> Vec<InputRecord> {
    let mut out = Vec::new();
    let mut put = |role: &str, file: String| {
        out.push(InputRecord { role: role.to_owned(), file, blake3: String::new() });
    };
    if let Some(Origin::Metallic { base, metallic }) = request.sbrdf.as_ref().map(|s| &s.origin) {
        if let ColourInput::Constant(c) = base {
            put(BASE, c.map(|v| v.to_string()).join(","));
        }
        if let NumberInput::Constant(m) = metallic {
            put(METALLIC, m.to_string());
        }
    }
    out
}

fn level(level: &Level<'_>, measured: Option<Measured>) -> LevelRecord {
    let fold = |f: fn(f32, f32) -> f32, of: fn(crate::maps::Texel) -> f32, start: f32| {
        level.iter().map(of).fold(start, f)
    };
    LevelRecord {
        size: level.size,
        roughness: [fold(f32::min, |t| t.roughness, 1.0), fold(f32::max, |t| t.roughness, 0.0)],
        mean: level.iter().map(|t| f64::from(t.distance)).sum::<f64>() / level.len().max(1) as f64,
        largest: fold(f32::max, |t| t.distance, 0.0),
        doubt: fold(f32::max, |t| t.doubt, 0.0),
        at_limit: level.iter().filter(|t| t.at_limit).count(),
        hopeless: level.iter().filter(|t| t.distance >= HOPELESS).count(),
        measured,
    }
}

/// The texels with the largest D, and those at the limit before others of the same D.
fn worst(levels: &[Level<'_>]) -> Vec<Place> {
    let mut all: Vec<Place> = Vec::new();
    for (k, level) in levels.iter().enumerate().skip(1) {
        let place = |(i, t): (usize, crate::maps::Texel)| Place {
            level: k,
            x: i % level.size[0],
            y: i / level.size[0],
            distance: t.distance,
            at_limit: t.at_limit,
        };
        // the order of the levels and texels decides between equals
        let least = all.get(LISTED - 1).map_or(0.0, |p| p.distance);
        let mut own: Vec<Place> =
            level.iter().enumerate().map(place).filter(|p| p.distance > least).collect();
        if own.len() > LISTED {
            let order =
                |a: &Place, b: &Place| b.distance.total_cmp(&a.distance).then((a.y, a.x).cmp(&(b.y, b.x)));
            own.select_nth_unstable_by(LISTED, order);
            own.truncate(LISTED);
            own.sort_by(order);
        }
        all.extend(own);
        all.sort_by(|a, b| b.distance.total_cmp(&a.distance));
        all.truncate(LISTED);
    }
    all
}
