//! Charlie's distribution with the visibility of Neubelt and Pettineo, as glTF viewers and MaterialX have it.
//!
//! Recipe: `model = "charlie-neubelt"`, `params = { roughness = 0.3 }`, `waive = [{ law = "energy", .. }]` for small roughness.

use super::charlie::ROUGHNESS;
use super::cloth::{Cloth, ClothLobe};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;
use crate::math::frame;
use crate::terms::{charlie, velvet};
use glam::DVec3;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "charlie-neubelt",
    title: "Charlie sheen, Neubelt visibility",
    formula: "f = D(wh) / (4 (mu_o + mu_i - mu_o mu_i)), D = (2 + 1/r) sin^(1/r) / (2 pi)",
    sources: &[
        (cite::ESTEVEZ_KULLA_2017, "Eq. 2 (D)"),
        (cite::NEUBELT_PETTINEO_2013, "the visibility of cloth"),
    ],
    params: &[ROUGHNESS.swept("roughness", [0.25, 1.0], 1.0)],
    laws: Laws { reciprocal: true, passive: false, isotropic: true },
    notes: "Not passive: E reaches 1.56 at grazing for roughness 0.07. Renderers scale the base by 1 - E, clamped.",
    also: &[Alias { name: "charlie_neubelt_visibility", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("roughness", "0.5")],
            value: 0.029_431_241_071_641_42,
            relative: 1e-12,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("roughness", "0.25")],
            value: 0.031_25,
            relative: 1e-10,
            source: "closed form: 1/32 at normal incidence and roughness 1/4",
        },
    ],
    splits: false,
    build,
};

#[derive(Debug)]
struct Charlie {
    roughness: f64,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(ClothLobe(Charlie { roughness: params.number("roughness")? })))
}

impl Cloth for Charlie {
    fn value(&self, wo: DVec3, wi: DVec3) -> f64 {
        let Some(h) = frame::half_vector(wo, wi) else { return 0.0 };
        charlie::d(self.roughness, h.wh) * velvet::visibility_neubelt(wo.z, wi.z)
    }
}
