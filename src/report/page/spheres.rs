//! White-furnace spheres: what an engine shows that shades them by the table, with its bilinear lookup of the stored numbers.

use super::colour;
use super::view::{Texels, View};
use crate::grid::axis::count;
use crate::grid::{Grid, Table};
use crate::math::figures::significant;
use crate::models;
use maud::{Markup, html};

/// Spheres of a row, and the radius of one in pixels.
const SPHERES: usize = 6;
const RADIUS: usize = 40;

/// How the channels give the albedo of a metal of a reflectance at normal incidence; the roles are those of the files.
#[derive(Debug, Clone, Copy)]
enum Reading {
    /// A channel is the white albedo.
    White(usize),
    /// Parts with weights 1 - Fc and Fc.
    ScaleBias(usize, usize),
    /// Parts with weights 1 and Fc.
    OneSchlick(usize, usize),
}

impl Reading {
    fn of(view: &View) -> Option<Reading> {
        let role = |r: &str| view.provenance.channels.iter().position(|c| c.role == r);
        let schlick = role("split part, Schlick weight");
        let scale = role("split part, complement of the Schlick weight");
        let one = role("split part, weight 1");
        match (scale, one, schlick) {
            (Some(scale), _, Some(bias)) => Some(Reading::ScaleBias(scale, bias)),
            (_, Some(one), Some(schlick)) => Some(Reading::OneSchlick(one, schlick)),
            _ => role("albedo").or_else(|| role("reflected albedo")).map(Reading::White),
        }
    }

    /// The albedo at F0, F90 = 1, and the white one.
    fn albedo(self, values: &[f64], f0: f64) -> [f64; 2] {
        match self {
            Reading::White(e) => [values[e], values[e]],
            Reading::ScaleBias(s, b) => [f0 * values[s] + values[b], values[s] + values[b]],
            Reading::OneSchlick(one, fc) => [f0 * (values[one] - values[fc]) + values[fc], values[one]],
        }
    }

    fn takes_f0(self) -> bool {
        !matches!(self, Reading::White(_))
    }
}

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
    let reading = Reading::of(view)?;
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

fn shade(reading: Reading, row: &Row, values: &[f64]) -> f64 {
    let [e, white] = reading.albedo(values, row.f0);
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
                codes[(y * roughness.len() + n) * size + x] = srgb(v);
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

/// The sRGB code of linear light (IEC 61966-2-1).
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in [0, 255] by the clamp")]
fn srgb(v: f64) -> u8 {
    let v = v.clamp(0.0, 1.0);
    let code = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055 };
    (255.0 * code).round() as u8
}
