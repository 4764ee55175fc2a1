//! GGX reflection with a Schlick Fresnel factor; with f0 = f90 = 1 the white model that split-sum tables integrate.
//!
//! Recipe: `model = "ggx"`, `params = { f0 = 0.04, masking = "correlated" }`; alpha usually sweeps an axis.
//! Typical widths: 0.001 looks like a mirror, 0.1 like satin, 0.7 like chalky metal.

use super::microfacet::{self, ALPHA, ALPHA_X, ALPHA_Y, F0, F90, Fresnel, Ggx, MASKING};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "ggx",
    title: "GGX, Schlick Fresnel",
    formula: "f = F(wo.wh) D(wh) G2(wo, wi) / (4 mu_o mu_i), F = F0 + (F90 - F0)(1 - wo.wh)^5",
    sources: &[
        (cite::WALTER_2007, "Eq. 33 (D), 34 (G1), 20 (f)"),
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
    microfacet::build(INFO.id, params, Ggx::new, fresnel)
}

const NOTES: &str = "Single scattering: the missing energy 1 - E grows to 0.69 at alpha = 1, mu = 1. \
    The limit alpha -> 0 is not uniform in mu: E dips to 0.89 at mu = 1.1 alpha however small alpha is. alpha = 0 is the mirror.";

const ALSO: &[Alias] = &[
    Alias { name: "ggx_smith_correlated", set: &[("masking", "correlated")] },
    Alias { name: "ggx_smith_separable", set: &[("masking", "separable")] },
];

const KNOWN: &[Known] = &[
    Known {
        what: KnownValue::Albedo(1.0),
        params: &[("alpha", "1")],
        value: 0.306_852_819_440_054_7,
        relative: 1e-12,
        source: "closed form: alpha = 1 is the Lommel-Seeliger law, E(1) = 1 - ln 2",
    },
    Known {
        what: KnownValue::Albedo(0.5),
        params: &[("alpha", "1"), ("masking", "\"separable\"")],
        value: 0.409_137_092_586_739_6,
        relative: 1e-12,
        source: "closed form: separable Smith at alpha = 1, E(mu) = 2 (1 - ln 2) / (1 + mu)",
    },
    Known {
        what: KnownValue::Albedo(0.05),
        params: &[("alpha", "0.01")],
        value: 0.976_207_590_052,
        relative: 1e-11,
        source: "two quadratures in extended precision that agree to 12 decimals",
    },
];
