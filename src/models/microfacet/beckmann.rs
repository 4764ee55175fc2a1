//! Beckmann normals with Smith masking (the exact erf form, not the rational fit).

use super::Distribution;
use crate::terms::beckmann;
use glam::{DVec2, DVec3};

/// Beckmann with widths along both tangents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beckmann {
    alpha: [f64; 2],
}

impl Beckmann {
    /// From both widths.
    #[must_use]
    pub fn new(alpha: [f64; 2]) -> Beckmann {
        Beckmann { alpha }
    }
}

impl Distribution for Beckmann {
    fn d(&self, wm: DVec3) -> f64 {
        beckmann::d(wm, self.alpha[0], self.alpha[1])
    }

    fn lambda(&self, w: DVec3) -> f64 {
        beckmann::lambda(w, self.alpha[0], self.alpha[1])
    }

    /// Draws from `D cos`: visible Beckmann normals have no closed inverse.
    fn sample(&self, _wo: DVec3, u: DVec2) -> DVec3 {
        beckmann::sample_d(self.alpha[0], self.alpha[1], u)
    }

    fn pdf(&self, _wo: DVec3, wm: DVec3) -> f64 {
        self.d(wm) * wm.z.max(0.0)
    }

    fn alpha(&self) -> Option<f64> {
        let [x, y] = self.alpha;
        ((x - y).abs() == 0.0).then_some(x)
    }
}
