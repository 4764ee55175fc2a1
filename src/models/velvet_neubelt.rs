//! Velvet of The Order: 1886: an inverted Gaussian on a floor, with a visibility that needs no masking.
//!
//! Recipe: `model = "velvet-neubelt"`, `params = { alpha = 0.5, f0 = 0.04 }`.

use super::cloth::{Cloth, ClothLobe};
use super::microfacet::{F0, F90, Fresnel};
use super::{Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::integrate::{Chart, FacetLobe};
use crate::math::frame;
use crate::terms::velvet;
use glam::DVec3;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "velvet-neubelt",
    title: "Velvet of Ashikhmin and Premoze, Neubelt's form",
    formula: "f = F(wo.wh) D(wh) / (4 (mu_o + mu_i - mu_o mu_i)), D = (1 + 4 exp(-cot^2 / alpha^2) / sin^4) / (pi (1 + 4 alpha^2))",
    sources: &[
        (cite::NEUBELT_PETTINEO_2013, "the cloth section"),
        (cite::ASHIKHMIN_PREMOZE_2007, "section 4 (D without its norm)"),
    ],
    params: &[
        Param::number(
            "alpha",
            "alpha",
            "width of the fibres about the horizon",
            [1e-3, 1.0],
            DefaultValue::Value(0.5),
        ),
        F0,
        F90,
    ],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "With F = 1 E stays below 0.85 for alpha of 0.1 and more. A widely copied line lacks the sin^4.",
    also: &[Alias { name: "velvet07_neubelt", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("alpha", "0.5")],
            value: 0.040_365_674_232_774_51,
            relative: 1e-12,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("alpha", "0.5")],
            value: 0.125_931_926_135_869_34,
            relative: 1e-10,
            source: "quadrature in 80-bit arithmetic by two parametrisations",
        },
    ],
    splits: true,
    build,
};

#[derive(Debug)]
struct Velvet {
    alpha: f64,
    fresnel: Fresnel,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let fresnel = Fresnel::Schlick { f0: params.number("f0")?, f90: params.number("f90")? };
    Ok(Box::new(ClothLobe(Velvet { alpha: params.number("alpha")?, fresnel })))
}

impl Cloth for Velvet {
    fn chart(&self) -> Chart {
        Chart::Ellipse(FacetLobe::upright(self.alpha))
    }

    fn value(&self, wo: DVec3, wi: DVec3) -> f64 {
        let Some(h) = frame::half_vector(wo, wi) else { return 0.0 };
        self.fresnel.at(h.cos_d) * velvet::d_2007(self.alpha, h.wh) * velvet::visibility_neubelt(wo.z, wi.z)
    }
}
