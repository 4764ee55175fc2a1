//! Filtering of normal maps: how far apart normals turn into roughness when seen from far away.

use std::f64::consts::PI;

/// Toksvig's exponent of the shrunk normal, `s' = s |N|/(|N| + s (1 − |N|))`.
///
/// `mean_length` is |N|, the length of the averaged unit normals. The factor of energy is (1 + s')/(1 + s).
/// Source: [Toksvig2005](crate::cite::TOKSVIG_2005). Domain: s ≥ 0 (a Blinn-Phong exponent), |N| in [0, 1]. Range: [0, s].
/// Guard: |N| = 0 gives 0. Accuracy: 4 ulp given 1 − |N| (`tests/terms.rs`); |N| close to 1 with s > 1e5 needs that
/// difference from second moments.
#[must_use]
pub fn toksvig(power: f64, mean_length: f64) -> f64 {
    let sum = mean_length + power * (1.0 - mean_length);
    if sum > 0.0 { power * mean_length / sum } else { 0.0 }
}

/// Width widened by the variance of the normals inside a pixel, `α'² = min(1, α² + min(2 σ² d², κ))`.
///
/// `d2` is |∂n/∂x|² + |∂n/∂y|² in screen space; σ² = 0.25 and κ = 0.18 are usual. The 2 turns a variance of slopes into α².
/// Source: [Tokuyoshi and Kaplanyan 2019](crate::cite::TOKUYOSHI_KAPLANYAN_2019) isotropic, as [Filament](crate::cite::FILAMENT_SHADERS) `normalFiltering` has it.
/// Domain: alpha in [0, 1], the rest ≥ 0. Range: [alpha, 1]. Accuracy: 2 ulp (`tests/terms.rs`).
#[must_use]
pub fn tokuyoshi_kaplanyan(alpha: f64, d2: f64, sigma2: f64, kappa: f64) -> f64 {
    (alpha * alpha + (2.0 * sigma2 * d2).min(kappa)).min(1.0).sqrt()
}

/// Filtered moments of the slopes of a normal map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lean {
    /// Mean slope.
    pub mean: [f64; 2],
    /// Second moments xx, xy, yy.
    pub moments: [f64; 3],
    /// Exponent of the base roughness; its slopes have the variance 1/s.
    pub power: f64,
}

impl Lean {
    /// Covariance xx, xy, yy: moments less the mean's, plus 1/s; its diagonal and determinant are kept ≥ 0.
    ///
    /// Source: [Olano and Baker 2010](crate::cite::OLANO_BAKER_2010) (the covariance of the filtered map). The difference cancels for steep
    /// means; a map stored in half floats leaves noise there, hence the guard.
    #[must_use]
    pub fn covariance(&self) -> [f64; 3] {
        let base = 1.0 / self.power;
        let xx = (self.moments[0] - self.mean[0] * self.mean[0]).max(0.0) + base;
        let yy = (self.moments[2] - self.mean[1] * self.mean[1]).max(0.0) + base;
        let limit = (xx * yy).sqrt();
        let xy = (self.moments[1] - self.mean[0] * self.mean[1]).clamp(-limit, limit);
        [xx, xy, yy]
    }

    /// Density of slopes, `exp(−(h − B)ᵀ Σ⁻¹ (h − B)/2)/(2π √|Σ|)`.
    ///
    /// `slope` is wh.xy/wh.z. Beckmann's D is this over `wh.z`⁴, with α² = 2/s.
    /// Source: [Olano and Baker 2010](crate::cite::OLANO_BAKER_2010) (the Gaussian of slopes). Unit 1. Range: ≥ 0, finite.
    /// Guard: a singular Σ (only for s = ∞) gives 0. Accuracy: relative 1e-13 (`tests/terms.rs`).
    #[must_use]
    pub fn slope_density(&self, slope: [f64; 2]) -> f64 {
        let [xx, xy, yy] = self.covariance();
        let determinant = xx * yy - xy * xy;
        if determinant <= 0.0 {
            return 0.0;
        }
        let (x, y) = (slope[0] - self.mean[0], slope[1] - self.mean[1]);
        let exponent = (yy * x * x - 2.0 * xy * x * y + xx * y * y) / determinant;
        libm::exp(-0.5 * exponent) / (2.0 * PI * determinant.sqrt())
    }
}
