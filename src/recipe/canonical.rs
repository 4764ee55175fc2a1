//! The canonical form of a table and its hash. The keys are those of a recipe, in fixed order; a key whose default is
//! "none" is left out. Numbers are written in the shortest form that reads back to the same bits.

use super::plan::PlannedTable;
use crate::grid::{Axis, Direction, Texel, Warp};
use crate::models::Kind;
use crate::tables::driver::OnMiss;
use serde_json::{Map, Value as Json, json};

/// blake3 of a canonical form and the program version, in hex.
pub(super) fn hash(canonical: &Json) -> String {
    let text = format!("{canonical}\n{}", env!("CARGO_PKG_VERSION"));
    blake3::hash(text.as_bytes()).to_hex().to_string()
}

/// Name and tables.
pub(super) fn plan(name: &str, tables: &[PlannedTable]) -> Json {
    json!({ "name": name, "table": tables.iter().map(|t| t.canonical.clone()).collect::<Vec<_>>() })
}

/// A table with everything filled in.
pub(super) fn table(table: &PlannedTable) -> Json {
    let spec = &table.bound.spec;
    let mut map = Map::new();
    let mut put = |key: &str, value: Json| drop(map.insert(key.to_owned(), value));
    put("kind", spec.kind.id.into());
    put("name", table.name.as_str().into());
    if let Some(file) = &table.file {
        put("file", file.as_str().into());
    }
    for (key, text) in ["before", "after"].into_iter().zip(&table.around) {
        if let Some(text) = text {
            put(key, text.as_str().into());
        }
    }
    if spec.layout.is_custom() {
        put("channels", spec.layout.ids().collect::<Vec<_>>().into());
    } else {
        put("layout", spec.layout.id.into());
    }
    if let Some((info, _)) = &spec.model {
        put("model", info.id.into());
    }
    put("params", params(table));
    put("tolerance", table.tolerance.into());
    let mut outputs: Vec<String> = table.outputs.iter().map(ToString::to_string).collect();
    outputs.sort();
    put("outputs", outputs.into());
    put("on-miss", if table.on_miss == OnMiss::Fail { "fail" } else { "report" }.into());
    put("reconstruction", if table.reconstruction { "on" } else { "off" }.into());
    if let Some(size) = &table.size {
        put("size", size.canonical());
    }
    if !table.texels.are_exact() {
        put("texels", table.texels.id().into());
    }
    let waivers = table.waivers.iter().map(|w| json!({ "law": w.law, "reason": w.reason }));
    put("waive", waivers.collect());
    let searched = |i: &usize| table.size.as_ref().is_some_and(|s| s.axes.contains(i));
    put("axis", spec.grid.axes().iter().enumerate().map(|(i, a)| axis(a, !searched(&i))).collect());
    Json::Object(map)
}

/// Parameters of the model, then of the kind, without those that an axis sweeps.
fn params(table: &PlannedTable) -> Json {
    let spec = &table.bound.spec;
    let swept = spec.swept();
    let mut map = Map::new();
    let model = spec.model.iter().map(|(info, params)| (info.params, params));
    for (declared, params) in model.chain([(spec.kind.params, &spec.params)]) {
        for param in declared.iter().filter(|p| !swept.contains(&p.id)) {
            let value = match param.kind {
                Kind::Number { .. } => Json::from(params.number(param.id) + 0.0),
                Kind::Choice(_) => Json::from(params.choice(param.id)),
                Kind::Rows { .. } => {
                    params.rows(param.id).iter().map(|row| Json::from(row.as_slice())).collect()
                }
            };
            map.insert(param.id.to_owned(), value);
        }
    }
    Json::Object(map)
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
