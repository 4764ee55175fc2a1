//! Why the tables were baked, where scenes asked for them, and what was left out.

use super::facts::captioned;
use maud::{Markup, html};
use serde_json::Value as Json;

/// What the manifest says of scenes.
pub(super) fn why(scenes: &Json) -> Markup {
    html! {
        p { @for f in list(scenes, "files") {
            (text(f, "file")) ": " (number(f, "materials")) " materials, " (number(f, "images")) " pictures. "
        } }
        @let needs = list(scenes, "needs");
        (captioned("why the tables were baked", "Who asks for what", html! {
            table {
                thead { tr { th scope="col" { "lobe" } th scope="col" { "tables" } th scope="col" { "material" } th scope="col" { "because of" } } }
                tbody {
                    @for need in needs { @for asked in list(need, "asked_by") { tr {
                        td { (text(need, "table")) } td { (tables(scenes, text(need, "table"))) }
                        td { (asked.get("material").map(material).unwrap_or_default()) } td { (text(asked, "why")) }
                    } } }
                    @if needs.is_empty() { tr { td colspan="4" { "Nothing asks for a table." } } }
                }
            }
        }))
        @let left_out = list(scenes, "left_out");
        @if !left_out.is_empty() {
            (captioned("what was left out", "Left out", html! {
                table {
                    thead { tr { th scope="col" { "what" } th scope="col" { "why" } th scope="col" { "materials" } } }
                    tbody { @for l in left_out { tr {
                        th scope="row" { (text(l, "what")) } td { (text(l, "why")) }
                        td { (list(l, "materials").iter().map(material).collect::<Vec<_>>().join("; ")) }
                    } } }
                }
            }))
        }
    }
}

/// Tables that serve a family of lobes.
fn tables(scenes: &Json, family: &str) -> String {
    let of = list(scenes, "tables").iter().filter(|t| text(t, "family") == family);
    of.map(|t| text(t, "table")).collect::<Vec<_>>().join(", ")
}

fn material(m: &Json) -> String {
    let place = match (m.get("name").and_then(Json::as_str), m.get("index").and_then(Json::as_u64)) {
        (Some(name), _) => name.to_owned(),
        (None, Some(index)) => format!("material {index}"),
        (None, None) => "no material".to_owned(),
    };
    format!("{}: {place}", text(m, "file"))
}

fn list<'a>(of: &'a Json, key: &str) -> &'a [Json] {
    of.get(key).and_then(Json::as_array).map_or(&[], Vec::as_slice)
}

fn text<'a>(of: &'a Json, key: &str) -> &'a str {
    of.get(key).and_then(Json::as_str).unwrap_or_default()
}

fn number(of: &Json, key: &str) -> u64 {
    of.get(key).and_then(Json::as_u64).unwrap_or_default()
}
