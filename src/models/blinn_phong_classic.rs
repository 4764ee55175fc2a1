//! Blinn-Phong as textbooks write it as a BRDF: the half-vector lobe over the incident cosine.
//!
//! For comparison only; the faults are those of [`phong_classic`](super::phong_classic), and the repaired model is
//! [`blinn_phong`](super::blinn_phong).
//!
//! Recipe: `model = "blinn-phong-classic"`, `waive = [{ law = "reciprocity", reason = "comparison" }, ...]`.

use super::lambert::Lambert;
use super::lobes::{Blinn, Diffuse, Over, Part, Sum};
use super::phong::{KD, KS, N};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;
use std::f64::consts::PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "blinn-phong-classic",
    title: "Blinn-Phong, the textbook form over the cosine",
    formula: "f = kd + ks (n.wh)^n / mu_i",
    sources: &[
        (cite::BRDF_EXPLORER, "`blinnphong.brdf`, divided by n.l (the lobe)"),
        (cite::BLINN_1977, "the lobe"),
    ],
    params: &[KD, KS, N],
    laws: Laws { reciprocal: false, passive: false, isotropic: true },
    notes: "Not reciprocal, not passive: at n = 0, E = pi kd + 2 pi ks, and the flux that a grazing beam loses grows as 1 / mu_i without bound \
        (E here is the albedo seen under a uniform sky, which stays finite).",
    also: &[Alias { name: "blinn_phong_classic", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("kd", "0.125"), ("ks", "0.5"), ("n", "8")],
            value: 0.355_730_798_620_964_6,
            relative: 1e-13,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("kd", "0.25"), ("ks", "0.5"), ("n", "2")],
            value: PI,
            relative: 1e-11,
            source: "closed form: E(1) = pi kd + 8 pi ks (1 - 2^(-n/2 - 1)) / (n + 2)",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let (kd, ks, n) = (params.number("kd")?, params.number("ks")?, params.number("n")?);
    let mut lobe = Part::new(ks, Blinn { n, scale: 1.0, over: Over::Cosine });
    lobe.chance = 8.0 * PI * ks / (n + 2.0);
    Ok(Box::new(Sum::new(vec![Part::new(PI * kd, Diffuse(Lambert { rho: 1.0 })), lobe])))
}
