//! White-furnace spheres: what an engine shows that shades them by the table, with its bilinear lookup of the stored numbers.

use super::colour;
use super::view::{Texels, View};
use crate::grid::axis::count;
use crate::grid::{Grid, Table};
use crate::math::figures::significant;
use crate::models;
use crate::picture::Space;
use crate::report::split::Split;
use maud::{Markup, html};

/// Spheres of a row, and the radius of one in pixels.
const SPHERES: usize = 6;
const RADIUS: usize = 40;

/// A row of spheres.
struct Row {
    title: &'static str,
    f0: f64,
    compensated: bool,
}

const ROWS: [Row; 4] = [
    Row { title: "white, single scattering", f0: 1.0, compensated: false },
    Row { title: "white, with energy compensation", f0: 1.0, compensated: true },
    Row { title: "metal of F0 = 0.5, single scattering", f0: 0.5, compensated: false },
    Row { title: "metal of F0 = 0.5, with energy compensation", f0: 0.5, compensated: true },
];

/// Rows of spheres, if the table is one that shades them.
pub(super) fn spheres(view: &View, texels: &Texels) -> Option<Markup> {
    let reading = Split::of(&view.provenance.channels)?;
    let grid = &texels.grid;
    let mu = grid.axes().iter().position(|a| a.quantity.base_id() == "mu")?;
    let width = grid.axes().iter().position(|a| a.quantity.base_id() == "alpha")?;
    let model = view.provenance.model.as_ref().and_then(|m| models::find(&m.id));
    // what a microfacet lobe loses to further scattering is given back; other lobes lose nothing that an engine knows of
    let compensates = model.is_some_and(|(info, _)| info.splits);
    let rows = ROWS.iter().filter(|r| (compensates || !r.compensated) && (reading.takes_f0() || r.f0 > 0.9));
    let table = Table {
        grid: grid.clone(),
        channels: view.provenance.channels.clone(),
        values: texels.stored.clone(),
        errors: Vec::new(),
        evaluations: Vec::new(),
    };
    let axis = &grid.axes()[width];
    let [lo, hi] = axis.domain;
    let roughness: Vec<f64> = (0..SPHERES).map(|i| lo + (hi - lo) * count(i) / count(SPHERES - 1)).collect();
    Some(html! {
        h4 { "In a white furnace" }
        p.note {
            "Radiance 1 from everywhere; an orthographic view; stored numbers, read bilinearly. Numbers: the mean over the disc. "
            @if compensates { "Compensated: times 1 + F0 (1 / E - 1), E read from the same table. " }
            "Spheres of " (axis.quantity.id) " " (roughness.iter().map(|r| significant(*r, 3)).collect::<Vec<_>>().join(", ")) "."
        }
        @for row in rows {
            @let (picture, means) = draw(&table, [mu, width], &roughness, &|v| shade(reading, row, v));
            @let told = means.iter().map(|m| format!("{m:.4}")).collect::<Vec<_>>().join(", ");
            figure.spheres {
                img src=(picture) width=(2 * RADIUS * SPHERES) height=(2 * RADIUS) alt=(format!("{}: mean radiance {told}", row.title));
                figcaption { (row.title) ": " (told) }
            }
        }
    })
}

fn shade(reading: Split, row: &Row, values: &[f64]) -> f64 {
    let [scale, bias] = reading.scale_bias(values);
    let [e, white] = [row.f0 * scale + bias, scale + bias];
    if row.compensated && white > 0.0 { e * (1.0 + row.f0 * (1.0 / white - 1.0)) } else { e }
}

/// The spheres as an sRGB picture on white, and the mean of each.
fn draw(
    table: &Table,
    axes: [usize; 2],
    roughness: &[f64],
    shade: &dyn Fn(&[f64]) -> f64,
) -> (String, Vec<f64>) {
    let size = 2 * RADIUS;
    let mut codes = vec![255; size * size * roughness.len()];
    let mut means = Vec::new();
    let mut values = vec![0.0; table.channels.len()];
    for (n, &r) in roughness.iter().enumerate() {
        let (mut sum, mut pixels) = (0.0, 0usize);
        for y in 0..size {
            for x in 0..size {
                let [dx, dy] = [x, y].map(|v| (count(v) + 0.5) / count(RADIUS) - 1.0);
                let mu2 = 1.0 - dx * dx - dy * dy;
                let Some(point) = (mu2 >= 0.0).then(|| point(&table.grid, axes, mu2.sqrt(), r)).flatten()
                else {
                    continue;
                };
                table.read(&point, &mut values);
                let v = shade(&values);
                sum += v;
                pixels += 1;
                codes[(y * roughness.len() + n) * size + x] = Space::Srgb.byte(v);
            }
        }
        means.push(sum / count(pixels.max(1)));
    }
    (colour::png(size * roughness.len(), &codes, None), means)
}

/// A view cosine and a width; the middle of every further axis.
fn point(
    grid: &Grid,
    [mu, width]: [usize; 2],
    cosine: f64,
    roughness: f64,
) -> Option<crate::grid::layout::Point> {
    let value = |i: usize| {
        let axis = &grid.axes()[i];
        match i {
            _ if i == mu => cosine,
            _ if i == width => axis.quantity.to_base(roughness),
            _ => axis.quantity.to_base(axis.value_at(0.5, 0.0)),
        }
    };
    grid.point(&(0..grid.axes().len()).map(value).collect::<Vec<_>>())
}
