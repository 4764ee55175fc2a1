//! Fujii's Oren-Nayar (FON): the qualitative model with its energy put right.
//!
//! Oren-Nayar's `max(0, cos phi)` becomes two branches without the jump in energy, and a factor keeps E at 1 for
//! grazing views. `r` in [0, 1] is an artist's roughness, not an angle: 0 is Lambert, 1 the roughest.
//!
//! Recipe: `model = "fujii"`, `params = { rho = 0.8, r = 0.5 }`.

use super::lobes::{Diffuse, Reflector};
use super::oren_nayar::RHO;
use super::{Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::integrate::Chart;
use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "fujii",
    title: "Fujii's Oren-Nayar (FON)",
    formula: "f = rho / pi A_F (1 + r s / t), s = x_i x_o + y_i y_o, t = max(mu_i, mu_o) if s > 0 else 1, \
        A_F = 1 / (1 + (1/2 - 2/(3 pi)) r)",
    sources: &[
        (cite::FUJII_2012, "the 'tiny improvement' page, first form"),
        (cite::PORTSMOUTH_2025, "the authors' listing, `f_EON` and `E_FON_exact` (FON and its albedo)"),
    ],
    params: &[RHO, R],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "E = 1 at grazing for rho = 1 and every r, below 1 elsewhere (0.85 at r = 1): the rest is light that met more than one facet, \
        which `eon` puts back. Kinks at mu_i = mu_o and at azimuth pi/2.",
    also: &[Alias { name: "fon_fujii", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("rho", "1"), ("r", "0.25")],
            value: 0.287_236_902_325_790_96,
            relative: 1e-14,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(0.0),
            params: &[("rho", "0.5"), ("r", "0.7")],
            value: 0.5,
            relative: 1e-13,
            source: "closed form: E(0) = rho for every r",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("rho", "1"), ("r", "0.25")],
            value: 0.932_880_765_991_993_9,
            relative: 1e-13,
            source: "closed form: E(1) = A_F",
        },
    ],
    splits: false,
    build,
};

/// `r`, the artist's roughness of diffuse models.
pub(super) const R: Param =
    Param::number("r", "r", "artist's roughness; 0 is Lambert", [0.0, 1.0], DefaultValue::Value(0.5))
        .also(&["roughness"])
        .swept("r", [0.0, 1.0], 1.0);

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(Diffuse(Fujii { rho: params.number("rho")?, fon: Fon::new(params.number("r")?) })))
}

/// The lobe of FON for `rho` = 1, shared with EON.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fon {
    r: f64,
    scale: f64,
}

/// `1/2 - 2/(3 pi)`.
const K1: f64 = 0.5 - 2.0 / (3.0 * PI);
/// `2/3 - 28/(15 pi)`.
const K2: f64 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

impl Fon {
    pub(super) fn new(r: f64) -> Fon {
        Fon { r, scale: 1.0 / (1.0 + K1 * r) }
    }

    /// `pi f`.
    pub(super) fn value(&self, wo: DVec3, wi: DVec3) -> f64 {
        let s = wo.x * wi.x + wo.y * wi.y;
        let t = if s > 0.0 { wo.z.max(wi.z) } else { 1.0 };
        self.scale * (1.0 + self.r * s / t)
    }

    /// `(1 - E(mu)) / r`, which has a limit at r = 0 and no cancellation at grazing.
    ///
    /// `A_F (K1 - G/pi)`, G the integral of s/t; with the height beta = pi/2 - theta,
    /// `pi K1 - G = (pi/2 - 2/3)(1 - s) + s beta + s^2 mu - 2/3 s mu (1 + s + s^2) / (1 + s)`, 1 - s = mu^2 / (1 + s).
    pub(super) fn lost(&self, mu: f64) -> f64 {
        let s = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
        let height = libm::atan2(mu, s);
        let rest = (0.5 * PI - 2.0 / 3.0) * mu * mu / (1.0 + s) + s * (height + s * mu)
            - s * mu * (1.0 + s + s * s) / (1.5 * (1.0 + s));
        self.scale * FRAC_1_PI * rest
    }

    /// `(1 - E_avg) / r = A_F (K1 - K2)`.
    pub(super) fn lost_average(&self) -> f64 {
        self.scale * (K1 - K2)
    }

    /// E(mu) for `rho` = 1.
    pub(super) fn albedo(&self, mu: f64) -> f64 {
        1.0 - self.r * self.lost(mu)
    }

    /// E_avg for `rho` = 1: `A_F (1 + K2 r)`.
    pub(super) fn average(&self) -> f64 {
        self.scale * (1.0 + K2 * self.r)
    }

    /// `r`.
    pub(super) fn r(&self) -> f64 {
        self.r
    }
}

#[derive(Debug)]
struct Fujii {
    rho: f64,
    fon: Fon,
}

impl Reflector for Fujii {
    fn f(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.rho * FRAC_1_PI * self.fon.value(wo, wi)
    }

    fn albedo(&self, mu_o: f64) -> Option<f64> {
        Some(self.rho * self.fon.albedo(mu_o))
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Folded)
    }
}
