//! What is said of a table in words and numbers: formula, files, laws, error budget, evaluations.

use super::view::{Origin, Texels, View};
use crate::grid::provenance::{LawResult, Subject};
use crate::grid::table::place;
use crate::math::figures::{short, significant};
use maud::{Markup, html};

/// Kind, model, axes, files.
pub(super) fn description(view: &View) -> Markup {
    let p = &view.provenance;
    html! {
        dl {
            (subject("table", &p.table))
            @if let Some(model) = &p.model { (subject("model", model)) }
            @for (i, r) in p.axes.iter().enumerate() {
                dt { "axis " (["x", "y", "z", "w"].get(i).unwrap_or(&"?")) }
                dd {
                    (r.axis.quantity.id) ", " (r.axis.len) " texels over [" (short(r.axis.domain[0])) ", " (short(r.axis.domain[1])) "]; "
                    "texture coordinate " code { (r.coordinate) }
                }
            }
            dt { "identity" } dd { code.long { (p.recipe.hash) } }
        }
        (scroll("files", html! {
            table {
                thead { tr { th scope="col" { "file" } th scope="col" { "container" } th scope="col" { "stored as" } th.n scope="col" { "bytes" } } }
                tbody { @for f in &view.files {
                    tr { th scope="row" { (f.file) } td { (f.container) } td { (f.encoding.storage) } td.n { (f.bytes) } }
                } }
            }
        }))
    }
}

fn subject(what: &str, s: &Subject) -> Markup {
    let params = s.params.iter().map(|(k, v)| format!("{k} = {v}")).collect::<Vec<_>>().join(", ");
    html! {
        dt { (what) } dd { (s.title) " (" code { (s.id) } ")" }
        dt { "formula of the " (what) } dd { (s.formula) @if !params.is_empty() { "; " (params) } }
        dt { "sources of the " (what) } dd { (s.sources.join("; ")) }
    }
}

/// A table that may be wider than the page.
pub(super) fn scroll(what: &str, table: Markup) -> Markup {
    html! { div.scroll tabindex="0" role="group" aria-label=(what) { (table) } }
}

/// The same with words above that stay where they are.
pub(super) fn captioned(what: &str, caption: &str, table: Markup) -> Markup {
    html! { p.note { (caption) } (scroll(what, table)) }
}

/// What came of every law, and what was not checked.
pub(super) fn laws(view: &View) -> Markup {
    let p = &view.provenance;
    let waived = |law: &str| p.waived.iter().find(|w| w.law == law);
    scroll(
        &format!("laws of {}", p.name),
        html! {
            table {
                thead { tr {
                    th scope="col" { "law" } th scope="col" { "result" } th.n scope="col" { "margin" } th.n scope="col" { "judged" }
                    th.n scope="col" { "not judged" } th scope="col" { "where the margin is least" } th scope="col" { "why" }
                } }
                tbody {
                    @for l in &p.laws {
                        tr class=(if l.result == LawResult::Broken { "bad" } else { "" }) {
                            th scope="row" { (l.law) } td { (l.result.words()) }
                            td.n { (l.margin.map_or_else(|| "-".to_owned(), |m| significant(m, 3))) } td.n { (l.checked) } td.n { (l.unchecked) }
                            td { (l.at) }
                            td { (l.why.as_deref().unwrap_or("")) @if let Some(w) = waived(&l.law) { " waived: " (w.reason) } }
                        }
                    }
                    @for w in p.waived.iter().filter(|w| p.laws.iter().all(|l| l.law != w.law)) {
                        tr { th scope="row" { (w.law) } td { "waived" } td.n { "-" } td.n { "0" } td.n { "0" } td {} td { (w.reason) } }
                    }
                    @if p.laws.is_empty() && p.waived.is_empty() { tr { td colspan="7" { "No law was checked." } } }
                }
            }
        },
    )
}

/// Laws held, of how many.
pub(super) fn laws_held(view: &View) -> String {
    let laws = &view.provenance.laws;
    format!("{} of {}", laws.iter().filter(|l| l.held()).count(), laws.len())
}

/// The verdict of the bake.
pub(super) fn verified(view: &View) -> &'static str {
    if view.provenance.verified { "verified" } else { "not verified" }
}

/// A bar of the budget.
struct Bar {
    what: String,
    value: f64,
    at: String,
}

/// Decades of the budget's bars, from 1 down.
const DECADES: f64 = 9.0;

/// Where the error of what a shader gets comes from: integration, storage, reading.
pub(super) fn budget(view: &View) -> Markup {
    let p = &view.provenance;
    let e = &p.integration.largest_error;
    let extreme = |e: &crate::grid::table::Extreme| format!("{}, {}", e.channel, place(&e.at));
    let mut bars = vec![
        Bar { what: "tolerance asked for".into(), value: p.integration.tolerance, at: String::new() },
        Bar { what: "integration, largest estimate".into(), value: e.value, at: extreme(e) },
    ];
    for f in &view.files {
        let bar = |what: &str, value: f64, at: String| Bar { what: format!("{}: {what}", f.file), value, at };
        bars.push(bar("storage, largest rounding", f.encoding.largest_error, String::new()));
        let Some(r) = &f.reconstruction else { continue };
        bars.push(bar("reading, largest", r.whole.largest.value, extreme(&r.whole.largest)));
        bars.push(bar("reading, mean", r.whole.mean, String::new()));
        if let Some(practical) = &r.practical {
            let e = &practical.largest;
            bars.push(bar("reading, largest where mu >= 0.05, roughness >= 0.09", e.value, extreme(e)));
        }
    }
    captioned(
        &format!("error budget of {}", p.name),
        &format!("Absolute errors; bars are logarithmic, from 1e-{DECADES} to 1. Reading includes rounding."),
        html! {
            table {
                thead { tr { th scope="col" { "error" } th.n scope="col" { "size" } th scope="col" { "from 1e-" (DECADES) " to 1" } th scope="col" { "where" } } }
                tbody { @for b in &bars { tr {
                    th scope="row" { (b.what) } td.n { (significant(b.value, 3)) }
                    td.bar { svg viewBox="0 0 100 10" preserveAspectRatio="none" aria-hidden="true" {
                        rect x="0" y="0" width="100" height="10" class="rail" {}
                        rect x="0" y="0" width=(format!("{:.1}", length(b.value))) height="10" class="fill" {}
                    } }
                    td { (b.at) }
                } } }
            }
            @if view.files.iter().all(|f| f.reconstruction.is_none()) {
                p.note { "The error of reading between texels was not measured." }
            }
        },
    )
}

fn length(error: f64) -> f64 {
    if error > 0.0 { 100.0 * (1.0 + libm::log10(error) / DECADES).clamp(0.0, 1.0) } else { 0.0 }
}

/// Evaluations, and where the integrals of the pictures are from.
pub(super) fn effort(view: &View) -> Markup {
    let i = &view.provenance.integration;
    let texels: usize = view.provenance.axes.iter().map(|r| r.axis.len).product();
    let known = view.texels.as_ref().ok().map(|t| &t.evaluations).filter(|e| !e.is_empty());
    html! {
        p {
            (i.evaluations) " evaluations, " (short(i.evaluations as f64 / texels.max(1) as f64)) " a texel"
            @if let Some(most) = known.and_then(|e| e.iter().max()) { ", at most " (most) } ". "
            "Rule: " (i.rule) ". "
            @if i.missed > 0 { strong { (i.missed) " texels miss the tolerance. " } }
            @if let Ok(t) = &view.texels { (origin(t)) }
        }
        @for r in &view.provenance.residuals {
            p { "Fit: " (r.meaning) ": at most " (short(r.spread.largest.value)) ", mean " (short(r.spread.mean)) "." }
        }
        @for f in &view.files { @if let Some(t) = &f.texels {
            p { (f.file) ": texels " (t.held) " (" (t.asked) " asked for): " (t.meaning) }
        } }
    }
}

/// What the integrals of the page are.
pub(super) fn origin(texels: &Texels) -> String {
    match &texels.origin {
        Origin::Bake => format!("Numbers of {}; integrals and estimates are those of the bake.", texels.file),
        Origin::Again { texels: n } if *n == texels.grid.len() => {
            format!("Numbers of {}; every texel was integrated anew for this page.", texels.file)
        }
        Origin::Again { texels: n } => format!(
            "Numbers of {}; {n} of {} texels were integrated anew for this page, the errors of the others are not known.",
            texels.file,
            texels.grid.len()
        ),
        Origin::None { why } => {
            format!(
                "Numbers of {}; the files hold no estimates of texels and nothing was integrated anew: {why}",
                texels.file
            )
        }
    }
}
