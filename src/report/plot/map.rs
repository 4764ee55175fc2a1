//! The lobe over the whole hemisphere as colours: a disc for each model and angle of incidence. The distance from the middle of a disc
//! is that of Lambert's azimuthal projection, so equal solid angles have equal areas; the tangent points to the right.

use super::{Figure, LEAST_COSINE, Look, Subject, azimuth};
use crate::math::figures::{short, significant};
use crate::math::frame;
use crate::report::drawing::{Drawing, Field, INK, wrapped};
use glam::DVec3;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Diameter of a disc, and the room round it, in pixels.
const DISC: u32 = 220;
const GAP: f64 = 20.0;
const LINE: f64 = 20.0;
const LEGEND: u32 = 256;
/// Least width, for the words.
const LEAST_WIDTH: f64 = 520.0;

/// Cosine and f of each pixel, row by row; none outside of the disc.
type Disc = Vec<Option<(f64, f64)>>;

/// Colours over the hemisphere.
#[must_use]
pub fn map(title: &str, subjects: &[Subject<'_>], look: &Look) -> Figure {
    let discs: Vec<Vec<Disc>> = subjects
        .iter()
        .map(|s| look.degrees.iter().map(|d| disc(s, d.to_radians(), look.azimuth.to_radians())).collect())
        .collect();
    let seen = discs.iter().flatten().flatten().flatten().filter(|(cos, _)| *cos >= LEAST_COSINE);
    let top = seen.map(|p| p.1).fold(0.0, f64::max);
    let side = f64::from(DISC) + GAP;
    let width = (GAP + side * look.degrees.len() as f64).max(LEAST_WIDTH);
    let names: Vec<Vec<String>> = subjects.iter().map(|s| wrapped(&s.name, width - 2.0 * GAP)).collect();
    let heading = wrapped(title, width - 2.0 * GAP);
    let lines = heading.len() + names.iter().map(Vec::len).sum::<usize>() + subjects.len();
    let height = 84.0 + LINE * lines as f64 + side * subjects.len() as f64;
    let mut d = Drawing::new([width, height], title);
    let mut y = 4.0;
    for line in heading {
        y += LINE;
        d.text([GAP, y], 0.0, INK, line);
    }
    for (discs, name) in discs.into_iter().zip(names) {
        for line in name {
            y += LINE;
            d.text([GAP, y], 0.0, INK, line);
        }
        y += 8.0;
        for ((values, degrees), i) in discs.into_iter().zip(&look.degrees).zip(0u32..) {
            let left = GAP + side * f64::from(i);
            let mut pixels: Vec<[u8; 3]> = values
                .into_iter()
                .map(|v| v.map_or([255; 3], |(_, f)| colour(look.scale.part(f, top))))
                .collect();
            cross(&mut pixels, degrees.to_radians(), look.azimuth.to_radians());
            d.field(Field { at: [whole(left), whole(y)], width: DISC, pixels });
            let middle = left + f64::from(DISC) / 2.0;
            d.text([middle, y + f64::from(DISC) + 16.0], 0.5, INK, format!("{} deg", short(*degrees)));
        }
        y += side + LINE - 8.0;
    }
    let strip = (0..10).flat_map(|_| (0..LEGEND).map(|i| colour(f64::from(i) / f64::from(LEGEND - 1))));
    d.field(Field { at: [whole(GAP), whole(y + 8.0)], width: LEGEND, pixels: strip.collect() });
    let scale = format!("up to {} 1/sr: {}", significant(top, 4), look.scale.words());
    d.text([GAP + f64::from(LEGEND) + 10.0, y + 17.0], 0.0, INK, scale);
    let told = format!("cross: mirror direction{}", azimuth(subjects, look));
    d.text([GAP, y + 40.0], 0.0, INK, told);
    Figure(d)
}

/// The pixels of a disc.
fn disc(subject: &Subject<'_>, incidence: f64, turned: f64) -> Disc {
    let wi = frame::spherical(incidence, PI + turned);
    let at = |i: u32| (2.0 * f64::from(i) + 1.0) / f64::from(DISC) - 1.0;
    let value = |(x, y): (u32, u32)| {
        let wo = lifted(at(x), -at(y))?;
        Some((wo.z, subject.model.eval(wo, wi)))
    };
    (0..DISC).flat_map(|y| (0..DISC).map(move |x| (x, y))).map(value).collect()
}

/// The direction of a place in the unit disc.
fn lifted(x: f64, y: f64) -> Option<DVec3> {
    // r = sqrt(2) sin(theta / 2), so that r = 1 at the horizon
    let r2 = x * x + y * y;
    let cos = 1.0 - r2;
    let stretch = (2.0 - r2).max(0.0).sqrt();
    (cos > 0.0).then(|| DVec3::new(x * stretch, y * stretch, cos))
}

/// Marks the mirror direction.
fn cross(pixels: &mut [[u8; 3]], incidence: f64, turned: f64) {
    let r = libm::sin(0.5 * incidence) / FRAC_1_SQRT_2;
    let pixel = |v: f64| whole(0.5 * (v + 1.0) * f64::from(DISC));
    let (x, y) = (pixel(r * libm::cos(turned)), pixel(-r * libm::sin(turned)));
    for k in 0..9 {
        for (x, y) in [(x + k, y + 4), (x + 4, y + k)] {
            let (Some(x), Some(y)) = (x.checked_sub(4), y.checked_sub(4)) else { continue };
            if x < DISC
                && y < DISC
                && let Some(p) = pixels.get_mut((y * DISC + x) as usize)
            {
                *p = [255; 3];
            }
        }
    }
}

fn colour(part: f64) -> [u8; 3] {
    colorous::CIVIDIS.eval_continuous(part.clamp(0.0, 1.0)).as_array()
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "places in a picture of a few hundred pixels"
)]
fn whole(v: f64) -> u32 {
    v.max(0.0) as u32
}
