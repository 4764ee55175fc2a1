//! The JSON schema of recipes, for editors and for programs that write recipes. It says which keys there are and what form their
//! values have; whether they make sense together is judged by the plan.

use super::keys::{Is, Key, Keys, Need, ROOT};
use super::section::{LONGEST_AROUND, LONGEST_TEXT};
use serde_json::{Map, Value as Json, json};

/// The schema, of the draft 2020-12.
///
/// ```
/// let schema = brdfbake::recipe::schema();
/// assert_eq!(schema["required"], serde_json::json!(["name"]));
/// ```
#[must_use]
pub fn schema() -> Json {
    let mut whole = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A recipe of brdfbake",
    });
    if let (Some(to), Json::Object(from)) = (whole.as_object_mut(), section(&ROOT)) {
        to.extend(from);
    }
    whole
}

fn section(keys: &Keys) -> Json {
    let mut object = Map::new();
    object.insert("type".to_owned(), "object".into());
    let properties: Map<String, Json> = keys.keys.iter().map(|k| (k.id.to_owned(), property(k))).collect();
    object.insert("properties".to_owned(), Json::Object(properties));
    object.insert("additionalProperties".to_owned(), false.into());
    let always = |k: &&Key| matches!(k.need, Need::Always(_)) && !keys.free.contains(&k.id);
    let required: Vec<&str> = keys.keys.iter().filter(always).map(|k| k.id).collect();
    if !required.is_empty() {
        object.insert("required".to_owned(), json!(required));
    }
    for key in keys.keys {
        if let Need::Unless(others, _) = key.need {
            let any = std::iter::once(&key.id).chain(others).map(|id| json!({ "required": [id] }));
            object.insert("anyOf".to_owned(), any.collect());
        }
    }
    if keys.alone {
        object.insert("minProperties".to_owned(), 1.into());
        object.insert("maxProperties".to_owned(), 1.into());
    }
    if let Some((without, id, is)) = &keys.without {
        object.insert("if".to_owned(), json!({ "not": { "required": [without] } }));
        object.insert("then".to_owned(), json!({ "properties": { *id: value(is) } }));
    }
    Json::Object(object)
}

fn property(key: &Key) -> Json {
    let mut property = value(&key.is);
    if let Some(object) = property.as_object_mut() {
        object.insert("description".to_owned(), key.doc.into());
    }
    property
}

fn value(is: &Is) -> Json {
    match is {
        Is::Text => json!({ "type": "string", "pattern": "\\S", "maxLength": LONGEST_TEXT }),
        Is::LongText => json!({ "type": "string", "maxLength": LONGEST_AROUND }),
        Is::Form(form) => json!({ "type": "string", "pattern": form() }),
        Is::Word(words) => json!({ "enum": words() }),
        Is::Number => json!({ "type": "number" }),
        Is::Count => json!({ "type": "integer", "minimum": 0 }),
        Is::Pair => json!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 }),
        Is::List(item, [least, most]) => {
            json!({ "type": "array", "items": value(item), "minItems": least, "maxItems": most })
        }
        Is::Section(keys) => section(keys),
        Is::Params => {
            let list = |items: Json| json!({ "type": "array", "items": items });
            let row = list(json!({ "type": "number" }));
            let one = json!([{ "type": "number" }, { "type": "string" }, row, list(row.clone())]);
            json!({ "type": "object", "additionalProperties": { "anyOf": one } })
        }
        Is::Any(all) => json!({ "anyOf": all.iter().map(value).collect::<Vec<_>>() }),
    }
}
