//! Single scattering in a layer of upright fibres (SGGX): the physics behind the sheen of Zeltner and others.
//!
//! Recipe: `model = "sggx-fiber"`, `params = { sigma = 0.3 }`. Unit depth, unit albedo.

use super::cloth::{Cloth, ClothLobe};
use super::{Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::integrate::{Chart, FacetLobe};
use crate::terms::sggx;
use glam::DVec3;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "sggx-fiber",
    title: "Layer of SGGX fibres, single scattering",
    formula: "f = D(wh) / 4 (1 - exp(-(l_i + l_o))) / ((l_i + l_o) mu_i mu_o), l = sqrt(x^2 + y^2 + sigma^2 z^2) / mu",
    sources: &[
        (cite::ZELTNER_2022, "section 3 (the layer)"),
        (cite::HEITZ_2015, "Eq. 10, 11 and 13 (the fibres)"),
    ],
    params: &[Param::number(
        "sigma",
        "sigma",
        "thickness of the fibres along the normal; the roughness of the sheen is its square root",
        [1e-3, 1.0],
        DefaultValue::Value(0.5),
    )
    .swept("sigma", [0.01, 1.0], 0.5)],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "The layer scatters once; what `ltc-sheen` fits has all orders.",
    also: &[Alias { name: "sggx_fiber_single_scatter", set: &[] }],
    known: &[Known {
        what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
        params: &[("sigma", "0.5")],
        value: 0.010_314_584_571_759_117,
        relative: 1e-12,
        source: "formula in 50-digit arithmetic",
    }],
    splits: false,
    build,
};

#[derive(Debug)]
struct Layer {
    sigma: f64,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(ClothLobe(Layer { sigma: params.number("sigma")? })))
}

impl Cloth for Layer {
    fn chart(&self) -> Chart {
        Chart::Ellipse(FacetLobe::upright(self.sigma))
    }

    fn value(&self, wo: DVec3, wi: DVec3) -> f64 {
        sggx::single_scattering(self.sigma, wo, wi)
    }
}
