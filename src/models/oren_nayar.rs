//! Oren-Nayar, the qualitative model: a diffuse surface of V-grooves whose facets are Lambertian.
//!
//! `sigma` is the standard deviation of the slope angle of the facets in radians: 0 is Lambert, 0.25 (14 degrees) clay
//! or plaster, 0.5 the moon-like flatness of a rough brick; above about 1 the fit means nothing. It is not the width of
//! a Beckmann distribution (a width alpha has sigma near alpha / sqrt 2).
//! Interreflection is left out; [`oren_nayar_full`](super::oren_nayar_full) has it.
//!
//! Recipe: `model = "oren-nayar"`, `params = { rho = 0.8, sigma = 0.35 }`.

use super::lobes::{Diffuse, Reflector};
use super::{Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::integrate::Chart;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "oren-nayar",
    title: "Oren-Nayar, qualitative",
    formula: "f = rho / pi (A + B max(0, cos(phi_i - phi_o)) sin(a) tan(b)), a = max(theta_i, theta_o), b = min(theta_i, theta_o), \
        A = 1 - sigma^2 / (2 (sigma^2 + 0.33)), B = 0.45 sigma^2 / (sigma^2 + 0.09)",
    sources: &[
        (cite::OREN_NAYAR_1994, "the qualitative model"),
        (cite::PBRT_2010, "`OrenNayar::f`: the same form"),
    ],
    params: &[RHO, SIGMA],
    laws: Laws { reciprocal: true, passive: false, isotropic: true },
    notes: "Not passive: with rho = 1, E at grazing is A + B/2, above 1 for 0 < sigma < 0.326, at most 1.0152 at sigma = 0.198. \
        f grows without bound where both directions graze together; E stays finite. Kinks at mu_i = mu_o and at azimuth pi/2.",
    also: &[Alias { name: "oren_nayar_qualitative", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("rho", "1"), ("sigma", "0.25")],
            value: 0.292_966_742_379_348_7,
            relative: 1e-14,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("rho", "1"), ("sigma", "0.25")],
            value: 0.920_382_165_605_095_5,
            relative: 1e-13,
            source: "closed form: E(1) = A",
        },
        Known {
            what: KnownValue::Albedo(0.0),
            params: &[("rho", "1"), ("sigma", "0.198")],
            value: 1.015_178_506_944_261_1,
            relative: 1e-12,
            source: "closed form: E(0) = A + B/2, its largest value",
        },
    ],
    splits: false,
    build,
};

/// `rho`.
pub(super) const RHO: Param =
    Param::number("rho", "rho", "reflectance of the facets", [0.0, 1.0], DefaultValue::Value(1.0));
/// `sigma`.
pub(super) const SIGMA: Param = Param {
    unit: "rad",
    ..Param::number(
        "sigma",
        "sigma",
        "standard deviation of the slope angle of the facets",
        [0.0, 1.57],
        DefaultValue::Value(0.35),
    )
    .swept("sigma", [0.0, 1.57], 1.0)
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let s2 = params.number("sigma")? * params.number("sigma")?;
    Ok(Box::new(Diffuse(OrenNayar {
        rho: params.number("rho")?,
        a: 1.0 - 0.5 * s2 / (s2 + 0.33),
        b: 0.45 * s2 / (s2 + 0.09),
    })))
}

#[derive(Debug)]
struct OrenNayar {
    rho: f64,
    a: f64,
    b: f64,
}

impl Reflector for OrenNayar {
    /// Without angles: `cos(dphi) sin a tan b = (x_i x_o + y_i y_o) / max(mu_i, mu_o)`.
    fn f(&self, wo: DVec3, wi: DVec3) -> f64 {
        let flat = wo.x * wi.x + wo.y * wi.y;
        self.rho * FRAC_1_PI * (self.a + self.b * flat.max(0.0) / wo.z.max(wi.z))
    }

    fn albedo(&self, mu_o: f64) -> Option<f64> {
        let fold = fold_albedo(mu_o);
        Some(self.rho * (self.a + self.b * FRAC_1_PI * fold))
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Folded)
    }
}

/// `int max(0, x_i x_o + y_i y_o) / max(mu_i, mu_o) mu_i dwi` over the hemisphere.
///
/// `s (theta - s mu) + 2/3 s mu (1 + s + s^2) / (1 + s)` with s = sin theta; the fraction is tan(theta) (1 - s^3)
/// without its 0 * infinity at grazing. Range: [0, pi/2], the end of which is its value at mu = 0.
pub(super) fn fold_albedo(mu: f64) -> f64 {
    let s = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
    let theta = libm::atan2(s, mu);
    s * (theta - s * mu) + s * mu * (1.0 + s + s * s) / (1.5 * (1.0 + s))
}
