//! GGX: the kernel over batches of nodes, and the one-dimensional reduction of its white albedo.

use super::{Distribution, Ggx, Masking, default_dv_nodes, four, reduction};
use crate::integrate::{BATCH, Estimate, Nodes};
use std::f64::consts::PI;

impl Distribution for Ggx {
    fn widths(&self) -> [f64; 2] {
        [self.alpha_x(), self.alpha_y()]
    }

    /// A plain loop over slices with + - * / sqrt only, so that the compiler can vectorise it without changing a bit.
    ///
    /// D = a^2 / (pi (a^2 cos^2 + sin^2)^2), and V without a division by a small cosine:
    /// correlated 1 / (2 (mu_o s_i + mu_i s_o)), separable 1 / ((mu_i + s_i)(mu_o + s_o)),
    /// with s = sqrt(mu^2 + a^2 (1 - mu^2)). Two widths go through the terms node by node.
    fn dv_nodes(&self, nodes: &Nodes, masking: Masking, out: &mut [f64; BATCH]) {
        if self.alpha().is_none() {
            default_dv_nodes(self, nodes, masking, out);
            return;
        }
        let n = nodes.len;
        let a2 = self.alpha_x() * self.alpha_x();
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

    fn four(&self, masking: Masking, [f0, f90]: [f64; 2]) -> Option<four::Facets> {
        Some(four::Facets { alpha: self.alpha()?, masking, f0, f90 })
    }

    fn reduced_albedo(&self, mu_o: f64, masking: Masking, tolerance: f64) -> Option<Estimate> {
        reduction::white_ggx(mu_o, self.alpha()?, masking, tolerance)
    }
}

#[inline]
fn smith_root(mu: f64, a2: f64) -> f64 {
    (mu * mu + a2 * ((1.0 - mu) * (1.0 + mu))).sqrt()
}
