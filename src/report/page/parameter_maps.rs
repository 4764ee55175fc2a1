//! A parameter map: its levels in numbers and pictures, its map of errors, and the texels that its lobes are farthest from.

use super::colour::{self, Meaning, Scale};
use super::facts::{captioned, scroll};
use super::view::{MapLevel, MapPlane, MapView};
use super::{Cells, Section};
use crate::math::figures::{short, significant};
use crate::report::inspect_map;
use crate::report::sheet;
use maud::{Markup, html};
use serde_json::Value as Json;

/// Most pixels along a side of a picture: those of larger levels stand for several texels.
const SIDE: usize = 128;
/// Width in CSS pixels that pictures of a few texels are enlarged to.
const WIDTH: usize = 256;

/// What a page says of a parameter map.
#[must_use]
pub fn map_section(view: &MapView) -> Section {
    let levels = list(&view.record, "levels");
    let most = levels.iter().map(|l| number(l, "largest")).fold(0.0, f64::max);
    let of_level = |k: usize, key: &str| levels.get(k).map_or(f64::NAN, |l| number(l, key));
    let size = levels.first().map(size).unwrap_or_default();
    let hopeless: f64 = levels.iter().map(|l| number(l, "hopeless")).sum();
    let bytes: u64 = view.files.iter().map(|f| f.bytes).sum();
    let cells = [
        size,
        levels.len().to_string(),
        significant(most, 3),
        if levels.len() > 1 { significant(of_level(1, "mean"), 3) } else { "-".to_owned() },
        short(hopeless),
        bytes.to_string(),
    ];
    let first = view.levels.as_ref().ok().and_then(|l| l.iter().min_by_key(|l| l.level));
    Section {
        name: view.name.clone(),
        thumbnail: first.and_then(|l| Some((l, l.planes.first()?))).and_then(|(l, p)| thumbnail(l, p)),
        cells: Cells::Map(cells),
        seconds: None,
        times: None,
        body: body(view),
    }
}

fn thumbnail(level: &MapLevel, plane: &MapPlane) -> Option<String> {
    let thin = Thin::new(level.size, 64);
    let values = thin.first(&plane.values);
    Some(Scale::of(Meaning::Value, values.iter().copied())?.picture(thin.size[0], values.into_iter()))
}

fn body(view: &MapView) -> Markup {
    let record = &view.record;
    let places = list(record, "worst");
    html! {
        p {
            @match places.first() {
                Some(p) => {
                    "A lobe is farthest from the texels that it stands for at level " (number(p, "level")) ", texel (" (number(p, "x")) ", "
                    (number(p, "y")) "): D = " (significant(number(p, "distance"), 4)) "."
                }
                None => "Every lobe is that of its texel: D = 0.",
            }
        }
        p.note { "D is half the integral of |footprint - lobe|: 0 the same, 1 disjoint." }
        @match &view.levels {
            Ok(levels) => @for level in levels { (shown(level, places)) },
            Err(why) => p { strong { "No picture: " (why) } },
        }
        @for why in &view.left_out { p.note { (why) } }
        @let elsewhere: Vec<&Json> = places.iter().filter(|p| !is_shown(view, p)).collect();
        @if !elsewhere.is_empty() { h3 { "Worst texels of other levels" } (worst(&elsewhere, None)) }
        @let spheres = sheet::worst_spheres(record);
        @if !spheres.is_empty() {
            h3 { "What the worst texels look like" }
            p.note { "Under a light at 30 degrees: on the left half what the texel stands for, on the right half the lobe that is written." }
            div.row { @for (name, size, codes) in &spheres {
                figure.lobe {
                    img src=(colour::png_rgb(*size, codes)) width=(size) height=(size) alt=(format!("{name}: what it stands for, and what is written"));
                    figcaption { (name) }
                }
            } }
        }
        h3 { "Levels" } (levels(record, &view.name))
        @let more = inspect_map::beside(record);
        @if !more.is_empty() { h3 { "Conversion and lobes" } pre { (more) } }
        h3 { "What it is" } (description(view))
    }
}

fn is_shown(view: &MapView, place: &Json) -> bool {
    let level = place.get("level").and_then(Json::as_u64);
    view.levels.as_ref().is_ok_and(|all| all.iter().any(|l| Some(l.level as u64) == level))
}

/// A level: its channels, its errors, its worst texels.
fn shown(level: &MapLevel, places: &[Json]) -> Markup {
    let thin = Thin::new(level.size, SIDE);
    let [w, h] = level.size;
    let own: Vec<&Json> =
        places.iter().filter(|p| p.get("level").and_then(Json::as_u64) == Some(level.level as u64)).collect();
    let pixels: Vec<Vec<f64>> = level.planes.iter().map(|p| thin.of(p)).collect();
    let interleaved = (0..thin.size[0] * thin.size[1]).flat_map(|i| pixels.iter().map(move |p| p[i]));
    html! {
        section.table {
            h3 { "Level " (level.level) ", " (w) " x " (h) " texels" }
            div.maps data-size=(format!("{},{}", thin.size[0], thin.size[1])) data-step=(format!("{0},{0}", thin.step))
                data-axes=(axes(&thin, level.size)) data-channels=(channels(level)) data-values=(colour::floats(interleaved))
            {
                p.note {
                    "Left to right u, top to bottom v. Point at a texel, or focus a picture and use the arrow keys."
                    @if thin.step > 1 { " A pixel is " (thin.step) " x " (thin.step) " texels, with the value of the first and the largest error of them." }
                }
                output.read aria-live="polite" { "No texel chosen." }
                @for (plane, values) in level.planes.iter().zip(&pixels) { (picture(level, plane, values, &thin)) }
            }
            @if !own.is_empty() { h4 { "Worst texels" } (worst(&own, Some(&thin))) }
        }
    }
}

fn picture(level: &MapLevel, plane: &MapPlane, values: &[f64], thin: &Thin) -> Markup {
    let (meaning, steps) = match plane.is_error {
        true => (Meaning::Error, "equal ratios"),
        false => (Meaning::Value, "equal steps"),
    };
    let title = format!("{}: {}", plane.map, plane.channel);
    let Some(scale) = Scale::of(meaning, values.iter().copied()) else {
        return html! { p.note { (title) ": not known" } };
    };
    let flat = values.iter().all(|v| (*v - scale.ends[1]).abs() <= 1e-12);
    if flat {
        return html! { p.note { (title) ": " (significant(scale.ends[1], 4)) " everywhere" } };
    }
    let [width, height] = thin.size;
    let by = (WIDTH / width.max(height)).max(1);
    let (w, h) = (width * by, height * by);
    let [lo, hi] = scale.ends.map(|v| significant(v, 4));
    let name = format!("{title}, level {}", level.level);
    html! {
        div.layer {
            h4 { (title) }
            figure {
                div.map tabindex="0" role="group" aria-label=(format!("{name}: arrow keys move over its texels")) data-slice="0"
                    style=(format!("width:{w}px;aspect-ratio:{w}/{h}"))
                {
                    img src=(scale.picture(width, values.iter().copied())) width=(w) height=(h) alt=(format!("{name}: from {lo} to {hi}"));
                }
            }
            p.legend {
                span { (lo) } " "
                img src=(scale.legend()) width="255" height="12" alt=(format!("colours of {name} from {lo} (dark) to {hi} (light), {steps}"));
                " " span { (hi) } " " span.note { (steps) }
            }
        }
    }
}

/// The texels that lobes are farthest from; with pictures, the way to theirs.
fn worst(places: &[&Json], thin: Option<&Thin>) -> Markup {
    let at_limit = |p: &Json| p.get("at_limit").and_then(Json::as_bool) == Some(true);
    let remarks = places.iter().any(|p| at_limit(p));
    scroll(
        "texels that lobes are farthest from",
        html! {
            table {
                thead { tr {
                    th.n scope="col" { "level" } th.n scope="col" { "x" } th.n scope="col" { "y" } th.n scope="col" { "D" }
                    @if remarks { th scope="col" { "remark" } } @if thin.is_some() { th scope="col" { "picture" } }
                } }
                tbody { @for p in places {
                    @let [x, y] = ["x", "y"].map(|k| p.get(k).and_then(Json::as_u64).unwrap_or(0));
                    tr {
                        td.n { (number(p, "level")) } td.n { (x) } td.n { (y) } td.n { (significant(number(p, "distance"), 4)) }
                        @if remarks { td { @if at_limit(p) { "a lobe wider than alpha = 1 would be nearer" } } }
                        @if let Some(thin) = thin {
                            td { button type="button" hidden data-at=(format!("0,{},{}", x / thin.step as u64, y / thin.step as u64)) { "show" } }
                        }
                    }
                } }
            }
        },
    )
}

/// All levels in numbers.
fn levels(record: &Json, name: &str) -> Markup {
    captioned(
        &format!("levels of {name}"),
        "Measured: D of a seeded choice of texels and the twenty worst against the texels of the inputs, before and after storage.",
        html! {
            table {
                thead { tr {
                    th.n scope="col" { "level" } th.n scope="col" { "size" } th.n scope="col" { "roughness" } th.n scope="col" { "mean D" }
                    th.n scope="col" { "largest D" } th.n scope="col" { "doubt" } th.n scope="col" { "D >= 0.5" } th.n scope="col" { "at the limit" }
                    th.n scope="col" { "measured" } th.n scope="col" { "mean" } th.n scope="col" { "largest" } th.n scope="col" { "mean stored" }
                    th.n scope="col" { "largest stored" }
                } }
                tbody { @for (k, l) in list(record, "levels").iter().enumerate() {
                    @let range = list(l, "roughness");
                    @let ends: Vec<String> = range.iter().map(|r| significant(r.as_f64().unwrap_or(f64::NAN), 3)).collect();
                    tr {
                        th.n scope="row" { (k) } td.n { (size(l)) } td.n { (ends.join(" to ")) }
                        @for key in ["mean", "largest", "doubt"] { td.n { (significant(number(l, key), 3)) } }
                        @for key in ["hopeless", "at_limit"] { td.n { (number(l, key)) } }
                        @match l.get("measured") {
                            Some(m) => {
                                td.n { (number(m, "texels")) }
                                @for key in ["mean", "largest", "stored_mean", "stored_largest"] { td.n { (significant(number(m, key), 3)) } }
                            }
                            None => @for _ in 0..5 { td.n { "-" } },
                        }
                    }
                } }
            }
        },
    )
}

fn description(view: &MapView) -> Markup {
    let record = &view.record;
    html! {
        dl {
            dt { "rule" } dd { (text(record, "rule")) ": " (text(record, "formula")) }
            dt { "lobes" } dd { (text(record, "shape")) ", normals " (text(record, "normals")) ", objective " (text(record, "objective")) ", effort " (text(record, "effort")) }
            @for input in list(record, "inputs") {
                dt { (text(input, "role")) }
                dd { (text(input, "file")) @if !text(input, "blake3").is_empty() { " (blake3 " code.long { (text(input, "blake3")) } ")" } }
            }
            dt { "factor of the roughness" } dd { (short(number(record, "factor"))) ", inside the map" }
            dt { "identity" } dd { code.long { (record.get("recipe").map_or("", |r| text(r, "hash"))) } }
        }
        (scroll("files", html! {
            table {
                thead { tr { th scope="col" { "file" } th scope="col" { "container" } th scope="col" { "stored as" } th.n scope="col" { "bytes" } } }
                tbody { @for f in &view.files {
                    tr { th scope="row" { (f.file) } td { (f.container) } td { (f.storage) } td.n { (f.bytes) } }
                } }
            }
        }))
    }
}

/// Which texels of a level are pixels.
struct Thin {
    size: [usize; 2],
    step: usize,
    from: [usize; 2],
}

impl Thin {
    fn new(from: [usize; 2], most: usize) -> Thin {
        let step = from[0].max(from[1]).div_ceil(most).max(1);
        Thin { size: from.map(|n| n.div_ceil(step)), step, from }
    }

    /// The value of the first texel of each pixel.
    fn first(&self, values: &[f64]) -> Vec<f64> {
        let [w, h] = self.size;
        let at = |i: usize| values.get(i / w * self.step * self.from[0] + i % w * self.step).copied();
        (0..w * h).map(|i| at(i).unwrap_or(f64::NAN)).collect()
    }

    /// The same, or of errors the largest.
    fn of(&self, plane: &MapPlane) -> Vec<f64> {
        if !plane.is_error || self.step == 1 {
            return self.first(&plane.values);
        }
        let [w, h] = self.size;
        let mut most = vec![f64::NAN; w * h];
        for (i, v) in plane.values.iter().enumerate().take(self.from[0] * self.from[1]) {
            let [x, y] = [i % self.from[0] / self.step, i / self.from[0] / self.step];
            most[y * w + x] = most[y * w + x].max(*v);
        }
        most
    }
}

/// Texture coordinates of the middles of the first texels, as the script reads them.
fn axes(thin: &Thin, from: [usize; 2]) -> String {
    let middles = |a: usize| {
        let all = (0..thin.size[a]).map(|i| (i * thin.step) as f64 + 0.5).map(|t| t / from[a].max(1) as f64);
        colour::floats(all)
    };
    serde_json::json!([["u", "x", middles(0)], ["v", "y", middles(1)]]).to_string()
}

fn channels(level: &MapLevel) -> String {
    let ids: Vec<&str> = level.planes.iter().map(|p| p.channel.as_str()).collect();
    serde_json::to_string(&ids).unwrap_or_default()
}

fn size(level: &Json) -> String {
    list(level, "size").iter().map(ToString::to_string).collect::<Vec<_>>().join(" x ")
}

fn list<'a>(of: &'a Json, key: &str) -> &'a [Json] {
    of.get(key).and_then(Json::as_array).map_or(&[], Vec::as_slice)
}

fn text<'a>(of: &'a Json, key: &str) -> &'a str {
    of.get(key).and_then(Json::as_str).unwrap_or_default()
}

fn number(of: &Json, key: &str) -> f64 {
    of.get(key).and_then(Json::as_f64).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::Thin;
    use crate::report::page::view::MapPlane;

    #[test]
    fn a_pixel_has_the_largest_error_of_its_texels() {
        let thin = Thin::new([5, 3], 2);
        assert_eq!((thin.size, thin.step), ([2, 1], 3));
        let mut plane =
            MapPlane { map: String::new(), channel: String::new(), is_error: true, values: vec![0.0; 15] };
        (plane.values[0], plane.values[2 + 5 * 2], plane.values[4 + 5]) = (0.125, 0.5, 0.25);
        assert_eq!(thin.of(&plane), [0.5, 0.25]);
        plane.is_error = false;
        assert_eq!(thin.of(&plane), [0.125, 0.0]);
    }
}
