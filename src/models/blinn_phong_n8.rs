//! Blinn-Phong with the normalisation (n + 8) / (8 pi) that games used: a rational fit to the exact one.
//!
//! Recipe: `model = "blinn-phong-n8"`, `params = { kd = 0.3, ks = 0.6, n = 200 }`.

use super::blinn_phong::normal_albedo;
use super::lambert::Lambert;
use super::lobes::{Blinn, Diffuse, Over, Part, Sum};
use super::phong::{KD, KS, N};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;
use std::f64::consts::PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "blinn-phong-n8",
    title: "Blinn-Phong, normalised by (n + 8) / (8 pi)",
    formula: "f = kd / pi + ks (n + 8) / (8 pi) (n.wh)^n",
    sources: &[(cite::BLINN_1977, "the lobe; the factor is folklore of game rendering")],
    params: &[KD, KS, N],
    laws: Laws { reciprocal: true, passive: false, isotropic: true },
    notes: "Not passive: E(1) = kd + ks (n + 8)(n + 2^(-n/2)) / ((n + 2)(n + 4)), at most 1.0752 ks at n = 8.75, and ks at n = 0 and as n -> infinity.",
    also: &[Alias { name: "blinn_phong_n8", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("kd", "0"), ("ks", "1"), ("n", "8")],
            value: 0.284_642_805_743_281_45,
            relative: 1e-13,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("kd", "0"), ("ks", "1"), ("n", "2")],
            value: 25.0 / 24.0,
            relative: 1e-11,
            source: "closed form: E(1) = (n + 8)(n + 2^(-n/2)) / ((n + 2)(n + 4))",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let (kd, ks, n) = (params.number("kd")?, params.number("ks")?, params.number("n")?);
    let scale = (n + 8.0) / (8.0 * PI);
    let mut lobe = Part::new(ks, Blinn { n, scale, over: Over::Nothing });
    lobe.chance = ks * scale * normal_albedo(n);
    Ok(Box::new(Sum::new(vec![Part::new(kd, Diffuse(Lambert { rho: 1.0 })), lobe])))
}
