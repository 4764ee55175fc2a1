//! Frostbite's diffuse lobe: Burley's, renormalised so that little energy is gained.
//!
//! `r` is the perceptual roughness of the course notes (alpha = r^2), as in [`burley_diffuse`](super::burley_diffuse).
//!
//! Recipe: `model = "frostbite-diffuse"`, `params = { rho = 0.8, r = 0.5 }`.

use super::burley_diffuse::{RHO, two_factors};
use super::fujii::R;
use super::lobes::{Diffuse, Reflector};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;
use crate::integrate::Chart;
use crate::terms::schlick;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "frostbite-diffuse",
    title: "Frostbite's renormalised diffuse lobe, 2014",
    formula: "f = rho / pi (1 - r + r / 1.51) (1 + (F90 - 1)(1 - mu_i)^5) (1 + (F90 - 1)(1 - mu_o)^5), F90 = r / 2 + 2 r (wi.wh)^2",
    sources: &[
        (
            cite::LAGARDE_2014,
            "the listing of Disney's diffuse lobe with its energy normalised (bias and factor)",
        ),
        (cite::BURLEY_2012, "section 5.3 (the diffuse model)"),
    ],
    params: &[RHO, R],
    laws: Laws { reciprocal: true, passive: false, isotropic: true },
    notes: "Not passive, but nearly: E reaches 1.0315 at grazing for rho = r = 1. At r = 0 it is 0 at grazing, not Lambert.",
    also: &[Alias { name: "frostbite_diffuse", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("rho", "1"), ("r", "0.25")],
            value: 0.288_280_912_287_451_6,
            relative: 1e-14,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(0.0),
            params: &[("rho", "1"), ("r", "1")],
            value: (10.0 / 7.0 + 65.0 / 504.0) / 1.51,
            relative: 1e-13,
            source: "closed form: E(0) = (1 - r + r / 1.51)(10 r / 7 + 65 r^2 / 504)",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("rho", "1"), ("r", "0.25")],
            value: 0.891_038_907_284_768_2,
            relative: 1e-13,
            source: "closed form in 50-digit arithmetic",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let (rho, r) = (params.number("rho")?, params.number("r")?);
    Ok(Box::new(Diffuse(Frostbite { scale: rho * (1.0 - r + r / 1.51), r })))
}

#[derive(Debug)]
struct Frostbite {
    scale: f64,
    r: f64,
}

impl Reflector for Frostbite {
    fn f(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.scale * FRAC_1_PI * two_factors(0.5 * self.r, self.r, wo, wi)
    }

    /// As Burley's: a polynomial in u = 1 - mu.
    fn albedo(&self, mu_o: f64) -> Option<f64> {
        let (r, u, u5) = (self.r, 1.0 - mu_o, schlick::weight(mu_o));
        let e = 20.0 / 21.0 + r / 12.0 - r * u / 84.0
            + u5 * (37.0 * r * r / 252.0 + 2.0 * r - 20.0 / 21.0 - u * (9.0 * r / 14.0 + u * r * r / 56.0));
        Some(self.scale * e)
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Hemisphere)
    }
}
