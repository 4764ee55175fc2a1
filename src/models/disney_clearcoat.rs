//! The clear coat of Disney's principled model of 2012: GTR1 facets, a quarter as strong as a coat of index 1.5.
//!
//! Recipe: `model = "disney-clearcoat"`, `params = { clearcoat = 1, gloss = 0.9 }`. Gloss 0 is satin, 1 nearly a mirror.

use super::facets::{Facets, HalfVectorLobe};
use super::microfacet::Fresnel;
use super::{Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::integrate::Chart;
use crate::math::frame::HalfVector;
use crate::terms::{clearcoat, gtr};
use glam::{DVec2, DVec3};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "disney-clearcoat",
    title: "Clear coat of Disney's model of 2012",
    formula: "f = (clearcoat / 4) D_GTR1(wh; alpha) F(wo.wh; 0.04) g(mu_o) g(mu_i), alpha = 0.1 + gloss (0.001 - 0.1), g = 1 / (mu + sqrt(a^2 + mu^2 - a^2 mu^2)), a = 1/4",
    sources: &[(cite::BURLEY_2012, "section 5.4 and App. B; g as in the published code")],
    params: &[
        Param::number("clearcoat", "cc", "strength of the coat", [0.0, 1.0], DefaultValue::Value(1.0)),
        Param::number(
            "gloss",
            "gloss",
            "0 is alpha = 0.1, 1 is alpha = 0.001",
            [0.0, 1.0],
            DefaultValue::Value(1.0),
        )
        .swept("gloss", [0.0, 1.0], 1.0),
    ],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "g holds the 1 / (2 mu) of both sides. Its masking has a width of its own, so this is no microfacet model; E stays below \
        a quarter of the coat's Fresnel factor nearly everywhere. The layers of that model are added, which does not conserve.",
    also: &[Alias { name: "disney_clearcoat", set: &[] }],
    known: &[Known {
        what: KnownValue::Value([0.5, 0.0, 0.5, 3.140_625]),
        params: &[("clearcoat", "1"), ("gloss", "0")],
        value: 0.022_022_405_316_302_946,
        relative: 1e-11,
        source: "formula in 50-digit arithmetic",
    }],
    splits: false,
    build,
};

#[derive(Debug)]
struct Coat {
    alpha: f64,
    strength: f64,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let facets =
        Coat { alpha: clearcoat::alpha(params.number("gloss")?), strength: params.number("clearcoat")? };
    let fresnel = Fresnel::Schlick { f0: clearcoat::F0, f90: 1.0 };
    Ok(Box::new(HalfVectorLobe { facets, fresnel, flat: false }))
}

impl Facets for Coat {
    fn d(&self, wm: DVec3) -> f64 {
        gtr::d(self.alpha, 1.0, wm)
    }

    fn sample_d(&self, u: DVec2) -> DVec3 {
        gtr::sample_d(self.alpha, 1.0, u)
    }

    /// The strength rides on the visibility: the density of samples must not carry it.
    fn visibility(&self, wo: DVec3, wi: DVec3, _h: &HalfVector) -> f64 {
        0.25 * self.strength * (clearcoat::g(wo.z) * clearcoat::g(wi.z))
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::HalfVector {
            alpha: self.alpha,
            reach: f64::INFINITY,
            kinks: false,
            slope: f64::INFINITY,
            layer: 3.0 * self.alpha,
        })
    }
}
