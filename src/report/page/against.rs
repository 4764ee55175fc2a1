//! A table beside the one of the same name of another bake.

use super::colour::{Meaning, Scale};
use super::facts::{laws_held, scroll, verified};
use super::shown::Shown;
use super::view::{Against, FileView, Texels, View};
use crate::grid::layout::Point;
use crate::grid::table::place;
use crate::grid::{Provenance, Table};
use crate::math::figures::{short, significant};
use maud::{Markup, html};

/// Numbers of both side by side, and how far their texels are apart.
pub(super) fn against(view: &View, other: &Against, name: &str) -> Markup {
    let rows = rows(view, &other.provenance);
    html! {
        h4 { "Against " (name) }
        @if view.provenance.recipe.hash == other.provenance.recipe.hash { p.note { "Both are of one recipe: the identities are the same." } }
        (scroll("both bakes", html! {
            table {
                thead { tr { th scope="col" { "what" } th scope="col" { "this" } th scope="col" { (name) } } }
                tbody { @for [what, this, that] in &rows {
                    tr class=(if this == that { "" } else { "changed" }) { th scope="row" { (what) } td { (this) } td { (that) } }
                } }
            }
        }))
        @match (&view.texels, &other.table) {
            (Ok(texels), Ok(table)) => (differences(view, texels, table)),
            (Err(why), _) | (_, Err(why)) => p.note { "The texels cannot be compared: " (why) },
        }
    }
}

fn rows(view: &View, b: &Provenance) -> Vec<[String; 3]> {
    let a = &view.provenance;
    let size = |p: &Provenance| {
        p.axes
            .iter()
            .map(|r| format!("{} {}", r.axis.quantity.id, r.axis.len))
            .collect::<Vec<_>>()
            .join(" x ")
    };
    let text = |what: &str, of: &dyn Fn(&Provenance) -> String| [what.to_owned(), of(a), of(b)];
    let other = View {
        provenance: b.clone(),
        files: Vec::<FileView>::new(),
        texels: Err(String::new()),
        seconds: None,
        against: None,
        convergence: Err(String::new()),
    };
    vec![
        text("program", &|p| p.tool.clone()),
        text("kind", &|p| p.table.title.clone()),
        text("model", &|p| p.model.as_ref().map_or_else(String::new, |m| m.title.clone())),
        text("size", &size),
        text("texture coordinates", &|p| {
            p.axes.iter().map(|r| r.coordinate.clone()).collect::<Vec<_>>().join("; ")
        }),
        text("tolerance", &|p| short(p.integration.tolerance)),
        text("largest estimate", &|p| significant(p.integration.largest_error.value, 3)),
        text("evaluations", &|p| p.integration.evaluations.to_string()),
        ["laws held".to_owned(), laws_held(view), laws_held(&other)],
        ["verdict".to_owned(), verified(view).to_owned(), verified(&other).to_owned()],
    ]
}

/// The other table, read at the texels of this one.
fn differences(view: &View, texels: &Texels, other: &Table) -> Markup {
    let quantities =
        |axes: &[crate::grid::Axis]| axes.iter().map(|a| a.quantity.base_id()).collect::<Vec<_>>();
    if quantities(texels.grid.axes()) != quantities(other.grid.axes()) {
        return html! { p.note { "The texels cannot be compared: the axes measure other quantities." } };
    }
    let pairs: Vec<(usize, usize, &str)> = view
        .provenance
        .channels
        .iter()
        .enumerate()
        .filter_map(|(i, c)| Some((i, other.channels.iter().position(|d| d.id == c.id)?, c.id.as_str())))
        .collect();
    let n = texels.channels();
    let mut read = vec![0.0; other.channels.len()];
    let mut apart = vec![f64::NAN; texels.stored.len()];
    for texel in 0..texels.grid.len() {
        let point: Point = texels.grid.texel(texel);
        other.read(&point, &mut read);
        for &(i, j, _) in &pairs {
            apart[texel * n + i] = (texels.stored[texel * n + i] - read[j]).abs();
        }
    }
    let worst =
        (0..apart.len()).filter(|i| apart[*i].is_finite()).max_by(|a, b| apart[*a].total_cmp(&apart[*b]));
    let shown = Shown::new(&texels.grid, n, worst.map(|w| w / n));
    let slice = worst.and_then(|w| shown.pixel(w / n)).map_or(0, |p| p[0]);
    html! {
        p { "The stored numbers of the other bake, read bilinearly at the texels of this one:" }
        @for (i, _, id) in pairs {
            @let of = |t: usize| apart[t * n + i];
            @let (largest, rms, at) = summary(texels, &of);
            p { (id) ": largest difference " (significant(largest, 3)) @if largest > 0.0 { " at " (at) } ", RMS " (significant(rms, 3)) "." }
            @let plane = shown.largest(slice, &of);
            @if let Some(scale) = Scale::of(Meaning::Error, plane.iter().copied()).filter(|_| largest > 0.0) {
                @let [w, h] = shown.size();
                @let by = (320 / w.max(h)).max(1);
                figure {
                    img.flat src=(scale.picture(w, plane.iter().copied())) width=(w * by) height=((h * by).max(32))
                        alt=(format!("{id}: |difference| of the two bakes, from {} (dark) to {} (light)", significant(scale.ends[0], 3), significant(scale.ends[1], 3)));
                }
            }
        }
    }
}

/// The largest, the root of the mean square, and where the largest is.
fn summary(texels: &Texels, of: &dyn Fn(usize) -> f64) -> (f64, f64, String) {
    let (mut largest, mut squares, mut at) = (0.0, 0.0, 0);
    for t in 0..texels.grid.len() {
        let v = of(t);
        squares += v * v;
        if v > largest {
            (largest, at) = (v, t);
        }
    }
    (largest, (squares / texels.grid.len().max(1) as f64).sqrt(), place(&texels.at(at)))
}
