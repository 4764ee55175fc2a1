//! Blinn's lobe: a power of the cosine between the half vector and the normal.

use super::Over;
use crate::integrate::{BATCH, Chart, Nodes};
use crate::math::{frame, special};
use crate::models::{Brdf, Sample};
use crate::terms::blinn_phong;
use glam::{DVec2, DVec3};

/// `-ln` of the part of its peak below which the lobe is left out of integrals.
const END: f64 = 42.0;

/// `scale (n . wh)^n`.
#[derive(Debug)]
pub struct Blinn {
    /// Exponent.
    pub n: f64,
    /// Factor.
    pub scale: f64,
    /// What the lobe is divided by.
    pub over: Over,
}

impl Brdf for Blinn {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        let Some(h) = frame::half_vector(wo, wi).filter(|_| frame::both_above(wo, wi)) else { return 0.0 };
        let value = self.scale * special::cos_pow(h.wh.z, frame::sin2_theta(h.wh), self.n);
        match self.over {
            Over::Nothing => value,
            Over::Cosine => value / wi.z,
        }
    }

    /// The half vector with density `(n + 2)/(2 pi) cos^(n+1)`, mirrored.
    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let wi = frame::reflect(wo, blinn_phong::sample_d(self.n, u));
        (wi.z > 0.0).then(|| Sample { wi, pdf: self.pdf(wo, wi) })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        match frame::half_vector(wo, wi) {
            Some(h) if frame::both_above(wo, wi) => blinn_phong::d(self.n, h.wh) * h.wh.z / (4.0 * h.cos_d),
            _ => 0.0,
        }
    }

    /// Graded on the width of the Beckmann lobe of equal peak; `cos^n = exp(-42)` where `tan^2 = exp(84/n) - 1`.
    fn chart(&self) -> Option<Chart> {
        let alpha = blinn_phong::equivalent_alpha(self.n);
        let end = if self.n > 1.0 { libm::expm1(2.0 * END / self.n).sqrt() } else { f64::INFINITY };
        Some(Chart::HalfVector {
            alpha,
            reach: end / alpha,
            kinks: false,
            slope: f64::INFINITY,
            layer: 3.0 * alpha,
        })
    }

    fn eval_nodes(&self, nodes: &Nodes, out: &mut [f64; BATCH]) {
        for (i, o) in out[..nodes.len].iter_mut().enumerate() {
            let sin = nodes.sin_h[i];
            let value = self.scale * special::cos_pow(nodes.cos_h[i], sin * sin, self.n);
            *o = match self.over {
                Over::Nothing => value,
                Over::Cosine => value / nodes.mu_i[i],
            };
        }
    }
}
