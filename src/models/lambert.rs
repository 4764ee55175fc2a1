//! Lambert: the same radiance in every direction.
//!
//! Recipe: `model = "lambert"`, `params = { rho = 0.8 }`.

use super::{Brdf, Known, Laws, ModelInfo, Param, ParamError, Params, Preset, Quantity, Sample};
use crate::cite;
use crate::integrate::Chart;
use crate::math::frame;
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, TAU};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "lambert",
    title: "Lambert",
    formula: "f = rho / pi",
    sources: &[(cite::LAMBERT_1760, "Pars prima, cap. II")],
    params: &[Param::number("rho", "rho", "diffuse reflectance", [0.0, 1.0], Preset::Value(1.0))],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "E = E_avg = rho for every angle.",
    also: &[],
    known: &[
        Known {
            what: Quantity::Albedo(0.3),
            params: &[("rho", "0.5")],
            value: 0.5,
            relative: 1e-14,
            source: "closed form: E = rho",
        },
        Known {
            what: Quantity::Value([0.5, 0.0, 0.5, 3.140_625]),
            params: &[("rho", "0.5")],
            value: 0.159_154_943_091_895_34,
            relative: 1e-15,
            source: "closed form: rho / pi",
        },
    ],
    splits: false,
    build,
};

#[derive(Debug)]
struct Lambert {
    rho: f64,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(Lambert { rho: params.number("rho") }))
}

impl Brdf for Lambert {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if frame::both_above(wo, wi) { self.rho * FRAC_1_PI } else { 0.0 }
    }

    fn sample(&self, _wo: DVec3, u: DVec2) -> Option<Sample> {
        let r = u.x.sqrt();
        let z = (1.0 - u.x).max(0.0).sqrt();
        let wi = DVec3::new(r * libm::cos(TAU * u.y), r * libm::sin(TAU * u.y), z);
        (z > 0.0).then_some(Sample { wi, pdf: z * FRAC_1_PI })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        if frame::both_above(wo, wi) { wi.z * FRAC_1_PI } else { 0.0 }
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Hemisphere)
    }
}
