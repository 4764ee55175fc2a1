//! A rough dielectric interface with Beckmann facets: reflection and transmission.
//!
//! Recipe: `model = "beckmann-glass"`, `params = { eta = 1.5 }`. See `ggx-glass`; the tails are shorter.

use super::glass::{self, ACROSS, Glass};
use super::microfacet::{self, ALPHA, ALPHA_X, ALPHA_Y, Beckmann, ETA_DIELECTRIC};
use super::{Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "beckmann-glass",
    title: "Rough dielectric with Beckmann facets, reflection and transmission",
    formula: "f_r = F D G2 / (4 mu_o mu_i); f_t = |wi.h| |wo.h| n_o^2 (1 - F) D G2 / (|mu_o mu_i| (n_i wi.h + n_o wo.h)^2)",
    sources: &[
        (cite::WALTER_2007, "Eq. 16 and 17 (h), 20 (f_r), 21 (f_t), 22 (F), 25 (D)"),
        (cite::HEITZ_2014, "section 5.2 (Lambda)"),
    ],
    params: &[ALPHA.swept("roughness", [0.1, 1.0], 1.0), ALPHA_X, ALPHA_Y, ETA_DIELECTRIC, ACROSS],
    laws: Laws { reciprocal: true, passive: true, isotropic: false },
    notes: "As `ggx-glass`. The masking is exact, not the rational fit of the paper. Default axes begin at alpha = 0.01.",
    also: &[],
    known: &[
        Known {
            what: KnownValue::Albedo(0.3),
            params: &[("alpha", "0"), ("eta", "1.5")],
            value: 0.207_756_343_070_897_7,
            relative: 1e-12,
            source: "closed form: the smooth interface",
        },
        Known {
            what: KnownValue::Value([0.0, 0.0, 0.0, 0.0]),
            params: &[("alpha", "0.5"), ("eta", "1.5")],
            value: 0.04 / std::f64::consts::PI,
            relative: 1e-13,
            source: "closed form: F0 D(n) / 4 = 0.04 / (4 pi alpha^2)",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let [x, y] = microfacet::alphas(INFO.id, params)?;
    let eta = params.number("eta")?;
    Ok(Box::new(Glass {
        distribution: Beckmann::new(x, y),
        flat: x <= 0.0 || glass::no_interface(eta),
        eta,
        across: glass::across(params)?,
    }))
}
