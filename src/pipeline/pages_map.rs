//! Parameter maps of a report: levels as their files hold them.

use super::map::{MapEntry, MapFile};
use super::transaction::is_plain;
use crate::cancel::{Cancel, Cancelled};
use crate::encode::read::{self, Claim, Image, Plane, ReadError, Sample};
use crate::grid::Channel;
use crate::report::page::{MapFileView, MapLevel, MapPlane, MapView};
use serde::Deserialize;

/// Channels that are errors.
const ERRORS: [&str; 4] = ["distance", "doubt", "residual", "energy"];

/// Beginnings of the names of channels that are signed, for files that do not tell.
const SIGNED: [&str; 2] = ["normal.", "direction."];

/// A table of numbers and no picture of the surface.
const NO_PICTURE: &str = "normalisation";

/// What a page shows of a map: the level with the worst texel, and the first. `bytes` gives a file by its name, or says why not.
pub(super) fn view(
    entry: &MapEntry,
    bytes: &dyn Fn(&str) -> Result<Vec<u8>, String>,
    cancel: &Cancel,
) -> Result<MapView, Cancelled> {
    let mut chosen: Vec<usize> = entry.record.worst.first().map(|p| p.level).into_iter().collect();
    if !chosen.contains(&0) {
        chosen.push(0);
    }
    let mut left_out = Vec::new();
    let mut levels = Vec::new();
    for level in chosen {
        cancel.check()?;
        let Some(size) = entry.record.levels.get(level).map(|l| l.size) else { continue };
        let planes = planes(entry, level, size, bytes, &mut left_out, cancel);
        if !planes.is_empty() {
            levels.push(MapLevel { level, size, planes });
        }
    }
    cancel.check()?;
    let file = |f: &MapFile| MapFileView {
        file: f.file.clone(),
        container: f.container.clone(),
        storage: f.storage.clone(),
        bytes: f.bytes,
    };
    Ok(MapView {
        name: entry.record.name.clone(),
        record: serde_json::to_value(&entry.record).unwrap_or_default(),
        files: entry.files.iter().map(file).collect(),
        levels: if levels.is_empty() { Err(left_out.join("; ")) } else { Ok(levels) },
        left_out,
    })
}

/// The channels of a level, of every map in the first of its containers that can be read.
fn planes(
    entry: &MapEntry,
    level: usize,
    size: [usize; 2],
    bytes: &dyn Fn(&str) -> Result<Vec<u8>, String>,
    left_out: &mut Vec<String>,
    cancel: &Cancel,
) -> Vec<MapPlane> {
    let mut kinds: Vec<&str> = Vec::new();
    for file in &entry.files {
        if !kinds.contains(&file.map.as_str()) && file.map != NO_PICTURE {
            kinds.push(&file.map);
        }
    }
    let mut planes = Vec::new();
    for kind in kinds {
        let holds = |f: &&MapFile| f.map == kind && f.level.is_none_or(|l| l == level);
        let mut why = Vec::new();
        let image = entry.files.iter().filter(holds).find_map(|f| {
            let read = image(f, level, bytes, cancel).and_then(|i| fits(&i, f, size).map(|()| (f, i)));
            read.map_err(|fault| why.push(format!("{}: {fault}", f.file))).ok()
        });
        match image {
            Some((file, image)) => planes.extend(channels(kind, file, image)),
            None if why.is_empty() => left_out.push(format!("{kind}, level {level}: no file holds it")),
            None => left_out.push(format!("{kind}, level {level}: {}", why.join("; "))),
        }
    }
    planes
}

fn image(
    file: &MapFile,
    level: usize,
    bytes: &dyn Fn(&str) -> Result<Vec<u8>, String>,
    cancel: &Cancel,
) -> Result<Image, String> {
    if !is_plain(&file.file) {
        return Err("not the name of a file in the folder".to_owned());
    }
    let bytes = bytes(&file.file)?;
    let inside = if file.level.is_some() { 0 } else { level };
    read::read_level_until(cancel, &bytes, inside).map_err(told)
}

fn fits(image: &Image, file: &MapFile, [w, h]: [usize; 2]) -> Result<(), String> {
    if [image.width, image.height] != [w, h] {
        return Err(format!(
            "it has {} x {} texels, the manifest tells of {w} x {h}",
            image.width, image.height
        ));
    }
    if image.channels.len() < file.channels.len() {
        return Err("it has fewer channels than the manifest tells of".to_owned());
    }
    Ok(())
}

/// By name where the file has names, else in order.
fn channels(kind: &str, file: &MapFile, image: Image) -> Vec<MapPlane> {
    let named = file.channels.iter().all(|c| image.channel(c).is_some());
    let place = |i: usize, id: &str| {
        if named { image.channels.iter().position(|c| c.name == id).unwrap_or(i) } else { i }
    };
    let ranges = ranges(&image, file);
    let places: Vec<usize> = file.channels.iter().enumerate().map(|(i, id)| place(i, id)).collect();
    let plane = |((id, at), range): ((&String, &usize), &[f64; 2])| MapPlane {
        map: kind.to_owned(),
        channel: id.clone(),
        is_error: ERRORS.contains(&id.as_str()),
        values: image.channels.get(*at).map_or_else(Vec::new, |c| decoded(c, *range)),
    };
    file.channels.iter().zip(&places).zip(&ranges).map(plane).collect()
}

/// The ranges that codes are spread over, from what the file says of its channels, or from their names.
fn ranges(image: &Image, file: &MapFile) -> Vec<[f64; 2]> {
    let told: Option<Told> = match &image.provenance {
        Some(Claim::Unknown { text, .. }) => serde_json::from_str(text).ok(),
        _ => None,
    };
    let range = |id: &String| {
        let own = told.iter().flat_map(|t| &t.channels).find(|c| c.id == *id).map(|c| c.range);
        let signed = SIGNED.iter().any(|start| id.starts_with(start));
        own.unwrap_or(if signed { [-1.0, 1.0] } else { [0.0, 1.0] })
    };
    file.channels.iter().map(range).collect()
}

/// What a file says of its channels.
#[derive(Deserialize)]
struct Told {
    channels: Vec<Channel>,
}

/// The numbers of a channel: codes stand for parts of its range.
fn decoded(plane: &Plane, [lo, hi]: [f64; 2]) -> Vec<f64> {
    use Sample::{Bc4, Bc5, Rgb10a2, Unorm8, Unorm16};
    match plane.sample {
        Unorm8 | Unorm16 | Rgb10a2 | Bc4 | Bc5 => plane.values.iter().map(|v| lo + v * (hi - lo)).collect(),
        _ => plane.values.clone(),
    }
}

/// A fault without the path, which has no place in a page.
pub(super) fn told(fault: ReadError) -> String {
    match fault {
        ReadError::Io { source, .. } => source.kind().to_string(),
        fault => fault.to_string(),
    }
}
