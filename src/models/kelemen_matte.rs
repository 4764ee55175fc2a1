//! Kelemen and Szirmay-Kalos' coupled model: the specular lobe, and a matte one that gets exactly what it leaves.
//!
//! Recipe: `model = "kelemen-matte"`, `params = { alpha = 0.2, f0 = 0.04, rho = 0.5 }`: polished wood, plastic, skin. The matte lobe
//! darkens where the specular one takes the light.

use super::albedo_curve::{AlbedoCurve, TOLERANCE};
use super::lobes::{Diffuse, Part, Reflector, Sum};
use super::microfacet::{F90, Fresnel};
use super::{Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params, kelemen};
use crate::cite;
use crate::integrate::Chart;
use crate::terms::multiple_scattering;
use glam::DVec3;
use std::sync::Arc;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "kelemen-matte",
    title: "Kelemen/Szirmay-Kalos specular over a coupled matte base",
    formula: "f = f_s + rho (1 - E(mu_o))(1 - E(mu_i)) / (pi (1 - E_avg)), f_s the lobe of `kelemen` with its Fresnel factor, E its albedo",
    sources: &[(cite::KELEMEN_2001, "section 3 (the matte part), section 2 (f_s)")],
    params: &[
        Param::number("alpha", "alpha", "width of the specular lobe", [1e-3, 2.0], DefaultValue::Value(0.25))
            .also(&["m"]),
        Param::number("f0", "F0", "reflectance at normal incidence", [0.0, 0.99], DefaultValue::Value(0.04))
            .also(&["F0"]),
        F90,
        Param::number("rho", "rho", "reflectance of the matte base", [0.0, 1.0], DefaultValue::Value(0.5))
            .also(&["kd", "k_d"]),
    ],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "E_total = E + rho (1 - E), so rho = 1 reflects everything. The curve E(mu) is integrated when the model is built, \
        to about 1e-8; it is what limits the accuracy of the matte part.",
    also: &[],
    known: &[
        Known {
            what: KnownValue::Albedo(0.4),
            params: &[("alpha", "0.3"), ("rho", "1")],
            value: 1.0,
            relative: 1e-6,
            source: "white furnace: E + (1 - E)",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("alpha", "0.25"), ("f0", "0.5"), ("f90", "0.5"), ("rho", "0.5")],
            value: 0.5 + 0.25 * 0.937_500_007_033_448_4,
            relative: 1e-6,
            source: "closed form: E + (1 - E) / 2 with E = (1 - m^2 (1 - exp(-1 / m^2))) / 2",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let (alpha, f0, f90) = (params.number("alpha")?, params.number("f0")?, params.number("f90")?);
    let rho = params.number("rho")?;
    let specular = kelemen::lobe(alpha, Fresnel::Schlick { f0, f90 });
    let curve = AlbedoCurve::shared(&format!("kelemen {alpha:e} {f0:e} {f90:e}"), &specular, TOLERANCE);
    let average = curve.missing_average();
    let specular = Part { weight: 1.0, chance: 1.0 - average, lobe: Box::new(specular) };
    let matte = Part { weight: rho, chance: rho * average, lobe: Box::new(Diffuse(Matte { curve })) };
    Ok(Box::new(Sum::new(vec![specular, matte])))
}

/// What the specular lobe leaves, for a white base.
#[derive(Debug)]
struct Matte {
    curve: Arc<AlbedoCurve>,
}

impl Reflector for Matte {
    fn f(&self, wo: DVec3, wi: DVec3) -> f64 {
        let missing = |mu| self.curve.missing(mu).max(0.0);
        multiple_scattering::kulla_conty(missing(wo.z), missing(wi.z), self.curve.missing_average())
    }

    fn albedo(&self, mu_o: f64) -> Option<f64> {
        Some(self.curve.missing(mu_o).max(0.0))
    }

    fn own_error(&self, mu_o: f64) -> f64 {
        self.curve.error_at(mu_o)
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Broad { kinks: false, floor: 0.0 })
    }
}
