//! EON, the energy-preserving Oren-Nayar of OpenPBR: FON plus the light that met more than one facet.
//!
//! `f = f_FON + rho_ms/pi (1 - E(mu_i))(1 - E(mu_o)) / (1 - E_avg)`, E that of FON with rho = 1, and
//! `rho_ms = rho^2 E_avg / (1 - rho (1 - E_avg))`. With rho = 1 nothing is lost: E = 1 for every view.
//! One colour channel is one model: rho_ms is not linear in rho, which saturates the colour of rough surfaces.
//!
//! The text of OpenPBR has a second 1/pi in rho_ms, with which the white furnace fails (0.88 at r = 0.75); it is a slip.
//!
//! Recipe: `model = "eon"`, `params = { rho = 0.8, r = 0.5 }`.

use super::fujii::{Fon, R};
use super::lobes::{Diffuse, Reflector};
use super::oren_nayar::RHO;
use super::{Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;
use crate::integrate::Chart;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "eon",
    title: "Energy-preserving Oren-Nayar (EON)",
    formula: "f = f_FON + rho_ms / pi (1 - E(mu_i)) (1 - E(mu_o)) / (1 - E_avg), rho_ms = rho^2 E_avg / (1 - rho (1 - E_avg)), E of FON at rho = 1",
    sources: &[
        (cite::PORTSMOUTH_2025, "the authors' listing, `f_EON` (both lobes) and `E_EON`"),
        (cite::FUJII_2012, "the 'tiny improvement' page, first form"),
    ],
    params: &[RHO, R],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "E = rho E_FON + rho_ms (1 - E_FON): exactly 1 at rho = 1. r = 0 is Lambert. Drawn by the cosine, not by the lobe of the paper.",
    also: &[],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("rho", "1"), ("r", "0.25")],
            value: 0.305_656_376_591_189_95,
            relative: 1e-13,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(0.3),
            params: &[("rho", "1"), ("r", "0.7")],
            value: 1.0,
            relative: 1e-13,
            source: "white furnace: E = 1 at rho = 1",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("rho", "0.5"), ("r", "0.25")],
            value: 0.482_788_055_341_047_44,
            relative: 1e-12,
            source: "closed form in 50-digit arithmetic",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let (rho, fon) = (params.number("rho")?, Fon::new(params.number("r")?));
    let average = fon.average();
    let rho_ms = rho * rho * average / (1.0 - rho * fon.r() * fon.lost_average());
    Ok(Box::new(Diffuse(Eon { rho, rho_ms, fon })))
}

#[derive(Debug)]
struct Eon {
    rho: f64,
    rho_ms: f64,
    fon: Fon,
}

impl Reflector for Eon {
    /// The compensation is `rho_ms/pi r L(mu_i) L(mu_o) / L_avg` with L = (1 - E)/r: no 0/0 as r -> 0.
    fn f(&self, wo: DVec3, wi: DVec3) -> f64 {
        let lost = self.fon.lost(wo.z) * self.fon.lost(wi.z);
        let multiple = self.rho_ms * self.fon.r() * lost / self.fon.lost_average();
        FRAC_1_PI * (self.rho * self.fon.value(wo, wi) + multiple)
    }

    fn albedo(&self, mu_o: f64) -> Option<f64> {
        let lost = self.fon.r() * self.fon.lost(mu_o);
        Some(self.rho * (1.0 - lost) + self.rho_ms * lost)
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Folded)
    }
}
