//! Beckmann reflection off a rough metal, with the exact unpolarised Fresnel factor of a complex index eta + i k.
//!
//! Recipe: `model = "beckmann-conductor"`, `params = { eta = 0.2, k = 3.9 }` (one wavelength; a colour is three bakes).

use super::microfacet::{self, ALPHA, ALPHA_X, ALPHA_Y, Beckmann, ETA_CONDUCTOR, K, MASKING, OUTSIDE};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "beckmann-conductor",
    title: "Beckmann reflection off a metal, exact Fresnel",
    formula: "f = F(wo.wh, (eta + i k) / outside) D(wh) G2(wo, wi) / (4 mu_o mu_i)",
    sources: &[
        (cite::WALTER_2007, "Eq. 25 (D), 26 (G1), 20 (f)"),
        (cite::HEITZ_2014, "Eq. 99 (correlated G2)"),
        (cite::BORN_WOLF_1999, "section 14.2 (F)"),
    ],
    params: &[ALPHA, ALPHA_X, ALPHA_Y, ETA_CONDUCTOR, K, OUTSIDE, MASKING],
    laws: Laws { reciprocal: true, passive: true, isotropic: false },
    notes: "k = 0 is the dielectric. Under a coat: outside is its index. Time factor exp(-i w t), so the index is eta + i k with k >= 0.",
    also: ALSO,
    known: KNOWN,
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    microfacet::build(INFO.id, params, Beckmann::new, microfacet::conductor(params)?)
}

const ALSO: &[Alias] = &[];

const KNOWN: &[Known] = &[Known {
    what: KnownValue::Albedo(1.0),
    params: &[("alpha", "0"), ("eta", "0.5"), ("k", "2")],
    value: 4.25 / 6.25,
    relative: 1e-14,
    source: "closed form: the mirror reflects ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2) at normal incidence",
}];
