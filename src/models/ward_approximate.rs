//! Ward's lobe with the approximate exponent that his paper offers for speed, and that lectures teach as the model.
//!
//! It is another BRDF, not a cheap identity: `X - Xs = 3/4 theta_h^4 / alpha^2` for narrow lobes, so at two widths off
//! the peak it is 1.13 times too bright at alpha = 0.1 and 2.1 times at 0.25. H must be normalised.
//! Parameters as in [`ward`](super::ward).
//!
//! Recipe: `model = "ward-approximate"`, `params = { rho_d = 0.3, rho_s = 0.4, alpha = 0.2 }`.

use super::lobes::Norm;
use super::ward::{PARAMS, assemble};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "ward-approximate",
    title: "Ward 1992, approximate exponent",
    formula: "f = rho_d / pi + rho_s exp(-Xs) / (4 pi alpha_x alpha_y sqrt(mu_i mu_o)), \
        Xs = 2 ((wh.x / alpha_x)^2 + (wh.y / alpha_y)^2) / (1 + wh.z)",
    sources: &[(cite::WARD_1992, "the elliptical Gaussian lobe, its approximation for speed")],
    params: &PARAMS,
    laws: Laws { reciprocal: true, passive: false, isotropic: false },
    notes: "Not passive: E grows as mu^(-1/2) at grazing (4.8 at theta = 1.57, alpha = 1), so start the mu axis above 0. \
        Widths below 1e-7 count as 1e-7.",
    also: &[Alias { name: "ward_seed_approx_exponent", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("rho_d", "0.25"), ("rho_s", "0.5"), ("alpha_x", "0.5"), ("alpha_y", "0.125")],
            value: 0.084_726_311_446_284_69,
            relative: 1e-13,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("rho_d", "0"), ("rho_s", "1"), ("alpha", "0.5")],
            value: 0.655_588_967_972_667_5,
            relative: 1e-11,
            source: "one-dimensional integral: 2/a^2 int exp(-2(1-c)/a^2) sqrt(2c^2-1) c dc over c in (1/sqrt 2, 1)",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    assemble(params.numbers(["rho_d", "rho_s"])?, params, Norm::Approximate)
}
