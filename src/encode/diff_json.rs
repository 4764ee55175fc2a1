//! Compares two JSON values and names the first place where they differ. The order of keys does not count.

use serde::Serialize;
use serde_json::Value;

/// The first difference of two JSON values.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct JsonDiff {
    /// Where: `tables[0].hash`; empty for the whole value.
    pub path: String,
    /// Value in the first, as JSON text, cut after 80 characters; none if it is absent.
    pub a: Option<String>,
    /// Value in the second.
    pub b: Option<String>,
}

/// The first difference, in the order of the first value; `None` if they are equal.
#[must_use]
pub fn first_difference(a: &Value, b: &Value) -> Option<JsonDiff> {
    let mut path = String::new();
    walk(Some(a), Some(b), &mut path)
}

fn walk(a: Option<&Value>, b: Option<&Value>, path: &mut String) -> Option<JsonDiff> {
    match (a, b) {
        (Some(Value::Object(x)), Some(Value::Object(y))) => {
            let new = y.keys().filter(|k| !x.contains_key(*k));
            x.keys().chain(new).find_map(|key| {
                let dot = if path.is_empty() { "" } else { "." };
                step(path, &format!("{dot}{key}"), |path| walk(x.get(key), y.get(key), path))
            })
        }
        (Some(Value::Array(x)), Some(Value::Array(y))) => (0..x.len().max(y.len()))
            .find_map(|i| step(path, &format!("[{i}]"), |path| walk(x.get(i), y.get(i), path))),
        _ if a == b => None,
        _ => Some(JsonDiff { path: path.clone(), a: a.map(brief), b: b.map(brief) }),
    }
}

/// Goes one step down the path and back.
fn step<T>(path: &mut String, part: &str, f: impl FnOnce(&mut String) -> T) -> T {
    let len = path.len();
    path.push_str(part);
    let result = f(path);
    path.truncate(len);
    result
}

fn brief(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(80) {
        Some((cut, _)) => format!("{}...", &text[..cut]),
        None => text,
    }
}
