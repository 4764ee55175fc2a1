//! What would be baked, at what cost, whoever asks for it: said by `plan` and by `bake --dry-run`.

use crate::math::figures::short;
use crate::models::{DefaultValue, Kind};
use crate::pipeline::cost::{self, Cost};
use crate::pipeline::memory;
use crate::plan::{Plan, PlannedMap, PlannedTable};
use crate::report::page;
use bytesize::ByteSize;
use serde_json::{Value as Json, json};

/// One line a table and a map, the sum, and the page if there is to be one.
pub(super) fn text(plan: &Plan, report: bool) -> String {
    let costs: Vec<Cost> = plan.tables.iter().map(cost::of_table).collect();
    let lines = plan.tables.iter().zip(&costs).map(|(t, c)| line(t, c));
    let mut text = lines.chain(plan.maps.iter().map(map_line)).collect::<Vec<_>>().join("\n");
    let (bytes, seconds) = costs.iter().fold((0, 0.0), |(b, s), c| (b + c.bytes, s + c.seconds));
    if costs.len() > 1 {
        text.push_str(&format!("\nall: at most {}, about {}", size(bytes), time(seconds)));
    }
    if text.is_empty() {
        return "nothing to bake".to_owned();
    }
    if report {
        text.push_str(&format!("\n{}: a page of all that", page::NAME));
    }
    text
}

/// An object, and the same as keys of it.
pub(super) fn json(mut all: Json, plan: &Plan, report: bool) -> Json {
    if !plan.maps.is_empty() {
        all["planned_maps"] = plan.maps.iter().map(map).collect();
    }
    all["planned"] = plan.tables.iter().map(|t| table(t, &cost::of_table(t))).collect();
    if report {
        all["report"] = page::NAME.into();
    }
    all
}

fn size(bytes: u64) -> String {
    ByteSize::b(bytes).display().si().to_string()
}

fn time(seconds: f64) -> String {
    if seconds < 0.095 { format!("{:.0} ms", seconds * 1e3) } else { format!("{seconds:.1} s") }
}

fn axes(table: &PlannedTable) -> Vec<Json> {
    let axes = table.bound.spec.grid.axes().iter();
    axes.map(|a| json!({ "id": a.quantity.id, "domain": a.domain, "length": a.len })).collect()
}

fn table(table: &PlannedTable, cost: &Cost) -> Json {
    let spec = &table.bound.spec;
    json!({
        "table": table.name(),
        "kind": spec.kind.id,
        "model": spec.model.as_ref().map(|(info, _)| info.id),
        "params": table.asked.request.params,
        "channels": spec.layout.ids().collect::<Vec<_>>(),
        "axes": axes(table),
        "tolerance": table.tolerance,
        "files": table.files(),
        "texels": spec.grid.len(),
        "bytes": cost.bytes,
        "seconds": cost.seconds,
    })
}

fn map(map: &PlannedMap) -> Json {
    json!({ "map": map.name(), "size": map.size, "levels": map.levels(), "memory": memory::map(map), "files": map.files(), "asked": map.asked.canonical() })
}

fn map_line(map: &PlannedMap) -> String {
    let kinds: Vec<&str> = map.asked.kinds().iter().map(|k| k.id()).collect();
    let [w, h] = map.size;
    let (name, kinds, files) = (map.name(), kinds.join(", "), map.files().join(", "));
    let memory = size(memory::map(map));
    format!(
        "{name}: map of {kinds}; {w} x {h}, {} levels, at most {memory} of memory -> {files}",
        map.levels()
    )
}

fn line(table: &PlannedTable, cost: &Cost) -> String {
    let spec = &table.bound.spec;
    let axis = |a: &crate::grid::Axis| {
        let [lo, hi] = a.domain;
        format!("{} [{}, {}] x {}", a.quantity.id, short(lo), short(hi), a.len)
    };
    let axes = spec.grid.axes().iter().map(axis).collect::<Vec<_>>().join(", ");
    let fixed = table.asked.request.params.iter().filter(|(id, value)| !is_default(table, id, value));
    let fixed: Vec<String> = fixed.map(|(id, value)| format!("{id} = {}", value_text(value))).collect();
    let fixed = if fixed.is_empty() { String::new() } else { format!("; {}", fixed.join(", ")) };
    format!(
        "{}: {} over {axes}{fixed}; at most {}, about {} -> {}",
        table.name(),
        spec.layout.ids().collect::<Vec<_>>().join(", "),
        size(cost.bytes),
        time(cost.seconds),
        table.files().join(", ")
    )
}

/// Is a parameter left as it is?
fn is_default(table: &PlannedTable, id: &str, value: &Json) -> bool {
    let spec = &table.bound.spec;
    let model = spec.model.as_ref().map_or(&[][..], |(info, _)| info.params);
    let param = spec.kind.params.iter().chain(model).find(|p| p.is_called(id));
    param.is_some_and(|p| match p.kind {
        Kind::Number { preset: DefaultValue::Value(v), .. } => {
            value.as_f64().is_some_and(|x| (x - v).abs() <= 0.0)
        }
        Kind::Choice(words) => value.as_str() == words.first().copied(),
        _ => false,
    })
}

/// A parameter as it is shown: a number in the fewest digits, a word without quotes.
fn value_text(value: &Json) -> String {
    match (value.as_f64(), value.as_str()) {
        (Some(number), _) => short(number),
        (_, Some(word)) => word.to_owned(),
        _ => value.to_string(),
    }
}
