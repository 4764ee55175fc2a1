//! Smith's masking and shadowing, written once for every normal distribution.
//!
//! Everything follows from one number a direction, [`Ndf::mu_lambda`]: the projected area `mu Λ(w)` of the facets
//! that are turned away from `w`, per unit area of the macrosurface. It is finite at grazing, where Λ itself is
//! infinite; with M = `mu_lambda(w)`,
//!
//! ```text
//! area facing w      ∫ D(m) max(0, w·m) dm = mu + M
//! G1                 mu/(mu + M)
//! G2, correlated     mu_o mu_i/(mu_o mu_i + (mu_o M_i + mu_i M_o))
//! V = G2/(4 mu_o mu_i)     the same with 1/4 in place of mu_o mu_i
//! visible normals    max(0, w·m) D(m)/(mu + M)
//! ```
//! so no step divides by a small cosine, and each formula is symmetric to the bit in the two directions.
//!
//! Cosines enter as |cos θ|: a direction below the surface sees the same statistics from below.

use crate::math::frame;
use glam::{DVec2, DVec3};
use std::fmt::Debug;

/// A distribution of facet normals on the upper hemisphere, with Smith masking.
///
/// All directions are unit, in the local frame, n = +z. Implementations give the first five functions; the rest
/// follows and is as accurate as they are.
pub trait Ndf: Debug + Send + Sync {
    /// Density of facet area over solid angle, `D(wm)`.
    ///
    /// Units: sr⁻¹. Range: ≥ 0, finite; 0 for `wm.z` ≤ 0. Law: `∫ D cos θm dωm = 1`.
    fn d(&self, wm: DVec3) -> f64;

    /// Density of facet slopes, `P22(x, y) = D cos⁴θm` at `wm ∝ (x, y, 1)`.
    ///
    /// Unit 1. Range: ≥ 0. Law: `∫∫ P22 dx dy = 1`.
    fn p22(&self, slope: DVec2) -> f64;

    /// `mu Λ(w) = ∫ D(m) max(0, −w·m) dm`, the projected area of the facets turned away from `w`.
    ///
    /// Unit 1. Range: ≥ 0, finite everywhere, > 0 at the horizon.
    fn mu_lambda(&self, w: DVec3) -> f64;

    /// A facet normal with density `D cos θm` from two uniform numbers in [0, 1]; see [`Ndf::pdf_d`].
    fn sample_d(&self, u: DVec2) -> DVec3;

    /// A facet normal with the density [`Ndf::d_visible`] from two uniform numbers in [0, 1].
    ///
    /// `wo.z` ≥ 0. The weight of a reflection sampled so is `F G2/G1(wo)`, in [0, 1].
    fn sample_visible(&self, wo: DVec3, u: DVec2) -> DVec3;

    /// Smith's `Λ(w)`: hidden over visible projected area of the facets that face away or towards `w`.
    ///
    /// Source: [Heitz2014](crate::cite::HEITZ_2014) Eq. 41. Range: [0, ∞]; +∞ at the horizon, its true limit: use
    /// [`Ndf::mu_lambda`] in formulas that reach it.
    fn lambda(&self, w: DVec3) -> f64 {
        self.mu_lambda(w) / frame::mu(w)
    }

    /// Smith's masking `G1(w) = 1/(1 + Λ)` of a facet that faces `w`.
    ///
    /// Source: [Heitz2014](crate::cite::HEITZ_2014) Eq. 42. Range: [0, 1]; 0 at the horizon.
    fn g1(&self, w: DVec3) -> f64 {
        let mu = frame::mu(w);
        mu / (mu + self.mu_lambda(w))
    }

    /// [`Ndf::g1`] with its support rule: 0 if `w` sees the back of the facet `wm`, (w·m)(w·n) ≤ 0.
    ///
    /// Source: [Walter2007](crate::cite::WALTER_2007) (the product of two G1 and its support).
    fn g1_facet(&self, w: DVec3, wm: DVec3) -> f64 {
        if w.dot(wm) * w.z > 0.0 { self.g1(w) } else { 0.0 }
    }

    /// Height-correlated masking and shadowing `G2 = 1/(1 + Λ_o + Λ_i)` for reflection.
    ///
    /// Source: [Heitz2014](crate::cite::HEITZ_2014) Eq. 99. Range: [0, 1]. Symmetric to the bit.
    /// Guard: 0 if both cosines are 0, where its limit depends on the path.
    fn g2(&self, wo: DVec3, wi: DVec3) -> f64 {
        let both = frame::mu(wo) * frame::mu(wi);
        quotient(both, self.masked_area(wo, wi))
    }

    /// Uncorrelated masking and shadowing `G2 = G1(wo) G1(wi)`.
    ///
    /// Source: [Walter2007](crate::cite::WALTER_2007) Eq. 23; [Heitz2014](crate::cite::HEITZ_2014) Eq. 98.
    /// Range: [0, 1], never above [`Ndf::g2`].
    fn g2_separable(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.g1(wo) * self.g1(wi)
    }

    /// Visibility `V = G2/(4 mu_o mu_i)`, height-correlated: the BRDF is `F D V`.
    ///
    /// Units: 1. Range: ≥ 0, finite. No division by a cosine; finite as long as one of the two is not 0.
    /// Guard: 0 if both are 0, as a reflection has no support there. Symmetric to the bit.
    fn visibility(&self, wo: DVec3, wi: DVec3) -> f64 {
        quotient(0.25, self.masked_area(wo, wi))
    }

    /// Visibility `V = G1(wo) G1(wi)/(4 mu_o mu_i)`, uncorrelated; finite everywhere.
    fn visibility_separable(&self, wo: DVec3, wi: DVec3) -> f64 {
        0.25 / (self.facing_area(wo) * self.facing_area(wi))
    }

    /// `mu (1 + Λ) = ∫ D(m) max(0, w·m) dm`: the projected area of the facets that face `w`, hidden or not.
    ///
    /// Source: [Heitz2014](crate::cite::HEITZ_2014) Eq. 14 and 41. Range: > 0.
    fn facing_area(&self, w: DVec3) -> f64 {
        frame::mu(w) + self.mu_lambda(w)
    }

    /// `mu_o mu_i (1 + Λ_o + Λ_i)`, the denominator of the correlated forms.
    fn masked_area(&self, wo: DVec3, wi: DVec3) -> f64 {
        let (mu_o, mu_i) = (frame::mu(wo), frame::mu(wi));
        mu_o * mu_i + (mu_o * self.mu_lambda(wi) + mu_i * self.mu_lambda(wo))
    }

    /// Density of the normals that `wo` sees, `D_wo(wm) = G1(wo) max(0, wo·wm) D(wm)/mu_o`.
    ///
    /// Source: [Heitz2014](crate::cite::HEITZ_2014) Eq. 16. Units: sr⁻¹. Domain: `wo.z` ≥ 0. Law: `∫ D_wo dωm = 1`.
    /// The reflected direction then has the density `D_wo/(4 wo·wm)`.
    fn d_visible(&self, wo: DVec3, wm: DVec3) -> f64 {
        let cos_o = wo.dot(wm);
        if cos_o > 0.0 && wo.z >= 0.0 { cos_o * self.d(wm) / self.facing_area(wo) } else { 0.0 }
    }

    /// Density of [`Ndf::sample_d`]: `D cos θm`, sr⁻¹.
    fn pdf_d(&self, wm: DVec3) -> f64 {
        self.d(wm) * wm.z.max(0.0)
    }
}

/// a/b, or 0 where b is 0.
fn quotient(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}

/// Widths below this count as this: a perfect mirror has no density.
pub const ALPHA_FLOOR: f64 = 1e-9;

/// `v/|v|`, or the normal where `v` is 0.
pub(crate) fn normal_or_z(v: DVec3) -> DVec3 {
    let length = v.length();
    if length > 0.0 { v / length } else { DVec3::Z }
}
