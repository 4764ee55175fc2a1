//! The cosine lobe round a direction that is linear in wo: Phong's, and Lafortune's generalisation.

use super::{Over, cosine_pdf, cosine_sample};
use crate::integrate::{Chart, View};
use crate::math::{frame, special};
use crate::models::{Brdf, Sample};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// `scale max(0, cx x_i x_o + cy y_i y_o + cz mu_i mu_o)^n`.
///
/// With v = C wo the lobe is `|v|^n cos^n a` round v, a the angle between v and wi. Guard: a base <= 0 gives 0 for every
/// n, also n = 0, which is the limit of n -> 0. Accuracy: sin^2 a is taken from the cross product and the power from
/// log1p, so that n = 1e7 loses no digits; for |c| = (1, 1, 1) the factor |v|^n is exactly 1.
#[derive(Debug)]
pub struct Cosine {
    /// Diagonal of C; (-1, -1, 1) is the mirror direction.
    pub c: [f64; 3],
    /// Exponent.
    pub n: f64,
    /// Factor.
    pub scale: f64,
    /// What the lobe is divided by.
    pub over: Over,
}

impl Cosine {
    /// Phong's lobe round the mirror direction.
    #[must_use]
    pub fn phong(n: f64, scale: f64, over: Over) -> Cosine {
        Cosine { c: [-1.0, -1.0, 1.0], n, scale, over }
    }

    fn centre(&self, wo: DVec3) -> DVec3 {
        DVec3::new(self.c[0] * wo.x, self.c[1] * wo.y, self.c[2] * wo.z)
    }

    /// `ln |v|`, by the deviation of C from a reflection.
    fn log_length(&self, wo: DVec3, v: DVec3) -> f64 {
        let excess = |c: f64, w: f64| (c - 1.0) * (c + 1.0) * w * w;
        let e = [excess(self.c[0].abs(), wo.x), excess(self.c[1].abs(), wo.y), excess(self.c[2].abs(), wo.z)];
        let sum = e[0] + e[1] + e[2];
        if sum.abs() < 0.5 { 0.5 * libm::log1p(sum) } else { libm::log(v.length()) }
    }

    /// What rounding of `ln |v|` comes to, by the terms that it is made of.
    fn rounding_of_length(&self, wo: DVec3) -> f64 {
        let terms = (self.c.map(f64::abs), wo.to_array());
        let square = |c: f64, w: f64| c * c * w * w;
        let moved = |c: f64, w: f64| ((c - 1.0) * (c + 1.0) * w * w).abs();
        let sum = |f: &dyn Fn(f64, f64) -> f64| (0..3).map(|k| f(terms.0[k], terms.1[k])).sum::<f64>();
        let v2 = sum(&square);
        if v2 > 0.0 { f64::EPSILON * (2.0 * sum(&moved) / v2 + libm::log(v2).abs()) } else { 0.0 }
    }

    /// `ln cos a`, or none where the lobe is 0.
    fn log_cos(v: DVec3, wi: DVec3) -> Option<f64> {
        let (length, dot) = (v.length(), v.dot(wi));
        if !(dot > 0.0 && length > 0.0) {
            return None;
        }
        let sin2 = v.cross(wi).length_squared() / (length * length);
        Some(if sin2 < 0.5 { 0.5 * libm::log1p(-sin2) } else { libm::log((dot / length).min(1.0)) })
    }
}

impl Brdf for Cosine {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if !frame::both_above(wo, wi) {
            return 0.0;
        }
        let v = self.centre(wo);
        let Some(log) = Self::log_cos(v, wi) else { return 0.0 };
        let value = self.scale * libm::exp(self.n * (log + self.log_length(wo, v)));
        match self.over {
            Over::Nothing => value,
            Over::Cosine => value / wi.z,
        }
    }

    /// A power of the cosine round v: `cos a = u1^(1/(n+1))`, azimuth 2 pi u2.
    ///
    /// Source: [Lafortune and Willems 1994](crate::cite::LAFORTUNE_WILLEMS_1994). Where v = 0, by the cosine.
    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let v = self.centre(wo);
        let length = v.length();
        if length <= 0.0 {
            return cosine_sample(u);
        }
        let log_cos = libm::log(u.x.clamp(f64::MIN_POSITIVE, 1.0)) / (self.n + 1.0);
        let sin = (-libm::expm1(2.0 * log_cos)).max(0.0).sqrt();
        let (cos_psi, sin_psi) = special::circle(u.y);
        let axis = v / length;
        let (a, b) = axis.any_orthonormal_pair();
        let wi = libm::exp(log_cos) * axis + sin * (cos_psi * a + sin_psi * b);
        (wi.z > 0.0).then(|| Sample { wi, pdf: self.pdf(wo, wi) })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        let v = self.centre(wo);
        if v.length() <= 0.0 {
            return cosine_pdf(wo, wi);
        }
        match Self::log_cos(v, wi) {
            Some(log) if frame::both_above(wo, wi) => (self.n + 1.0) / TAU * libm::exp(self.n * log),
            _ => 0.0,
        }
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Lobe { c: self.c, exponent: self.n })
    }

    /// The power magnifies the rounding of its base, and an angle of the width of the lobe is known to that of a unit vector.
    fn rounding(&self, view: View) -> f64 {
        self.n * self.rounding_of_length(view.direction()) + 2.0 * f64::EPSILON * self.n.sqrt()
    }

    fn turns(&self) -> bool {
        (self.c[0] - self.c[1]).abs() > 0.0
    }
}
