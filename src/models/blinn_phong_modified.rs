//! Modified Blinn-Phong of the textbooks: the half-vector lobe without the cosine below it, not normalised.
//!
//! Recipe: `model = "blinn-phong-modified"`, `waive = [{ law = "energy", reason = "comparison" }]`.

use super::blinn_phong::normal_albedo;
use super::lambert::Lambert;
use super::lobes::{Blinn, Diffuse, Over, Part, Sum};
use super::phong::{KD, KS, N};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;
use std::f64::consts::PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "blinn-phong-modified",
    title: "Blinn-Phong, modified, not normalised",
    formula: "f = kd + ks (n.wh)^n",
    sources: &[
        (cite::BRDF_EXPLORER, "`blinnphong.brdf`, not divided by n.l (the lobe)"),
        (cite::BLINN_1977, "the lobe"),
    ],
    params: &[KD, KS, N],
    laws: Laws { reciprocal: true, passive: false, isotropic: true },
    notes: "Not passive: E(1) = pi kd + 8 pi ks (n + 2^(-n/2)) / ((n + 2)(n + 4)), which is pi (kd + ks) at n = 0 and dims as n grows.",
    also: &[Alias { name: "blinn_phong_modified", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("kd", "0.125"), ("ks", "0.5"), ("n", "8")],
            value: 0.348_557_936_855_069_9,
            relative: 1e-13,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("kd", "0.25"), ("ks", "0.5"), ("n", "2")],
            value: 0.25 * PI + 0.5 * PI * 20.0 / 24.0,
            relative: 1e-11,
            source: "closed form: E(1) = pi kd + 8 pi ks (n + 2^(-n/2)) / ((n + 2)(n + 4))",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let (kd, ks, n) = (params.number("kd")?, params.number("ks")?, params.number("n")?);
    let mut lobe = Part::new(ks, Blinn { n, scale: 1.0, over: Over::Nothing });
    lobe.chance = ks * normal_albedo(n);
    Ok(Box::new(Sum::new(vec![Part::new(PI * kd, Diffuse(Lambert { rho: 1.0 })), lobe])))
}
