//! A JSON text whose values keep their own text: where each member and element begins and ends.

use std::fmt;
use std::ops::Range;

use serde::de::{Deserializer, MapAccess, Visitor};
use serde_json::Value;
use serde_json::value::RawValue;

/// A value, as its text without the blanks around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Raw<'a>(&'a str);

/// A member of an object: the text of its key, quotes and escapes included, and its value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Member<'a> {
    pub(super) key: &'a str,
    pub(super) value: Raw<'a>,
}

impl Member<'_> {
    /// Is this the member's name, whatever is escaped in it?
    pub(super) fn is(&self, name: &str) -> bool {
        serde_json::from_str::<String>(self.key).is_ok_and(|key| key == name)
    }
}

impl<'a> Raw<'a> {
    /// The value of a whole text.
    ///
    /// # Errors
    /// The parser's, if the text is no JSON.
    pub fn new(text: &'a str) -> Result<Raw<'a>, serde_json::Error> {
        serde_json::from_str::<&RawValue>(text).map(|raw| Raw(raw.get()))
    }

    /// Its text.
    #[must_use]
    pub fn text(self) -> &'a str {
        self.0
    }

    /// Its value; numbers are read, and so no longer have their text.
    #[must_use]
    pub fn value(self) -> Value {
        serde_json::from_str(self.0).unwrap_or_default()
    }

    /// A member of an object; none if this is something else.
    #[must_use]
    pub fn get(self, key: &str) -> Option<Raw<'a>> {
        self.members()?.into_iter().rev().find(|m| m.is(key)).map(|m| m.value)
    }

    /// A member of a member, and so on.
    #[must_use]
    pub fn find(self, path: &[&str]) -> Option<Raw<'a>> {
        path.iter().try_fold(self, |raw, key| raw.get(key))
    }

    /// The elements of an array; none if this is something else.
    #[must_use]
    pub fn items(self) -> Option<Vec<Raw<'a>>> {
        let items: Vec<&'a RawValue> = serde_json::from_str(self.0).ok()?;
        Some(items.into_iter().map(|raw| Raw(raw.get())).collect())
    }

    /// The members of an object; none if this is something else.
    pub(super) fn members(self) -> Option<Vec<Member<'a>>> {
        serde_json::Deserializer::from_str(self.0).deserialize_map(Members).ok()
    }

    /// Where this value stands in a text that it is a part of.
    pub(super) fn span(self, whole: &str) -> Range<usize> {
        span(self.0, whole)
    }
}

/// Where a part of a text stands in it.
pub(super) fn span(part: &str, whole: &str) -> Range<usize> {
    let start = part.as_ptr().addr().saturating_sub(whole.as_ptr().addr());
    start..start + part.len()
}

struct Members;

impl<'de> Visitor<'de> for Members {
    type Value = Vec<Member<'de>>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut members = Vec::new();
        while let Some((key, value)) = map.next_entry::<&RawValue, &RawValue>()? {
            members.push(Member { key: key.get(), value: Raw(value.get()) });
        }
        Ok(members)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "test")]
    use super::*;

    #[test]
    fn every_value_keeps_its_text() {
        let text = r#" { "a" : 1.50 , "b\u0041": [1e3, -0.0,"x\/y" ], "c": { } } "#;
        let raw = Raw::new(text).unwrap();
        assert_eq!(raw.get("a").unwrap().text(), "1.50");
        let list = raw.get("bA").unwrap().items().unwrap();
        assert_eq!(list.iter().map(|r| r.text()).collect::<Vec<_>>(), ["1e3", "-0.0", r#""x\/y""#]);
        assert_eq!(&text[list[1].span(text)], "-0.0");
        assert_eq!(raw.find(&["c", "d"]), None);
        assert_eq!(raw.get("a").unwrap().members().map(|m| m.len()), None);
    }
}
