//! A rough dielectric interface with GGX facets: reflection and transmission (frosted glass).
//!
//! Recipe: `model = "ggx-glass"`, `params = { eta = 1.5 }`. `eval` has values for directions on opposite sides as well; `albedo`
//! prints R and T. eta below 1 is the view from inside. alpha = 0 is the smooth interface, perfect reflection and refraction.

use super::glass::{self, ACROSS, Glass};
use super::microfacet::{self, ALPHA, ALPHA_X, ALPHA_Y, ETA_DIELECTRIC, Ggx};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "ggx-glass",
    title: "Rough dielectric with GGX facets, reflection and transmission",
    formula: "f_r = F D G2 / (4 mu_o mu_i); f_t = |wi.h| |wo.h| n_o^2 (1 - F) D G2 / (|mu_o mu_i| (n_i wi.h + n_o wo.h)^2)",
    sources: &[
        (cite::WALTER_2007, "Eq. 16 and 17 (h), 20 (f_r), 21 (f_t), 22 (F), 33 and 34 (D, G1)"),
        (cite::HEITZ_2016_MULTIPLE, "Appendix A, and the authors' code, `beta` (G2 across the surface)"),
    ],
    params: &[ALPHA, ALPHA_X, ALPHA_Y, ETA_DIELECTRIC, ACROSS],
    laws: Laws { reciprocal: true, passive: true, isotropic: false },
    notes: "Radiance: light that arrives along wi. f_t is reciprocal as f_t / n_o^2. E is the reflected part; with the transmitted T, the \
        part of the flux along wo that crosses, E + T <= 1. Single scattering. At eta = 1 there is no interface, and all light goes \
        straight on.",
    also: &[
        Alias { name: "walter2007_ggx_glass_separable", set: &[("masking", "separable")] },
        Alias { name: "ggx_glass_heightcorr_beta", set: &[("masking", "beta")] },
        Alias { name: "ggx_glass_pbrt_1_over_1plusLambdas", set: &[("masking", "sum")] },
    ],
    known: &[
        Known {
            what: KnownValue::Value([0.5, 0.0, 0.75, 3.140_625]),
            params: &[("alpha", "0.25"), ("eta", "1.5")],
            value: 0.055_584_974_219_629_05,
            relative: 1e-12,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Value([1.25, 0.0, 2.5, 3.25]),
            params: &[
                ("alpha_x", "0.375"),
                ("alpha_y", "0.75"),
                ("eta", "1.328125"),
                ("masking", "\"beta\""),
            ],
            value: 0.234_969_113_498_245_2,
            relative: 1e-12,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("alpha", "0.25"), ("eta", "1.5")],
            value: 0.037_048_663_177_816_79,
            relative: 1e-10,
            source: "slope-space quadrature in 80-bit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(0.968_912_421_710_644_8),
            params: &[("alpha", "0.25"), ("eta", "0.6875")],
            value: 0.053_233_101_238_064_1,
            relative: 1e-3,
            source: "slope-space quadrature, 10 digits; total reflection limits what the chart reaches",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let [x, y] = microfacet::alphas(INFO.id, params)?;
    let eta = params.number("eta")?;
    Ok(Box::new(Glass {
        distribution: Ggx::new(x, y),
        flat: x <= 0.0 || glass::no_interface(eta),
        eta,
        across: glass::across(params)?,
    }))
}
