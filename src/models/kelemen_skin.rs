//! The specular of skin in GPU Gems 3: Kelemen and Szirmay-Kalos, with or without the factor pi of its lights.
//!
//! Recipe: `model = "kelemen-skin"`, `params = { m = 0.3, rho_s = 0.18 }`. The texture of its Beckmann factor is the table
//! `kelemen-beckmann`.

use super::{
    BATCH, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Nodes, Param, ParamError, Params, Sample,
    kelemen,
};
use crate::cite;
use crate::integrate::Chart;
use crate::models::facets::HalfVectorLobe;
use crate::models::microfacet::Fresnel;
use crate::terms::skin_specular;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, PI};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "kelemen-skin",
    title: "Skin specular of GPU Gems 3",
    formula: "f = rho_s PH(wh) F(wo.wh) / (pi |wo + wi|^2), PH = exp(-tan^2 / m^2) / (m^2 cos^4) = pi D",
    sources: &[(cite::DEON_LUEBKE_2007, "section 14.3, KS_Skin_Specular"), (cite::KELEMEN_2001, "section 2")],
    params: &[
        Param::number("m", "m", "roughness, Beckmann's alpha", [1e-4, 2.0], DefaultValue::Value(0.3))
            .also(&["alpha"]),
        Param::number("rho_s", "rho_s", "strength", [0.0, 1.0], DefaultValue::Value(0.18)),
        Param::number(
            "f0",
            "F0",
            "reflectance at normal incidence",
            [0.0, 1.0],
            DefaultValue::Value(skin_specular::F0),
        )
        .also(&["F0"]),
        Param::choice(
            "units",
            "radiometric: a BRDF; punctual: pi times that, as the shader has it for lights whose intensity carries pi",
            &["radiometric", "punctual"],
        ),
    ],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "The shader multiplies by the cosine of the light as well: the function `skin-specular` is what it returns. With units = \
        punctual E is pi times too large by intent, and stays below 1 only for a small rho_s.",
    also: &[],
    known: &[Known {
        what: KnownValue::Value([0.5, 0.0, 0.5, 3.140_625]),
        params: &[("m", "0.3125"), ("rho_s", "0.1875"), ("units", "\"punctual\"")],
        value: 0.015_329_404_718_887_1 / 0.877_582_561_890_372_6,
        relative: 1e-12,
        source: "shading value in 50-digit arithmetic over cos 0.5",
    }],
    splits: false,
    build,
};

/// The lobe of Kelemen, scaled.
#[derive(Debug)]
struct Skin {
    lobe: HalfVectorLobe<kelemen::Kelemen>,
    m: f64,
    f0: f64,
    scale: f64,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let (m, f0) = (params.number("m")?, params.number("f0")?);
    let units = if params.choice("units")? == "punctual" { 1.0 } else { FRAC_1_PI };
    Ok(Box::new(Skin {
        lobe: kelemen::lobe(m, Fresnel::Schlick { f0, f90: 1.0 }),
        m,
        f0,
        scale: params.number("rho_s")? * units,
    }))
}

impl Brdf for Skin {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.scale * skin_specular::lobe(self.m, self.f0, wo, wi)
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        self.lobe.sample(wo, u)
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.lobe.pdf(wo, wi)
    }

    fn chart(&self) -> Option<Chart> {
        self.lobe.chart()
    }

    /// PH is pi D: the lobe of Kelemen by the half vectors of the nodes.
    fn eval_nodes(&self, nodes: &Nodes, out: &mut [f64; BATCH]) {
        self.lobe.eval_nodes(nodes, out);
        out[..nodes.len].iter_mut().for_each(|f| *f *= PI * self.scale);
    }

    fn own_error(&self, mu_o: f64) -> f64 {
        PI * self.scale * self.lobe.own_error(mu_o)
    }
}
