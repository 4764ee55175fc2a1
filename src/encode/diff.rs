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

/// Compares two pictures; channels are matched by name.
#[must_use]
pub fn images(a: &Image, b: &Image, tolerance: Tolerance) -> ImageDiff {
    let mut diff = ImageDiff {
        shape: Vec::new(),
        notes: Vec::new(),
        channels: Vec::new(),
        metadata: metadata(a, b),
        tolerance,
    };
    if a.format != b.format {
        diff.notes.push(format!("container: {} against {}", a.format, b.format));
    }
    if (a.width, a.height) != (b.width, b.height) {
        diff.shape.push(format!("size: {} x {} against {} x {}", a.width, a.height, b.width, b.height));
    }
    for c in a.channels.iter().filter(|c| b.channel(&c.name).is_none()) {
        diff.shape.push(format!("channel `{}` is in the first only", c.name));
    }
    for c in b.channels.iter().filter(|c| a.channel(&c.name).is_none()) {
        diff.shape.push(format!("channel `{}` is in the second only", c.name));
    }
    for p in &a.channels {
        let Some(q) = b.channel(&p.name) else { continue };
        if p.sample != q.sample {
            diff.notes.push(format!("channel `{}`: {} against {}", p.name, p.sample.id(), q.sample.id()));
        }
        if p.values.len() == q.values.len() && a.width == b.width {
            diff.channels.push(planes(p, q, a.width, tolerance));
        }
    }
    diff
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
