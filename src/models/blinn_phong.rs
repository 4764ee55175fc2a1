//! Blinn-Phong with its exact normalisation: the half-vector lobe, with E = ks at normal incidence.
//!
//! For the same highlight the exponent is about four times Phong's. n = 40 is dull plastic, 400 polished wood.
//! Close to a Beckmann lobe of `alpha^2 = 2 / (n + 2)` without masking.
//!
//! Recipe: `model = "blinn-phong"`, `params = { kd = 0.3, ks = 0.6, n = 200 }`.

use super::lambert::Lambert;
use super::lobes::{Blinn, Diffuse, Over, Part, Sum};
use super::phong::{KD, KS, N, at_most_one};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;
use std::f64::consts::PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "blinn-phong",
    title: "Blinn-Phong, exact normalisation",
    formula: "f = kd / pi + ks C (n.wh)^n, C = (n + 2)(n + 4) / (8 pi (n + 2^(-n/2)))",
    sources: &[
        (cite::BLINN_1977, "the lobe"),
        (cite::BRDF_EXPLORER, "`blinnphong.brdf`, not divided by n.l (the lobe; its norm is derived here)"),
    ],
    params: &[KD, KS, N],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "kd + ks may not exceed 1. C makes int C (n.wh)^n mu dw = 1 at normal incidence; E falls off from there, to ks mu^2 as n -> infinity.",
    also: &[Alias { name: "blinn_phong_normalised_exact", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("kd", "0"), ("ks", "1"), ("n", "8")],
            value: 0.264_784_005_342_587_4,
            relative: 1e-13,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("kd", "0.25"), ("ks", "0.5"), ("n", "100")],
            value: 0.75,
            relative: 1e-11,
            source: "closed form: E(1) = kd + ks",
        },
    ],
    splits: false,
    build,
};

/// `int (n.wh)^n mu dw = 8 pi (n + 2^(-n/2)) / ((n + 2)(n + 4))` at normal incidence.
pub(super) fn normal_albedo(n: f64) -> f64 {
    8.0 * PI * (n + libm::exp2(-0.5 * n)) / ((n + 2.0) * (n + 4.0))
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let [kd, ks] = at_most_one(INFO.id, params, ["kd", "ks"])?;
    let n = params.number("n")?;
    Ok(Box::new(Sum::new(vec![
        Part::new(kd, Diffuse(Lambert { rho: 1.0 })),
        Part::new(ks, Blinn { n, scale: 1.0 / normal_albedo(n), over: Over::Nothing }),
    ])))
}
