//! Beckmann reflection with a Schlick Fresnel factor; with f0 = f90 = 1 the white model that split-sum tables integrate.
//!
//! Recipe: `model = "beckmann"`, `params = { f0 = 0.04, masking = "correlated" }`; alpha usually sweeps an axis.
//! Typical widths: 0.001 looks like a mirror, 0.1 like satin, 0.7 like chalky metal.

use super::microfacet::{self, ALPHA, ALPHA_X, ALPHA_Y, Beckmann, F0, F90, Fresnel, MASKING};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "beckmann",
    title: "Beckmann, Schlick Fresnel",
    formula: "f = F(wo.wh) D(wh) G2(wo, wi) / (4 mu_o mu_i), F = F0 + (F90 - F0)(1 - wo.wh)^5",
    sources: &[
        (cite::WALTER_2007, "Eq. 25 (D), 26 (G1), 20 (f)"),
        (cite::HEITZ_2014, "Eq. 99 (correlated G2)"),
        (cite::SCHLICK_1994, "Eq. 15 (F)"),
    ],
    params: &[ALPHA, ALPHA_X, ALPHA_Y, F0, F90, MASKING],
    laws: Laws { reciprocal: true, passive: true, isotropic: false },
    notes: NOTES,
    also: ALSO,
    known: KNOWN,
    splits: true,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let fresnel = Fresnel::Schlick { f0: params.number("f0")?, f90: params.number("f90")? };
    microfacet::build(INFO.id, params, Beckmann::new, fresnel)
}

const NOTES: &str = "Single scattering: the missing energy grows with alpha (E = 0.46 at alpha = 1, mu = 1). Masking is the exact erf form; \
    renderers that use the rational fit differ by up to 6e-3 in G1. alpha = 0 is the mirror.";

const ALSO: &[Alias] = &[
    Alias { name: "beckmann_smith_correlated", set: &[("masking", "correlated")] },
    Alias { name: "beckmann_smith_separable", set: &[("masking", "separable")] },
];

const KNOWN: &[Known] = &[Known {
    what: KnownValue::Albedo(1.0),
    params: &[("alpha", "0.25")],
    value: 0.999_991_012_221_851_34,
    relative: 1e-12,
    source: "slope-space quadrature in 80-bit arithmetic",
}];
