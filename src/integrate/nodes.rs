//! A batch of nodes, structure of arrays, so that an integrand is a plain loop over slices.

use glam::DVec3;

/// Most nodes in one batch.
pub const BATCH: usize = 128;

/// Most panels of a chart; errors are estimated panel by panel, so that they cannot cancel unseen.
pub const MAX_PANELS: usize = 8;

/// A batch of incident directions with their weights.
///
/// All directions are in the frame of the chart: `wo = (sin_o, 0, mu_o)`. By mirror symmetry charts of isotropic
/// models cover `phi` in (0, pi) and carry the factor 2 in the weight.
#[derive(Debug, Clone)]
pub struct Nodes {
    /// Number of nodes in use.
    pub len: usize,
    /// Which panel of the chart the batch belongs to, below [`MAX_PANELS`].
    pub panel: usize,
    /// Cosine of the view direction.
    pub mu_o: f64,
    /// Sine of the view direction.
    pub sin_o: f64,
    /// Weight in solid angle of `wi`, sr.
    pub weight: [f64; BATCH],
    /// Cosine of the incident direction.
    pub mu_i: [f64; BATCH],
    /// `wo . wh = wi . wh`.
    pub cos_d: [f64; BATCH],
    /// Cosine of the half vector.
    pub cos_h: [f64; BATCH],
    /// Sine of the half vector.
    pub sin_h: [f64; BATCH],
    /// Cosine of the azimuth of the half vector.
    pub cos_phi: [f64; BATCH],
}

impl Nodes {
    /// An empty batch for a view cosine.
    #[must_use]
    pub fn new(mu_o: f64) -> Nodes {
        let sin_o = ((1.0 - mu_o) * (1.0 + mu_o)).max(0.0).sqrt();
        let zero = [0.0; BATCH];
        Nodes {
            len: 0,
            panel: 0,
            mu_o,
            sin_o,
            weight: zero,
            mu_i: zero,
            cos_d: zero,
            cos_h: zero,
            sin_h: zero,
            cos_phi: zero,
        }
    }

    /// Makes this an empty batch for another view cosine; the arrays are overwritten as they are filled.
    pub fn reset(&mut self, mu_o: f64) {
        self.len = 0;
        self.panel = 0;
        self.mu_o = mu_o;
        self.sin_o = ((1.0 - mu_o) * (1.0 + mu_o)).max(0.0).sqrt();
    }

    /// The view direction.
    #[must_use]
    pub fn wo(&self) -> DVec3 {
        DVec3::new(self.sin_o, 0.0, self.mu_o)
    }

    /// The half vector of node `i`.
    #[must_use]
    pub fn wh(&self, i: usize) -> DVec3 {
        let (c, s) = (self.cos_phi[i], self.sin_h[i]);
        DVec3::new(s * c, s * ((1.0 - c) * (1.0 + c)).max(0.0).sqrt(), self.cos_h[i])
    }

    /// The incident direction of node `i`; its z is exactly `mu_i`.
    #[must_use]
    pub fn wi(&self, i: usize) -> DVec3 {
        let wi = 2.0 * self.cos_d[i] * self.wh(i) - self.wo();
        DVec3::new(wi.x, wi.y, self.mu_i[i])
    }
}
