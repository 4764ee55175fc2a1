//! Requests as the text of a recipe that reads back to the same plan.
//!
//! The keys are those of the canonical form, so a new key is written without a line here. What an axis has by default is left out.

use super::write_map;
use crate::plan::map::MapRequest;
use crate::plan::{TableRequest, canonical};
use serde_json::{Map, Value as Json, json};
use std::fmt::Write;

/// The recipe with these tables. Of a plan, by [`Plan::requests`](crate::plan::Plan::requests), it says everything; of other requests
/// what they say.
///
/// ```
/// use brdfbake::plan::{Plan, TableRequest};
/// use brdfbake::recipe::{parse, text};
/// use brdfbake::tables::spec::Request;
///
/// let table = TableRequest::new("e", Request { kind: "albedo".into(), ..Request::default() });
/// let plan = parse(&text("mine", &[table]), "mine.toml")?;
/// let again = parse(&text("mine", &plan.requests()), "again.toml")?;
/// assert_eq!(again.hash, plan.hash);
/// # Ok::<(), brdfbake::recipe::RecipeError>(())
/// ```
#[must_use]
pub fn text(name: &str, tables: &[TableRequest]) -> String {
    text_of(name, tables, Vec::new())
}

/// [`text`] with maps behind the tables: the whole of a plan. None where an image of a map lies in another file, as those of scenes may, or under
/// a path that is no text.
#[must_use]
pub fn text_with_maps(name: &str, tables: &[TableRequest], maps: &[MapRequest]) -> Option<String> {
    let maps: Option<Vec<Map<String, Json>>> = maps.iter().map(write_map::map).collect();
    Some(text_of(name, tables, maps?))
}

fn text_of(name: &str, tables: &[TableRequest], maps: Vec<Map<String, Json>>) -> String {
    let mut out = format!("name = {}\n", string(name));
    for table in tables {
        out.push_str("\n[[table]]\n");
        let mut keys = canonical::table(table);
        let axes = keys.remove("axis");
        pairs(&mut out, &keys);
        for axis in axes.iter().filter_map(Json::as_array).flatten().filter_map(Json::as_object) {
            let mut axis = axis.clone();
            for (key, preset) in
                [("warp", json!("linear")), ("direction", json!("ascending")), ("offset", json!(0.0))]
            {
                if axis.get(key) == Some(&preset) {
                    axis.remove(key);
                }
            }
            out.push_str("\n[[table.axis]]\n");
            pairs(&mut out, &axis);
        }
    }
    for keys in maps {
        out.push_str("\n[[map]]\n");
        pairs(&mut out, &keys);
    }
    out
}

/// `key = value` lines.
fn pairs(out: &mut String, keys: &Map<String, Json>) {
    for (k, v) in keys {
        // writing to a string does not fail
        let _ = writeln!(out, "{} = {}", key(k), value(v));
    }
}

/// A value in one line. JSON and TOML write numbers and booleans alike.
fn value(json: &Json) -> String {
    match json {
        Json::String(text) => string(text),
        Json::Array(items) => format!("[{}]", items.iter().map(value).collect::<Vec<_>>().join(", ")),
        Json::Object(map) if map.is_empty() => "{}".to_owned(),
        Json::Object(map) => {
            let pair = |(k, v): (&String, &Json)| format!("{} = {}", key(k), value(v));
            format!("{{ {} }}", map.iter().map(pair).collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}

fn key(text: &str) -> String {
    let bare = |b: u8| b.is_ascii_alphanumeric() || b == b'-' || b == b'_';
    if !text.is_empty() && text.bytes().all(bare) { text.to_owned() } else { string(text) }
}

/// A basic string: the escapes of JSON, and one of a character that JSON takes as it is.
fn string(text: &str) -> String {
    Json::from(text).to_string().replace('\u{7f}', "\\u007f")
}
