//! The texels with the largest errors, as a table.

use super::facts::captioned;
use super::shown::Shown;
use super::view::{Texels, View};
use crate::math::figures::{short, significant};
use maud::{Markup, html};

/// Rows of the table.
const ROWS: usize = 12;

/// The worst texels: where, what is stored, and what is known of its error.
pub(super) fn worst(view: &View, texels: &Texels, shown: &Shown) -> Markup {
    let ranked = texels.ranked(ROWS);
    if ranked.is_empty() {
        return html! { p.note { "No error of a texel is known." } };
    }
    let n = texels.channels();
    let p = &view.provenance;
    let tolerance = p.integration.tolerance;
    captioned(
        &format!("worst texels of {}", p.name),
        &format!(
            "Largest |stored - integral| + estimate. The tolerance of the integrals is {}.",
            short(tolerance)
        ),
        html! {
            table {
                thead { tr {
                    th scope="col" { "channel" }
                    @for r in &p.axes { th.n scope="col" { (r.axis.quantity.id) } }
                    th.n scope="col" { "texel" } th.n scope="col" { "stored" } th.n scope="col" { "|stored - integral|" } th.n scope="col" { "estimate" }
                    th scope="col" { "picture" }
                } }
                tbody { @for at in ranked {
                    @let (texel, channel) = (at / n, at % n);
                    tr {
                        th scope="row" { (p.channels.get(channel).map_or("", |c| c.id.as_str())) }
                        @for (_, v) in texels.at(texel) { td.n { (short(v)) } }
                        td.n { (index(texels, texel)) }
                        td.n { (short(texels.stored[at])) }
                        td.n { (significant((texels.stored[at] - texels.integrals[at]).abs(), 3)) }
                        td.n { (significant(texels.estimates[at], 3)) }
                        td { @if let Some([slice, i, j]) = shown.pixel(texel) {
                            button type="button" hidden data-at=(format!("{slice},{i},{j}")) { "show" }
                        } }
                    }
                } }
            }
        },
    )
}

/// The indices of a texel: `3, 7`.
fn index(texels: &Texels, texel: usize) -> String {
    let index = texels.grid.unravel(texel);
    index[..texels.grid.axes().len()].iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
