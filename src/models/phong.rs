//! Phong, normalised by Lafortune and Willems: a lobe round the mirror direction that conserves energy.
//!
//! n = 10 is dull plastic, 100 polished wood, 1e4 nearly a mirror; the lobe is about 2 / sqrt(n) rad wide. Unlike a
//! microfacet lobe it keeps its shape at grazing angles, and loses what falls below the horizon.
//!
//! Recipe: `model = "phong"`, `params = { kd = 0.3, ks = 0.6, n = 50 }`.

use super::lambert::Lambert;
use super::lobes::{Cosine, Diffuse, Over, Part, Sum};
use super::{Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::math::figures::exact;
use std::f64::consts::{FRAC_1_PI, TAU};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "phong",
    title: "Phong, normalised (Lafortune and Willems 1994)",
    formula: "f = kd / pi + ks (n + 2) / (2 pi) max(0, R.wo)^n, R = 2 (n.wi) n - wi",
    sources: &[
        (cite::LAFORTUNE_WILLEMS_1994, "the modified Phong model"),
        (cite::MITSUBA, "`phong.cpp`: the same form"),
        (cite::PHONG_1975, "the lobe"),
    ],
    params: &[KD, KS, N],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "kd + ks may not exceed 1. The lobe has E = ks at normal incidence and less elsewhere: ks mu as n -> infinity. \
        At mu = 0 it keeps ks (n + 2) / (2 pi) B((n + 1)/2, 3/2).",
    also: &[Alias { name: "phong_lafortune_willems", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("kd", "0"), ("ks", "1"), ("n", "8")],
            value: 0.053_448_284_883_453_77,
            relative: 1e-13,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("kd", "0.25"), ("ks", "0.5"), ("n", "1000")],
            value: 0.75,
            relative: 1e-12,
            source: "closed form: E(1) = kd + ks",
        },
        Known {
            what: KnownValue::Albedo(0.0),
            params: &[("kd", "0"), ("ks", "1"), ("n", "4")],
            value: 0.1875,
            relative: 1e-11,
            source: "closed form: E(0) = 3/pi B(5/2, 3/2) = 3/16",
        },
        Known {
            what: KnownValue::Albedo(0.0),
            params: &[("kd", "0"), ("ks", "1"), ("n", "1")],
            value: FRAC_1_PI,
            relative: 1e-11,
            source: "closed form: E(0) = 3/(2 pi) B(1, 3/2) = 1/pi",
        },
    ],
    splits: false,
    build,
};

/// `kd`.
pub(super) const KD: Param =
    Param::number("kd", "kd", "diffuse reflectance", [0.0, 1.0], DefaultValue::Value(0.5));
/// `ks`.
pub(super) const KS: Param = Param::number(
    "ks",
    "ks",
    "specular reflectance at normal incidence",
    [0.0, 1.0],
    DefaultValue::Value(0.5),
);
/// `n`.
pub(super) const N: Param =
    Param::number("n", "n", "exponent of the lobe", [0.0, 1e7], DefaultValue::Value(50.0))
        .spelled(&["alpha"])
        .swept("n", [1.0, 1000.0], 0.25);

/// Two reflectances of which a model keeps its promise of E <= 1 only up to a sum of 1.
///
/// # Errors
/// [`ParamError::Together`] if they exceed it.
pub(super) fn at_most_one(
    model: &'static str,
    params: &Params,
    ids: [&'static str; 2],
) -> Result<[f64; 2], ParamError> {
    let [a, b] = params.numbers(ids)?;
    // the slack lets 0.1 + 0.9 and the like through
    if a + b <= 1.0 + 4.0 * f64::EPSILON {
        Ok([a, b])
    } else {
        let why = format!(
            "{} = {} and {} = {} add up to more than 1; lower one of them",
            ids[0],
            exact(a),
            ids[1],
            exact(b)
        );
        Err(ParamError::Together { model, why })
    }
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let [kd, ks] = at_most_one(INFO.id, params, ["kd", "ks"])?;
    let n = params.number("n")?;
    Ok(Box::new(Sum::new(vec![
        Part::new(kd, Diffuse(Lambert { rho: 1.0 })),
        Part::new(ks, Cosine::phong(n, (n + 2.0) / TAU, Over::Nothing)),
    ])))
}
