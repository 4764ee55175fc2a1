//! GTR, Burley's generalised Trowbridge-Reitz facets, with their own Smith masking by quadrature.
//!
//! Recipe: `model = "gtr"`, `params = { gamma = 1, alpha = 0.1 }`. gamma = 1 has the longest tail (Berry's), 2 is GGX.

use super::facets::{Facets, HalfVectorLobe};
use super::microfacet::{self, ALPHA, F0, F90, Fresnel, MASKING, Masking};
use super::normals::turned_away;
use super::{Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::integrate::Chart;
use crate::integrate::graded::{Graded, Order};
use crate::math::frame::HalfVector;
use crate::terms::gtr;
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_PI_2;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "gtr",
    title: "GTR facets, Smith masking",
    formula: "f = F(wo.wh) D(wh) G2(wo, wi) / (4 mu_o mu_i), D = c / (1 + (alpha^2 - 1) cos^2)^gamma",
    sources: &[
        (cite::BURLEY_2012, "App. B.2 (D; Eq. 4 is its limit at gamma = 1)"),
        (cite::HEITZ_2014, "Eq. 14 and 41 (Lambda as an area), 99 (G2)"),
    ],
    params: &[
        ALPHA,
        Param::number(
            "gamma",
            "gamma",
            "exponent of the tail; 2 is GGX",
            [0.0, 10.0],
            DefaultValue::Value(1.0),
        ),
        F0,
        F90,
        MASKING,
    ],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "The paper gives no masking for gamma other than 2 and borrows that of GGX, which does not conserve; here Lambda is the \
        integral of D that Smith's theory asks for, to 1e-13. Slower than closed forms: some 50 evaluations for each direction. \
        alpha = 0 is the mirror.",
    also: &[],
    known: &[
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("alpha", "1"), ("gamma", "1")],
            value: 0.306_852_819_440_054_7,
            relative: 1e-10,
            source: "closed form: at alpha = 1 every gamma is the uniform hemisphere of GGX, E(1) = 1 - ln 2",
        },
        Known {
            what: KnownValue::Value([0.5, 0.0, 0.5, 3.140_625]),
            params: &[("alpha", "0.25"), ("gamma", "2")],
            value: 1.638_023_489_826_618_8,
            relative: 1e-12,
            source: "GGX in 50-digit arithmetic, which gamma = 2 is",
        },
    ],
    splits: true,
    build,
};

#[derive(Debug)]
struct Gtr {
    alpha: f64,
    gamma: f64,
    masking: Masking,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let alpha = params.number("alpha")?;
    Ok(Box::new(HalfVectorLobe {
        facets: Gtr { alpha, gamma: params.number("gamma")?, masking: microfacet::masking(params)? },
        fresnel: Fresnel::Schlick { f0: params.number("f0")?, f90: params.number("f90")? },
        flat: alpha <= 0.0,
    }))
}

impl Gtr {
    /// `mu Lambda = int D(m) max(0, -w . m) dm`, the azimuth of m done in closed form.
    ///
    /// ```text
    /// mu Lambda = 2 c s^2 int_0^(pi/2) B(x) sin x / (1 - (1 - alpha^2) s^2 cos^2 x)^gamma dx,
    /// B = mu cos x (t - atan t),  t = tan x / mu,  s^2 = 1 - mu^2
    /// ```
    /// where cos theta_m = s cos x. The integrand changes on the scales mu and sqrt(mu^2 + alpha^2 s^2) at x = 0, towards
    /// which the rule is graded.
    fn mu_lambda(&self, mu: f64, sin2: f64) -> f64 {
        let b = (1.0 - self.alpha) * (1.0 + self.alpha);
        // mu is the finer scale; at grazing the other one, alpha, is left
        let width = (mu * mu + self.alpha * self.alpha * sin2).sqrt();
        let scale = if mu > 0.0 { mu.min(width) } else { width };
        let eps = (scale / FRAC_PI_2).clamp(1e-12, 1e3);
        // the power falls from the larger scale on: an end of panels
        let end = (3.0 * width / FRAC_PI_2).min(1.0);
        let mut sum = 0.0;
        for span in [[0.0, end], [end, 1.0]] {
            if span[1] - span[0] <= 0.0 {
                continue;
            }
            let rule = Graded::between(eps, Order(1.0, 0.35), 17.0, span);
            for (x, w) in rule.node.iter().zip(&rule.weight) {
                let (sin, cos) = libm::sincos(FRAC_PI_2 * x);
                // 1 - b s^2 cos^2 = mu^2 + alpha^2 s^2 + b s^2 sin^2
                let base = mu * mu + self.alpha * self.alpha * sin2 + b * sin2 * sin * sin;
                sum += w * turned_away(mu, sin, cos) * sin * libm::pow(base, -self.gamma);
            }
        }
        2.0 * FRAC_PI_2 * sin2 * sum * self.norm()
    }

    /// c of D: its value in the horizon, where the base is 1.
    fn norm(&self) -> f64 {
        gtr::d(self.alpha, self.gamma, DVec3::new(1.0, 0.0, f64::MIN_POSITIVE))
    }

    /// Width of the peak, and how many widths it reaches.
    ///
    /// `D(theta) / D(0) = (1 + q sin^2)^(-gamma)`, `q = (1 - alpha^2) / alpha^2`: a high power falls on a finer scale than alpha, and to
    /// nothing within a few.
    fn peak(&self) -> (f64, f64) {
        let a2 = self.alpha * self.alpha;
        let narrow = (1.0 - a2).max(0.0);
        let alpha = self.alpha / (1.0 + (self.gamma - 2.0).max(0.0) * narrow).sqrt();
        let sin2 = a2 * libm::expm1(END / self.gamma) / narrow;
        let reach = if sin2 < 1.0 { (sin2 / (1.0 - sin2)).sqrt() / alpha } else { f64::INFINITY };
        (alpha, if reach < LONG { reach } else { f64::INFINITY })
    }

    /// `mu Lambda` of a direction.
    fn masked(&self, w: DVec3) -> f64 {
        self.mu_lambda(w.z, crate::math::frame::sin2_theta(w))
    }
}

/// `-ln` of the part of its peak below which D is left out of integrals.
const END: f64 = 44.0;

/// Widths from which on a tail is a long one.
const LONG: f64 = 30.0;

/// Error of an albedo by the rounding of the masking integral, over `1 / alpha`: measured by the drift of the white albedo at grazing
/// views, which does not depend on a small alpha, from alpha 8e-4 to 8e-6.
const ROUNDING: f64 = 4e-13;

impl Facets for Gtr {
    fn d(&self, wm: DVec3) -> f64 {
        gtr::d(self.alpha, self.gamma, wm)
    }

    fn sample_d(&self, u: DVec2) -> DVec3 {
        gtr::sample_d(self.alpha, self.gamma, u)
    }

    fn visibility(&self, wo: DVec3, wi: DVec3, _h: &HalfVector) -> f64 {
        let (o, i) = (self.masked(wo), self.masked(wi));
        match self.masking {
            Masking::Correlated => 0.25 / (wo.z * wi.z + (wo.z * i + wi.z * o)),
            Masking::Separable => 0.25 / ((wo.z + o) * (wi.z + i)),
        }
    }

    fn own_error(&self, _mu_o: f64) -> f64 {
        ROUNDING / self.alpha
    }

    fn chart(&self) -> Option<Chart> {
        let (alpha, reach) = self.peak();
        Some(Chart::HalfVector { alpha, reach, kinks: false, slope: f64::INFINITY, layer: 3.0 * alpha })
    }
}

#[cfg(test)]
mod tests {
    use super::{Gtr, Masking};
    use crate::math::frame;
    use crate::terms::ggx::Ggx;
    use crate::terms::smith::Ndf;

    #[test]
    fn masking_of_gamma_2_is_that_of_ggx() {
        for alpha in [1e-4, 0.01, 0.1, 0.5, 1.0, 1.7] {
            let gtr = Gtr { alpha, gamma: 2.0, masking: Masking::Correlated };
            for mu in [0.0, 1e-6, 1e-3, 0.03, 0.3, 0.8, 0.99, 1.0 - 1e-9] {
                let w = frame::from_mu(mu);
                let (got, expected) = (gtr.masked(w), Ggx::isotropic(alpha).mu_lambda(w));
                assert!(
                    (got - expected).abs() <= 1e-12 * (mu + expected),
                    "{alpha} {mu}: {got:e} {expected:e}"
                );
            }
        }
    }
}
