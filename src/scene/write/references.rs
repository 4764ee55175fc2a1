//! The files that a scene names, wherever it does: buffers, images, and whatever an extension has.

use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

use super::edit::{EditError, Patch};
use crate::scene::json::{Step, path};

/// A URI in a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reference {
    /// The URI.
    pub uri: String,
    steps: Vec<Owned>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Owned {
    Key(String),
    Index(usize),
}

impl Reference {
    /// Its JSON path.
    #[must_use]
    pub fn at(&self) -> String {
        path(self.steps.iter().map(|step| match step {
            Owned::Key(key) => Step::Key(key),
            Owned::Index(i) => Step::Index(*i),
        }))
    }

    /// Its place in a patch.
    pub fn patch<'p>(&self, root: &'p mut Patch) -> &'p mut Patch {
        self.steps.iter().fold(root, |patch, step| match step {
            Owned::Key(key) => patch.member(key),
            Owned::Index(i) => patch.element(*i),
        })
    }
}

/// Every member whose name is `uri` or ends in `Uri`, in the order of the text, but for those of this program's own extension and in
/// `extras`, where nobody knows what they mean.
///
/// # Errors
/// [`EditError::Json`] for a text that is no JSON.
pub fn references(text: &str) -> Result<Vec<Reference>, EditError> {
    let mut found = Collected { steps: Vec::new(), all: Vec::new() };
    let mut reader = serde_json::Deserializer::from_str(text);
    Walk(&mut found).deserialize(&mut reader).map_err(|e| EditError::Json(e.to_string()))?;
    Ok(found.all)
}

/// A path as a URI: what RFC 3986 does not allow in one is escaped.
#[must_use]
pub fn escape(path: &str) -> String {
    let mut out = String::with_capacity(path.len());
    for byte in path.bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~/!$&'()*+,;=@".contains(&byte) {
            out.push(char::from(byte));
        } else {
            out.push_str(&format!("%{byte:02X}"));
        }
    }
    out
}

struct Collected {
    steps: Vec<Owned>,
    all: Vec<Reference>,
}

struct Walk<'f>(&'f mut Collected);

impl<'de> DeserializeSeed<'de> for Walk<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Walk<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        Ok(())
    }

    fn visit_bool<E>(self, _: bool) -> Result<(), E> {
        Ok(())
    }

    fn visit_u64<E>(self, _: u64) -> Result<(), E> {
        Ok(())
    }

    fn visit_i64<E>(self, _: i64) -> Result<(), E> {
        Ok(())
    }

    fn visit_f64<E>(self, _: f64) -> Result<(), E> {
        Ok(())
    }

    fn visit_str<E>(self, text: &str) -> Result<(), E> {
        let named =
            matches!(self.0.steps.last(), Some(Owned::Key(key)) if key == "uri" || key.ends_with("Uri"));
        if named {
            self.0.all.push(Reference { uri: text.to_owned(), steps: self.0.steps.clone() });
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<(), A::Error> {
        for index in 0.. {
            self.0.steps.push(Owned::Index(index));
            let next = seq.next_element_seed(Walk(self.0))?;
            self.0.steps.pop();
            if next.is_none() {
                break;
            }
        }
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        while let Some(key) = map.next_key::<String>()? {
            if key == "extras" || key == super::tables::NAME {
                map.next_value::<IgnoredAny>()?;
                continue;
            }
            self.0.steps.push(Owned::Key(key));
            map.next_value_seed(Walk(self.0))?;
            self.0.steps.pop();
        }
        Ok(())
    }
}
