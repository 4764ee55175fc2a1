//! Student's t distribution of slopes (STD): GGX, Beckmann, and everything between and beyond.
//!
//! Recipe: `model = "student-t"`, `params = { gamma = 4, f0 = 0.04 }`. gamma = 2 is GGX, above 100 nearly Beckmann, below 2 the
//! tails are longer than GGX's.

use super::microfacet::{self, ALPHA, ALPHA_X, ALPHA_Y, F0, F90, Fresnel, MASKING, StudentT};
use super::{Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "student-t",
    title: "Student's t facets, Schlick Fresnel",
    formula: "f = F(wo.wh) D(wh) G2(wo, wi) / (4 mu_o mu_i), D = (1 + X / (gamma - 1))^(-gamma) / (pi ax ay cos^4), X = tan^2 / alpha^2",
    sources: &[
        (cite::RIBARDIERE_2017, "Eq. 18, by appleseed (D), 13 to 15, by BBM (Lambda)"),
        (cite::APPLESEED, "`StdMDF::D`: the same form"),
        (cite::BBM, "`ndf/studentt.h`: the same Lambda, by a fit"),
        (cite::HEITZ_2014, "Eq. 99 (correlated G2)"),
        (cite::SCHLICK_1994, "Eq. 15 (F)"),
    ],
    params: &[
        ALPHA,
        ALPHA_X,
        ALPHA_Y,
        Param::number(
            "gamma",
            "gamma",
            "exponent of the tail: 2 is GGX, large is Beckmann; above 3/2, where the masking is finite",
            [1.501, 1e8],
            DefaultValue::Value(4.0),
        ),
        F0,
        F90,
        MASKING,
    ],
    laws: Laws { reciprocal: true, passive: true, isotropic: false },
    notes: "Exact masking, not the fit of the paper. Below gamma = 2 D grows without bound at the horizon, integrably, where \
        quadrature converges slowly. alpha = 0 is the mirror.",
    also: &[Alias { name: "std_smith_correlated", set: &[("masking", "correlated")] }],
    known: &[
        Known {
            what: KnownValue::Value([0.0, 0.0, 0.75, 0.0]),
            params: &[("alpha", "1"), ("gamma", "10")],
            value: 0.119_280_672_136_647_57,
            relative: 1e-12,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("alpha", "1"), ("gamma", "2")],
            value: 0.306_852_819_440_054_7,
            relative: 1e-10,
            source: "closed form: gamma = 2 is GGX, and that at alpha = 1 is the Lommel-Seeliger law, E(1) = 1 - ln 2",
        },
    ],
    splits: true,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let fresnel = Fresnel::Schlick { f0: params.number("f0")?, f90: params.number("f90")? };
    let gamma = params.number("gamma")?;
    microfacet::build(INFO.id, params, |x, y| StudentT::new(x, y, gamma), fresnel)
}
