//! Kelemen and Szirmay-Kalos' coupled model: the specular lobe, and a matte one that gets exactly what it leaves.
//!
//! Recipe: `model = "kelemen-matte"`, `params = { alpha = 0.2, f0 = 0.04, rho = 0.5 }`: polished wood, plastic, skin. The matte lobe
//! darkens where the specular one takes the light.

use super::albedo_curve::{AlbedoCurve, directional_albedo};
use super::facets::HalfVectorLobe;
use super::kelemen::{self, Kelemen};
use super::microfacet::{F90, Fresnel};
use super::{Brdf, Known, Laws, ModelInfo, Param, ParamError, Params, Preset, Quantity, Sample};
use crate::cite;
use crate::integrate::{Chart, Estimate};
use crate::math::{frame, special};
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_1_PI;
use std::sync::Arc;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "kelemen-matte",
    title: "Kelemen/Szirmay-Kalos specular over a coupled matte base",
    formula: "f = f_s + rho (1 - E(mu_o))(1 - E(mu_i)) / (pi (1 - E_avg)), f_s the lobe of `kelemen` with its Fresnel factor, E its albedo",
    sources: &[(cite::KELEMEN_2001, "section 3 (the matte part), section 2 (f_s)")],
    params: &[
        Param::number("alpha", "alpha", "width of the specular lobe", [1e-3, 2.0], Preset::Value(0.25))
            .also(&["m"]),
        Param::number("f0", "F0", "reflectance at normal incidence", [0.0, 0.99], Preset::Value(0.04))
            .also(&["F0"]),
        F90,
        Param::number("rho", "rho", "reflectance of the matte base", [0.0, 1.0], Preset::Value(0.5))
            .also(&["kd", "k_d"]),
    ],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "E_total = E + rho (1 - E), so rho = 1 reflects everything. The curve E(mu) is integrated when the model is built, \
        to about 1e-8; it is what limits the accuracy of the matte part.",
    also: &[],
    known: &[
        Known {
            what: Quantity::Albedo(0.4),
            params: &[("alpha", "0.3"), ("rho", "1")],
            value: 1.0,
            relative: 1e-6,
            source: "white furnace: E + (1 - E)",
        },
        Known {
            what: Quantity::Albedo(1.0),
            params: &[("alpha", "0.25"), ("f0", "0.5"), ("f90", "0.5"), ("rho", "0.5")],
            value: 0.5 + 0.25 * 0.937_500_007_033_448_4,
            relative: 1e-6,
            source: "closed form: E + (1 - E) / 2 with E = (1 - m^2 (1 - exp(-1 / m^2))) / 2",
        },
    ],
    splits: false,
    build,
};

#[derive(Debug)]
struct Coupled {
    specular: HalfVectorLobe<Kelemen>,
    curve: Arc<AlbedoCurve>,
    alpha: f64,
    rho: f64,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let (alpha, f0, f90) = (params.number("alpha"), params.number("f0"), params.number("f90"));
    let specular = kelemen::lobe(alpha, Fresnel::Schlick { f0, f90 });
    let curve =
        AlbedoCurve::shared(&format!("kelemen {alpha:e} {f0:e} {f90:e}"), &specular).ok_or_else(|| {
            ParamError::Together { model: INFO.id, why: "the specular lobe has no chart".to_owned() }
        })?;
    Ok(Box::new(Coupled { specular, curve, alpha, rho: params.number("rho") }))
}

impl Coupled {
    fn matte(&self, mu_o: f64, mu_i: f64) -> f64 {
        let average = self.curve.missing_average();
        if average <= 0.0 {
            return 0.0;
        }
        let product = self.curve.missing(mu_o).max(0.0) * self.curve.missing(mu_i).max(0.0);
        self.rho * FRAC_1_PI * product / average
    }

    /// Share of the samples that go to the specular lobe.
    fn share(&self, mu_o: f64) -> f64 {
        let e = self.curve.albedo(mu_o).clamp(0.0, 1.0);
        let rest = self.rho * (1.0 - e);
        if e + rest > 0.0 { (e / (e + rest)).clamp(0.05, 1.0) } else { 1.0 }
    }
}

impl Brdf for Coupled {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if !frame::both_above(wo, wi) {
            return 0.0;
        }
        self.specular.eval(wo, wi) + self.matte(wo.z, wi.z)
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let share = self.share(wo.z);
        let wi = if u.x < share {
            self.specular.sample(wo, DVec2::new(u.x / share, u.y))?.wi
        } else {
            let x = (u.x - share) / (1.0 - share);
            let (cos, sin) = special::circle(u.y);
            let r = x.sqrt();
            DVec3::new(r * cos, r * sin, (1.0 - x).max(0.0).sqrt())
        };
        (wi.z > 0.0).then(|| Sample { wi, pdf: self.pdf(wo, wi) })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        if !frame::both_above(wo, wi) {
            return 0.0;
        }
        let share = self.share(wo.z);
        share * self.specular.pdf(wo, wi) + (1.0 - share) * wi.z * FRAC_1_PI
    }

    /// That of the specular lobe, without an end: the matte lobe covers the hemisphere.
    fn chart(&self) -> Option<Chart> {
        Some(Chart::HalfVector { alpha: self.alpha, reach: f64::INFINITY, kinks: false })
    }

    /// `E + rho (1 - E)`.
    fn reduced_albedo(&self, mu_o: f64, tolerance: f64) -> Option<Estimate> {
        let mut e = directional_albedo(&self.specular, mu_o, tolerance)?;
        e.value[0] += self.rho * (1.0 - e.value[0]);
        Some(e)
    }
}
