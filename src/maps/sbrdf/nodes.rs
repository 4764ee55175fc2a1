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
    /// The width that they are made for.
    pub alpha: f64,
}

impl Directions {
    /// Directions for lobes of about this width.
    #[must_use]
    pub fn new(alpha: f64) -> Directions {
        let [grazing, share] = GRAZING;
        let squares = (0..LIGHTS).map(|k| (k as f64 + 0.5) / LIGHTS as f64);
        let light = |square: f64| DVec3::new((1.0 - square).sqrt(), 0.0, square.sqrt());
        let lights: Vec<DVec3> = std::iter::once(grazing * grazing).chain(squares).map(light).collect();
        let view = |(k, i): (usize, &DVec3)| rings(*i, alpha, if k == 0 { share } else { 1.0 });
        let views = lights.iter().enumerate().map(view).collect();
        Directions { lights, views, alpha }
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

fn rings(i: DVec3, alpha: f64, share: f64) -> Vec<(DVec3, f64)> {
    let mirror = DVec3::new(-i.x, -i.y, i.z);
    let [t, b, n] = frame(mirror);
    let charts = [(alpha, RINGS[0]), (BROAD, RINGS[1])];
    // rings per radian: tan(theta/2) = a sqrt(u/(1 - u)), half vectors as GGX has them
    let density = |tangent: f64, (a, rings): (f64, usize)| {
        let q = a * a + tangent * tangent;
        rings as f64 * tangent * a * a * (1.0 + tangent * tangent) / (q * q)
    };
    let mut out = Vec::with_capacity((RINGS[0] + RINGS[1]) * SECTORS);
    for (a, rings) in charts {
        for ring in 0..rings {
            let u = (ring as f64 + 0.5) / rings as f64;
            let tangent = a * (u / (1.0 - u)).sqrt();
            let (sin, cos) = libm::sincos(2.0 * libm::atan(tangent));
            // both halves count
            let area =
                2.0 * sin * PI / SECTORS as f64 / charts.map(|c| density(tangent, c)).iter().sum::<f64>();
            for sector in 0..SECTORS {
                let (s, c) = libm::sincos(PI * (sector as f64 + 0.5) / SECTORS as f64);
                let o = (t * c + b * s) * sin + n * cos;
                if o.z > 0.0 {
                    out.push((o, share * area / LIGHTS as f64));
                }
            }
        }
    }
    out
}
