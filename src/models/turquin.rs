//! Turquin's compensation: the single-scattering lobe, scaled by what its view side has lost.
//!
//! Recipe: `model = "turquin"`, `params = { base = "ggx", alpha = 0.5, f0 = 0.9 }`. What game engines do: one multiplication.

use super::compensated::{self, Parts, Rule};
use super::{Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "turquin",
    title: "Microfacets with the compensation of Turquin",
    formula: "f = f_s (1 + F0 (1 - E(mu_o)) / E(mu_o)), E the white albedo",
    sources: &[
        (cite::TURQUIN_2019, "Eq. 16, by MaterialX"),
        (cite::MATERIALX, "`mx_ggx_energy_compensation`: the same factor"),
    ],
    params: compensated::PARAMS,
    laws: Laws { reciprocal: false, passive: true, isotropic: true },
    notes: "Not reciprocal: the view side alone is compensated. White (f0 = f90 = 1) reflects everything. alpha = 0 is the mirror.",
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
            // (E / 2) (1 + (1 - E) / (2 E)) = (1 + E) / 4
            value: 0.25 * 1.306_852_819_440_054_7,
            relative: 1e-6,
            source: "closed form: (1 + E) / 4 for F = 1/2, E = 1 - ln 2",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    compensated::build(INFO.id, params, |params, _: &Parts<'_>| {
        Ok(Rule::Turquin { f0: params.number("f0")? })
    })
}
