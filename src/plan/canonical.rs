//! The canonical form of a request: its keys under the names that recipes have for them, in fixed order. A key that is not given
//! is left out, so the form of a resolved request has every default filled in. Numbers are written in the shortest form that
//! reads back to the same bits.

use super::request::TableRequest;
use crate::grid::{Axis, Direction, Texel, Warp};
use serde_json::{Map, Value as Json, json};

/// A table. The keys of what its numbers mean are written here, all others by [`TableRequest`] itself.
pub(crate) fn table(asked: &TableRequest) -> Map<String, Json> {
    let request = &asked.request;
    let mut map = Map::new();
    let mut put = |key: &str, value: Option<Json>| {
        if let Some(value) = value {
            map.insert(key.to_owned(), value);
        }
    };
    put("kind", Some(request.kind.as_str().into()));
    put("name", Some(asked.name.as_str().into()));
    put("layout", request.layout.as_deref().map(Json::from));
    put("channels", request.channels.as_deref().map(Json::from));
    put("model", request.model.as_deref().map(Json::from));
    put("params", (!request.params.is_empty()).then(|| request.params.clone().into()));
    // a request has nothing that JSON cannot hold
    if let Ok(Json::Object(keys)) = serde_json::to_value(asked) {
        map.extend(keys);
    }
    if let Some(axes) = &request.axes {
        let searched = |i: &usize| asked.size.as_ref().is_some_and(|s| s.axes.contains(i));
        let axes = axes.iter().enumerate().map(|(i, a)| axis(a, !searched(&i))).collect();
        map.insert("axis".to_owned(), axes);
    }
    map
}

/// `sized`: it has a length of its own.
fn axis(axis: &Axis, sized: bool) -> Json {
    let mut map = Map::new();
    let mut put = |key: &str, value: Json| drop(map.insert(key.to_owned(), value));
    put("id", axis.quantity.id.into());
    if sized {
        put("length", axis.len.into());
    }
    put("domain", axis.domain.to_vec().into());
    put("warp", warp(&axis.warp));
    put("texel", if axis.texel == Texel::Center { "center" } else { "endpoint" }.into());
    put("direction", if axis.direction == Direction::Ascending { "ascending" } else { "descending" }.into());
    put("offset", axis.offset.into());
    if let Some(clamp) = axis.clamp {
        put("clamp", clamp.to_vec().into());
    }
    Json::Object(map)
}

fn warp(warp: &Warp) -> Json {
    match warp {
        Warp::Linear => "linear".into(),
        Warp::Power(p) => json!({ "power": p }),
        Warp::OneMinusPower(p) => json!({ "one-minus-power": p }),
        Warp::Coupled { to, power, scale, exponent } => {
            json!({ "coupled": to, "power": power, "scale": scale, "exponent": exponent })
        }
    }
}
