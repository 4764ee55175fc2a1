//! Banks' shading of fibres (1994): hair, brushed metal and streamlines lit as one-dimensional things.
//!
//! The fibres run along the tangent +x. Each has normals all round, and the brightest one is taken: `s_i` is the
//! largest `n.wi` over them, and the specular base the largest cosine to a mirror direction. The value includes its own
//! falloff and must not be multiplied by a cosine. `p` is an "excess brightness" exponent, 4.8 is commonly quoted.
//!
//! Both vectors point away from the surface here; with an eye vector that points towards it the minus becomes a plus.
//!
//! Recipe: for `brdfbake eval`; an albedo of it can be computed but has no meaning.

use super::lobes::{cosine_pdf, cosine_sample};
use super::phong::{KD, KS};
use super::{
    Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params, Sample,
};
use crate::cite;
use crate::integrate::Chart;
use crate::math::{frame, special};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "banks",
    title: "Banks' fibre shading, 1994 (not a BRDF)",
    formula: "I = kd s_i^p + ks max(0, s_i s_o - x_i x_o)^q, s = sqrt(1 - x^2), x along the fibre",
    sources: &[(
        cite::BANKS_1994,
        "illumination of one-dimensional manifolds (the geometry is derived here)",
    )],
    params: &[
        KD,
        KS,
        Param::number("p", "p", "exponent of the diffuse term", [0.0, 1e3], DefaultValue::Value(4.75)),
        Param::number("q", "q", "exponent of the specular term", [0.0, 1e7], DefaultValue::Value(40.0)),
    ],
    laws: Laws { reciprocal: false, passive: false, isotropic: false },
    notes: "A shading value, not a BRDF: it includes its own falloff. The diffuse term depends on wi only, so it is not reciprocal; \
        energy is not defined. The base of the specular term is clamped at 0, and both terms are 0 below the horizon.",
    also: &[Alias { name: "banks_seed_shading", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("kd", "0.5"), ("ks", "0.5"), ("p", "4.75"), ("q", "16")],
            value: 0.455_687_532_087_703_9,
            relative: 1e-13,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("kd", "0.5"), ("ks", "0.5"), ("p", "2"), ("q", "4")],
            value: 3.0 * PI / 8.0 + 5.0 * PI / 16.0,
            relative: 1e-12,
            source: "closed form: kd 2 int sin^(p+2) + ks 2 int sin^(q+2) over (0, pi)",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let [kd, ks, p, q] = params.numbers(["kd", "ks", "p", "q"])?;
    Ok(Box::new(Banks { kd, ks, p, q }))
}

#[derive(Debug)]
struct Banks {
    kd: f64,
    ks: f64,
    p: f64,
    q: f64,
}

impl Brdf for Banks {
    /// The specular base is `cos(beta_i + beta_o - pi)` of the angles to the fibre; its sine keeps the digits that a
    /// large q needs.
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if !frame::both_above(wo, wi) {
            return 0.0;
        }
        let across = |w: DVec3| (w.y * w.y + w.z * w.z).sqrt();
        let (s_i, s_o) = (across(wi), across(wo));
        let cos = s_i * s_o - wi.x * wo.x;
        let sin = s_i * wo.x + wi.x * s_o;
        let specular = if cos > 0.0 { special::cos_pow(cos, sin * sin, self.q) } else { 0.0 };
        self.kd * special::cos_pow(s_i, wi.x * wi.x, self.p) + self.ks * specular
    }

    fn sample(&self, _wo: DVec3, u: DVec2) -> Option<Sample> {
        cosine_sample(u)
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        cosine_pdf(wo, wi)
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Fibre { across: self.p, cone: self.q })
    }

    fn turns(&self) -> bool {
        true
    }
}
