//! The directions that a fit sees, and what a target reflects there.

use super::super::lobe::frame;
use glam::DVec3;
use std::f64::consts::PI;

/// Directions of light of equal projected solid angle.
pub const LIGHTS: usize = 8;

/// Cosine of one more light, which holds lobes down that only grazing light would show, and its share against the others.
pub const GRAZING: [f64; 2] = [0.05, 0.25];

/// Rings of the narrow and of the broad set about the mirror direction of a light, and sectors of a half-circle.
const RINGS: [usize; 2] = [26, 12];
const SECTORS: usize = 12;

/// Rings of the three sets of a surface with two widths, sectors of a circle, directions of light and azimuths of them.
const STRETCHED_RINGS: [usize; 3] = [14, 8, 6];
const STRETCHED_SECTORS: usize = 16;
const STRETCHED_LIGHTS: usize = 4;
const AZIMUTHS: usize = 3;

/// Width of the broad set.
const BROAD: f64 = 0.8;

/// Pairs of directions with their weight in the norm: solid angle of o times the share of i.
///
/// i has the cosines √((k + 1/2)/8), so that each stands for the same part of what a surface receives; [`GRAZING`] is one more. o lies on rings about the
/// mirror direction, some as dense as a lobe of GGX of the width α reflects and some that reach all of the hemisphere, in the half of it
/// that an isotropic surface needs; each stands for one over the density of both.
#[derive(Debug, Clone)]
pub struct Directions {
    /// Directions of light, in the plane of x and z.
    pub lights: Vec<DVec3>,
    /// For each light: direction of the viewer, weight.
    pub views: Vec<Vec<(DVec3, f64)>>,
    /// The smaller width that they are made for.
    pub alpha: f64,
    /// For two widths: lights stand at several azimuths.
    pub stretched: bool,
}

impl Directions {
    /// Directions for lobes of about this width.
    #[must_use]
    pub fn new(alpha: f64) -> Directions {
        let [grazing, share] = GRAZING;
        let squares = (0..LIGHTS).map(|k| (k as f64 + 0.5) / LIGHTS as f64);
        let light = |square: f64| DVec3::new((1.0 - square).sqrt(), 0.0, square.sqrt());
        let lights: Vec<DVec3> = std::iter::once(grazing * grazing).chain(squares).map(light).collect();
        let charts = [(alpha, RINGS[0]), (BROAD, RINGS[1])];
        let view = |(k, i): (usize, &DVec3)| {
            rings(*i, &charts, true, (if k == 0 { share } else { 1.0 }, LIGHTS as f64))
        };
        let views = lights.iter().enumerate().map(view).collect();
        Directions { lights, views, alpha, stretched: false }
    }

    /// Directions for lobes of two widths, along x and y: lights in a quarter of the azimuths, which stands for all, and all views.
    #[must_use]
    pub fn stretched(widths: [f64; 2]) -> Directions {
        let [wide, alpha] = [widths[0].max(widths[1]), widths[0].min(widths[1])];
        let charts = [(alpha, STRETCHED_RINGS[0]), (wide, STRETCHED_RINGS[1]), (BROAD, STRETCHED_RINGS[2])];
        let [grazing, share] = GRAZING;
        let number = (STRETCHED_LIGHTS * AZIMUTHS) as f64;
        let squares = (0..STRETCHED_LIGHTS).map(|k| ((k as f64 + 0.5) / STRETCHED_LIGHTS as f64, 1.0));
        let (mut lights, mut views) = (Vec::new(), Vec::new());
        for (square, share) in std::iter::once((grazing * grazing, share)).chain(squares) {
            for azimuth in 0..AZIMUTHS {
                let (sin, cos) = libm::sincos(0.5 * PI * (azimuth as f64 + 0.5) / AZIMUTHS as f64);
                let across = (1.0 - square).sqrt();
                let light = DVec3::new(across * cos, across * sin, square.sqrt());
                views.push(rings(light, &charts, false, (share, number)));
                lights.push(light);
            }
        }
        Directions { lights, views, alpha, stretched: true }
    }

    /// What a function of light and viewer is at every pair, lights first.
    pub fn sample(&self, f: impl Fn(DVec3, DVec3) -> f64) -> Vec<f64> {
        let of = |(i, views): (&DVec3, &Vec<(DVec3, f64)>)| {
            views.iter().map(|(o, _)| f(*i, *o)).collect::<Vec<_>>()
        };
        self.lights.iter().zip(&self.views).flat_map(of).collect()
    }

    /// The weights in the order of [`sample`](Directions::sample).
    #[must_use]
    pub fn weights(&self) -> Vec<f64> {
        self.views.iter().flatten().map(|v| v.1).collect()
    }
}

/// Rings about the mirror direction of a light, one of so many, with its share; in half of the circle, which stands for both, or all of it.
fn rings(i: DVec3, charts: &[(f64, usize)], half: bool, (share, lights): (f64, f64)) -> Vec<(DVec3, f64)> {
    let mirror = DVec3::new(-i.x, -i.y, i.z);
    let [t, b, n] = frame(mirror);
    let (count, halves, turn) = if half { (SECTORS, 2.0, PI) } else { (STRETCHED_SECTORS, 1.0, 2.0 * PI) };
    // rings per radian: tan(theta/2) = a sqrt(u/(1 - u)), half vectors as GGX has them
    let density = |tangent: f64, (a, rings): (f64, usize)| {
        let q = a * a + tangent * tangent;
        rings as f64 * tangent * a * a * (1.0 + tangent * tangent) / (q * q)
    };
    let mut out = Vec::with_capacity(charts.iter().map(|c| c.1).sum::<usize>() * count);
    for &(a, rings) in charts {
        for ring in 0..rings {
            let u = (ring as f64 + 0.5) / rings as f64;
            let tangent = a * (u / (1.0 - u)).sqrt();
            let (sin, cos) = libm::sincos(2.0 * libm::atan(tangent));
            let all = charts.iter().map(|c| density(tangent, *c)).sum::<f64>();
            let area = halves * sin * turn / count as f64 / all;
            for k in 0..count {
                let (s, c) = libm::sincos(turn * (k as f64 + 0.5) / count as f64);
                let o = (t * c + b * s) * sin + n * cos;
                if o.z > 0.0 {
                    out.push((o, share * area / lights));
                }
            }
        }
    }
    out
}
