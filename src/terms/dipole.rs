//! The dipole approximation of diffusion below a plane surface: marble, milk, skin.
//!
//! A point source inside the medium and its mirror image outside: how much of a thin beam leaves at distance r.

use std::f64::consts::PI;

/// A homogeneous medium below a smooth interface.
///
/// Units: any one length, sigmas its inverse. Domain: `sigma_a` ≥ 0, `sigma_s` (reduced, (1 − g) σs) > 0, eta in [1, 3].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dipole {
    /// Absorption coefficient.
    pub sigma_a: f64,
    /// Reduced scattering coefficient σs'.
    pub sigma_s: f64,
    /// Relative index of refraction of the medium.
    pub eta: f64,
}

/// Internal diffuse reflectance, `F_dr = −1.440/eta² + 0.710/eta + 0.668 + 0.0636 eta`.
///
/// Source: [Jensen2001](crate::cite::JENSEN_2001) §2.1, a fit to measurements that predates graphics.
/// Approximates [`dielectric_average`](super::fresnel::dielectric_average)(1/eta): below 0.1 % near 1.3, 3.5 % at 1.01.
/// Domain: eta ≥ 1. Range: about [0, 0.8].
#[must_use]
pub fn internal_reflectance(eta: f64) -> f64 {
    -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta
}

impl Dipole {
    /// Reduced extinction σt' = σa + σs'.
    fn sigma_t(&self) -> f64 {
        self.sigma_a + self.sigma_s
    }

    /// `A = (1 + Fdr)/(1 − Fdr)`: how far the boundary pushes the image away.
    fn boundary(&self) -> f64 {
        let f = internal_reflectance(self.eta);
        (1.0 + f) / (1.0 - f)
    }

    /// Diffuse reflectance at distance `r`, `R_d = α'/(4π) Σ z (1 + σtr d) exp(−σtr d)/d³`.
    ///
    /// z_r = 1/σt', z_v = z_r (1 + 4A/3), d = √(r² + z²), σtr = √(3 σa σt'), α' = σs'/σt'.
    /// Source: [Jensen and Buhler 2002](crate::cite::JENSEN_2002) for both terms. The second term of
    /// [Jensen2001](crate::cite::JENSEN_2001) Eq. 4 as printed has the wrong dimension.
    /// Units: 1/length². Domain: r ≥ 0. Range: > 0, finite. Accuracy: relative 1e-14 (`tests/terms.rs`).
    #[must_use]
    pub fn reflectance(&self, r: f64) -> f64 {
        let sigma_t = self.sigma_t();
        let sigma_tr = (3.0 * self.sigma_a * sigma_t).sqrt();
        let real = 1.0 / sigma_t;
        let image = real * (1.0 + 4.0 / 3.0 * self.boundary());
        let term = |z: f64| {
            let d = libm::hypot(r, z);
            z * (1.0 + sigma_tr * d) * libm::exp(-sigma_tr * d) / (d * d * d)
        };
        self.sigma_s / sigma_t / (4.0 * PI) * (term(real) + term(image))
    }

    /// Total diffuse reflectance `2π ∫ R_d r dr = (α'/2)(1 + exp(−4As/3)) exp(−s)`, `s = √(3 (1 − α'))`.
    ///
    /// Source: [Jensen and Buhler 2002](crate::cite::JENSEN_2002) ; checked against the integral.
    /// Range: (0, 1]; `sigma_a` = 0 gives 1 for every eta. Accuracy: relative 1e-14 (`tests/terms.rs`).
    #[must_use]
    pub fn total(&self) -> f64 {
        let sigma_t = self.sigma_t();
        let s = (3.0 * self.sigma_a / sigma_t).sqrt();
        let image = libm::exp(-4.0 / 3.0 * self.boundary() * s);
        0.5 * self.sigma_s / sigma_t * (1.0 + image) * libm::exp(-s)
    }
}
