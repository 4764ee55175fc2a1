//! Changes of a JSON text that leave every other byte as it is: the text of each number, the order of members, members that
//! nobody knows, blanks.
//!
//! A [`Patch`] is a tree of what is to change. What it does not name is copied. A new member comes last in its object, with the
//! blanks that its neighbours have.

use std::collections::BTreeMap;
use std::ops::Range;

use serde::Serialize;
use serde_json::Value;
use serde_json::ser::{PrettyFormatter, Serializer};

use super::raw::{Raw, span};
use crate::scene::json::{Step, path};

/// A new value.
#[derive(Debug, Clone, PartialEq)]
pub enum Json {
    /// A value.
    Value(Value),
    /// The text of one, such as a piece of the document itself, whose numbers are to keep theirs.
    Text(String),
}

impl From<Value> for Json {
    fn from(value: Value) -> Json {
        Json::Value(value)
    }
}

/// What is to become of a value.
#[derive(Debug, Clone, Default)]
pub struct Patch {
    put: Put,
    members: Vec<(String, Patch)>,
    elements: BTreeMap<usize, Patch>,
    pushed: Vec<Json>,
}

#[derive(Debug, Clone, Default)]
enum Put {
    #[default]
    Keep,
    Set(Json),
    Remove,
}

/// Why a text cannot be changed as it was asked.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// It is no JSON.
    #[error("bad JSON: {0}")]
    Json(
        /// The parser's message.
        String,
    ),
    /// A value of another kind than the change needs.
    #[error("{at} is no {expected}, and cannot take what is to be written there")]
    Kind {
        /// JSON path.
        at: String,
        /// `object` or `array`.
        expected: &'static str,
    },
    /// An element that is not there.
    #[error("{at} is not there: the array has {len} elements")]
    Missing {
        /// JSON path.
        at: String,
        /// Elements that there are.
        len: usize,
    },
}

impl Patch {
    /// What is to become of a member of an object. A member that is not there is made if it is set, or if one inside it is.
    pub fn member(&mut self, key: &str) -> &mut Patch {
        let index = self.members.iter().position(|(k, _)| k == key).unwrap_or_else(|| {
            self.members.push((key.to_owned(), Patch::default()));
            self.members.len() - 1
        });
        &mut self.members[index].1
    }

    /// What is to become of a member, if anything is.
    #[must_use]
    pub fn member_ref(&self, key: &str) -> Option<&Patch> {
        self.members.iter().find(|(k, _)| k == key).map(|(_, patch)| patch)
    }

    /// How many values are put behind the last element of this array.
    #[must_use]
    pub fn count_pushed(&self) -> usize {
        self.pushed.len()
    }

    /// What is to become of an element of an array.
    pub fn element(&mut self, index: usize) -> &mut Patch {
        self.elements.entry(index).or_default()
    }

    /// Puts a value here, whatever there was.
    pub fn set(&mut self, value: impl Into<Json>) {
        self.put = Put::Set(value.into());
    }

    /// Takes the member or element away. An object or array that has nothing left stays, empty.
    pub fn remove(&mut self) {
        self.put = Put::Remove;
    }

    /// Puts a value behind the last element of this array.
    pub fn push(&mut self, value: impl Into<Json>) {
        self.pushed.push(value.into());
    }

    /// Changes nothing?
    #[must_use]
    pub fn is_empty(&self) -> bool {
        matches!(self.put, Put::Keep)
            && self.pushed.is_empty()
            && self.members.iter().all(|(_, p)| p.is_empty())
            && self.elements.values().all(Patch::is_empty)
    }

    /// Is there anything to write where there was nothing?
    fn makes(&self) -> bool {
        match self.put {
            Put::Set(_) => true,
            Put::Remove => false,
            Put::Keep => !self.pushed.is_empty() || self.members.iter().any(|(_, p)| p.makes()),
        }
    }
}

/// The text with the changes of a patch.
///
/// # Errors
/// [`EditError`], if it is no JSON or does not have the form that the patch takes for granted.
pub fn edit(text: &str, patch: &Patch) -> Result<String, EditError> {
    let raw = Raw::new(text).map_err(|e| EditError::Json(e.to_string()))?;
    let span = raw.span(text);
    let style = Style::of(raw);
    let value = style.value(raw, patch, if style.lines.is_some() { "\n" } else { "" }, &[])?;
    Ok([&text[..span.start], &value, &text[span.end..]].concat())
}

/// How the document is laid out.
#[derive(Debug)]
struct Style {
    /// What stands between key and value.
    colon: String,
    /// Line break, and the blanks of one level; none where everything stands on one line.
    lines: Option<(&'static str, String)>,
}

impl Style {
    /// That of the first member.
    fn of(root: Raw<'_>) -> Style {
        let mut style = Style { colon: ":".to_owned(), lines: None };
        let Some(first) = root.members().and_then(|m| m.into_iter().next()) else { return style };
        let text = root.text();
        let key = span(first.key, text);
        style.colon = text[key.end..first.value.span(text).start].to_owned();
        let lead = &text[1..key.start];
        if let Some((_, indent)) = lead.rsplit_once('\n') {
            let newline = if lead.contains("\r\n") { "\r\n" } else { "\n" };
            style.lines = Some((newline, indent.to_owned()));
        }
        style
    }

    /// The text that becomes of a value. `lead` are the blanks before it (or its key); if they break the line, so does what is new
    /// inside.
    fn value(&self, raw: Raw<'_>, patch: &Patch, lead: &str, at: &[Step<'_>]) -> Result<String, EditError> {
        match &patch.put {
            Put::Set(json) => Ok(self.new_value(json, lead)),
            _ if patch.is_empty() => Ok(raw.text().to_owned()),
            _ if !patch.members.is_empty() => self.object(raw, patch, lead, at),
            _ => self.array(raw, patch, lead, at),
        }
    }

    fn object(&self, raw: Raw<'_>, patch: &Patch, lead: &str, at: &[Step<'_>]) -> Result<String, EditError> {
        let text = raw.text();
        let members = raw.members().filter(|_| patch.elements.is_empty() && patch.pushed.is_empty());
        let Some(members) = members else {
            return Err(EditError::Kind { at: path(at.iter().copied()), expected: "object" });
        };
        let spans = members.iter().map(|m| span(m.key, text).start..m.value.span(text).end).collect();
        let entries = Entries { text, spans };
        let mut kept = Vec::with_capacity(members.len());
        for (i, member) in members.iter().enumerate() {
            let whole = &text[entries.spans[i].clone()];
            kept.push(match patch.members.iter().find(|(key, _)| member.is(key)) {
                None => Some(whole.to_owned()),
                Some((_, Patch { put: Put::Remove, .. })) => None,
                Some((key, inner)) => {
                    let head = &whole[..whole.len() - member.value.text().len()];
                    let at = [at, &[Step::Key(key)]].concat();
                    Some(format!("{head}{}", self.value(member.value, inner, entries.lead(i), &at)?))
                }
            });
        }
        let mut new = Vec::new();
        let inside = entries.lead_of_new().map_or_else(|| self.inside(lead).0, str::to_owned);
        for (key, inner) in
            patch.members.iter().filter(|(k, p)| p.makes() && !members.iter().any(|m| m.is(k)))
        {
            let at = [at, &[Step::Key(key)]].concat();
            let value = self.made(inner, &inside, &at)?;
            new.push(format!("{}{}{value}", Value::from(key.as_str()), self.colon));
        }
        Ok(entries.joined(&kept, &new, &self.inside(lead)))
    }

    fn array(&self, raw: Raw<'_>, patch: &Patch, lead: &str, at: &[Step<'_>]) -> Result<String, EditError> {
        let text = raw.text();
        let items =
            raw.items().ok_or_else(|| EditError::Kind { at: path(at.iter().copied()), expected: "array" })?;
        if let Some((&index, _)) = patch.elements.range(items.len()..).next() {
            let at = [at, &[Step::Index(index)]].concat();
            return Err(EditError::Missing { at: path(at.into_iter()), len: items.len() });
        }
        let entries = Entries { text, spans: items.iter().map(|item| item.span(text)).collect() };
        let mut kept = Vec::with_capacity(items.len());
        for (i, item) in items.iter().enumerate() {
            kept.push(match patch.elements.get(&i) {
                None => Some(item.text().to_owned()),
                Some(Patch { put: Put::Remove, .. }) => None,
                Some(inner) => {
                    let at = [at, &[Step::Index(i)]].concat();
                    Some(self.value(*item, inner, entries.lead(i), &at)?)
                }
            });
        }
        let inside = entries.lead_of_new().map_or_else(|| self.inside(lead).0, str::to_owned);
        let new: Vec<String> = patch.pushed.iter().map(|json| self.new_value(json, &inside)).collect();
        Ok(entries.joined(&kept, &new, &self.inside(lead)))
    }

    /// A value where there was none.
    fn made(&self, patch: &Patch, lead: &str, at: &[Step<'_>]) -> Result<String, EditError> {
        let empty = if patch.members.is_empty() { "[]" } else { "{}" };
        self.value(Raw::new(empty).map_err(|e| EditError::Json(e.to_string()))?, patch, lead, at)
    }

    /// Blanks before each entry of a container behind `lead`, and before its end.
    fn inside(&self, lead: &str) -> (String, String) {
        match (&self.lines, lead.rsplit_once('\n')) {
            (Some((newline, unit)), Some((_, own))) => {
                (format!("{newline}{own}{unit}"), format!("{newline}{own}"))
            }
            _ => (String::new(), String::new()),
        }
    }

    /// The text of a new value, in the lines of the document.
    fn new_value(&self, json: &Json, lead: &str) -> String {
        let value = match json {
            Json::Text(text) => return text.clone(),
            Json::Value(value) => value,
        };
        let (Some((_, unit)), (_, end)) = (&self.lines, self.inside(lead)) else { return value.to_string() };
        if end.is_empty() {
            return value.to_string();
        }
        let mut bytes = Vec::new();
        let mut writer =
            Serializer::with_formatter(&mut bytes, PrettyFormatter::with_indent(unit.as_bytes()));
        // writing into memory does not fail, and neither does a value that is one
        if value.serialize(&mut writer).is_err() {
            return value.to_string();
        }
        // in JSON a line breaks between values only
        String::from_utf8_lossy(&bytes).replace('\n', &end)
    }
}

/// The entries of a container in its text, keys included.
struct Entries<'a> {
    text: &'a str,
    spans: Vec<Range<usize>>,
}

impl<'a> Entries<'a> {
    /// The blanks before and behind the comma (or the bracket) that an entry follows.
    fn lead(&self, i: usize) -> &'a str {
        let from = if i == 0 { 1 } else { self.spans[i - 1].end };
        let between = &self.text[from..self.spans[i].start];
        between.rsplit_once(',').map_or(between, |(_, lead)| lead)
    }

    /// The blanks between an entry and the comma or bracket behind it.
    fn tail(&self, i: usize) -> &'a str {
        let to = self.spans.get(i + 1).map_or(self.text.len() - 1, |next| next.start);
        let between = &self.text[self.spans[i].end..to];
        between.split_once(',').map_or(between, |(tail, _)| tail)
    }

    /// The blanks that a new entry has before it, where there are others.
    fn lead_of_new(&self) -> Option<&'a str> {
        self.spans.len().checked_sub(1).map(|last| self.lead(last))
    }

    /// The container with what is left of its entries and with new ones.
    fn joined(&self, kept: &[Option<String>], new: &[String], blanks: &(String, String)) -> String {
        let (open, close) = (&self.text[..1], &self.text[self.text.len() - 1..]);
        let old = kept
            .iter()
            .enumerate()
            .filter_map(|(i, text)| Some((self.lead(i), text.as_ref()?, self.tail(i))));
        let lead = self.lead_of_new().unwrap_or(&blanks.0);
        let all: Vec<_> = old.chain(new.iter().map(|text| (lead, text, ""))).collect();
        let end = match self.spans.len() {
            0 if new.is_empty() || self.text.len() > 2 => &self.text[1..self.text.len() - 1],
            0 => blanks.1.as_str(),
            n if !all.is_empty() => self.tail(n - 1),
            _ => "",
        };
        let mut out = open.to_owned();
        for (i, (lead, text, tail)) in all.iter().enumerate() {
            out.push_str(lead);
            out.push_str(text);
            if i + 1 < all.len() {
                out.push_str(tail);
                out.push(',');
            }
        }
        out.push_str(end);
        out.push_str(close);
        out
    }
}
