//! Beckmann reflection off a rough dielectric: the reflected part only, with the exact unpolarised Fresnel factor.
//!
//! Recipe: `model = "beckmann-dielectric"`, `params = { eta = 1.5 }`. eta < 1 is the view from inside, with total
//! internal reflection. Typical eta: water 1.333, plastic and glass 1.5, diamond 2.42.

use super::microfacet::{self, ALPHA, ALPHA_X, ALPHA_Y, Beckmann, ETA_DIELECTRIC, Fresnel, MASKING};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "beckmann-dielectric",
    title: "Beckmann reflection off a dielectric, exact Fresnel",
    formula: "f = F(wo.wh, eta) D(wh) G2(wo, wi) / (4 mu_o mu_i)",
    sources: &[
        (cite::WALTER_2007, "Eq. 25 (D), 26 (G1), 20 (f), 22 (F)"),
        (cite::HEITZ_2014, "Eq. 99 (correlated G2)"),
    ],
    params: &[ALPHA, ALPHA_X, ALPHA_Y, ETA_DIELECTRIC, MASKING],
    laws: Laws { reciprocal: true, passive: true, isotropic: false },
    notes: "Reflection only. For eta < 1 the integrand has a square-root edge at the critical angle, where convergence is slower.",
    also: ALSO,
    known: KNOWN,
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    microfacet::build(INFO.id, params, Beckmann::new, Fresnel::Dielectric { eta: params.number("eta")? })
}

const ALSO: &[Alias] = &[];

const KNOWN: &[Known] = &[Known {
    what: KnownValue::Albedo(1.0),
    params: &[("alpha", "0"), ("eta", "1.5")],
    value: 0.04,
    relative: 1e-14,
    source: "closed form: the mirror reflects ((eta - 1) / (eta + 1))^2 at normal incidence",
}];
