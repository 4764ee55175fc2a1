//! Blinn-Phong facets in V-shaped grooves: the power of a cosine as a distribution of normals, not as a BRDF.
//!
//! Recipe: `model = "blinn-phong-microfacet"`, `params = { n = 64, f0 = 0.04 }`. n = 10 is satin, 1000 polished.

use super::facets::{Facets, HalfVectorLobe, vcavity_visibility};
use super::grooves;
use super::microfacet::{F0, F90, Fresnel};
use super::{Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::integrate::Chart;
use crate::math::frame::HalfVector;
use crate::terms::blinn_phong;
use glam::{DVec2, DVec3};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "blinn-phong-microfacet",
    title: "Torrance-Sparrow with Blinn-Phong facets",
    formula: "f = F(wo.wh) (n + 2) / (2 pi) cos^n G / (4 mu_o mu_i), G = min(1, 2 h.z mu_o / v, 2 h.z mu_i / v)",
    sources: &[
        (cite::WALTER_2007, "the Phong distribution (D), Eq. 20 (f)"),
        (cite::BBM, "`ndf/phong.h`: the same D"),
        (cite::TORRANCE_SPARROW_1967, "Eq. 16 to 18 (G)"),
    ],
    params: &[
        Param::number(
            "n",
            "n",
            "exponent of the cosine; alpha^2 = 2 / (n + 2)",
            [0.0, 1e7],
            DefaultValue::Value(64.0),
        )
        .swept("n", [1.0, 1000.0], 0.25),
        F0,
        F90,
    ],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "n + 2 over 2 pi normalises D cos; as a BRDF it would be four times too bright. V-cavity masking has kinks.",
    also: &[Alias { name: "torrance_sparrow_blinn_vcavity", set: &[] }],
    known: &[Known {
        what: KnownValue::Value([0.5, 0.0, 0.5, 3.140_625]),
        params: &[("n", "1")],
        value: 0.154_990_618_003_411_46,
        relative: 1e-12,
        source: "formula in 50-digit arithmetic",
    }],
    splits: true,
    build,
};

#[derive(Debug)]
struct Grooves {
    n: f64,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(HalfVectorLobe {
        facets: Grooves { n: params.number("n")? },
        fresnel: Fresnel::Schlick { f0: params.number("f0")?, f90: params.number("f90")? },
        flat: false,
    }))
}

impl Facets for Grooves {
    fn d(&self, wm: DVec3) -> f64 {
        blinn_phong::d(self.n, wm)
    }

    fn sample_d(&self, u: DVec2) -> DVec3 {
        blinn_phong::sample_d(self.n, u)
    }

    fn visibility(&self, wo: DVec3, wi: DVec3, h: &HalfVector) -> f64 {
        vcavity_visibility(wo, wi, h)
    }

    /// `cos^n` falls slower than Beckmann's Gaussian of equal peak; at n below 100 it reaches the horizon.
    fn chart(&self) -> Option<Chart> {
        let alpha = blinn_phong::equivalent_alpha(self.n);
        let reach = if self.n > 100.0 { 9.0 } else { f64::INFINITY };
        Some(Chart::HalfVector { alpha, reach, kinks: true, slope: f64::INFINITY, layer: 3.0 * alpha })
    }

    /// Where `cos^n` has fallen below rounding: `n/2 ln(1 + tan²)` is that many.
    fn groove_reach(&self) -> Option<f64> {
        let decay = 2.0 * grooves::DECAY / self.n.max(1e-3);
        Some(if decay < 100.0 { libm::atan(libm::expm1(decay).sqrt()) } else { std::f64::consts::FRAC_PI_2 })
    }
}
