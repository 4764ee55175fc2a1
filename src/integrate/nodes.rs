//! A batch of nodes, structure of arrays, so that an integrand is a plain loop over slices.

use super::view::View;
use glam::DVec3;

/// Most nodes in one batch.
pub const BATCH: usize = 128;

/// Most panels of a chart; errors are estimated panel by panel, so that they cannot cancel unseen.
pub const MAX_PANELS: usize = 48;

/// Height at which a view in the horizon is evaluated: no f64 sum can tell it from 0.
const JUST_ABOVE: f64 = 1e-150;

/// A batch of incident directions with their weights.
///
/// Directions are in the tangent frame. Charts of isotropic models put `wo` at azimuth 0, cover by mirror symmetry the
/// azimuths in (0, pi) only, and carry the factor 2 in the weight.
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
    /// Cosine and sine of the azimuth of the view direction.
    pub azimuth_o: [f64; 2],
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
    /// Sine of the azimuth of the half vector.
    pub sin_phi: [f64; BATCH],
}

impl Nodes {
    /// An empty batch for a view.
    #[must_use]
    pub fn new(view: View) -> Nodes {
        let zero = [0.0; BATCH];
        Nodes {
            len: 0,
            panel: 0,
            mu_o: view.mu,
            sin_o: view.sine(),
            azimuth_o: view.azimuth(),
            weight: zero,
            mu_i: zero,
            cos_d: zero,
            cos_h: zero,
            sin_h: zero,
            cos_phi: zero,
            sin_phi: zero,
        }
    }

    /// Makes this an empty batch for another view; the arrays are overwritten as they are filled.
    pub fn reset(&mut self, view: View) {
        self.len = 0;
        self.panel = 0;
        self.mu_o = view.mu;
        self.sin_o = view.sine();
        self.azimuth_o = view.azimuth();
    }

    /// The view direction.
    #[must_use]
    pub fn wo(&self) -> DVec3 {
        DVec3::new(self.sin_o * self.azimuth_o[0], self.sin_o * self.azimuth_o[1], self.mu_o)
    }

    /// The view direction, lifted by 1e-150 if it lies in the horizon.
    ///
    /// A value there is 0 by convention; an integral wants the limit for grazing views instead.
    #[must_use]
    pub fn wo_above(&self) -> DVec3 {
        let wo = self.wo();
        DVec3::new(wo.x, wo.y, wo.z.max(JUST_ABOVE))
    }

    /// The half vector of node `i`.
    #[must_use]
    pub fn wh(&self, i: usize) -> DVec3 {
        let s = self.sin_h[i];
        DVec3::new(s * self.cos_phi[i], s * self.sin_phi[i], self.cos_h[i])
    }

    /// The incident direction of node `i`; its z is exactly `mu_i`.
    #[must_use]
    pub fn wi(&self, i: usize) -> DVec3 {
        let wi = 2.0 * self.cos_d[i] * self.wh(i) - self.wo();
        DVec3::new(wi.x, wi.y, self.mu_i[i])
    }

    /// Sets node `i` from an incident direction on or above the horizon and its weight.
    pub fn set(&mut self, i: usize, wi: DVec3, weight: f64) {
        let h = self.wo() + wi;
        let flat = (h.x * h.x + h.y * h.y).sqrt();
        let length = (flat * flat + h.z * h.z).sqrt();
        self.weight[i] = weight;
        self.mu_i[i] = wi.z;
        self.cos_d[i] = 0.5 * length;
        // opposite directions in the horizon have no half vector; any one will do, since cos_d = 0
        (self.cos_h[i], self.sin_h[i]) =
            if length > 0.0 { (h.z / length, flat / length) } else { (1.0, 0.0) };
        (self.cos_phi[i], self.sin_phi[i]) = if flat > 0.0 { (h.x / flat, h.y / flat) } else { (1.0, 0.0) };
    }
}
