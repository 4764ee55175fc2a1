//! The texels of a table as pictures, and what the script needs to name the one under the pointer.

use super::colour::{self, Meaning, Scale};
use super::shown::Shown;
use super::view::{Texels, View};
use crate::grid::provenance::AxisRecord;
use crate::grid::table::place;
use crate::math::figures::{short, significant};
use maud::{Markup, html};

/// Width in CSS pixels that pictures of a few texels are enlarged to.
const WIDTH: usize = 320;

/// A channel shown by one of its numbers.
struct Layer<'a> {
    title: String,
    meaning: Meaning,
    of: Box<dyn Fn(usize) -> f64 + 'a>,
}

/// All pictures of a table.
pub(super) fn maps(view: &View, texels: &Texels, shown: &Shown) -> Markup {
    let n = texels.channels();
    let [step_x, step_y] = shown.step();
    html! {
        div.maps data-size=(format!("{},{}", shown.size()[0], shown.size()[1])) data-step=(format!("{step_x},{step_y}"))
            data-axes=(axes(&view.provenance.axes, texels, shown))
            data-channels=(channel_ids(view, n))
            data-values=(colour::floats(all(shown, n, &|i| texels.stored[i]).into_iter()))
            data-estimates=(colour::short_floats(blocks(shown, n, &|i| texels.estimates[i]).into_iter()))
            data-off=(colour::short_floats(blocks(shown, n, &|i| (texels.stored[i] - texels.integrals[i]).abs()).into_iter()))
        {
            p.note { (orientation(&view.provenance.axes)) " Point at a texel, or focus a picture and use the arrow keys." }
            output.read aria-live="polite" { "No texel chosen." }
            @if !shown.is_whole() {
                p.note {
                    "Not all of the table is shown. "
                    @if [step_x, step_y] != [1, 1] {
                        "A pixel is " (step_x) " x " (step_y) " texels, with the value of the first and the largest error of them. "
                    }
                    @if texels.grid.axes().len() > 2 { (shown.slices.len()) " slices, that of the worst texel among them." }
                }
            }
            @for channel in 0..n {
                @let id = view.provenance.channels.get(channel).map_or("", |c| c.id.as_str());
                h4 { (id) }
                @if let Some(c) = view.provenance.channels.get(channel) { p.note { (c.meaning) } }
                @for layer in layers(texels, channel, n) {
                    (pictures(view, texels, shown, channel, id, &layer))
                }
            }
        }
    }
}

/// What is shown of a channel.
fn layers<'a>(texels: &'a Texels, channel: usize, n: usize) -> Vec<Layer<'a>> {
    let stored: Box<dyn Fn(usize) -> f64> = Box::new(move |t| texels.stored[t * n + channel]);
    let mut all = vec![Layer { title: "stored value".to_owned(), meaning: Meaning::Value, of: stored }];
    if texels.worst().is_some() {
        let estimate = Box::new(move |t| texels.estimates[t * n + channel]);
        all.push(Layer {
            title: "estimated error of the integral".to_owned(),
            meaning: Meaning::Error,
            of: estimate,
        });
        let off = Box::new(move |t: usize| {
            (texels.stored[t * n + channel] - texels.integrals[t * n + channel]).abs()
        });
        all.push(Layer { title: "|stored value - integral|".to_owned(), meaning: Meaning::Error, of: off });
    }
    all
}

/// One layer: its slices with one scale.
fn pictures(
    view: &View,
    texels: &Texels,
    shown: &Shown,
    channel: usize,
    id: &str,
    layer: &Layer<'_>,
) -> Markup {
    let planes: Vec<Vec<f64>> = (0..shown.slices.len())
        .map(|s| match layer.meaning {
            Meaning::Value => shown.texels(s).map(|t| (layer.of)(t)).collect(),
            Meaning::Error => shown.largest(s, &layer.of),
        })
        .collect();
    let Some(scale) = Scale::of(layer.meaning, planes.iter().flatten().copied()) else {
        return html! { p.note { (layer.title) ": not known" } };
    };
    let [width, height] = shown.size();
    let enlarged = (WIDTH / width.max(height)).max(1);
    let (w, h) = (width * enlarged, (height * enlarged).max(32));
    let [lo, hi] = scale.ends.map(|v| significant(v, 4));
    html! {
        div.layer.one[planes.len() == 1] {
            h5 { (layer.title) }
            div.row {
                @for (slice, plane) in planes.iter().enumerate() {
                    @let name = format!("{id}, {}{}", layer.title, slice_name(texels, shown, slice, ", at "));
                    figure {
                        div.map tabindex="0" role="group" aria-label=(format!("{name}: arrow keys move over its texels"))
                            data-slice=(slice) data-channel=(channel) style=(format!("width:{w}px;aspect-ratio:{w}/{h}"))
                        {
                            img src=(scale.picture(width, plane.iter().copied())) width=(w) height=(h)
                                alt=(format!("{name}: from {lo} to {hi}{}", largest_at(texels, shown, slice, plane)));
                        }
                        @if shown.slices.len() > 1 {
                            figcaption { (slice_name(texels, shown, slice, "")) }
                        }
                    }
                }
            }
            (legend(&scale, &lo, &hi, layer.meaning, &view.provenance.name))
        }
    }
}

fn legend(scale: &Scale, lo: &str, hi: &str, meaning: Meaning, table: &str) -> Markup {
    let steps = match meaning {
        Meaning::Value => "equal steps",
        Meaning::Error => "equal ratios; grey is not known",
    };
    html! {
        p.legend {
            span { (lo) } " "
            img src=(scale.legend()) width="255" height="12" alt=(format!("colours of {table} from {lo} (dark) to {hi} (light), {steps}"));
            " " span { (hi) } " " span.note { (steps) }
        }
    }
}

/// Where a plane is largest.
fn largest_at(texels: &Texels, shown: &Shown, slice: usize, plane: &[f64]) -> String {
    let known = plane.iter().enumerate().filter(|(_, v)| v.is_finite());
    let Some((at, _)) = known.max_by(|a, b| a.1.total_cmp(b.1)) else { return String::new() };
    let texel = shown.texel(slice, at % shown.size()[0], at / shown.size()[0]);
    format!(", largest at {}", place(&texels.at(texel)))
}

/// The values on the third and fourth axis of a slice; empty for a table without them.
fn slice_name(texels: &Texels, shown: &Shown, slice: usize, before: &str) -> String {
    if texels.grid.axes().len() < 3 {
        return String::new();
    }
    let at = texels.at(shown.texel(slice, 0, 0));
    format!("{before}{}", place(&at[2..]))
}

/// Which way the axes run.
fn orientation(axes: &[AxisRecord]) -> String {
    let run = |r: &AxisRecord, way: &str| {
        let [a, b] = r.axis.domain;
        let [a, b] = if r.axis.direction == crate::grid::Direction::Ascending { [a, b] } else { [b, a] };
        format!("{way} {} from {} to {}", r.axis.quantity.id, short(a), short(b))
    };
    let ways = ["Left to right", "top to bottom", "slices", "slices"];
    let all: Vec<String> = axes.iter().zip(ways).map(|(r, way)| run(r, way)).collect();
    format!("{}.", all.join("; "))
}

fn channel_ids(view: &View, n: usize) -> String {
    let ids: Vec<&str> =
        (0..n).map(|c| view.provenance.channels.get(c).map_or("", |c| c.id.as_str())).collect();
    serde_json::to_string(&ids).unwrap_or_default()
}

/// A number of every texel that is shown, `[slice][y][x][channel]`.
fn all(shown: &Shown, n: usize, of: &dyn Fn(usize) -> f64) -> Vec<f64> {
    let texels = (0..shown.slices.len()).flat_map(|s| shown.texels(s));
    texels.flat_map(|t| (0..n).map(move |c| of(t * n + c))).collect()
}

/// The same of the largest of a pixel.
fn blocks(shown: &Shown, n: usize, of: &dyn Fn(usize) -> f64) -> Vec<f64> {
    let mut values = Vec::new();
    for slice in 0..shown.slices.len() {
        let planes: Vec<Vec<f64>> = (0..n).map(|c| shown.largest(slice, &|t| of(t * n + c))).collect();
        values.extend((0..planes.first().map_or(0, Vec::len)).flat_map(|i| planes.iter().map(move |p| p[i])));
    }
    values
}

/// The values of every axis as JSON: id, the pictures' axes that they depend on (`x`, `y`, `s` for the slice), and the values.
fn axes(records: &[AxisRecord], texels: &Texels, shown: &Shown) -> String {
    const DIMS: [char; 4] = ['x', 'y', 's', 's'];
    let [width, height] = shown.size();
    let base = |id: &str| records.iter().position(|r| r.axis.quantity.base_id() == id);
    let axis = |(i, r): (usize, &AxisRecord)| {
        let coupled = r.axis.warp.couples_to().and_then(base);
        let depends = |d: char| DIMS[i] == d || coupled.is_some_and(|j| DIMS[j] == d);
        let count = |d: char, n: usize| if depends(d) { n } else { 1 };
        let mut values = Vec::new();
        for slice in 0..count('s', shown.slices.len()) {
            for y in 0..count('y', height) {
                for x in 0..count('x', width) {
                    let at = texels.at(shown.texel(slice, x, y));
                    values.push(at.get(i).map_or(f64::NAN, |(_, v)| *v));
                }
            }
        }
        let dims: String = ['s', 'y', 'x'].into_iter().filter(|d| depends(*d)).collect();
        serde_json::json!([r.axis.quantity.id, dims, colour::floats(values.into_iter())])
    };
    serde_json::Value::from(records.iter().enumerate().map(axis).collect::<Vec<_>>()).to_string()
}
