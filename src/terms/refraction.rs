//! Refraction by facets: the half vector of two directions on opposite sides, its Jacobian, and masking across the surface.

use super::smith::Ndf;
use crate::math::frame;
use glam::DVec3;

/// How masking of the two sides is combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Across {
    /// `G1(wo) G1(wi)`.
    Separable,
    /// `B(1 + Λ_o, 1 + Λ_i)`, B Euler's beta: heights of the two sides are opposite.
    Beta,
    /// `1/(1 + Λ_o + Λ_i)`, the form of reflection.
    Sum,
}

/// The facet that refracts one direction into the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refracting {
    /// Its normal, on the upper side.
    pub wm: DVec3,
    /// `wo·wm`.
    pub cos_o: f64,
    /// `wi·wm`, of the other sign.
    pub cos_i: f64,
    /// `n_o²/(n_i wi·wm + n_o wo·wm)²`: with |wo·wm| it is dω_m/dω_o, for radiance.
    pub jacobian: f64,
}

/// The half vector of refraction, `wm ∝ −(n_i wi + n_o wo)` turned upwards; `None` if no facet refracts so.
///
/// `eta` is the index below over that above; `wo`, `wi` lie on opposite sides. A facet must show each direction the face of
/// its own side. n_i wi·wm + n_o wo·wm is taken as the length of the sum, which has no cancellation left.
/// Source: [Walter2007](crate::cite::WALTER_2007) Eqs. 16 and 17. Domain: eta in [1e-3, 1e3], not 1 (there the lobe is a delta).
#[must_use]
pub fn facet(wo: DVec3, wi: DVec3, eta: f64) -> Option<Refracting> {
    if wo.z * wi.z >= 0.0 {
        return None;
    }
    let (n_o, n_i) = if wo.z > 0.0 { (1.0, eta) } else { (eta, 1.0) };
    let sum = n_i * wi + n_o * wo;
    let square = sum.length_squared();
    if square <= 0.0 {
        return None;
    }
    let wm = sum / square.sqrt().copysign(sum.z);
    let (cos_o, cos_i) = (wo.dot(wm), wi.dot(wm));
    let seen = cos_o * wo.z > 0.0 && cos_i * wi.z > 0.0;
    seen.then_some(Refracting { wm, cos_o, cos_i, jacobian: n_o * n_o / square })
}

/// Masking and shadowing of two directions on opposite sides.
///
/// Source: [Walter2007](crate::cite::WALTER_2007) Eq. 23 (product); [Heitz2014](crate::cite::HEITZ_2014) §6.3 and the beta form of
/// [Heitz and others 2016](crate::cite::HEITZ_2016_MULTIPLE) Appendix A. Range: [0, 1]; 0 where a cosine is 0.
#[must_use]
pub fn g2<N: Ndf + ?Sized>(across: Across, ndf: &N, wo: DVec3, wi: DVec3) -> f64 {
    match across {
        Across::Separable => ndf.g2_separable(wo, wi),
        Across::Sum => ndf.g2(wo, wi),
        Across::Beta => beta(ndf.lambda(wo), ndf.lambda(wi)),
    }
}

/// `B(1 + a, 1 + b) = Γ(1 + a) Γ(1 + b)/Γ(2 + a + b)`.
fn beta(a: f64, b: f64) -> f64 {
    let (large, small) = (a.max(b), a.min(b));
    if !large.is_finite() {
        return 0.0;
    }
    libm::exp(libm::lgamma(1.0 + small) - log_rising(1.0 + large, 1.0 + small))
}

/// `ln Γ(x + y) − ln Γ(x)` for x ≥ y ≥ 1, without the difference of large logarithms.
fn log_rising(x: f64, y: f64) -> f64 {
    if x < 20.0 {
        return libm::lgamma(x + y) - libm::lgamma(x);
    }
    // Stirling: (x − 1/2) ln(1 + y/x) + y ln(x + y) − y + r(x + y) − r(x), r = 1/12x − 1/360x³ + 1/1260x⁵
    let r = |x: f64| {
        let i2 = 1.0 / (x * x);
        (1.0 / 12.0 - i2 * (1.0 / 360.0 - i2 * (1.0 / 1260.0 - i2 / 1680.0))) / x
    };
    (x - 0.5) * libm::log1p(y / x) + y * libm::log(x + y) - y + (r(x + y) - r(x))
}

/// `f = |wi·wm| |wo·wm| n_o² T D G2/(|mu_i mu_o| (n_i wi·wm + n_o wo·wm)²)`, T the transmittance of the facet.
///
/// Source: [Walter2007](crate::cite::WALTER_2007) Eq. 21. Radiance, light arriving along `wi`: the n_o² of its side; importance has n_i².
/// Units: sr⁻¹. Range: ≥ 0, finite. Law: f(wo, wi)/n_o² = f(wi, wo)/n_i². 0 if a direction is in the horizon.
/// Accuracy: relative 1e-12 (`tests/functions.rs`).
#[must_use]
pub fn value<N: Ndf + ?Sized>(ndf: &N, across: Across, eta: f64, wo: DVec3, wi: DVec3) -> f64 {
    let Some(facet) = facet(wo, wi, eta) else { return 0.0 };
    let through = super::fresnel::dielectric_transmittance(facet.cos_i, eta).unpolarised();
    let g2 = g2(across, ndf, wo, wi);
    let cosines = (facet.cos_i * facet.cos_o).abs() / (frame::mu(wo) * frame::mu(wi));
    if g2 > 0.0 { cosines * facet.jacobian * through * ndf.d(facet.wm) * g2 } else { 0.0 }
}
