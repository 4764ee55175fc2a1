//! Facet normals in polar coordinates round the view direction: `c = wo . wm` and the azimuth `psi` from the macronormal.
//!
//! Heights of `wm` at which masking has a kink are azimuths of it. With `wo = (s, 0, mu)`, `e = (-mu, 0, s)` and `wm = c wo + s_c (cos psi e + sin psi y)`:
//!
//! ```text
//! dwm = dc dpsi,  wm.z = c mu + s_c s cos psi,  wm.x = (c^2 - mu^2) / (c s + s_c mu) + 2 s_c mu sin^2(psi / 2)
//! ```
//! so that the slopes of normals near the macronormal, at c = mu and psi = 0, are not differences.

use glam::DVec3;
use std::f64::consts::PI;

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
