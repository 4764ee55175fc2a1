//! JSON text to a tree: with a budget, without what is never read, and with the path of every fault.
//!
//! `serde_json` alone would build all of a file that holds a billion accessors, keep the last of two equal
//! keys, and name a fault only by line and column. Its depth limit of 128 is kept.
//! The feature `arbitrary_precision` of `serde_json` must stay off: numbers would arrive as objects here.

use std::cell::{Cell, RefCell};
use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};

use super::error::Fault;
use super::json::{self, Step};
use crate::math::shown::show;

/// The sections of a document that this room reads. Any other is stepped over without being kept.
const KEPT: &[&str] = &[
    "animations",
    "asset",
    "bufferViews",
    "buffers",
    "extensions",
    "extensionsRequired",
    "extensionsUsed",
    "images",
    "materials",
    "meshes",
    "nodes",
    "samplers",
    "textures",
];

/// What is stepped over inside these sections: the bulk of a large file. `*` stands for any index or key.
const SKIPPED: &[&[&str]] = &[
    &["animations", "*", "samplers"],
    &["asset", "extensions"],
    &["extensions", "*"],
    &["bufferViews", "*", "extensions"],
    &["meshes", "*", "extensions"],
    &["meshes", "*", "primitives", "*", "targets"],
    &["meshes", "*", "weights"],
    &["nodes", "*", "children"],
    &["nodes", "*", "extensions"],
    &["nodes", "*", "matrix"],
    &["nodes", "*", "rotation"],
    &["nodes", "*", "scale"],
    &["nodes", "*", "translation"],
    &["nodes", "*", "weights"],
];

/// What is kept besides, where it is asked which texels meshes cover.
const GEOMETRY: &[&[&str]] =
    &[&["accessors"], &["bufferViews", "*", "extensions"], &["meshes", "*", "primitives", "*", "targets"]];

/// What is kept besides, where meshes are shaded.
const PLACES: &[&[&str]] = &[
    &["scene"],
    &["scenes"],
    &["meshes", "*", "primitives", "*", "extensions"],
    &["nodes", "*", "children"],
    &["nodes", "*", "matrix"],
    &["nodes", "*", "rotation"],
    &["nodes", "*", "scale"],
    &["nodes", "*", "translation"],
];

/// Reads a document of at most `max_values` kept values, with what says where geometry lies, and how nodes place it, if that is asked.
pub(super) fn parse(text: &str, max_values: usize, [geometry, places]: [bool; 2]) -> Result<Value, Fault> {
    let state = State { max_values, geometry, places, left: Cell::new(max_values), ..State::default() };
    let mut reader = serde_json::Deserializer::from_str(text);
    let parsed = Seed(&state).deserialize(&mut reader).and_then(|value| reader.end().map(|()| value));
    parsed.map_err(|error| state.fault.take().unwrap_or_else(|| state.syntax(&error)))
}

/// A step of the path, owned.
#[derive(Debug)]
enum Owned {
    Key(String),
    Index(usize),
}

/// What all levels of the recursion share. The path is left as it was when a fault was met.
#[derive(Debug, Default)]
struct State {
    path: RefCell<Vec<Owned>>,
    max_values: usize,
    geometry: bool,
    places: bool,
    left: Cell<usize>,
    fault: RefCell<Option<Fault>>,
}

impl State {
    fn at(&self) -> String {
        json::path(self.path.borrow().iter().map(|step| match step {
            Owned::Key(key) => Step::Key(key),
            Owned::Index(i) => Step::Index(*i),
        }))
    }

    /// The parser's own complaint, with the path instead of nothing.
    fn syntax(&self, error: &serde_json::Error) -> Fault {
        let message = error.to_string();
        let detail = message.rsplit_once(" at line ").map_or(message.as_str(), |(head, _)| head);
        Fault::Json { at: self.at(), line: error.line(), column: error.column(), detail: show(detail) }
    }

    /// Stops the parser with a fault of our own.
    fn stop<E: Error>(&self, fault: Fault) -> E {
        self.fault.replace(Some(fault));
        E::custom("stopped")
    }

    /// Counts one value against the budget.
    fn spend<E: Error>(&self) -> Result<(), E> {
        match self.left.get().checked_sub(1) {
            Some(left) => {
                self.left.set(left);
                Ok(())
            }
            None => Err(self.stop(Fault::TooManyValues { at: self.at(), limit: self.max_values })),
        }
    }

    /// True if the value at the current path is never read.
    fn skips(&self) -> bool {
        let path = self.path.borrow();
        let key = |i: usize| match path.get(i) {
            Some(Owned::Key(key)) => key.as_str(),
            _ => "",
        };
        let is = |rule: &&[&str]| {
            rule.len() == path.len()
                && rule.iter().enumerate().all(|(i, want)| *want == "*" || *want == key(i))
        };
        if self.geometry && GEOMETRY.iter().any(&is) || self.places && PLACES.iter().any(&is) {
            return false;
        }
        if path.len() == 1 {
            return !KEPT.contains(&key(0));
        }
        // `extras` is the application's own data, anywhere.
        key(path.len() - 1) == "extras" || SKIPPED.iter().any(is)
    }
}

/// Reads one value at the current path.
struct Seed<'s>(&'s State);

impl<'de> DeserializeSeed<'de> for Seed<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Seed<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E: Error>(self) -> Result<Value, E> {
        self.0.spend().map(|()| Value::Null)
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<Value, E> {
        self.0.spend().map(|()| Value::Bool(value))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Value, E> {
        self.0.spend().map(|()| Value::Number(value.into()))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Value, E> {
        self.0.spend().map(|()| Value::Number(value.into()))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Value, E> {
        self.0.spend()?;
        // The parser refuses numbers beyond f64 before they come here.
        Number::from_f64(value).map(Value::Number).ok_or_else(|| E::custom("number out of range"))
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<Value, E> {
        self.0.spend().map(|()| Value::String(value.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Value, A::Error> {
        self.0.spend()?;
        let mut array = Vec::new();
        loop {
            self.0.path.borrow_mut().push(Owned::Index(array.len()));
            let next = seq.next_element_seed(Seed(self.0))?;
            self.0.path.borrow_mut().pop();
            match next {
                Some(value) => array.push(value),
                None => return Ok(Value::Array(array)),
            }
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Value, A::Error> {
        self.0.spend()?;
        let mut object = Map::new();
        while let Some(key) = map.next_key::<String>()? {
            let twice = object.contains_key(&key);
            self.0.path.borrow_mut().push(Owned::Key(key));
            if twice {
                return Err(self.0.stop(Fault::DuplicateKey { at: self.0.at() }));
            }
            let value = if self.0.skips() {
                map.next_value::<IgnoredAny>()?;
                None
            } else {
                Some(map.next_value_seed(Seed(self.0))?)
            };
            let step = self.0.path.borrow_mut().pop();
            if let (Some(Owned::Key(key)), Some(value)) = (step, value) {
                object.insert(key, value);
            }
        }
        Ok(Value::Object(object))
    }
}
