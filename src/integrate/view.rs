//! Where a surface is seen from.

use glam::DVec3;

/// A view direction: cosine to the normal and azimuth from the tangent.
///
/// A plain number is a view in the plane of the tangent, which is all that an isotropic model needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Cosine to the normal, in [0, 1].
    pub mu: f64,
    /// Azimuth from the tangent, rad.
    pub phi: f64,
}

impl View {
    /// Sine to the normal.
    #[must_use]
    pub fn sine(&self) -> f64 {
        ((1.0 - self.mu) * (1.0 + self.mu)).max(0.0).sqrt()
    }

    /// Cosine and sine of the azimuth; exact at azimuth 0.
    #[must_use]
    pub fn azimuth(&self) -> [f64; 2] {
        let (sin, cos) = libm::sincos(self.phi);
        [cos, sin]
    }

    /// The unit direction.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        let (s, [cos, sin]) = (self.sine(), self.azimuth());
        DVec3::new(s * cos, s * sin, self.mu)
    }

    /// The same cosine at azimuth 0.
    #[must_use]
    pub fn in_plane(&self) -> View {
        View::from(self.mu)
    }
}

impl From<f64> for View {
    fn from(mu: f64) -> View {
        View { mu, phi: 0.0 }
    }
}
