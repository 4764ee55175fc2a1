//! What a conversion does to the light: the reflectance E of the lobe that was told against that of the GGX lobe that is written.

use super::{By, Conversion, Converted};
use crate::models::{self, Brdf, ParamError, Params};
use glam::DVec3;
use serde_json::Value as Json;
use std::f64::consts::{FRAC_PI_2, TAU};

/// View cosines of the comparison, over [0.05, 1].
pub const COSINES: [f64; 8] = [0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0];

/// Rings of the narrow and of the broad set of nodes, and sectors.
const RINGS: [usize; 2] = [48, 24];
const SECTORS: usize = 64;

/// Width of the broad set.
const BROAD: f64 = 1.0;

/// The difference of two reflectances over [`COSINES`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gap {
    /// Largest |E of GGX − E of the lobe|.
    pub largest: f64,
    /// The view cosine where it is.
    pub mu: f64,
    /// Most that GGX reflects above the lobe, where that gains energy: E above the lobe's, or 0.
    pub gained: f64,
}

impl Conversion {
    /// The largest difference of E over view cosines in [0.05, 1], Fresnel's factor 1, along both axes.
    ///
    /// The lobe is the model that [`Conversion::model`] names, the other one GGX with height-correlated masking. Accuracy: 2e-3 (the sum of
    /// `energy.rs`; `tests/conversions.rs`). What is GGX already has no difference.
    ///
    /// # Errors
    /// [`ParamError`] if a number is outside the range of the model.
    pub fn gap(&self, numbers: [f64; 2], converted: &Converted) -> Result<Gap, ParamError> {
        let Some(model) = self.model else { return Ok(Gap::default()) };
        let (id, given) = model(numbers);
        let lobe = built(id, &given)?;
        let alphas = converted.alphas.map(|a| a.clamp(1e-3, 1.0));
        let ggx = built("ggx", &[("alpha_x", alphas[0]), ("alpha_y", alphas[1]), ("f0", 1.0)])?;
        let azimuths: &[f64] =
            if numbers[0].total_cmp(&numbers[1]).is_eq() { &[0.0] } else { &[0.0, FRAC_PI_2] };
        let narrow = alphas[0].min(alphas[1]);
        let mut out = Gap { mu: 1.0, ..Gap::default() };
        for mu in COSINES {
            for phi in azimuths {
                let sin = (1.0 - mu * mu).max(0.0).sqrt();
                let (s, c) = libm::sincos(*phi);
                let wo = DVec3::new(sin * c, sin * s, mu);
                let nodes = nodes(wo, narrow);
                let difference = reflectance(&*ggx, wo, &nodes) - reflectance(&*lobe, wo, &nodes);
                if difference.abs() > out.largest {
                    (out.largest, out.mu) = (difference.abs(), mu);
                }
                out.gained = out.gained.max(difference);
            }
        }
        Ok(out)
    }

    /// The conversion with its gap.
    ///
    /// # Errors
    /// As [`Conversion::gap`].
    pub fn certified(&self, numbers: [f64; 2], by: By) -> Result<(Converted, Gap), ParamError> {
        let converted = self.convert(numbers, by);
        Ok((converted, self.gap(numbers, &converted)?))
    }
}

fn built(id: &str, given: &[(&str, f64)]) -> Result<Box<dyn Brdf>, ParamError> {
    let Some((info, _)) = models::find(id) else {
        return Err(ParamError::Together { model: "to-ggx", why: format!("there is no model {id}") });
    };
    let values: Vec<(&str, Json)> = given.iter().map(|(k, v)| (*k, Json::from(*v))).collect();
    (info.build)(&Params::resolve(info.id, info.params, values.iter().map(|(k, v)| (*k, v)))?)
}

/// Directions with their solid angles, by half vectors as dense as GGX lobes of two widths: dωi = 4 (wo·wm) dωm. At grazing a lobe is far narrower
/// across the plane of incidence than along it, which rings about the mirror direction would miss.
fn nodes(wo: DVec3, alpha: f64) -> Vec<(DVec3, f64)> {
    let charts = [(alpha, RINGS[0]), (BROAD, RINGS[1])];
    // rings per radian of tan(theta) = a sqrt(u/(1 - u))
    let density = |tangent: f64, (a, rings): (f64, usize)| {
        let q = a * a + tangent * tangent;
        rings as f64 * 2.0 * tangent * a * a * (1.0 + tangent * tangent) / (q * q)
    };
    let mut out = Vec::with_capacity((RINGS[0] + RINGS[1]) * SECTORS);
    for (a, rings) in charts {
        for ring in 0..rings {
            let u = (ring as f64 + 0.5) / rings as f64;
            let tangent = a * (u / (1.0 - u)).sqrt();
            let (sin, cos) = libm::sincos(libm::atan(tangent));
            let area = sin * TAU / SECTORS as f64 / charts.map(|c| density(tangent, c)).iter().sum::<f64>();
            for sector in 0..SECTORS {
                let (s, c) = libm::sincos(TAU * (sector as f64 + 0.5) / SECTORS as f64);
                let wm = DVec3::new(sin * c, sin * s, cos);
                let along = wo.dot(wm);
                let wi = wm * (2.0 * along) - wo;
                if along > 0.0 && wi.z > 0.0 {
                    out.push((wi, 4.0 * along * area));
                }
            }
        }
    }
    out
}

fn reflectance(brdf: &dyn Brdf, wo: DVec3, nodes: &[(DVec3, f64)]) -> f64 {
    nodes.iter().map(|(wi, area)| area * brdf.eval(wo, *wi) * wi.z).sum()
}
