//! Facet normals in polar coordinates round the view direction: `c = wo . wm` and the azimuth `psi` from the macronormal.
//!
//! Everything that an interface does depends on c alone, so the critical angle, where reflectance has an infinite slope, is a
//! line of this chart. With `wo = (s, 0, mu)`, `e = (-mu, 0, s)` and `wm = c wo + s_c (cos psi e + sin psi y)`:
//!
//! ```text
//! dwm = dc dpsi,  wm.z = c mu + s_c s cos psi,  wm.x = (c^2 - mu^2) / (c s + s_c mu) + 2 s_c mu sin^2(psi / 2)
//! ```
//! so that the slopes of normals near the macronormal, at c = mu and psi = 0, are not differences.
//!
//! Both coordinates run under the double exponential of [`broad`](super::broad), which resolves the peak of D, the square
//! roots at ends of ranges, and corners of masking, wherever they are, so long as they are at the ends of panels.

use super::broad::double_exponential;
use glam::DVec3;
use std::f64::consts::PI;

/// A facet normal with its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facet {
    /// The normal.
    pub wm: DVec3,
    /// `wo . wm`.
    pub cos: f64,
    /// Which panel in c it belongs to.
    pub panel: usize,
    /// Weight in solid angle, sr; it counts the mirror image in the plane of incidence as well.
    pub weight: f64,
}

/// One value of c.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// `wo . wm`.
    pub c: f64,
    /// `sqrt(1 - c^2)`.
    pub sin: f64,
    /// Cosine of the view.
    pub mu: f64,
    /// Sine of the view.
    pub s: f64,
}

impl Row {
    /// Largest azimuth with `wm.z > 0`.
    #[must_use]
    pub fn horizon(&self) -> f64 {
        let product = self.c * self.mu;
        let square = (self.s - self.c) * (self.s + self.c);
        if square > 0.0 && product < self.sin * self.s { libm::atan2(square.sqrt(), -product) } else { PI }
    }

    /// The facet normal at an azimuth; `tilt` is the sine of its angle from the macronormal at `psi = 0`, so that slopes
    /// of normals near the macronormal are not differences.
    #[must_use]
    pub fn normal(&self, tilt: f64, psi: f64) -> DVec3 {
        let half = libm::sin(0.5 * psi);
        let x = tilt + 2.0 * self.sin * self.mu * half * half;
        let z = self.c * self.mu + self.sin * self.s * (1.0 - 2.0 * half * half);
        DVec3::new(x, self.sin * libm::sin(psi), z)
    }

    /// The azimuth at which `wm.z` has a value; 0 and pi if it is out of reach.
    #[must_use]
    pub fn azimuth_of_height(&self, z: f64) -> f64 {
        let scale = self.sin * self.s;
        let cosine = z - self.c * self.mu;
        if cosine >= scale {
            0.0
        } else if cosine <= -scale {
            PI
        } else {
            libm::atan2(((scale - cosine) * (scale + cosine)).sqrt(), cosine)
        }
    }
}

/// Calls `visit` with facets. `breaks` are the ends of the panels in c, in increasing order; `range` gives the azimuths of a
/// row.
pub fn visit(
    mu: f64,
    breaks: &[f64],
    level: f64,
    range: &dyn Fn(&Row) -> (f64, f64),
    visit: &mut dyn FnMut(&Facet),
) {
    let s = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
    for (panel, pair) in breaks.windows(2).enumerate() {
        let (lo, hi) = (pair[0], pair[1]);
        if hi - lo <= 0.0 {
            continue;
        }
        double_exponential(level, |t, rest, weight| {
            let c = lo + (hi - lo) * t;
            // distances to the view and to c = 1, exact where a panel ends there
            let to_view = if (lo - mu).abs() <= 0.0 {
                (hi - lo) * t
            } else if (hi - mu).abs() <= 0.0 {
                -(hi - lo) * rest
            } else {
                c - mu
            };
            let to_one = (1.0 - hi) + (hi - lo) * rest;
            let row = Row { c, sin: (to_one * (1.0 + c)).sqrt(), mu, s };
            let (from, to) = range(&row);
            if to > from {
                azimuths(&row, to_view, [from, to], level, ((hi - lo) * weight, panel), visit);
            }
        });
    }
}

/// The facets of one row, both signs of the azimuth counted by the weight.
fn azimuths(
    row: &Row,
    to_view: f64,
    [from, to]: [f64; 2],
    level: f64,
    (width, panel): (f64, usize),
    visit: &mut dyn FnMut(&Facet),
) {
    let Row { c, sin, mu, s } = *row;
    let sum = c * s + sin * mu;
    // c s - sin mu, the sine of the angle between wm and the macronormal at psi = 0
    let tilt = if sum > 0.0 { to_view * (c + mu) / sum } else { 0.0 };
    double_exponential(level, |t, _, weight| {
        let wm = row.normal(tilt, from + (to - from) * t);
        visit(&Facet { wm, cos: c, panel, weight: 2.0 * (to - from) * weight * width });
    });
}
