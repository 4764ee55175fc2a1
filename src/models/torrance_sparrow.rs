//! Torrance and Sparrow in its modern form: Beckmann facets in V-shaped grooves.
//!
//! What lectures call Cook-Torrance, with the factor 1/4 that [`cook_torrance_1982`](super::cook_torrance_1982) lacks.
//! Recipe: `model = "torrance-sparrow"`, `params = { alpha = 0.3, f0 = 0.04 }`.

use super::facets::{Facets, HalfVectorLobe, vcavity_visibility};
use super::grooves;
use super::microfacet::{ALPHA, Beckmann, F0, F90, Fresnel};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;
use crate::integrate::Chart;
use crate::math::frame::HalfVector;
use crate::terms::smith::Ndf;
use glam::{DVec2, DVec3};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "torrance-sparrow",
    title: "Torrance-Sparrow, Beckmann facets in V-cavities",
    formula: "f = F(wo.wh) D(wh) G / (4 mu_o mu_i), G = min(1, 2 h.z mu_o / v, 2 h.z mu_i / v)",
    sources: &[
        (cite::TORRANCE_SPARROW_1967, "Eq. 16 to 18 (G)"),
        (cite::COOK_TORRANCE_1982, "section 2 (D, here with its 1/pi)"),
        (cite::WALTER_2007, "Eq. 20 (f)"),
    ],
    params: &[ALPHA, F0, F90],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "Exactly a quarter of `cook-torrance-1982`. V-cavity masking has kinks; E is integrated between them. \
        alpha = 0 is the mirror.",
    also: &[Alias { name: "torrance_sparrow_beckmann_vcavity", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.5, 0.0, 0.5, 3.140_625]),
            params: &[("alpha", "0.25")],
            value: 1.653_231_699_459_855_4,
            relative: 1e-12,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("alpha", "0.25")],
            value: 0.999_377_144_063_740_6,
            relative: 1e-11,
            source: "slope-space quadrature in 80-bit arithmetic",
        },
    ],
    splits: true,
    build,
};

#[derive(Debug)]
struct Grooves {
    distribution: Beckmann,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let alpha = params.number("alpha")?;
    Ok(Box::new(HalfVectorLobe {
        facets: Grooves { distribution: Beckmann::isotropic(alpha) },
        fresnel: Fresnel::Schlick { f0: params.number("f0")?, f90: params.number("f90")? },
        flat: alpha <= 0.0,
    }))
}

impl Facets for Grooves {
    fn d(&self, wm: DVec3) -> f64 {
        self.distribution.d(wm)
    }

    fn sample_d(&self, u: DVec2) -> DVec3 {
        self.distribution.sample_d(u)
    }

    fn visibility(&self, wo: DVec3, wi: DVec3, h: &HalfVector) -> f64 {
        vcavity_visibility(wo, wi, h)
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::HalfVector {
            alpha: self.distribution.alpha_x(),
            reach: 6.5,
            kinks: true,
            slope: f64::INFINITY,
            layer: 3.0 * self.distribution.alpha_x(),
        })
    }

    fn groove_reach(&self) -> Option<f64> {
        Some(grooves::gaussian_reach(self.distribution.alpha_x()))
    }
}
