//! Phong's shading formula of 1975: what is added to the colour of a pixel, not a BRDF.
//!
//! The value contains the falloff of the light already and must not be multiplied by a cosine. It is here so that the
//! lecture's formula can be evaluated; an albedo of it has no meaning, though one can be computed.
//! The clamp is needed: with an even exponent a negative base would give a ghost lobe.
//!
//! Recipe: for `brdfbake eval` only.

use super::lobes::{Cosine, Diffuse, Over, Part, Reflector, Sum};
use super::phong::{KD, KS, N};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;
use crate::integrate::Chart;
use glam::DVec3;
use std::f64::consts::PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "phong-shading",
    title: "Phong's shading formula, 1975 (not a BRDF)",
    formula: "I = kd mu_i + ks max(0, R.wo)^n",
    sources: &[(cite::PHONG_1975, "the shading formula")],
    params: &[KD, KS, N],
    laws: Laws { reciprocal: false, passive: false, isotropic: true },
    notes: "A shading value, not a BRDF: it includes its own falloff. Not reciprocal; energy is not defined for it.",
    also: &[Alias { name: "phong_seed_shading", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("kd", "0.5"), ("ks", "0.5"), ("n", "8")],
            value: 0.501_247_484_769_005_7,
            relative: 1e-13,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(0.3),
            params: &[("kd", "0.5"), ("ks", "0")],
            value: PI / 3.0,
            relative: 1e-12,
            source: "closed form: kd int mu_i^2 dwi = 2 pi kd / 3",
        },
    ],
    splits: false,
    build,
};

/// The diffuse term with its falloff.
#[derive(Debug)]
struct Falloff;

impl Reflector for Falloff {
    fn f(&self, _wo: DVec3, wi: DVec3) -> f64 {
        wi.z
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::Hemisphere)
    }
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let (kd, ks, n) = (params.number("kd")?, params.number("ks")?, params.number("n")?);
    Ok(Box::new(Sum::new(vec![
        Part::new(kd, Diffuse(Falloff)),
        Part::new(ks, Cosine::phong(n, 1.0, Over::Nothing)),
    ])))
}
