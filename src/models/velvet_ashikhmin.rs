//! Ashikhmin's velvet of 2000: an inverted Gaussian of slopes in V-shaped grooves.
//!
//! Recipe: `model = "velvet-ashikhmin"`, `params = { sigma = 0.5 }`. Small sigma is a thin rim.

use super::cloth::{Cloth, ClothLobe};
use super::facets::vcavity_visibility;
use super::grooves::Grooves;
use super::microfacet::Fresnel;
use super::{
    Alias, Brdf, DefaultValue, Functional, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params,
};
use crate::cite;
use crate::integrate::{Chart, Estimate};
use crate::math::frame;
use crate::terms::velvet;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "velvet-ashikhmin",
    title: "Velvet of Ashikhmin, V-cavities",
    formula: "f = D(wh) G / (4 mu_o mu_i), D = exp(-cot^2 / sigma^2) / (pi sigma^2 sin^4), G of V-cavities",
    sources: &[
        (cite::ASHIKHMIN_2000, "section 5.1 (D), here normalised"),
        (cite::TORRANCE_SPARROW_1967, "Eq. 16 to 18 (G)"),
    ],
    params: &[Param::number(
        "sigma",
        "sigma",
        "width of the fibres about the horizon",
        [1e-3, 2.0],
        DefaultValue::Value(0.5),
    )
    .swept("sigma", [0.1, 1.0], 1.0)],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "0 to all orders where the half vector is the normal. V-cavity masking has kinks; E is integrated between them.",
    also: &[Alias { name: "velvet00_vcavity", set: &[] }],
    known: &[Known {
        what: KnownValue::Value([1.25, 0.5, 1.0, 1.75]),
        params: &[("sigma", "0.5")],
        value: 0.321_330_560_219_072_4,
        relative: 1e-12,
        source: "formula in 50-digit arithmetic",
    }],
    splits: false,
    build,
};

/// Cotangents in units of sigma between which the inverted Gaussian falls; at the last of them it is below the rounding of any sum.
const HEIGHTS: [f64; 4] = [0.6, 1.7, 4.0, 6.8];

#[derive(Debug)]
struct Velvet {
    sigma: f64,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(ClothLobe(Velvet { sigma: params.number("sigma")? })))
}

impl Cloth for Velvet {
    fn value(&self, wo: DVec3, wi: DVec3) -> f64 {
        let Some(h) = frame::half_vector(wo, wi) else { return 0.0 };
        velvet::d_2000(self.sigma, h.wh) * vcavity_visibility(wo, wi, &h)
    }

    fn chart(&self) -> Chart {
        Chart::Broad { kinks: true, floor: 0.0 }
    }

    fn reduced(&self, mu_o: f64, functionals: &[Functional], tolerance: f64) -> Option<Estimate> {
        let d = |wm| velvet::d_2000(self.sigma, wm);
        let white = Fresnel::Schlick { f0: 1.0, f90: 1.0 };
        let heights = HEIGHTS.map(|z| z * self.sigma / (1.0 + z * z * self.sigma * self.sigma).sqrt());
        Some(Grooves { d: &d, heights: &heights, reach: FRAC_PI_2, fresnel: white }.integrate(
            mu_o,
            functionals,
            tolerance,
        ))
    }
}
