//! The numbers of a texel, by the ids of their channels, from the files of a map.

use super::texel::{TexelError, TexelPlace};
use crate::cancel::Cancel;
use crate::encode::mips::containers;
use crate::encode::read::{Claim, Plane, Sample, load_until, read_level_until};
use crate::maps::sbrdf::Normalise;
use crate::plan::map::Kind;
use serde_json::Value as Json;
use std::path::{Path, PathBuf};

/// What was read so far.
#[derive(Debug, Default)]
pub(super) struct Found {
    values: Vec<(String, f64)>,
    /// Channels that are no parameters, and the file of the last one.
    other: Vec<String>,
    file: String,
    /// y of the normals points down.
    pub(super) green_down: bool,
    /// Lobes that the record tells of.
    pub(super) lobes: usize,
    /// They are divided by their own integral.
    pub(super) incident: bool,
}

impl Found {
    pub(super) fn of(&self, id: &str) -> Option<f64> {
        self.values.iter().find(|(own, _)| own == id).map(|(_, v)| *v)
    }

    /// The channels that were found, in words.
    pub(super) fn ids(&self) -> String {
        self.values.iter().map(|(id, _)| id.as_str()).collect::<Vec<_>>().join(", ")
    }

    /// Do the albedos differ between red, green and blue?
    pub(super) fn coloured(&self) -> bool {
        let of = |start: &str, c: &str| self.of(&format!("{start}.{c}"));
        ["diffuse", "albedo1", "albedo2", "albedo3"]
            .iter()
            .any(|s| of(s, "r") != of(s, "g") || of(s, "g") != of(s, "b"))
    }

    pub(super) fn no_parameter(&self) -> TexelError {
        TexelError::NoParameter { file: self.file.clone(), got: self.other.join(", ") }
    }

    fn put(&mut self, id: String, value: f64) -> Result<(), TexelError> {
        if self.of(&id).is_some() {
            return Err(TexelError::Twice(id));
        }
        self.values.push((id, value));
        Ok(())
    }
}

/// Kinds of map that hold parameters.
fn kinds() -> Vec<Kind> {
    let lobes = (0..crate::maps::sbrdf::MOST_LOBES).flat_map(|j| [Kind::Albedo(j), Kind::Shape(j)]);
    [Kind::Roughness, Kind::Normal, Kind::Anisotropy, Kind::Wide, Kind::Diffuse, Kind::Tangent]
        .into_iter()
        .chain(lobes)
        .collect()
}

/// The files that a place names, with the level to read of each.
fn files(place: &TexelPlace) -> Vec<(PathBuf, usize)> {
    if place.path.is_file() {
        return vec![(place.path.clone(), place.level)];
    }
    let start = place.path.to_string_lossy().into_owned();
    let of = |kind: Kind, encoder: &dyn crate::encode::Encoder| {
        let (end, level) = match encoder.holds_all_levels() {
            true => (encoder.extension().to_owned(), place.level),
            false => (format!("mip{}.{}", place.level, encoder.extension()), 0),
        };
        (PathBuf::from(format!("{start}.{}.{end}", kind.id())), level)
    };
    let all = containers().filter(|e| e.holds_metadata()).map(|e| {
        kinds().into_iter().map(|kind| of(kind, e)).filter(|(path, _)| path.is_file()).collect::<Vec<_>>()
    });
    all.into_iter().find(|files| !files.is_empty()).unwrap_or_default()
}

/// Reads the channels of a place.
pub(super) fn add(found: &mut Found, place: &TexelPlace, cancel: &Cancel) -> Result<(), TexelError> {
    let files = files(place);
    if files.is_empty() {
        return Err(TexelError::Missing(place.path.display().to_string()));
    }
    for (path, level) in files {
        one(found, &path, (place.x, place.y, level), cancel)?;
    }
    Ok(())
}

fn one(
    found: &mut Found,
    path: &Path,
    (x, y, level): (usize, usize, usize),
    cancel: &Cancel,
) -> Result<(), TexelError> {
    let file = path.display().to_string();
    let read = |source| TexelError::Read { file: file.clone(), source };
    let bytes = load_until(cancel, path).map_err(read)?;
    let image = read_level_until(cancel, &bytes, level).map_err(read)?;
    let (width, height) = (image.width, image.height);
    if x >= width || y >= height {
        return Err(TexelError::Outside { file, level, width, height, x, y });
    }
    let told: Json = match &image.provenance {
        Some(Claim::Unknown { text, .. }) => serde_json::from_str(text).unwrap_or(Json::Null),
        _ => Json::Null,
    };
    let (Some(kind), Some(channels)) = (told["map"].as_str(), told["channels"].as_array()) else {
        return Err(TexelError::Untold(file));
    };
    let kind = kinds().into_iter().find(|k| k.id() == kind);
    found.green_down |= kind == Some(Kind::Normal) && told["green_down"].as_bool() == Some(true);
    if let Some(lobes) = told["sbrdf"]["lobes"].as_u64() {
        found.lobes = usize::try_from(lobes).unwrap_or(0);
        found.incident = told["sbrdf"]["normalise"].as_str() == Some(Normalise::Incident.id());
    }
    for (c, channel) in channels.iter().enumerate() {
        let Some(id) = channel["id"].as_str() else { continue };
        // files with names may have another order
        let named = |p: &&Plane| p.name == id;
        let Some(plane) = image.channels.iter().find(named).or_else(|| image.channels.get(c)) else {
            continue;
        };
        let value = value(plane, y * width + x, &channel["range"]);
        let own = match kind {
            Some(Kind::Roughness) => (id == "roughness").then(|| id.to_owned()),
            Some(Kind::Albedo(j)) => Some(match id.split_once('.') {
                Some((start, colour)) => format!("{start}{}.{colour}", j + 1),
                None => format!("{id}{}", j + 1),
            }),
            Some(Kind::Shape(j)) => Some(format!("{id}{}", j + 1)),
            Some(_) => Some(id.to_owned()),
            None => None,
        };
        match own {
            Some(id) => found.put(id, value)?,
            None => found.other.push(id.to_owned()),
        }
    }
    found.file = file;
    Ok(())
}

/// The number that a code stands for; floats are themselves.
fn value(plane: &Plane, at: usize, range: &Json) -> f64 {
    let code = plane.values.get(at).copied().unwrap_or(0.0);
    let float = matches!(plane.sample, Sample::Half | Sample::Float | Sample::Double);
    let end = |i: usize| range[i].as_f64().filter(|_| !float);
    end(0).zip(end(1)).map_or(code, |(lo, hi)| lo + (hi - lo) * code)
}
