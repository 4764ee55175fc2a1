//! Lafortune's sum of generalised cosine lobes: the classic fit to measured reflectance, with any number of lobes.
//!
//! A lobe is a row `[cx, cy, cz, n, rho]`. `cx = cy = -1, cz = 1` is Phong's mirror lobe (with rho = (n + 2)/(2 pi) its
//! normalised form), cx, cy > 0 is retro-reflection, |cx| > cz is an off-specular peak, and cx != cy is anisotropic.
//! A published fit, blue house paint in red light: rho_d = 0.3264 and lobes [0.87, 0.87, 0.774, 21.8, ...],
//! [-0.451, -0.451, 0.023, 3.03, ...], [-1.03, -1.03, 0.707, 66.9, ...].
//!
//! Recipe: `model = "lafortune"`, `params = { rho_d = 0.3, lobes = [[-1, -1, 1, 20, 1.5], [0.9, 0.9, 0.8, 10, 0.2]] }`.
//! A single lobe whose numbers can sweep axes is [`lafortune_lobe`](super::lafortune_lobe).

use super::lambert::Lambert;
use super::lobes::{Cosine, Diffuse, Over, Part, Sum};
use super::param::Column;
use super::ward::RHO_D;
use super::{Brdf, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::math::figures::exact;
use std::f64::consts::TAU;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "lafortune",
    title: "Lafortune, sum of cosine lobes",
    formula: "f = rho_d / pi + sum_j rho_j max(0, cx_j x_i x_o + cy_j y_i y_o + cz_j mu_i mu_o)^n_j",
    sources: &[
        (cite::LAFORTUNE_1997, "Eq. 4, by BBM (the generalised cosine lobe)"),
        (cite::BBM, "`lafortune.h`: the same form"),
    ],
    params: &[RHO_D, Param::rows("lobes", "the lobes", COLUMNS, &[&[-1.0, -1.0, 1.0, 20.0, 1.0]])],
    laws: Laws { reciprocal: true, passive: false, isotropic: false },
    notes: "Passive only if the parameters make it so: a lobe has E <= rho |C wo|^n 2 pi / (n + 2), with equality where C wo is along the normal. \
        The clamp at 0 is part of the model.",
    also: &[],
    known: &[Known {
        what: KnownValue::Albedo(1.0),
        params: &[("rho_d", "0.25"), ("lobes", "[[-1, -1, 0.5, 2, 1], [0.5, 0.5, 1, 6, 0.125]]")],
        value: 0.25 + TAU / 16.0 + TAU / 64.0,
        relative: 1e-12,
        source: "closed form: E(1) = rho_d + sum rho cz^n 2 pi / (n + 2)",
    }],
    splits: false,
    build,
};

const COLUMNS: &[Column] = &[
    Column { id: "cx", min: -2.0, max: 2.0 },
    Column { id: "cy", min: -2.0, max: 2.0 },
    Column { id: "cz", min: -2.0, max: 2.0 },
    Column { id: "n", min: 0.0, max: 1e7 },
    Column { id: "rho", min: 0.0, max: 1e7 },
];

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let rho_d = params.number("rho_d")?;
    let mut parts = vec![Part::new(rho_d, Diffuse(Lambert { rho: 1.0 }))];
    for row in params.rows("lobes")? {
        if let &[cx, cy, cz, n, rho] = row.as_slice() {
            parts.push(part(INFO.id, [cx, cy, cz], n, rho)?);
        }
    }
    Ok(Box::new(Sum::new(parts)))
}

/// A lobe, drawn as often as its largest albedo says.
///
/// # Errors
/// [`ParamError::Together`] if its peak leaves the range of f64.
pub(super) fn part(model: &'static str, c: [f64; 3], n: f64, rho: f64) -> Result<Part, ParamError> {
    let longest = c.iter().fold(0.0f64, |m, c| m.max(c.abs()));
    let log_peak = n * libm::log(longest.max(f64::MIN_POSITIVE));
    if log_peak > 600.0 {
        let why = format!(
            "a lobe with |C| = {} and n = {} has a peak of e^{log_peak:.0}, beyond all numbers; lower one of them",
            exact(longest),
            exact(n)
        );
        return Err(ParamError::Together { model, why });
    }
    let mut part = Part::new(rho, Cosine { c, n, scale: 1.0, over: Over::Nothing });
    part.chance = (rho * libm::exp(log_peak) * TAU / (n + 2.0)).min(1.0);
    Ok(part)
}
