//! GGX reflection off a rough metal, with the exact unpolarised Fresnel factor of a complex index eta + i k.
//!
//! Recipe: `model = "ggx-conductor"`, `params = { eta = 0.2, k = 3.9 }` (one wavelength; a colour is three bakes).

use super::microfacet::{self, ALPHA, ALPHA_X, ALPHA_Y, ETA_CONDUCTOR, Ggx, K, MASKING, OUTSIDE};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "ggx-conductor",
    title: "GGX reflection off a metal, exact Fresnel",
    formula: "f = F(wo.wh, (eta + i k) / outside) D(wh) G2(wo, wi) / (4 mu_o mu_i)",
    sources: &[
        (cite::WALTER_2007, "Eq. 33 (D), 34 (G1), 20 (f)"),
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
    microfacet::build(INFO.id, params, Ggx::new, microfacet::conductor(params)?)
}

const ALSO: &[Alias] = &[Alias { name: "ggx_conductor_correlated", set: &[("masking", "correlated")] }];

const KNOWN: &[Known] = &[
    Known {
        what: KnownValue::Albedo(1.0),
        params: &[("alpha", "0.25"), ("eta", "0.1875"), ("k", "3.375")],
        value: 0.862_052_878_489_248_64,
        relative: 1e-11,
        source: "slope-space quadrature in 80-bit arithmetic",
    },
    Known {
        what: KnownValue::Value([0.5, 0.0, 0.5, 3.140_625]),
        params: &[("alpha", "0.25"), ("eta", "0.1875"), ("k", "3.375")],
        value: 1.541_516_846_610_180_6,
        relative: 1e-12,
        source: "formula in 50-digit arithmetic",
    },
];
