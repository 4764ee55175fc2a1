//! GGX normals with Smith masking.

use super::{Distribution, Masking, reduction};
use crate::integrate::{BATCH, Estimate, Nodes};
use crate::terms::ggx;
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// GGX (Trowbridge-Reitz) with widths along both tangents.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ggx {
    alpha: [f64; 2],
}

impl Ggx {
    /// From both widths.
    #[must_use]
    pub fn new(alpha: [f64; 2]) -> Ggx {
        Ggx { alpha }
    }
}

impl Distribution for Ggx {
    fn d(&self, wm: DVec3) -> f64 {
        ggx::d(wm, self.alpha[0], self.alpha[1])
    }

    fn lambda(&self, w: DVec3) -> f64 {
        ggx::lambda(w, self.alpha[0], self.alpha[1])
    }

    fn visibility(&self, wo: DVec3, wi: DVec3, masking: Masking) -> f64 {
        let [x, y] = self.alpha;
        match masking {
            Masking::Correlated => ggx::visibility_correlated(wo, wi, x, y),
            Masking::Separable => ggx::visibility_separable(wo, wi, x, y),
        }
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> DVec3 {
        ggx::sample_visible(wo, self.alpha[0], self.alpha[1], u)
    }

    fn pdf(&self, wo: DVec3, wm: DVec3) -> f64 {
        ggx::visible_density(wo, wm, self.alpha[0], self.alpha[1])
    }

    fn alpha(&self) -> Option<f64> {
        let [x, y] = self.alpha;
        ((x - y).abs() == 0.0).then_some(x)
    }

    /// A plain loop over slices with + - * / sqrt only, so that the compiler can vectorise it without changing a bit.
    ///
    /// D = a^2 / (pi (a^2 cos^2 + sin^2)^2), and V without a division by a small cosine:
    /// correlated 1 / (2 (mu_o s_i + mu_i s_o)), separable 1 / ((mu_i + s_i)(mu_o + s_o)),
    /// with s = sqrt(mu^2 + a^2 (1 - mu^2)).
    fn dv_nodes(&self, nodes: &Nodes, masking: Masking, out: &mut [f64; BATCH]) {
        let n = nodes.len;
        let a2 = self.alpha[0] * self.alpha[0];
        let mu_o = nodes.mu_o;
        let s_o = smith_root(mu_o, a2);
        let scale = a2 / PI;
        let (cos, sin, mu_i) = (&nodes.cos_h[..n], &nodes.sin_h[..n], &nodes.mu_i[..n]);
        let out = &mut out[..n];
        match masking {
            Masking::Correlated => {
                for i in 0..n {
                    let q = a2 * (cos[i] * cos[i]) + sin[i] * sin[i];
                    let v = 2.0 * (mu_o * smith_root(mu_i[i], a2) + mu_i[i] * s_o);
                    out[i] = scale / (q * q * v);
                }
            }
            Masking::Separable => {
                for i in 0..n {
                    let q = a2 * (cos[i] * cos[i]) + sin[i] * sin[i];
                    let v = (mu_i[i] + smith_root(mu_i[i], a2)) * (mu_o + s_o);
                    out[i] = scale / (q * q * v);
                }
            }
        }
    }

    fn reduced_albedo(&self, mu_o: f64, masking: Masking, tolerance: f64) -> Option<Estimate> {
        reduction::white_ggx(mu_o, self.alpha()?, masking, tolerance)
    }
}

#[inline]
fn smith_root(mu: f64, a2: f64) -> f64 {
    (mu * mu + a2 * ((1.0 - mu) * (1.0 + mu))).sqrt()
}
