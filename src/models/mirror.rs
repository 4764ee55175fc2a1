//! The perfect mirror: a delta in direction, whose only number is a reflectance.
//!
//! Recipe: `model = "mirror"`, `params = { f0 = 0.04 }`. `eval` has no value to give; albedos and split sums are exact.

use super::microfacet::{F0, F90, Fresnel};
use super::{Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params, Sample};
use crate::cite;
use crate::integrate::Chart;
use glam::{DVec2, DVec3};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "mirror",
    title: "Perfect mirror, Schlick Fresnel",
    formula: "f = F(mu_o) delta(wi - (2 mu_o n - wo)) / mu_o, F = F0 + (F90 - F0)(1 - mu_o)^5",
    sources: &[
        (cite::BORN_WOLF_1999, "section 1.5.1 (the law of reflection)"),
        (cite::SCHLICK_1994, "Eq. 15 (F)"),
    ],
    params: &[F0.swept("f0", [0.0, 1.0], 1.0), F90],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "A delta is never tabulated: E(mu) = F(mu). It is the limit of every microfacet model as alpha -> 0, though not a uniform one.",
    also: &[],
    known: &[
        Known {
            what: KnownValue::Albedo(0.5),
            params: &[("f0", "0.04")],
            value: 0.04 + 0.96 / 32.0,
            relative: 1e-15,
            source: "closed form: F(mu)",
        },
        Known {
            what: KnownValue::Albedo(0.0),
            params: &[("f0", "0.04")],
            value: 1.0,
            relative: 1e-15,
            source: "closed form: F90",
        },
    ],
    splits: true,
    build,
};

#[derive(Debug)]
struct Mirror {
    fresnel: Fresnel,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let fresnel = Fresnel::Schlick { f0: params.number("f0")?, f90: params.number("f90")? };
    Ok(Box::new(Mirror { fresnel }))
}

impl Brdf for Mirror {
    /// 0: a delta has no value at a pair of directions.
    fn eval(&self, _wo: DVec3, _wi: DVec3) -> f64 {
        0.0
    }

    /// `None`: the one direction that reflects has no density.
    fn sample(&self, _wo: DVec3, _u: DVec2) -> Option<Sample> {
        None
    }

    fn pdf(&self, _wo: DVec3, _wi: DVec3) -> f64 {
        0.0
    }

    fn chart(&self) -> Option<Chart> {
        None
    }

    fn mirror(&self, mu_o: f64) -> Option<f64> {
        Some(self.fresnel.at(mu_o))
    }
}
