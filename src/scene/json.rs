//! A JSON value that knows its own path, so that every complaint can name the place.

use crate::math::figures::meant;
use serde_json::Value;

use super::error::Fault;
use super::factor::Factor;
use crate::math::shown::show;

/// The step from a value to one of its parts.
#[derive(Debug, Clone, Copy)]
pub(super) enum Step<'a> {
    /// Member of an object.
    Key(&'a str),
    /// Element of an array, from 0.
    Index(usize),
}

/// A path as text: `materials[3].pbrMetallicRoughness.roughnessFactor`; the root is `the document`.
///
/// A path of more than 16 steps is cut after 12, for nesting may be 128 deep.
pub(super) fn path<'a>(steps: impl ExactSizeIterator<Item = Step<'a>>) -> String {
    let mut out = String::new();
    let shown = if steps.len() > 16 { 12 } else { 16 };
    for (i, step) in steps.enumerate() {
        if i == shown {
            out.push('…');
            break;
        }
        match step {
            Step::Index(i) => out.push_str(&format!("[{i}]")),
            Step::Key(key) if plain(key) => {
                if !out.is_empty() {
                    out.push('.');
                }
                out.push_str(key);
            }
            Step::Key(key) => out.push_str(&format!("[\"{}\"]", show(key))),
        }
    }
    if out.is_empty() { "the document".to_owned() } else { out }
}

/// True for keys that need no quotes in a path.
fn plain(key: &str) -> bool {
    !key.is_empty()
        && key.len() <= 64
        && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-')
}

/// A range of numbers with its name: the one place where a range is tested.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Allowed {
    /// Smallest allowed value.
    pub lo: f64,
    /// Largest allowed value.
    pub hi: f64,
    /// One value that is allowed although it lies outside.
    pub also: Option<f64>,
    /// The range in words, as messages print it.
    pub text: &'static str,
}

/// Weights, roughness, strength.
pub const UNIT: Allowed = Allowed { lo: 0.0, hi: 1.0, also: None, text: "[0, 1]" };
/// Thickness, dispersion, colours that may exceed 1.
pub const NOT_NEGATIVE: Allowed = Allowed { lo: 0.0, hi: f64::MAX, also: None, text: "[0, ∞)" };
/// Asymmetry of a phase function: the open interval (-1, 1), cut where peaks are no wider than a degree.
pub const ASYMMETRY: Allowed = Allowed { lo: -1.0, hi: 1.0, also: None, text: "[-1, 1]" };
/// `KHR_materials_ior`: at least 1, or 0 for "no dielectric Fresnel, F0 = 1".
pub const IOR: Allowed = Allowed { lo: 1.0, hi: f64::MAX, also: Some(0.0), text: "0 or [1, ∞)" };

impl Allowed {
    /// True if `x` lies in the range. NaN never does.
    #[must_use]
    pub fn holds(&self, x: f64) -> bool {
        (x >= self.lo && x <= self.hi) || self.also == Some(x)
    }
}

/// A value and the way to it. Parents are borrowed, so a path costs nothing until a message needs it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node<'a> {
    value: &'a Value,
    parent: Option<(&'a Node<'a>, Step<'a>)>,
}

impl<'a> Node<'a> {
    pub(super) fn root(value: &'a Value) -> Self {
        Self { value, parent: None }
    }

    fn child(&'a self, step: Step<'a>, value: &'a Value) -> Self {
        Self { value, parent: Some((self, step)) }
    }

    /// The JSON path of this value.
    pub(super) fn path(&self) -> String {
        self.path_with(None)
    }

    /// The JSON path of a member that may be missing.
    fn path_with(&self, last: Option<Step<'_>>) -> String {
        let mut steps: Vec<Step<'_>> = last.into_iter().collect();
        let mut at = self;
        while let Some((parent, step)) = at.parent {
            steps.push(step);
            at = parent;
        }
        path(steps.into_iter().rev())
    }

    fn wrong(&self, expected: &'static str) -> Fault {
        Fault::Type { at: self.path(), got: describe(self.value), expected }
    }

    /// A member of this object, if it is there.
    pub(super) fn get(&'a self, key: &'a str) -> Result<Option<Node<'a>>, Fault> {
        let object = self.value.as_object().ok_or_else(|| self.wrong("an object"))?;
        Ok(object.get(key).map(|value| self.child(Step::Key(key), value)))
    }

    /// A member of this object that must be there.
    pub(super) fn need(&'a self, key: &'a str, expected: &'static str) -> Result<Node<'a>, Fault> {
        self.get(key)?.ok_or_else(|| Fault::Missing { at: self.path_with(Some(Step::Key(key))), expected })
    }

    /// All members of this object, in the file's order.
    pub(super) fn members(&'a self) -> Result<impl Iterator<Item = (&'a str, Node<'a>)>, Fault> {
        let object = self.value.as_object().ok_or_else(|| self.wrong("an object"))?;
        Ok(object.iter().map(|(key, value)| (key.as_str(), self.child(Step::Key(key), value))))
    }

    /// All elements of this array.
    pub(super) fn items(&'a self) -> Result<impl Iterator<Item = Node<'a>>, Fault> {
        let array = self.value.as_array().ok_or_else(|| self.wrong("an array"))?;
        Ok(array.iter().enumerate().map(|(i, value)| self.child(Step::Index(i), value)))
    }

    /// An element of this array.
    pub(super) fn item(&'a self, i: usize) -> Result<Option<Node<'a>>, Fault> {
        let array = self.value.as_array().ok_or_else(|| self.wrong("an array"))?;
        Ok(array.get(i).map(|value| self.child(Step::Index(i), value)))
    }

    /// The number of elements of this array.
    pub(super) fn len(&self) -> Result<usize, Fault> {
        self.value.as_array().map(Vec::len).ok_or_else(|| self.wrong("an array"))
    }

    /// This value as text.
    pub(super) fn text(&self) -> Result<&'a str, Fault> {
        self.value.as_str().ok_or_else(|| self.wrong("a string"))
    }

    /// This value as a number in a range, as it was meant: exporters that compute in f32 write its digits.
    pub(super) fn number(&self, allowed: &Allowed) -> Result<f64, Fault> {
        let got = self.value.as_f64().map(meant).ok_or_else(|| self.wrong("a number"))?;
        if allowed.holds(got) {
            return Ok(got);
        }
        Err(Fault::Range { at: self.path(), got, allowed: allowed.text })
    }

    /// This value as an index below `len`. A float such as `1.0` is no index (glTF 2.0 §2.7, JSON encoding).
    pub(super) fn index(&self, what: &'static str, len: usize) -> Result<usize, Fault> {
        let got = self.value.as_u64().ok_or_else(|| self.wrong("an index (an integer of at least 0)"))?;
        match usize::try_from(got) {
            Ok(index) if index < len => Ok(index),
            _ => Err(Fault::Index { at: self.path(), got, what, len }),
        }
    }

    /// This value as a whole number.
    pub(super) fn whole(&self) -> Result<u64, Fault> {
        self.value.as_u64().ok_or_else(|| self.wrong("an integer of at least 0"))
    }

    /// A whole number that is 0 where it is left out.
    pub(super) fn whole_or_zero(&'a self, key: &'a str) -> Result<u64, Fault> {
        self.get(key)?.map_or(Ok(0), |n| n.whole())
    }

    /// This value as a flag.
    pub(super) fn flag(&self) -> Result<bool, Fault> {
        self.value.as_bool().ok_or_else(|| self.wrong("true or false"))
    }

    /// A number member in a range, or its default.
    pub(super) fn factor(&self, key: &str, default: f64, allowed: &Allowed) -> Result<f64, Fault> {
        match self.get_here(key)? {
            None => Ok(default),
            Some(value) => Node { value, parent: Some((self, Step::Key(key))) }.number(allowed),
        }
    }

    /// R, G and B of a colour member, or its default.
    pub(super) fn channels(&self, factor: &Factor) -> Result<[f64; 3], Fault> {
        let Some(value) = self.get_here(factor.key)? else { return Ok([factor.default; 3]) };
        let colour = Node { value, parent: Some((self, Step::Key(factor.key))) };
        if colour.len()? != factor.channels {
            let four = factor.channels == 4;
            return Err(colour.wrong(if four { "an array of 4 numbers" } else { "an array of 3 numbers" }));
        }
        let mut all = [0.0; 3];
        for (to, channel) in all.iter_mut().zip(colour.items()?) {
            *to = channel.number(factor.allowed)?;
        }
        Ok(all)
    }

    /// As [`Node::get`], for keys that live shorter than the document.
    fn get_here(&self, key: &str) -> Result<Option<&'a Value>, Fault> {
        Ok(self.value.as_object().ok_or_else(|| self.wrong("an object"))?.get(key))
    }
}

/// A value in a few words, for messages.
fn describe(value: &Value) -> String {
    match value {
        Value::Null => "null".to_owned(),
        Value::Bool(b) => format!("the boolean {b}"),
        Value::Number(n) => format!("the number {n}"),
        Value::String(s) => format!("the string \"{}\"", show(s)),
        Value::Array(a) => format!("an array of {}", a.len()),
        Value::Object(o) => format!("an object of {}", o.len()),
    }
}
