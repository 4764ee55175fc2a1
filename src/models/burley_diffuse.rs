//! Burley's diffuse lobe of the Disney principled model: Lambert with a grazing rise or fall that follows roughness.
//!
//! Smooth surfaces (r = 0) darken to half at grazing angles, as light that enters under a Fresnel interface twice does;
//! rough ones (r = 1) brighten towards the retro-reflection. `r` is the artist's roughness (alpha = r^2).
//!
//! Recipe: `model = "burley-diffuse"`, `params = { rho = 0.8, r = 0.5 }`.

use super::fujii::R;
use super::lobes::{Diffuse, Reflector};
use super::{Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::integrate::Chart;
use crate::terms::schlick;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "burley-diffuse",
    title: "Burley's (Disney) diffuse lobe, 2012",
    formula: "f = rho / pi (1 + (F90 - 1)(1 - mu_i)^5) (1 + (F90 - 1)(1 - mu_o)^5), F90 = 1/2 + 2 r (wi.wh)^2",
    sources: &[(cite::BURLEY_2012, "section 5.3 (the diffuse model)")],
    params: &[RHO, R],
    laws: Laws { reciprocal: true, passive: false, isotropic: true },
    notes: "Not passive: with rho = 1, E at grazing is 41/84 + r + 5 r^2 / 72, above 1 for r > 0.495 and 1.5575 at r = 1; E_avg exceeds 1 for r > 0.427. \
        `frostbite-diffuse` renormalises it.",
    also: &[Alias { name: "disney_diffuse", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("rho", "1"), ("r", "0.25")],
            value: 0.317_317_835_353_728,
            relative: 1e-14,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(0.0),
            params: &[("rho", "1"), ("r", "1")],
            value: 785.0 / 504.0,
            relative: 1e-13,
            source: "closed form: E(0) = 41/84 + r + 5 r^2 / 72",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("rho", "1"), ("r", "0.25")],
            value: 83.25 / 84.0,
            relative: 1e-13,
            source: "closed form: E(1) = (82 + 5 r) / 84",
        },
    ],
    splits: false,
    build,
};

/// `rho`.
pub(super) const RHO: Param =
    Param::number("rho", "rho", "base reflectance", [0.0, 1.0], DefaultValue::Value(1.0)).also(&["base"]);

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(Diffuse(Burley { rho: params.number("rho")?, r: params.number("r")? })))
}

/// `pi f / rho` of two Fresnel-like factors that share an F90; exactly reciprocal, as `1 + wi.wo` is.
pub(super) fn two_factors(f90_base: f64, r: f64, wo: DVec3, wi: DVec3) -> f64 {
    // cos^2 of the difference angle = (1 + wi.wo)/2 = |wi + wo|^2/4
    let f90 = f90_base + 0.5 * r * (wo + wi).length_squared();
    schlick::schlick(1.0, f90, wo.z) * schlick::schlick(1.0, f90, wi.z)
}

#[derive(Debug)]
struct Burley {
    rho: f64,
    r: f64,
}

impl Reflector for Burley {
    fn f(&self, wo: DVec3, wi: DVec3) -> f64 {
        self.rho * FRAC_1_PI * two_factors(0.5, self.r, wo, wi)
    }

    /// A polynomial in u = 1 - mu: the azimuth leaves only even powers of cos(phi).
    fn albedo(&self, mu_o: f64) -> Option<f64> {
        let (r, u, u5) = (self.r, 1.0 - mu_o, schlick::weight(mu_o));
        let e = 41.0 / 42.0 + 5.0 * r / 84.0 - r * u / 84.0
            + u5 * (19.0 * r * r / 252.0 + 45.0 * r / 28.0 - 41.0 / 84.0
                + u * (r * r / 84.0 - 55.0 * r / 84.0 - u * r * r / 56.0));
        Some(self.rho * e)
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Hemisphere)
    }
}
