//! A smooth dielectric interface: perfect reflection and perfect refraction, both deltas in direction.
//!
//! Recipe: `model = "smooth-glass"`, `params = { eta = 1.5 }`. eta below 1 is the view from inside, with total internal
//! reflection. `eval` has no value to give; `albedo` prints R and T, which are exact.

use super::microfacet::ETA_DIELECTRIC;
use super::{Alias, Brdf, Btdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params, Sample};
use crate::cite;
use crate::integrate::{Chart, Estimate, View};
use crate::terms::fresnel;
use glam::{DVec2, DVec3};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "smooth-glass",
    title: "Smooth dielectric interface: perfect reflection and refraction",
    formula: "f_r = F delta(wi - wr) / mu_o, f_t = (n_o / n_i)^2 (1 - F) delta(wi - wt) / |mu_i|, n_o sin_o = n_i sin_t; F = 1 beyond sin_o = n_i / n_o",
    sources: &[
        (cite::BORN_WOLF_1999, "section 1.5.1 (Snell), 1.5.2 (F), 1.5.4 (total reflection)"),
        (cite::WALTER_2007, "Eq. 22 (F), 40 (refracted direction)"),
    ],
    params: &[ETA_DIELECTRIC.swept("eta", [1.2, 2.5], 1.0)],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "E is the reflected part F(mu), T = 1 - F the part of the flux that crosses. Radiance changes by (n_o / n_i)^2 on its way \
        across, flux does not. Critical cosine from inside: sqrt(1 - eta^2). The tables `fresnel-dielectric` hold F from both sides.",
    also: &[Alias { name: "perfect-refraction", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("eta", "1.5")],
            value: 0.04,
            relative: 1e-15,
            source: "closed form: ((eta - 1) / (eta + 1))^2",
        },
        Known {
            what: KnownValue::Albedo(0.5),
            params: &[("eta", "0.5")],
            value: 1.0,
            relative: 1e-15,
            source: "closed form: 60 degrees is beyond the critical angle of 30 degrees",
        },
    ],
    splits: false,
    build,
};

#[derive(Debug)]
struct SmoothGlass {
    eta: f64,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(SmoothGlass { eta: params.number("eta")? }))
}

/// 0, `None` and 0: deltas have no value and no density.
impl Brdf for SmoothGlass {
    fn eval(&self, _wo: DVec3, _wi: DVec3) -> f64 {
        0.0
    }

    fn sample(&self, _wo: DVec3, _u: DVec2) -> Option<Sample> {
        None
    }

    fn pdf(&self, _wo: DVec3, _wi: DVec3) -> f64 {
        0.0
    }

    fn chart(&self) -> Option<Chart> {
        None
    }

    fn mirror(&self, mu_o: f64) -> Option<f64> {
        Some(fresnel::dielectric(mu_o, self.eta).unpolarised())
    }

    fn transmission(&self) -> Option<&dyn Btdf> {
        Some(self)
    }
}

impl Btdf for SmoothGlass {
    fn eval(&self, _wo: DVec3, _wi: DVec3) -> f64 {
        0.0
    }

    fn sample(&self, _wo: DVec3, _u: DVec2) -> Option<Sample> {
        None
    }

    fn pdf(&self, _wo: DVec3, _wi: DVec3) -> f64 {
        0.0
    }

    fn albedo(&self, view: View, _tolerance: f64) -> Estimate {
        Estimate::exact_one(fresnel::dielectric_transmittance(view.mu, self.eta).unpolarised())
    }
}
