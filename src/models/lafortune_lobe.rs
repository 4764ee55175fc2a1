//! One generalised cosine lobe of Lafortune over a diffuse term, with its numbers as parameters of their own.
//!
//! What the numbers mean is said at [`lafortune`](super::lafortune), which takes any number of lobes.
//!
//! Recipe: `model = "lafortune-lobe"`, `params = { rho_d = 0.3, rho_s = 1.0, cx = -0.9, cy = -0.9, cz = 0.8, n = 20 }`.

use super::lafortune::part;
use super::lambert::Lambert;
use super::lobes::{Diffuse, Part, Sum};
use super::ward::RHO_D;
use super::{Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use std::f64::consts::PI;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "lafortune-lobe",
    title: "Lafortune, one cosine lobe",
    formula: "f = rho_d / pi + rho_s max(0, cx x_i x_o + cy y_i y_o + cz mu_i mu_o)^n",
    sources: &[
        (cite::LAFORTUNE_1997, "Eq. 4, by BBM (the generalised cosine lobe)"),
        (cite::BBM, "`lafortune.h`: the same form"),
    ],
    params: &[
        RHO_D,
        Param::number("rho_s", "rho_s", "factor of the lobe", [0.0, 1e7], DefaultValue::Value(1.0)),
        coefficient("cx", -1.0).also(&["Cx"]),
        coefficient("cy", -1.0).also(&["Cy"]),
        coefficient("cz", 1.0).also(&["Cz"]),
        Param::number("n", "n", "exponent", [0.0, 1e7], DefaultValue::Value(20.0)).swept(
            "n",
            [1.0, 1000.0],
            0.25,
        ),
    ],
    laws: Laws { reciprocal: true, passive: false, isotropic: false },
    notes: "Passive only if the parameters make it so: the lobe has E <= rho_s |C wo|^n 2 pi / (n + 2), with equality where C wo is along the normal. \
        The clamp at 0 is part of the model.",
    also: &[Alias { name: "lafortune_lobe", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([1.5, 0.25, 1.468_75, 3.375]),
            params: &[("rho_d", "0"), ("cx", "-0.5"), ("cy", "-0.75"), ("cz", "0.875"), ("n", "12")],
            value: 0.000_361_165_674_183_068_3,
            relative: 1e-12,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("rho_d", "0.25"), ("cz", "0.5"), ("n", "2")],
            value: 0.25 + PI / 8.0,
            relative: 1e-12,
            source: "closed form: E(1) = rho_d + rho_s cz^n 2 pi / (n + 2)",
        },
    ],
    splits: false,
    build,
};

const fn coefficient(id: &'static str, default: f64) -> Param {
    Param::number(id, id, "element of the diagonal matrix C", [-2.0, 2.0], DefaultValue::Value(default))
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let [rho_d, rho_s, cx, cy, cz, n] = params.numbers(["rho_d", "rho_s", "cx", "cy", "cz", "n"])?;
    Ok(Box::new(Sum::new(vec![
        Part::new(rho_d, Diffuse(Lambert { rho: 1.0 })),
        part(INFO.id, [cx, cy, cz], n, rho_s)?,
    ])))
}
