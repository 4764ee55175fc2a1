//! The diffuse part of Ashikhmin and Shirley alone: a substrate under a Schlick interface that light passes twice.
//!
//! The factor 28/23 makes up for the interface: `int (1 - (1 - mu/2)^5) mu dw = 23 pi / 28`.
//!
//! Recipe: `model = "ashikhmin-shirley-diffuse"`, `params = { rd = 0.5, rs = 0.05 }`.

use super::lobes::{Diffuse, Reflector};
use super::{Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::integrate::Chart;
use glam::DVec3;
use std::f64::consts::PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "ashikhmin-shirley-diffuse",
    title: "Ashikhmin-Shirley, diffuse part",
    formula: "f = 28 Rd / (23 pi) (1 - Rs) (1 - (1 - mu_i/2)^5) (1 - (1 - mu_o/2)^5)",
    sources: &[
        (cite::ASHIKHMIN_SHIRLEY_2000, "the diffuse term"),
        (cite::PBRT_2010, "`FresnelBlend::f`, its first term: the same form"),
    ],
    params: &[RD, RS],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "E = Rd (1 - Rs) (1 - (1 - mu/2)^5): 0 at grazing, at most 31/32; E_avg = 23/28 Rd (1 - Rs).",
    also: &[Alias { name: "ashikhmin_shirley_diffuse", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("rd", "1"), ("rs", "0")],
            value: 0.296_067_690_965_64,
            relative: 1e-14,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("rd", "1"), ("rs", "0")],
            value: 31.0 / 32.0,
            relative: 1e-13,
            source: "closed form: E = 1 - (1 - mu/2)^5",
        },
    ],
    splits: false,
    build,
};

/// `rd`.
pub(super) const RD: Param =
    Param::number("rd", "Rd", "diffuse reflectance", [0.0, 1.0], DefaultValue::Value(0.5)).also(&["Rd"]);
/// `rs`.
pub(super) const RS: Param = Param::number(
    "rs",
    "Rs",
    "specular reflectance at normal incidence",
    [0.0, 1.0],
    DefaultValue::Value(0.05),
)
.also(&["Rs"]);

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(Diffuse(Substrate::new(params)?)))
}

/// The lobe; also the diffuse part of the whole model.
#[derive(Debug)]
pub(super) struct Substrate {
    scale: f64,
}

impl Substrate {
    pub(super) fn new(params: &Params) -> Result<Substrate, ParamError> {
        Ok(Substrate { scale: params.number("rd")? * (1.0 - params.number("rs")?) })
    }
}

/// `1 - (1 - mu/2)^5` multiplied out, so that it keeps its digits at grazing.
fn entered(mu: f64) -> f64 {
    let x = 0.5 * mu;
    x * (5.0 - x * (10.0 - x * (10.0 - x * (5.0 - x))))
}

impl Reflector for Substrate {
    fn f(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.scale * 28.0 / (23.0 * PI) * (entered(wo.z) * entered(wi.z))
    }

    fn albedo(&self, mu_o: f64) -> Option<f64> {
        Some(self.scale * entered(mu_o))
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Hemisphere)
    }
}
