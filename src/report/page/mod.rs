//! The report of a bake as HTML: one page, or an index with a page a table where one would be larger than [`LIMIT`].
//!
//! A page loads nothing: pictures are data URIs, style and script are its own, and its content security policy forbids the rest. All
//! text goes through a library that escapes it (`maud`). Data for the script are attributes, so that no name can end a script.
//! Bytes depend on nothing but what is shown.

mod against;
mod colour;
mod curves;
mod effort;
mod facts;
mod lobes;
mod maps;
mod parameter_maps;
mod shown;
mod spheres;
mod view;
mod why;
mod worst;

pub use parameter_maps::map_section;
pub use view::{
    Against, Convergence, FileView, Head, MapFileView, MapLevel, MapPlane, MapView, Origin, Texels, View,
};

use crate::grid::table::place;
use crate::math::figures::{short, significant};
use colour::{Meaning, Scale};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use shown::Shown;

/// Most bytes of a page that holds all tables.
pub const LIMIT: usize = 2_000_000;

/// Name of the page, in the folder that it is of.
pub const NAME: &str = "report.html";

const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");
const POLICY: &str =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// What a page says of one table, or of one parameter map.
#[derive(Debug)]
pub struct Section {
    name: String,
    thumbnail: Option<String>,
    cells: Cells,
    seconds: Option<[f64; 2]>,
    /// Error against time.
    times: Option<Markup>,
    body: Markup,
}

/// The line of an overview.
#[derive(Debug)]
enum Cells {
    Table([String; 8]),
    Map([String; 6]),
}

impl Cells {
    fn cells(&self, maps: bool) -> Option<&[String]> {
        match self {
            Cells::Table(cells) => (!maps).then_some(cells),
            Cells::Map(cells) => maps.then_some(cells),
        }
    }
}

/// Name of the page of a table or map, counted from 0, tables before maps, where it has one of its own.
#[must_use]
pub fn page_of(table: usize) -> String {
    format!("report-{}.html", table + 1)
}

/// Renders a table; it can be dropped then.
#[must_use]
pub fn section(view: &View, against: Option<&str>) -> Section {
    let p = &view.provenance;
    let reading = view.files.iter().filter_map(|f| f.reconstruction.as_ref());
    let most = |values: Vec<f64>| {
        values.into_iter().reduce(f64::max).map_or_else(|| "-".to_owned(), |v| significant(v, 2))
    };
    let whole = most(reading.clone().map(|r| r.whole.largest.value).collect());
    let practical = most(reading.filter_map(|r| r.practical.as_ref()).map(|s| s.largest.value).collect());
    let size = p.axes.iter().map(|r| r.axis.len.to_string()).collect::<Vec<_>>().join(" x ");
    let cells = [
        size,
        significant(p.integration.largest_error.value, 2),
        significant(p.integration.tolerance, 2),
        most(view.files.iter().map(|f| f.encoding.largest_error).collect()),
        format!("{whole} ({practical})"),
        p.integration.evaluations.to_string(),
        facts::laws_held(view),
        facts::verified(view).to_owned(),
    ];
    Section {
        name: p.name.clone(),
        thumbnail: view.texels.as_ref().ok().and_then(thumbnail),
        cells: Cells::Table(cells),
        seconds: view.seconds,
        times: view.convergence.as_ref().ok().and_then(effort::times),
        body: body(view, against),
    }
}

fn thumbnail(texels: &Texels) -> Option<String> {
    // 16 times as many channels: a picture of at most 64 texels a side, or less where there are slices
    let shown = Shown::new(&texels.grid, texels.channels().max(16), None);
    let n = texels.channels();
    let values: Vec<f64> = shown.texels(0).map(|t| texels.stored[t * n]).collect();
    Some(Scale::of(Meaning::Value, values.iter().copied())?.picture(shown.size()[0], values.into_iter()))
}

fn body(view: &View, against: Option<&str>) -> Markup {
    let p = &view.provenance;
    let e = &p.integration.largest_error;
    html! {
        p {
            strong { (facts::verified(view)) } "; " (facts::laws_held(view)) " laws held. Largest estimate of the integrals "
            (significant(e.value, 3)) " (" (short(p.integration.tolerance)) " asked for), " (e.channel) " at " (place(&e.at)) "."
        }
        @match &view.texels {
            Ok(texels) => {
                @let shown = Shown::new(&texels.grid, texels.channels(), texels.worst().map(|w| w / texels.channels()));
                section.table {
                    h3 { "Texels" } (maps::maps(view, texels, &shown))
                    h3 { "Worst texels" } (worst::worst(view, texels, &shown))
                }
                h3 { "Curves" } (curves::curves(view, texels))
                @if let Some(spheres) = spheres::spheres(view, texels) { h3 { "Spheres" } (spheres) }
            }
            Err(why) => p { strong { "No picture: " (why) } }
        }
        @if let Some(lobes) = lobes::lobes(view) { h3 { "Lobes" } (lobes) }
        h3 { "Error budget" } (facts::budget(view))
        h3 { "Laws" } (facts::laws(view))
        h3 { "Effort" } (facts::effort(view)) (effort::chart(view))
        @if let Some(name) = against {
            h3 { "Comparison" }
            @match &view.against {
                Some(other) => (against::against(view, other, name)),
                None => p { (name) " has no table of this name." },
            }
        }
        h3 { "What it is" } (facts::description(view))
    }
}

/// The page, or the index and its pages: names and bytes.
#[must_use]
pub fn pages(head: &Head, sections: &[Section]) -> Vec<(String, Vec<u8>)> {
    let whole = whole(head, sections);
    if whole.len() <= LIMIT || sections.len() < 2 {
        return vec![(NAME.to_owned(), whole.into_bytes())];
    }
    let link = |i: usize| page_of(i);
    let index = document(
        &format!("{}: report", head.recipe),
        html! { (title(head)) main { (overview(sections, &link, true)) (rest(head, sections)) } },
        false,
    );
    let mut all = vec![(NAME.to_owned(), index.into_bytes())];
    for (i, s) in sections.iter().enumerate() {
        let page = html! {
            header { h1 { "Report of " (head.recipe) } p { a href=(NAME) { "All tables and maps" } } }
            main { article { h2 { (s.name) } (s.body) } }
        };
        all.push((page_of(i), document(&format!("{}: {}", head.recipe, s.name), page, true).into_bytes()));
    }
    all
}

fn whole(head: &Head, sections: &[Section]) -> String {
    let link = |i: usize| format!("#t{}", i + 1);
    let page = html! {
        (title(head))
        main {
            (overview(sections, &link, false))
            (rest(head, sections))
            @for (i, s) in sections.iter().enumerate() {
                article id=(format!("t{}", i + 1)) { h2 { (s.name) } (s.body) }
            }
        }
    };
    document(&format!("{}: report", head.recipe), page, true)
}

fn title(head: &Head) -> Markup {
    html! {
        header {
            h1 { "Report of " (head.recipe) }
            p { "Baked by " (head.tool) "; hash of the recipe " code.long { (head.hash) } }
            @if let Some((name, _)) = &head.against { p { "Compared with " (name) "." } }
            @if !head.stale.is_empty() {
                p { strong { "Files of earlier bakes are in the folder: " } (head.stale.join(", ")) }
            }
        }
    }
}

/// All tables, and all maps, a line each.
fn overview(sections: &[Section], link: &dyn Fn(usize) -> String, thumbnails: bool) -> Markup {
    const TABLES: [&str; 8] = [
        "size",
        "largest estimate",
        "asked for",
        "rounding",
        "reading (practical)",
        "evaluations",
        "laws held",
        "verdict",
    ];
    const MAPS: [&str; 6] =
        ["size", "levels", "largest D", "mean D of level 1", "texels with D >= 0.5", "bytes"];
    let any = |maps: bool| sections.iter().any(|s| s.cells.cells(maps).is_some());
    html! {
        nav aria-label="contents" {
            @if any(false) || !any(true) {
                h2 { "Tables" }
                (facts::captioned(
                    "all tables",
                    "Absolute errors; reading: largest error between texels, in parentheses where mu >= 0.05 and roughness >= 0.09.",
                    lines(sections, false, "table", &TABLES, link, thumbnails),
                ))
            }
            @if any(true) {
                h2 { "Maps" }
                (facts::captioned(
                    "all maps",
                    "D is half the integral of |footprint - lobe|: 0 the same, 1 disjoint.",
                    lines(sections, true, "map", &MAPS, link, thumbnails),
                ))
            }
        }
    }
}

fn lines(
    sections: &[Section],
    maps: bool,
    what: &str,
    heads: &[&str],
    link: &dyn Fn(usize) -> String,
    thumbnails: bool,
) -> Markup {
    html! {
        table {
            thead { tr {
                @if thumbnails { th scope="col" { "picture" } }
                th scope="col" { (what) } @for h in heads { th.n scope="col" { (h) } }
            } }
            tbody { @for (i, s) in sections.iter().enumerate() { @if let Some(cells) = s.cells.cells(maps) { tr {
                @if thumbnails { td { @if let Some(uri) = &s.thumbnail { img.flat src=(uri) width="64" height="64" alt=(format!("first channel of {}", s.name)); } } }
                th scope="row" { a href=(link(i)) { (s.name) } }
                @for c in cells { td.n { (c) } }
            } } } }
        }
    }
}

/// Scenes, tables that only the other bake has, times.
fn rest(head: &Head, sections: &[Section]) -> Markup {
    html! {
        @if let Some(scenes) = &head.scenes { section { h2 { "Why it was baked" } (why::why(scenes)) } }
        @if let Some((name, only)) = head.against.as_ref().filter(|(_, only)| !only.is_empty()) {
            p { "Only " (name) " has: " (only.join(", ")) "." }
        }
        @if sections.iter().any(|s| s.seconds.is_some() || s.times.is_some()) {
            section {
                h2 { "Timings" }
                p.note { "Of this run on this machine; they are no part of what the tables are." }
                @if sections.iter().any(|s| s.seconds.is_some()) { (facts::scroll("timings", html! {
                    table {
                        thead { tr { th scope="col" { "table" } th.n scope="col" { "integration, s" } th.n scope="col" { "laws, rounding, reading, s" } } }
                        tbody { @for s in sections { @if let Some([bake, check]) = s.seconds {
                            tr { th scope="row" { (s.name) } td.n { (format!("{bake:.3}")) } td.n { (format!("{check:.3}")) } }
                        } } }
                    }
                })) }
                @for s in sections { @if let Some(times) = &s.times { h3 { (s.name) ": error against time" } (times) } }
            }
        }
    }
}

fn document(name: &str, body: Markup, script: bool) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                link rel="icon" href="data:,";
                title { (name) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                (body)
                @if script { script { (PreEscaped(SCRIPT)) } }
            }
        }
    }
    .into_string()
}
