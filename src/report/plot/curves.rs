//! The directional albedo over the cosine of the view, E(mu), and of models that transmit the part T that crosses, dashed.

use super::{Figure, PlotError, Subject};
use crate::cancel::Cancel;
use crate::integrate::View;
use crate::math::figures::{short, significant};
use crate::report::drawing::{COLOURS, Drawing, INK, LETTER, Stroke, wrapped};
use crate::tables::integral::{Functional, integrate};

/// Size of the picture, and the frame inside it: left, top, right, bottom.
const WIDTH: f64 = 680.0;
const FRAME: [f64; 4] = [64.0, 40.0, 640.0, 440.0];
const LINE: f64 = 20.0;
const GRID: [u8; 3] = [222, 222, 222];
/// Intervals of a curve; they crowd at grazing views, where it bends.
const STEPS: u32 = 64;
/// Least cosine of the views that set the frame: some albedos grow without bound towards grazing ones, and are cut there.
const FRAMED: f64 = 0.05;
/// Of what a picture of a few hundred pixels shows.
const TOLERANCE: f64 = 1e-4;

/// E, and T of what transmits, at a view.
#[derive(Debug, Clone, Copy)]
struct Value {
    mu: f64,
    e: f64,
    t: Option<f64>,
}

/// Curves of E(mu); the azimuth of the view in degrees from the tangent.
///
/// # Errors
/// [`PlotError`] where an albedo has no value, or when it is stopped.
pub fn curves(
    title: &str,
    subjects: &[Subject<'_>],
    azimuth: f64,
    cancel: &Cancel,
) -> Result<Figure, PlotError> {
    let all: Vec<Vec<Value>> =
        subjects.iter().map(|s| values(s, azimuth, cancel)).collect::<Result<_, _>>()?;
    let heading = wrapped(title, WIDTH - 2.0 * FRAME[0]);
    let head = LINE * heading.len() as f64;
    let framed = all.iter().flatten().filter(|v| v.mu >= FRAMED).flat_map(|v| [Some(v.e), v.t]).flatten();
    let top = ceiling(framed.fold(1.0, f64::max));
    let place = |mu: f64, v: f64| {
        let [left, upper, right, lower] = [FRAME[0], FRAME[1] + head, FRAME[2], FRAME[3] + head];
        [left + (right - left) * mu, lower - (lower - upper) * (v / top).min(1.0)]
    };
    let through = all.iter().flatten().any(|v| v.t.is_some());
    let caption: Vec<(String, [u8; 3])> = subjects
        .iter()
        .zip(&all)
        .enumerate()
        .flat_map(|(i, (s, values))| {
            let ends = [values.first(), values.last()].map(|v| v.map_or(0.0, |v| v.e));
            let text = format!(
                "{}: E {} at grazing, {} at normal",
                s.name,
                significant(ends[0], 4),
                significant(ends[1], 4)
            );
            let colour = COLOURS[i % COLOURS.len()];
            wrapped(&text, WIDTH - 2.0 * FRAME[0]).into_iter().map(move |l| (l, colour))
        })
        .collect();
    let below = FRAME[3] + head + 44.0;
    let mut d = Drawing::new([WIDTH, below + LINE * (caption.len() as f64 + 0.5)], title);
    for (line, i) in heading.into_iter().zip(1..) {
        d.text([FRAME[0], 4.0 + LINE * f64::from(i)], 0.0, INK, line);
    }
    let what = if through { "E; dashed: T" } else { "E" };
    let turned = subjects.iter().any(|s| s.model.turns());
    let turned = if turned { format!(", azimuth {} deg", short(azimuth)) } else { String::new() };
    d.text([FRAME[0], FRAME[1] + head - 10.0], 0.0, INK, format!("{what}{turned}"));
    let middle = 0.5 * (FRAME[0] + FRAME[2]);
    d.text([middle, FRAME[3] + head + 36.0], 0.5, INK, "mu, cosine of the view".to_owned());
    for i in 0..=5 {
        let part = f64::from(i) / 5.0;
        d.line([place(part, 0.0), place(part, top)], GRID, 1.0, false);
        d.line([place(0.0, part * top), place(1.0, part * top)], GRID, 1.0, false);
        let ([x, y], [left, across]) = (place(part, 0.0), place(0.0, part * top));
        d.text([x, y + 18.0], 0.5, INK, short(part));
        d.text([left - LETTER, across + 4.0], 1.0, INK, short(part * top));
    }
    for (i, values) in all.iter().enumerate() {
        let (colour, dashed) = (COLOURS[i % COLOURS.len()], i >= COLOURS.len());
        let points: Vec<[f64; 2]> = values.iter().map(|v| place(v.mu, v.e)).collect();
        points.iter().step_by(8).for_each(|p| d.mark(*p, i, colour));
        d.strokes.push(Stroke { points, colour, width: 2.0, dashed });
        let points: Vec<[f64; 2]> = values.iter().filter_map(|v| Some(place(v.mu, v.t?))).collect();
        d.strokes.push(Stroke { points, colour, width: 1.0, dashed: true });
    }
    for ((text, colour), i) in caption.into_iter().zip(1..) {
        d.text([FRAME[0], below + LINE * f64::from(i) - 6.0], 0.0, colour, text);
    }
    Ok(Figure(d))
}

fn values(subject: &Subject<'_>, azimuth: f64, cancel: &Cancel) -> Result<Vec<Value>, PlotError> {
    let one = |i: u32| -> Result<Value, PlotError> {
        cancel.check()?;
        let part = f64::from(i) / f64::from(STEPS);
        let mu = part * part;
        let view = View { mu, phi: azimuth.to_radians() };
        let e = integrate(subject.model, view, &[Functional::One], TOLERANCE)?.value[0];
        let t = subject.model.transmission().map(|t| t.albedo(view, TOLERANCE).value[0]);
        Ok(Value { mu, e, t })
    };
    // in the horizon itself an albedo may be infinite
    let first = one(0);
    if let Err(PlotError::Cancelled(stopped)) = first {
        return Err(stopped.into());
    }
    first.ok().into_iter().map(Ok).chain((1..=STEPS).map(one)).collect()
}

/// The next of 1, 1.5, 2, 3, 5 and their tens.
fn ceiling(v: f64) -> f64 {
    let ten = libm::pow(10.0, libm::floor(libm::log10(v)));
    let steps = [1.0, 1.5, 2.0, 3.0, 5.0, 10.0];
    // an albedo that touches 1 by rounding is no reason for a wider frame
    steps.map(|s| s * ten).into_iter().find(|s| v <= s * (1.0 + 1e-6)).unwrap_or(10.0 * ten)
}
