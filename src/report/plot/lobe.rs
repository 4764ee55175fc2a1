//! Polar plots of f in the plane of incidence: light from the left, the reflected lobe to the right, the transmitted one below. A
//! curve for each model and angle of incidence; colours tell angles apart, or models where there are several.

use super::{Figure, LEAST_COSINE, Look, Subject, azimuth};
use crate::math::figures::{short, significant};
use crate::math::frame;
use crate::models::Brdf;
use crate::report::drawing::{COLOURS, Drawing, INK, Stroke, wrapped};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Radius of the rim and margins, in pixels.
const RADIUS: f64 = 300.0;
const MARGIN: f64 = 40.0;
const WIDTH: f64 = 2.0 * (MARGIN + RADIUS);
/// Between lines of words.
const LINE: f64 = 20.0;

/// Points on a half circle.
const STEPS: u32 = 1440;

const GREY: [u8; 3] = [176, 176, 176];

/// Points of a curve: the angle from the normal, negative towards the light and beyond a right one below the surface, and f.
type Curve = Vec<(f64, f64)>;

/// A lobe, with those that it is a sum of.
struct Lobe {
    subject: usize,
    angle: usize,
    above: Curve,
    below: Curve,
    apart: Vec<Curve>,
}

/// f in the plane of incidence.
#[must_use]
pub fn polar(title: &str, subjects: &[Subject<'_>], look: &Look) -> Figure {
    let lobes: Vec<Lobe> = subjects
        .iter()
        .enumerate()
        .flat_map(|(subject, s)| {
            // the lobes of a sum apart, such as its diffuse and its specular part, where there is room for them
            let parts = s.model.parts().filter(|parts| parts.len() > 1 && subjects.len() == 1);
            let parts = parts.unwrap_or_default();
            (0..look.degrees.len()).map(move |angle| lobe(subject, s.model, &parts, angle, look))
        })
        .collect();
    let inside = |curve: &Curve| {
        let seen = curve.iter().filter(|(theta, _)| libm::cos(*theta).abs() >= LEAST_COSINE);
        seen.map(|p| p.1).fold(0.0, f64::max)
    };
    let top = lobes.iter().flat_map(|l| [inside(&l.above), inside(&l.below)]).fold(0.0, f64::max);
    let through = lobes.iter().any(|l| !l.below.is_empty());
    let heading = match subjects {
        [one] if !one.name.is_empty() => format!("{title} ({})", one.name),
        _ => title.to_owned(),
    };
    let heading = wrapped(&heading, WIDTH - 2.0 * MARGIN);
    let centre = [WIDTH / 2.0, 24.0 + LINE * heading.len() as f64 + RADIUS];
    let mut caption = captions(subjects, look, &lobes, &inside);
    let apart = lobes.iter().any(|l| !l.apart.is_empty());
    caption.push((note(subjects, look, apart, through, cut(&lobes, top)), INK));
    let caption: Vec<(String, [u8; 3])> = caption
        .into_iter()
        .flat_map(|(text, colour)| wrapped(&text, WIDTH - 2.0 * MARGIN).into_iter().map(move |l| (l, colour)))
        .collect();
    let bottom = centre[1] + if through { RADIUS + 8.0 } else { 0.0 };
    let height = bottom + LINE * (caption.len() as f64 + 1.0);
    let mut d = Drawing::new([WIDTH, height], &heading.join(" "));
    heading
        .into_iter()
        .zip(1..)
        .for_each(|(line, i)| d.text([MARGIN, 4.0 + LINE * f64::from(i)], 0.0, INK, line));
    grid(&mut d, centre, through);
    for lobe in &lobes {
        let which = if subjects.len() == 1 { lobe.angle } else { lobe.subject };
        draw(&mut d, centre, lobe, COLOURS[which % COLOURS.len()], |f| RADIUS * look.scale.part(f, top));
        from(&mut d, centre, look.degrees[lobe.angle], COLOURS[which % COLOURS.len()]);
    }
    for ((text, colour), i) in caption.into_iter().zip(1..) {
        d.text([MARGIN, bottom + LINE * f64::from(i)], 0.0, colour, text);
    }
    Figure(d)
}

fn lobe(subject: usize, model: &dyn Brdf, parts: &[(f64, &dyn Brdf)], angle: usize, look: &Look) -> Lobe {
    let incidence = look.degrees[angle].to_radians();
    let turned = look.azimuth.to_radians();
    let above = |f: &dyn Fn(DVec3, DVec3) -> f64| curve(incidence, turned, [-FRAC_PI_2, FRAC_PI_2], f);
    let through = model.transmission();
    let below = through.map(|t| curve(incidence, turned, [FRAC_PI_2, 3.0 * FRAC_PI_2], |o, i| t.eval(o, i)));
    Lobe {
        subject,
        angle,
        above: above(&|o, i| model.eval(o, i)),
        below: below.unwrap_or_default(),
        apart: parts.iter().map(|(weight, lobe)| above(&|o, i| weight * lobe.eval(o, i))).collect(),
    }
}

/// f over a range of angles from the normal, for light from an angle of incidence.
fn curve(incidence: f64, turned: f64, [from, to]: [f64; 2], f: impl Fn(DVec3, DVec3) -> f64) -> Curve {
    let wi = frame::spherical(incidence, PI + turned);
    (0..=STEPS)
        .map(|i| {
            let theta = from + (to - from) * f64::from(i) / f64::from(STEPS);
            let (sin, cos) = (libm::sin(theta), libm::cos(theta));
            let wo = DVec3::new(sin * libm::cos(turned), sin * libm::sin(turned), cos);
            (theta, f(wo, wi))
        })
        .collect()
}

/// A line for each curve, or for each model where there are several.
fn captions(
    subjects: &[Subject<'_>],
    look: &Look,
    lobes: &[Lobe],
    inside: &dyn Fn(&Curve) -> f64,
) -> Vec<(String, [u8; 3])> {
    let peak = |l: &Lobe| {
        let below = inside(&l.below);
        let below = if below > 0.0 { format!(", {} below", significant(below, 4)) } else { String::new() };
        format!("{}{below}", significant(inside(&l.above), 4))
    };
    if subjects.len() == 1 {
        let line = |l: &Lobe| {
            let angle = short(look.degrees[l.angle]);
            (format!("{angle} deg: largest f {} 1/sr", peak(l)), COLOURS[l.angle % COLOURS.len()])
        };
        return lobes.iter().map(line).collect();
    }
    let line = |(i, s): (usize, &Subject<'_>)| {
        let own = lobes.iter().filter(|l| l.subject == i);
        let peaks: Vec<String> =
            own.map(|l| format!("{} ({} deg)", peak(l), short(look.degrees[l.angle]))).collect();
        (format!("{}: largest f {} 1/sr", s.name, peaks.join(", ")), COLOURS[i % COLOURS.len()])
    };
    subjects.iter().enumerate().map(line).collect()
}

fn note(subjects: &[Subject<'_>], look: &Look, apart: bool, through: bool, cut: bool) -> String {
    let apart = if apart { "; dashed: its lobes apart" } else { "" };
    let through = if through { "; below: transmitted" } else { "" };
    let cut = if cut { "; cut where it grows within 0.6 deg of the horizon" } else { "" };
    format!("radius: {}{}{apart}{through}{cut}", look.scale.words(), azimuth(subjects, look))
}

/// Is there more than the scale shows?
fn cut(lobes: &[Lobe], top: f64) -> bool {
    lobes.iter().flat_map(|l| l.above.iter().chain(&l.below)).any(|p| p.1 > top * (1.0 + 1e-9))
}

/// Pixel position; the origin of the plot is in the middle of the surface.
fn place([x, y]: [f64; 2], theta: f64, r: f64) -> [f64; 2] {
    [x + r * libm::sin(theta), y - r * libm::cos(theta)]
}

fn draw(d: &mut Drawing, centre: [f64; 2], lobe: &Lobe, colour: [u8; 3], radius: impl Fn(f64) -> f64) {
    let outline = |curve: &Curve| curve.iter().map(|&(theta, f)| place(centre, theta, radius(f))).collect();
    for curve in [&lobe.above, &lobe.below].into_iter().filter(|c| !c.is_empty()) {
        d.strokes.push(Stroke { points: outline(curve), colour, width: 2.0, dashed: false });
    }
    for curve in &lobe.apart {
        d.strokes.push(Stroke { points: outline(curve), colour, width: 1.0, dashed: true });
    }
}

/// Where the light comes from.
fn from(d: &mut Drawing, centre: [f64; 2], degrees: f64, colour: [u8; 3]) {
    let from = -degrees.to_radians();
    d.line([place(centre, from, RADIUS), place(centre, from, RADIUS + 14.0)], colour, 3.0, false);
}

fn grid(d: &mut Drawing, centre: [f64; 2], through: bool) {
    let half = if through { 180 } else { 90 };
    for part in [0.25, 0.5, 0.75, 1.0] {
        let arc = (-half..=half).map(|i| place(centre, f64::from(i).to_radians(), part * RADIUS)).collect();
        d.strokes.push(Stroke { points: arc, colour: GREY, width: 1.0, dashed: false });
    }
    for degrees in (-half..=half).step_by(30) {
        let end = place(centre, f64::from(degrees).to_radians(), RADIUS);
        d.line([centre, end], GREY, 1.0, false);
    }
}
