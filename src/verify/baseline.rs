//! The estimators that others ship, as yardsticks for benchmarks and reports. No baked value comes from here.
//!
//! [`hammersley_f32`] is the split-sum loop found in most bakers and engines: N Hammersley points, D-sampling, f32,
//! height-correlated Smith; [`hammersley_f64`] is the same in f64, which shows how little of its error is rounding.

use crate::integrate::hammersley::radical_inverse;
use std::f32::consts::TAU;

/// Scale and bias by N Hammersley points in f32, as other bakers compute them; sine and cosine are those of libm, which are the same
/// on every machine.
#[must_use]
#[allow(clippy::cast_possible_truncation, reason = "the originals compute in f32")]
pub fn hammersley_f32(mu_o: f32, alpha: f32, samples: u32) -> [f32; 2] {
    let view = [(1.0 - mu_o * mu_o).sqrt(), 0.0, mu_o];
    let a2 = alpha * alpha;
    let (mut scale, mut bias) = (0.0f32, 0.0f32);
    for i in 0..samples {
        let (u, v) = (i as f32 / samples as f32, radical_inverse(i) as f32);
        let cos = ((1.0 - v) / (1.0 + (a2 - 1.0) * v)).sqrt();
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let h = [sin * libm::cosf(TAU * u), sin * libm::sinf(TAU * u), cos];
        let voh = (view[0] * h[0] + view[2] * h[2]).max(0.0);
        let mu_i = 2.0 * voh * h[2] - view[2];
        if mu_i > 0.0 {
            let vis = 0.5
                / (mu_i * (mu_o * mu_o * (1.0 - a2) + a2).sqrt()
                    + mu_o * (mu_i * mu_i * (1.0 - a2) + a2).sqrt());
            let weight = 4.0 * vis * mu_i * voh / h[2];
            let m = 1.0 - voh;
            let fc = (m * m) * (m * m) * m;
            scale += (1.0 - fc) * weight;
            bias += fc * weight;
        }
    }
    [scale / samples as f32, bias / samples as f32]
}

/// The same estimator in f64.
#[must_use]
pub fn hammersley_f64(mu_o: f64, alpha: f64, samples: u32) -> [f64; 2] {
    let sin_o = ((1.0 - mu_o) * (1.0 + mu_o)).max(0.0).sqrt();
    let a2 = alpha * alpha;
    let root = |mu: f64| (mu * mu * (1.0 - a2) + a2).sqrt();
    let (mut scale, mut bias) = (0.0, 0.0);
    for i in 0..samples {
        let (u, v) = (f64::from(i) / f64::from(samples), radical_inverse(i));
        let cos = ((1.0 - v) / (1.0 + (a2 - 1.0) * v)).sqrt();
        let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
        let voh = (sin_o * sin * libm::cos(std::f64::consts::TAU * u) + mu_o * cos).max(0.0);
        let mu_i = 2.0 * voh * cos - mu_o;
        if mu_i > 0.0 {
            let weight = 2.0 * mu_i * voh / (cos * (mu_i * root(mu_o) + mu_o * root(mu_i)));
            let m = 1.0 - voh;
            let fc = (m * m) * (m * m) * m;
            scale += (1.0 - fc) * weight;
            bias += fc * weight;
        }
    }
    [scale / f64::from(samples), bias / f64::from(samples)]
}
