//! Compares two pictures: how far apart, in numbers and in steps of the storage, and where it is worst.

use super::diff_json::{self, JsonDiff};
use super::read::{Claim, Image, Plane};
use serde::{Serialize, Serializer};

/// How far two values may be apart and still count as equal: the larger of the two allowances.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Tolerance {
    /// Absolute difference.
    pub absolute: f64,
    /// Steps of the storage at the larger of the two values.
    pub ulps: f64,
}

/// Which channel of the second picture a channel of the first is compared with.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Pairing {
    /// By name; by position where no name is in both and both have as many channels, or the second only padding beyond.
    #[default]
    Best,
    /// By position, whatever they are called.
    Position,
    /// Pairs of names, of the first and of the second picture. Other channels are left out.
    Named(Vec<[String; 2]>),
}

/// Two values at one place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Worst {
    /// Column.
    pub x: usize,
    /// Row, from the top.
    pub y: usize,
    /// Value in the first picture.
    #[serde(serialize_with = "number")]
    pub a: f64,
    /// Value in the second picture.
    #[serde(serialize_with = "number")]
    pub b: f64,
}

/// Differences of one channel. NaN at the same place in both, and equal infinities, are no difference; a NaN or an
/// infinity in one only is an infinite difference.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ChannelDiff {
    /// Name.
    pub name: String,
    /// Largest absolute difference.
    #[serde(serialize_with = "number")]
    pub largest: f64,
    /// Root of the mean squared difference.
    #[serde(serialize_with = "number")]
    pub rmse: f64,
    /// Largest difference in steps of the storage (the coarser one, if the pictures store differently).
    #[serde(serialize_with = "number")]
    pub ulps: f64,
    /// Values that differ at all.
    pub different: usize,
    /// Values that differ by more than the tolerance.
    pub outside: usize,
    /// The place of the largest absolute difference, if there is a difference.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst: Option<Worst>,
}

/// Differences of two pictures.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ImageDiff {
    /// Differences that have no number: sizes, missing channels. Any of them makes the pictures unequal.
    pub shape: Vec<String>,
    /// Differences that do not count: containers, sample types.
    pub notes: Vec<String>,
    /// How channels were matched where not by their names: `R = dfg.scale`, and so on.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub mapping: Vec<String>,
    /// Channels that both pictures have, in the order of the first.
    pub channels: Vec<ChannelDiff>,
    /// First difference of the provenance, if any. It does not count: only the values do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub metadata: Option<JsonDiff>,
    /// The tolerance of this comparison.
    pub tolerance: Tolerance,
}

impl ImageDiff {
    /// True if the pictures have the same shape and no value differs by more than the tolerance.
    #[must_use]
    pub fn equal(&self) -> bool {
        self.shape.is_empty() && self.channels.iter().all(|c| c.outside == 0)
    }

    /// The channel with the largest absolute difference.
    #[must_use]
    pub fn worst(&self) -> Option<&ChannelDiff> {
        self.channels.iter().filter(|c| c.worst.is_some()).max_by(|a, b| a.largest.total_cmp(&b.largest))
    }
}

/// Compares two pictures; channels are matched as [`Pairing::Best`] says.
#[must_use]
pub fn images(a: &Image, b: &Image, tolerance: Tolerance) -> ImageDiff {
    images_by(a, b, tolerance, &Pairing::Best)
}

/// Compares two pictures, with channels matched as told.
#[must_use]
pub fn images_by(a: &Image, b: &Image, tolerance: Tolerance, pairing: &Pairing) -> ImageDiff {
    let mut diff = ImageDiff {
        shape: Vec::new(),
        notes: Vec::new(),
        mapping: Vec::new(),
        channels: Vec::new(),
        metadata: metadata(a, b),
        tolerance,
    };
    for (image, which) in [(a, "first"), (b, "second")] {
        diff.notes.extend(image.warnings.iter().map(|w| format!("{which}: {w}")));
    }
    if a.format != b.format {
        diff.notes.push(format!("container: {} against {}", a.format, b.format));
    }
    if (a.width, a.height) != (b.width, b.height) {
        diff.shape.push(format!("size: {} x {} against {} x {}", a.width, a.height, b.width, b.height));
    }
    for (p, q) in pairs(a, b, pairing, &mut diff) {
        if p.name != q.name {
            diff.mapping.push(format!("{} = {}", p.name, q.name));
        }
        if p.sample != q.sample {
            diff.notes.push(format!("channel `{}`: {} against {}", p.name, p.sample.id(), q.sample.id()));
        }
        if p.values.len() == q.values.len() && a.width == b.width {
            diff.channels.push(planes(p, q, a.width, tolerance));
        }
    }
    diff
}

/// The channels that are compared; what has no partner is told in `diff`.
fn pairs<'a>(
    a: &'a Image,
    b: &'a Image,
    pairing: &Pairing,
    diff: &mut ImageDiff,
) -> Vec<(&'a Plane, &'a Plane)> {
    let unknown = || !a.channels.iter().any(|p| b.channel(&p.name).is_some());
    match pairing {
        Pairing::Named(names) => named(a, b, names, diff),
        Pairing::Position => by_position(a, b, diff),
        Pairing::Best if unknown() && fits(a, b) => by_position(a, b, diff),
        Pairing::Best => by_name(a, b, diff),
    }
}

fn by_name<'a>(a: &'a Image, b: &'a Image, diff: &mut ImageDiff) -> Vec<(&'a Plane, &'a Plane)> {
    for c in a.channels.iter().filter(|c| b.channel(&c.name).is_none()) {
        diff.shape.push(format!("channel `{}` is in the first only", c.name));
    }
    for c in b.channels.iter().filter(|c| a.channel(&c.name).is_none()) {
        diff.shape.push(format!("channel `{}` is in the second only", c.name));
    }
    a.channels.iter().filter_map(|p| Some((p, b.channel(&p.name)?))).collect()
}

fn named<'a>(
    a: &'a Image,
    b: &'a Image,
    names: &[[String; 2]],
    diff: &mut ImageDiff,
) -> Vec<(&'a Plane, &'a Plane)> {
    let mut found = Vec::new();
    for [first, second] in names {
        for (image, name, which) in [(a, first, "first"), (b, second, "second")] {
            if image.channel(name).is_none() {
                let all: Vec<&str> = image.channels.iter().map(|c| c.name.as_str()).collect();
                diff.shape.push(format!("the {which} has no channel `{name}`, but {}", all.join(", ")));
            }
        }
        found.extend(a.channel(first).zip(b.channel(second)));
    }
    found
}

fn by_position<'a>(a: &'a Image, b: &'a Image, diff: &mut ImageDiff) -> Vec<(&'a Plane, &'a Plane)> {
    let (first, second) = (in_order(a), in_order(b));
    let count = first.len().min(second.len());
    for (planes, which) in [(&first, "first"), (&second, "second")] {
        for plane in planes.iter().skip(count) {
            let text = format!("channel `{}` is in the {which} only", plane.name);
            match padding(plane) {
                Some(value) => diff.notes.push(format!("{text}, {value} everywhere")),
                None => diff.shape.push(text),
            }
        }
    }
    first.into_iter().zip(second).collect()
}

/// As many channels, or padding behind the fewer.
fn fits(a: &Image, b: &Image) -> bool {
    let (first, second) = (in_order(a), in_order(b));
    let count = first.len().min(second.len());
    first.iter().chain(&second).count() > 0
        && first.iter().skip(count).chain(second.iter().skip(count)).all(|p| padding(p).is_some())
}

/// The value of a channel that holds nothing but zeros or ones.
fn padding(plane: &Plane) -> Option<f64> {
    [0.0, 1.0].into_iter().find(|value| plane.values.iter().all(|v| (v - value).abs() == 0.0))
}

/// Channels in the order of a pixel: that of the metadata; R, G, B, A where these are the names; that of the file.
fn in_order(image: &Image) -> Vec<&Plane> {
    if let Some(p) = image.known() {
        let told: Option<Vec<&Plane>> = p.channels.iter().map(|c| image.channel(&c.id)).collect();
        if let Some(told) = told.filter(|t| t.len() == image.channels.len()) {
            return told;
        }
    }
    const COLOURS: [&str; 5] = ["Y", "R", "G", "B", "A"];
    let place = |p: &Plane| COLOURS.iter().position(|c| p.name.eq_ignore_ascii_case(c));
    let mut all: Vec<&Plane> = image.channels.iter().collect();
    if all.iter().all(|p| place(p).is_some()) {
        all.sort_by_key(|p| place(p));
    }
    all
}

fn planes(p: &Plane, q: &Plane, width: usize, tolerance: Tolerance) -> ChannelDiff {
    let mut diff = ChannelDiff {
        name: p.name.clone(),
        largest: 0.0,
        rmse: 0.0,
        ulps: 0.0,
        different: 0,
        outside: 0,
        worst: None,
    };
    let mut squares = 0.0;
    for (i, (&a, &b)) in p.values.iter().zip(&q.values).enumerate() {
        let d = distance(a, b);
        if d > 0.0 {
            let largest = if a.abs() > b.abs() { a } else { b };
            let step = p.sample.ulp(largest, p.range).max(q.sample.ulp(largest, q.range));
            diff.different += 1;
            diff.outside += usize::from(d > tolerance.absolute.max(tolerance.ulps * step));
            diff.ulps = diff.ulps.max(d / step);
            squares += d * d;
            if d > diff.largest {
                diff.largest = d;
                diff.worst = Some(Worst { x: i % width, y: i / width, a, b });
            }
        }
    }
    if diff.different > 0 {
        diff.rmse = (squares / p.values.len() as f64).sqrt();
    }
    diff
}

fn distance(a: f64, b: f64) -> f64 {
    let d = (a - b).abs();
    let same = a.is_nan() && b.is_nan() || a.is_infinite() && b.is_infinite() && (a > 0.0) == (b > 0.0);
    match () {
        () if same => 0.0,
        () if d.is_nan() => f64::INFINITY,
        () => d,
    }
}

fn metadata(a: &Image, b: &Image) -> Option<JsonDiff> {
    let value = |image: &Image| match &image.provenance {
        None => serde_json::Value::Null,
        Some(Claim::Known(p)) => serde_json::to_value(p).unwrap_or_default(),
        Some(Claim::Several(all)) => serde_json::to_value(all).unwrap_or_default(),
        Some(Claim::Unknown { text, .. }) => {
            serde_json::from_str(text).unwrap_or_else(|_| serde_json::Value::String(text.clone()))
        }
    };
    diff_json::first_difference(&value(a), &value(b))
}

/// JSON has no infinity: it is written as a word.
fn number<S: Serializer>(v: &f64, s: S) -> Result<S::Ok, S::Error> {
    if v.is_finite() { s.serialize_f64(*v) } else { s.serialize_str(&v.to_string()) }
}
