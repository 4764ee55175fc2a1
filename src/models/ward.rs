//! Ward's anisotropic Gaussian lobe of 1992, with the exact exponent.
//!
//! `alpha_x` and `alpha_y` are RMS-like slopes along the tangent and across it: 0.05 is polished metal, 0.2 brushed
//! metal across the brush, 0.5 the roughest that the model was meant for. Close to the mirror direction it looks like a
//! Beckmann lobe, but it loses energy at moderate angles and gains it without bound at grazing.
//!
//! Recipe: `model = "ward"`, `params = { rho_d = 0.3, rho_s = 0.4, alpha_x = 0.1, alpha_y = 0.3 }`.

use super::lambert::Lambert;
use super::lobes::{Diffuse, Norm, Part, Sum, Ward};
use super::microfacet::{ALPHA, ALPHA_X, ALPHA_Y};
use super::{Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "ward",
    title: "Ward 1992",
    formula: "f = rho_d / pi + rho_s exp(-X) / (4 pi alpha_x alpha_y sqrt(mu_i mu_o)), \
        X = tan^2(theta_h) (cos^2(phi_h) / alpha_x^2 + sin^2(phi_h) / alpha_y^2)",
    sources: &[
        (cite::WARD_1992, "the elliptical Gaussian lobe"),
        (cite::MITSUBA, "`ward.cpp`, variant ward: the same form"),
        (cite::WALTER_2005, "sampling and its weights"),
    ],
    params: &PARAMS,
    laws: Laws { reciprocal: true, passive: false, isotropic: false },
    notes: "Not passive: E grows as mu^(-1/2) at grazing (2.37 at theta = 1.57, alpha = 0.7), so start the mu axis above 0; \
        elsewhere it loses energy, E -> rho_s mu as alpha -> 0. Widths below 1e-7 count as 1e-7.",
    also: &[Alias { name: "ward_1992_exact_exponent", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("rho_d", "0.25"), ("rho_s", "0.5"), ("alpha_x", "0.5"), ("alpha_y", "0.125")],
            value: 0.081_788_994_206_152_99,
            relative: 1e-13,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("rho_d", "0"), ("rho_s", "1"), ("alpha", "0.5")],
            value: 0.585_490_376_444_347_2,
            relative: 1e-11,
            source: "one-dimensional integral: int_0^1 exp(-t/a^2)/a^2 sqrt(1-t) (1+t)^(-5/2) dt",
        },
    ],
    splits: false,
    build,
};

/// The parameters of all four.
pub(super) const PARAMS: [Param; 5] = [RHO_D, RHO_S, ALPHA, ALPHA_X, ALPHA_Y];

/// `rho_d`.
pub(super) const RHO_D: Param =
    Param::number("rho_d", "rho_d", "diffuse reflectance", [0.0, 1.0], DefaultValue::Value(0.5));
/// `rho_s`.
pub(super) const RHO_S: Param =
    Param::number("rho_s", "rho_s", "specular reflectance", [0.0, 1.0], DefaultValue::Value(0.5));

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    assemble(params.numbers(["rho_d", "rho_s"])?, params, Norm::Ward)
}

/// A diffuse part and a lobe in one of its normalisations.
///
/// # Errors
/// [`ParamError`] for widths that are not declared.
pub(super) fn assemble(
    [rho_d, rho_s]: [f64; 2],
    params: &Params,
    norm: Norm,
) -> Result<Box<dyn Brdf>, ParamError> {
    let lobe = Ward::new(params.number("alpha_x")?, params.number("alpha_y")?, norm);
    Ok(Box::new(Sum::new(vec![Part::new(rho_d, Diffuse(Lambert { rho: 1.0 })), Part::new(rho_s, lobe)])))
}
