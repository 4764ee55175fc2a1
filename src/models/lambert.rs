//! Lambert: the same radiance in every direction.
//!
//! Recipe: `model = "lambert"`, `params = { rho = 0.8 }`.

use super::lobes::{Diffuse, Reflector};
use super::{Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::integrate::Chart;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "lambert",
    title: "Lambert",
    formula: "f = rho / pi",
    sources: &[(cite::LAMBERT_1760, "Pars prima, cap. II")],
    params: &[Param::number("rho", "rho", "diffuse reflectance", [0.0, 1.0], DefaultValue::Value(1.0))
        .swept("rho", [0.0, 1.0], 1.0)],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "E = E_avg = rho for every angle.",
    also: &[],
    known: &[
        Known {
            what: KnownValue::Albedo(0.3),
            params: &[("rho", "0.5")],
            value: 0.5,
            relative: 1e-14,
            source: "closed form: E = rho",
        },
        Known {
            what: KnownValue::Albedo(0.0),
            params: &[("rho", "0.5")],
            value: 0.5,
            relative: 1e-14,
            source: "closed form: E = rho, also for grazing views",
        },
        Known {
            what: KnownValue::Value([0.5, 0.0, 0.5, 3.140_625]),
            params: &[("rho", "0.5")],
            value: 0.159_154_943_091_895_34,
            relative: 1e-15,
            source: "closed form: rho / pi",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(Diffuse(Lambert { rho: params.number("rho")? })))
}

/// The lobe; also the diffuse part of other models.
#[derive(Debug)]
pub(super) struct Lambert {
    /// Reflectance.
    pub(super) rho: f64,
}

impl Reflector for Lambert {
    fn f(&self, _wo: DVec3, _wi: DVec3) -> f64 {
        self.rho * FRAC_1_PI
    }

    fn albedo(&self, _mu_o: f64) -> Option<f64> {
        Some(self.rho)
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Hemisphere)
    }
}
