//! A request as a recipe: the text that reads back to it. What is a default is left out.

use super::TableRequest;
use crate::grid::{Axis, Direction, Texel, Warp};
use std::fmt::Write;

/// A recipe with one table. Waivers and `size` are not written: they are of no use to what a program suggests.
///
/// ```
/// use brdfbake::recipe::{TableRequest, parse, text};
/// use brdfbake::tables::spec::Request;
///
/// let request = Request { kind: "albedo".into(), ..Request::default() };
/// let plan = parse(&text("mine", &TableRequest::new("e", request)), "mine.toml")?;
/// assert_eq!(plan.tables[0].name, "e");
/// # Ok::<(), brdfbake::recipe::RecipeError>(())
/// ```
#[must_use]
pub fn text(name: &str, table: &TableRequest) -> String {
    let request = &table.request;
    let mut out =
        format!("name = \"{name}\"\n\n[[table]]\nkind = \"{}\"\nname = \"{}\"\n", request.kind, table.name);
    let mut put = |key: &str, value: String| {
        let _ = writeln!(out, "{key} = {value}");
    };
    if let Some(layout) = &request.layout {
        put("layout", quoted(layout));
    }
    if let Some(channels) = &request.channels {
        put("channels", list(channels));
    }
    if let Some(model) = &request.model {
        put("model", quoted(model));
    }
    if !request.params.is_empty() {
        let params: Vec<String> = request.params.iter().map(|(k, v)| format!("{k} = {v}")).collect();
        put("params", format!("{{ {} }}", params.join(", ")));
    }
    if let Some(tolerance) = table.tolerance {
        put("tolerance", format!("{tolerance:?}"));
    }
    let outputs: Vec<String> = table.outputs.iter().map(ToString::to_string).collect();
    put("outputs", list(&outputs));
    if !table.reconstruction {
        put("reconstruction", quoted("off"));
    }
    for axis in request.axes.iter().flatten() {
        out.push_str(&axis_text(axis));
    }
    out
}

fn axis_text(axis: &Axis) -> String {
    let mut out = format!("\n[[table.axis]]\nid = \"{}\"\nlength = {}\n", axis.quantity.id, axis.len);
    let mut put = |key: &str, value: String| {
        let _ = writeln!(out, "{key} = {value}");
    };
    let pair = |[a, b]: [f64; 2]| format!("[{a:?}, {b:?}]");
    put("domain", pair(axis.domain));
    match &axis.warp {
        Warp::Linear => {}
        Warp::Power(p) => put("warp", format!("{{ power = {p:?} }}")),
        Warp::OneMinusPower(p) => put("warp", format!("{{ one-minus-power = {p:?} }}")),
        Warp::Coupled { to, power, scale, exponent } => put(
            "warp",
            format!(
                "{{ coupled = \"{to}\", power = {power:?}, scale = {scale:?}, exponent = {exponent:?} }}"
            ),
        ),
    }
    put("texel", quoted(if axis.texel == Texel::Center { "center" } else { "endpoint" }));
    if axis.direction == Direction::Descending {
        put("direction", quoted("descending"));
    }
    if axis.offset.abs() > 0.0 {
        put("offset", format!("{:?}", axis.offset));
    }
    if let Some(clamp) = axis.clamp {
        put("clamp", pair(clamp));
    }
    out
}

fn quoted(text: &str) -> String {
    format!("\"{text}\"")
}

fn list(items: &[String]) -> String {
    let items: Vec<String> = items.iter().map(|i| quoted(i)).collect();
    format!("[{}]", items.join(", "))
}
