//! Phong's lobe as textbooks write it as a BRDF: divided by the incident cosine, not normalised, not reciprocal.
//!
//! For comparison only. As a BRDF it is wrong in three ways: it is not reciprocal, `kd` is 1/pi short, and light that
//! grazes the surface is reflected without bound. [`phong`](super::phong) is the repaired model.
//!
//! Recipe: `model = "phong-classic"`, `waive = [{ law = "reciprocity", reason = "comparison" }, ...]`.

use super::lambert::Lambert;
use super::lobes::{Cosine, Diffuse, Over, Part, Sum};
use super::phong::{KD, KS, N};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;
use std::f64::consts::{PI, TAU};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "phong-classic",
    title: "Phong, the textbook form over the cosine",
    formula: "f = kd + ks max(0, R.wo)^n / mu_i",
    sources: &[
        (cite::BRDF_EXPLORER, "`phong.brdf`, divided by n.l (the lobe)"),
        (cite::PHONG_1975, "the lobe"),
    ],
    params: &[KD, KS, N],
    laws: Laws { reciprocal: false, passive: false, isotropic: true },
    notes: "Not reciprocal, not passive: E(1) = pi kd + 2 pi ks / (n + 1), and the flux that a grazing beam loses grows as 1 / mu_i without bound \
        (E here is the albedo seen under a uniform sky, which stays finite). kd + ks <= 1 means nothing for this form.",
    also: &[Alias { name: "phong_classic", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("kd", "0.125"), ("ks", "0.5"), ("n", "8")],
            value: 0.142_330_022_339_932_2,
            relative: 1e-13,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("kd", "0.25"), ("ks", "0.5"), ("n", "9")],
            value: 0.35 * PI,
            relative: 1e-12,
            source: "closed form: E(1) = pi kd + 2 pi ks / (n + 1)",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let (kd, ks, n) = (params.number("kd")?, params.number("ks")?, params.number("n")?);
    let mut lobe = Part::new(ks, Cosine::phong(n, 1.0, Over::Cosine));
    lobe.chance = ks * TAU / (n + 1.0);
    let mut matte = Part::new(PI * kd, Diffuse(Lambert { rho: 1.0 }));
    matte.chance = PI * kd;
    Ok(Box::new(Sum::new(vec![matte, lobe])))
}
