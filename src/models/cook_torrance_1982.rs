//! Cook-Torrance as printed in 1982, with `F D' G / (pi mu_o mu_i)`: exactly four times the modern microfacet form.
//!
//! It is here because lectures still teach it. Its albedo reaches 4; a bake of it needs a waiver.
//! Recipe: `model = "cook-torrance-1982"`, `waive = [{ law = "energy", reason = "comparison" }]`.

use super::grooves::{self, Grooves};
use super::microfacet::{ALPHA, Beckmann, F0, F90, Fresnel};
use super::{Alias, Brdf, Functional, Known, KnownValue, Laws, ModelInfo, ParamError, Params, Sample};
use crate::cite;
use crate::integrate::{Chart, Estimate};
use crate::math::frame;
use crate::terms::smith::Ndf;
use glam::{DVec2, DVec3};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "cook-torrance-1982",
    title: "Cook-Torrance, as printed in 1982",
    formula: "f = (F / pi) D' G / (mu_o mu_i), D' = exp(-tan^2 / m^2) / (m^2 cos^4), G = min(1, 2 h.z mu_o / v, 2 h.z mu_i / v)",
    sources: &[(cite::COOK_TORRANCE_1982, "section 2 (Rs) and the Beckmann distribution")],
    params: &[ALPHA, F0, F90],
    laws: Laws { reciprocal: true, passive: false, isotropic: true },
    notes: "Not passive: the printed D' lacks its 1/pi while the denominator has pi instead of 4, so f is 4 times the modern form and \
        E approaches 4 F as alpha -> 0. V-cavity masking has kinks; E is integrated between them.",
    also: &[Alias { name: "cook_torrance_1982_seed_form", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.5, 0.0, 0.5, 3.140_625]),
            params: &[("alpha", "0.25")],
            value: 6.612_926_797_839_421_7,
            relative: 1e-12,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("alpha", "0.25")],
            value: 4.0 * 0.999_377_144_063_740_57,
            relative: 1e-11,
            source: "slope-space quadrature in 80-bit arithmetic",
        },
    ],
    splits: true,
    build,
};

#[derive(Debug)]
struct CookTorrance {
    distribution: Beckmann,
    alpha: f64,
    fresnel: Fresnel,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let alpha = params.number("alpha")?;
    Ok(Box::new(CookTorrance {
        distribution: Beckmann::isotropic(alpha),
        alpha,
        fresnel: Fresnel::Schlick { f0: params.number("f0")?, f90: params.number("f90")? },
    }))
}

impl Brdf for CookTorrance {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if self.alpha <= 0.0 || !frame::both_above(wo, wi) {
            return 0.0;
        }
        let Some(h) = frame::half_vector(wo, wi) else { return 0.0 };
        // G / (mu_o mu_i) with the minimum taken before the division, so that small cosines cancel
        let least = wo.z.min(wi.z);
        let g = (wo.z * wi.z).recip().min(2.0 * h.wh.z * least / (h.cos_d * wo.z * wi.z));
        self.fresnel.at(h.cos_d) * self.distribution.d(h.wh) * g
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let wm = self.distribution.sample_visible(wo, u);
        let wi = frame::reflect(wo, wm);
        (wi.z > 0.0).then(|| Sample { wi, pdf: self.pdf(wo, wi) })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        match frame::half_vector(wo, wi) {
            Some(h) if frame::both_above(wo, wi) => self.distribution.d_visible(wo, h.wh) / (4.0 * h.cos_d),
            _ => 0.0,
        }
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::HalfVector {
            alpha: self.alpha,
            reach: 6.5,
            kinks: true,
            slope: f64::INFINITY,
            layer: 3.0 * self.alpha,
        })
    }

    /// Four times that of the modern form.
    fn reduced(&self, mu_o: f64, functionals: &[Functional], tolerance: f64) -> Option<Estimate> {
        if self.alpha <= 0.0 {
            return None;
        }
        let d = |wm| 4.0 * self.distribution.d(wm);
        let reach = grooves::gaussian_reach(self.alpha);
        Some(Grooves { d: &d, heights: &[], reach, fresnel: self.fresnel }.integrate(
            mu_o,
            functionals,
            tolerance,
        ))
    }
}
