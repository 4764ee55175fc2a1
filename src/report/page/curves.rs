//! The channels of a table as curves over one axis, a few of them for values of another.

use super::shown::spread;
use super::view::{Texels, View};
use crate::math::figures::significant;
use crate::report::drawing::{COLOURS, hex};
use maud::{Markup, PreEscaped, html};

/// Curves of a figure.
const CURVES: usize = 6;
/// Size and margins of a figure, in pixels.
const SIZE: [f64; 2] = [360.0, 240.0];
const LEFT: f64 = 56.0;
const BOTTOM: f64 = 36.0;
const TOP: f64 = 10.0;
/// Dashes beside colours, so that curves are told apart without these.
const DASHES: [&str; CURVES] = ["", "6 3", "2 2", "8 3 2 3", "12 4", "4 4"];

struct Curve {
    label: String,
    points: Vec<[f64; 2]>,
}

/// One figure a channel.
pub(super) fn curves(view: &View, texels: &Texels) -> Markup {
    let axes = texels.grid.axes();
    let across = axes.iter().take(2).position(|a| a.quantity.base_id() == "mu").unwrap_or(0);
    let other = (axes.len() > 1).then_some(1 - across);
    let x = axes[across].quantity;
    html! {
        div.row {
            @for (c, channel) in view.provenance.channels.iter().enumerate().take(texels.channels()) {
                @let all = family(texels, c, across, other);
                figure.curves {
                    (PreEscaped(svg(&all, &format!("{} over {}", channel.id, x.id), x.symbol)))
                    figcaption {
                        (channel.id) " over " (x.id)
                        @if all.len() > 1 {
                            ul.key {
                                @for (i, curve) in all.iter().enumerate() {
                                    li {
                                        (PreEscaped(format!(
                                            "<svg width=\"28\" height=\"8\" aria-hidden=\"true\"><line x2=\"28\" y1=\"4\" y2=\"4\" stroke=\"{}\" \
                                             stroke-width=\"2\" stroke-dasharray=\"{}\"/></svg> ",
                                            hex(COLOURS[i % CURVES]), DASHES[i % CURVES]
                                        )))
                                        (curve.label)
                                    }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Curves for values of the other axis, in the middle of all further ones.
fn family(texels: &Texels, channel: usize, across: usize, other: Option<usize>) -> Vec<Curve> {
    let grid = &texels.grid;
    let n = texels.channels();
    let mut stride = vec![1; grid.axes().len()];
    for i in 1..stride.len() {
        stride[i] = stride[i - 1] * grid.axes()[i - 1].len;
    }
    let further: usize = (2..stride.len()).map(|i| stride[i] * (grid.axes()[i].len / 2)).sum();
    let rows = other.map_or_else(|| vec![0], |o| spread(grid.axes()[o].len, CURVES));
    let curve = |row: &usize| {
        let start = further + other.map_or(0, |o| stride[o] * row);
        let texel = |i: usize| start + i * stride[across];
        let label = other.map_or_else(String::new, |o| {
            let at = texels.at(texel(grid.axes()[across].len / 2));
            format!("{} = {}", at[o].0, significant(at[o].1, 3))
        });
        let point = |i: usize| [texels.at(texel(i))[across].1, texels.stored[texel(i) * n + channel]];
        Curve { label, points: (0..grid.axes()[across].len).map(point).collect() }
    };
    rows.iter().map(curve).collect()
}

fn svg(all: &[Curve], title: &str, symbol: &str) -> String {
    let [w, h] = SIZE;
    let xs = bounds(all.iter().flat_map(|c| c.points.iter().map(|p| p[0])));
    let ys = bounds(all.iter().flat_map(|c| c.points.iter().map(|p| p[1])));
    let x = |v: f64| LEFT + (w - LEFT - 10.0) * (v - xs[0]) / (xs[1] - xs[0]);
    let y = |v: f64| h - BOTTOM - (h - BOTTOM - TOP) * (v - ys[0]) / (ys[1] - ys[0]);
    let [lo, hi] = ys.map(|v| significant(v, 3));
    let mut svg = format!(
        "<svg viewBox=\"0 0 {w} {h}\" role=\"img\" aria-label=\"{}: between {lo} and {hi}\" font-size=\"12\">",
        crate::report::drawing::escape(title)
    );
    for i in 0..=4u8 {
        let part = f64::from(i) / 4.0;
        let (vx, vy) = (xs[0] + part * (xs[1] - xs[0]), ys[0] + part * (ys[1] - ys[0]));
        let (px, py) = (x(vx), y(vy));
        svg += &format!(
            "<path class=\"grid\" d=\"M{px:.1} {TOP}V{:.1}M{LEFT} {py:.1}H{:.1}\"/>\
             <text x=\"{px:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            h - BOTTOM,
            w - 10.0,
            h - BOTTOM + 14.0,
            significant(vx, 3),
            LEFT - 5.0,
            py + 4.0,
            significant(vy, 3)
        );
    }
    svg += &format!(
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
        (LEFT + w) / 2.0,
        h - 5.0,
        crate::report::drawing::escape(symbol)
    );
    for (i, curve) in all.iter().enumerate() {
        let points: Vec<String> = curve
            .points
            .iter()
            .filter(|p| p[1].is_finite())
            .map(|p| format!("{:.1},{:.1}", x(p[0]), y(p[1])))
            .collect();
        svg += &format!(
            "<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"{}\" points=\"{}\"/>",
            hex(COLOURS[i % CURVES]),
            DASHES[i % CURVES],
            points.join(" ")
        );
    }
    svg + "</svg>"
}

/// Least and largest, apart from each other.
fn bounds(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let [lo, hi] = values
        .filter(|v| v.is_finite())
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], v| [lo.min(v), hi.max(v)]);
    match () {
        () if lo > hi => [0.0, 1.0],
        () if hi - lo <= 1e-12 * hi.abs() => [lo - 0.5, hi + 0.5],
        () => [lo, hi],
    }
}
