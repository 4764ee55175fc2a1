//! Fdez-Aguera's compensation of split sums: what is lost comes back as a diffuse lobe.
//!
//! Recipe: `model = "fdez-aguera"`, `params = { base = "ggx", alpha = 0.5, f0 = 0.9 }`. Made for image-based lighting, where the
//! diffuse lobe is an irradiance map; the function `fdez-aguera-weights` gives the weights.

use super::compensated::{self, Parts, Rule};
use super::{Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "fdez-aguera",
    title: "Microfacets with the compensation of Fdez-Aguera",
    formula: "f = f_s + F_ms E_ms / pi, F_ms = E_s F_avg / (1 - F_avg E_ms), E_ms = 1 - E(mu_o), E_s the albedo of f_s",
    sources: &[(cite::FDEZ_AGUERA_2019, "the split sum with multiple scattering")],
    params: compensated::PARAMS,
    laws: Laws { reciprocal: false, passive: true, isotropic: true },
    notes: "Not reciprocal: the added lobe depends on the view only. White (f0 = f90 = 1) reflects everything. alpha = 0 is the mirror.",
    also: &[],
    known: &[
        Known {
            what: KnownValue::Albedo(0.3),
            params: &[("alpha", "0.7")],
            value: 1.0,
            relative: 1e-6,
            source: "white furnace",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("alpha", "1"), ("f0", "0.5"), ("f90", "0.5")],
            // k / (1 - F (1 - E)) with k = E / 2, F = 1/2
            value: 0.306_852_819_440_054_7 / 1.306_852_819_440_054_7,
            relative: 1e-6,
            source: "closed form: E / (1 + E) for F = 1/2, E = 1 - ln 2",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    compensated::build(INFO.id, params, |params, parts: &Parts<'_>| {
        Ok(Rule::FdezAguera { f_avg: compensated::f_avg(params)?, coloured: parts.coloured() })
    })
}
