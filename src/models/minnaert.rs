//! Minnaert: a power of both cosines, for the limb darkening of the moon.
//!
//! k = 1 is Lambert, k > 1 darkens towards the limb (velvet seen face on), k < 1 brightens it (the full moon, k near 0.5,
//! looks like a flat disc).
//!
//! Recipe: `model = "minnaert"`, `params = { rho = 0.5, k = 1.5 }`.

use super::{
    Brdf, DefaultValue, Functional, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params, Sample,
};
use crate::cite;
use crate::integrate::{Chart, Estimate};
use crate::math::{frame, special};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_1_PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "minnaert",
    title: "Minnaert",
    formula: "f = rho / pi (mu_i mu_o)^(k - 1)",
    sources: &[
        (cite::MINNAERT_1941, "the reciprocal law of limb darkening"),
        (cite::BRDF_EXPLORER, "`minnaert.brdf`: the same power, with the factor (k + 1) / 2"),
    ],
    params: &[
        Param::number("rho", "rho", "reflectance at k = 1", [0.0, 1.0], DefaultValue::Value(1.0)),
        Param::number("k", "k", "limb darkening exponent", [0.0, 10.0], DefaultValue::Value(1.5)).swept(
            "k",
            [1.0, 4.0],
            1.0,
        ),
    ],
    laws: Laws { reciprocal: true, passive: false, isotropic: true },
    notes: "E = 2 rho mu^(k-1) / (k + 1): not passive for k < 1, where it is infinite at mu = 0; start the mu axis above 0 there.",
    also: &[],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("rho", "0.5"), ("k", "0.5")],
            value: 0.219_967_976_279_128_35,
            relative: 1e-14,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(0.5),
            params: &[("rho", "1"), ("k", "2")],
            value: 1.0 / 3.0,
            relative: 1e-13,
            source: "closed form: E = 2 rho mu^(k-1) / (k + 1)",
        },
        Known {
            what: KnownValue::Albedo(0.25),
            params: &[("rho", "1"), ("k", "0.5")],
            value: 8.0 / 3.0,
            relative: 1e-12,
            source: "closed form: E = 2 rho mu^(k-1) / (k + 1)",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(Minnaert { rho: params.number("rho")?, k: params.number("k")? }))
}

#[derive(Debug)]
struct Minnaert {
    rho: f64,
    k: f64,
}

impl Brdf for Minnaert {
    /// Guard: where both directions graze, `mu_i mu_o` may underflow and f with k < 1 is capped at 1e300.
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if !frame::both_above(wo, wi) {
            return 0.0;
        }
        (self.rho * FRAC_1_PI * libm::pow(wo.z * wi.z, self.k - 1.0)).min(1e300)
    }

    /// A power of the cosine: density `(k + 1)/(2 pi) mu_i^k`, which makes the weight constant.
    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let (cos, sin) = special::circle(u.y);
        let z = libm::pow(u.x, 1.0 / (self.k + 1.0));
        let r = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        let wi = DVec3::new(r * cos, r * sin, z);
        (z > 0.0).then(|| Sample { wi, pdf: self.pdf(wo, wi) })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        if frame::both_above(wo, wi) {
            0.5 * FRAC_1_PI * (self.k + 1.0) * libm::pow(wi.z, self.k)
        } else {
            0.0
        }
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Horizon)
    }

    fn reduced(&self, mu_o: f64, functionals: &[Functional], _tolerance: f64) -> Option<Estimate> {
        let [Functional::One] = functionals else { return None };
        Some(Estimate::exact_one(2.0 * self.rho * libm::pow(mu_o, self.k - 1.0) / (self.k + 1.0)))
    }
}
