//! Fresnel reflectance, exact and approximate, and the indices that artists type.

use super::{FunctionInfo, Input, NO_ANGLES, REFERENCE, alias, alias_with, known, number, theta};
use crate::cite;
use crate::models::{Param, ParamError, Params};
use crate::terms::fresnel::{self, Polarised};
use crate::terms::{gulbrandsen, lazanyi, schlick};

pub(super) const ETA: Param =
    number("eta", "relative index of refraction, below over above", [1e-3, 1e3], 1.5)
        .also(&["eta_t_over_i", "ior"]);
pub(super) const N: Param = number("n", "real part of the relative index", [0.0, 1e4], 0.2).also(&["eta"]);
pub(super) const K: Param = number("k", "extinction coefficient", [0.0, 1e4], 3.9);
pub(super) const F0: Param = number("f0", "reflectance at normal incidence", [0.0, 1.0], 0.04).also(&["F0"]);
pub(super) const F90: Param =
    number("f90", "reflectance at grazing incidence", [0.0, 1.0], 1.0).also(&["F90"]);
pub(super) const EXPONENT: Param = number("exponent", "power of 1 - cos", [1e-3, 1e3], 5.0);
pub(super) const TINT: Param =
    number("tint", "colour that multiplies Schlick's value at 82 degrees", [0.0, 1.0], 1.0);
pub(super) const DIP: Param = number("a", "depth of the dip", [0.0, 100.0], 1.0);
pub(super) const DIP_EXPONENT: Param =
    number("exponent", "power of 1 - cos in the dip", [1e-3, 1e3], 6.0).also(&["alpha"]);
pub(super) const POLARISATION: Param = Param::choice(
    "polarisation",
    "electric field across the plane of incidence (s), in it (p), or the mean",
    &["unpolarised", "s", "p"],
);
const INCIDENCE: Input = Input::Incidence("the angle of incidence");
const BOTH_SIDES: Input = Input::WiTheta("the angle of incidence; above pi/2 the light comes from below");

/// The polarisation that the parameters name.
pub(super) fn polarised(params: &Params, value: Polarised) -> Result<f64, ParamError> {
    Ok(match params.choice("polarisation")? {
        "s" => value.s,
        "p" => value.p,
        _ => value.unpolarised(),
    })
}

/// The family.
pub static ALL: &[FunctionInfo] = &[
    FunctionInfo {
        id: "f0-dielectric",
        title: "Reflectance of a dielectric at normal incidence",
        formula: "((eta - 1) / (eta + 1))^2",
        sources: &[(cite::BORN_WOLF_1999, "section 1.5.2 Eq. 23")],
        params: &[ETA],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "The same from both sides.",
        also: &[alias("F0_dielectric")],
        known: &[known(&[("eta", "1.5")], NO_ANGLES, 0.04, 1e-15, "closed form: 1 / 25")],
        eval: |p, _| Ok(fresnel::dielectric(1.0, p.number("eta")?).unpolarised()),
    },
    FunctionInfo {
        id: "f0-conductor",
        title: "Reflectance of a conductor at normal incidence",
        formula: "((n - 1)^2 + k^2) / ((n + 1)^2 + k^2)",
        sources: &[(cite::BORN_WOLF_1999, "section 14.2")],
        params: &[N, K],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "n and k relative to the medium above.",
        also: &[],
        known: &[known(
            &[("n", "0.1875"), ("k", "3.375")],
            NO_ANGLES,
            0.941_409_826_060_421_1,
            1e-15,
            REFERENCE,
        )],
        eval: |p, _| Ok(lazanyi::f0(p.number("n")?, p.number("k")?)),
    },
    FunctionInfo {
        id: "fresnel-dielectric",
        title: "Fresnel reflectance of a dielectric",
        formula: "R_s = (d / (c + g)^2)^2, R_p = (d (eta^2 c^2 - sin^2) / (eta^2 c + g)^2)^2, d = eta^2 - 1, g = sqrt(d + c^2)",
        sources: &[(cite::BORN_WOLF_1999, "section 1.5.2"), (cite::WALTER_2007, "Eq. 22")],
        params: &[ETA, POLARISATION],
        inputs: &[BOTH_SIDES],
        unit: "1",
        range: [0.0, 1.0],
        notes: "1 under total internal reflection. Product forms: no cancellation as eta approaches 1 or at Brewster's angle.",
        also: &[
            alias_with("fresnel_dielectric_s", &[("polarisation", "s")]),
            alias_with("fresnel_dielectric_p", &[("polarisation", "p")]),
            alias_with("fresnel_dielectric_unpolarised", &[("polarisation", "unpolarised")]),
        ],
        known: &[known(&[("eta", "1.5")], theta(1.25), 0.193_372_521_289_781_5, 1e-14, REFERENCE)],
        eval: |p, at| Ok(polarised(p, fresnel::dielectric(libm::cos(at.wi_theta), p.number("eta")?))?),
    },
    FunctionInfo {
        id: "fresnel-dielectric-transmittance",
        title: "Fresnel transmittance of a dielectric (power)",
        formula: "T_s = 4 c g / (c + g)^2, T_p = 4 eta^2 c g / (eta^2 c + g)^2, g = sqrt(eta^2 - 1 + c^2)",
        sources: &[(cite::BORN_WOLF_1999, "section 1.5.3")],
        params: &[ETA, POLARISATION],
        inputs: &[BOTH_SIDES],
        unit: "1",
        range: [0.0, 1.0],
        notes: "1 - R without the subtraction; no factor eta^2.",
        also: &[],
        known: &[known(&[("eta", "1.5")], theta(0.0), 0.96, 1e-15, "closed form: 24 / 25")],
        eval: |p, at| {
            Ok(polarised(p, fresnel::dielectric_transmittance(libm::cos(at.wi_theta), p.number("eta")?))?)
        },
    },
    FunctionInfo {
        id: "fresnel-conductor",
        title: "Fresnel reflectance of a conductor",
        formula: "R_s = |(c - q) / (c + q)|^2, R_p = |(N^2 c - q) / (N^2 c + q)|^2, q = sqrt(N^2 - sin^2), N = n + i k",
        sources: &[(cite::BORN_WOLF_1999, "section 14.2")],
        params: &[N, K, POLARISATION],
        inputs: &[INCIDENCE],
        unit: "1",
        range: [0.0, 1.0],
        notes: "k = 0 is the dielectric. Product forms: accurate for k much larger than n.",
        also: &[
            alias_with("fresnel_conductor_s", &[("polarisation", "s")]),
            alias_with("fresnel_conductor_p", &[("polarisation", "p")]),
            alias_with("fresnel_conductor_unpolarised", &[("polarisation", "unpolarised")]),
        ],
        known: &[known(
            &[("n", "0.25"), ("k", "2.5")],
            theta(1.0),
            0.870_233_012_658_252_8,
            1e-14,
            REFERENCE,
        )],
        eval: |p, at| {
            let value = fresnel::conductor(libm::cos(at.wi_theta), p.number("n")?, p.number("k")?);
            Ok(polarised(p, value)?)
        },
    },
    FunctionInfo {
        id: "fresnel-conductor-absorptance",
        title: "What a conductor absorbs, 1 - R",
        formula: "A_s = 4 a c / |c + q|^2, A_p = 4 a c (|q|^2 + sin^2) / |N^2 c + q|^2, a = Re q",
        sources: &[(cite::BORN_WOLF_1999, "section 14.2")],
        params: &[N, K, POLARISATION],
        inputs: &[INCIDENCE],
        unit: "1",
        range: [0.0, 1.0],
        notes: "Without the subtraction, which leaves no digit of good metals.",
        also: &[],
        known: &[known(
            &[("n", "0.0625"), ("k", "64"), ("polarisation", "\"s\"")],
            theta(1.5),
            1.0 - 0.999_995_684_135_251_1,
            1e-10,
            REFERENCE,
        )],
        eval: |p, at| {
            let value =
                fresnel::conductor_absorptance(libm::cos(at.wi_theta), p.number("n")?, p.number("k")?);
            Ok(polarised(p, value)?)
        },
    },
    FunctionInfo {
        id: "fresnel-schlick",
        title: "Schlick's Fresnel factor",
        formula: "F0 + (F90 - F0)(1 - c)^5",
        sources: &[(cite::SCHLICK_1994, "Eq. 15")],
        params: &[F0, F90],
        inputs: &[INCIDENCE],
        unit: "1",
        range: [0.0, 1.0],
        notes: "Off by up to 0.060 from a dielectric of 1.33, 0.036 of 1.5, 0.082 of 2.5.",
        also: &[alias("fresnel_schlick")],
        known: &[known(&[("f0", "0.02")], theta(1.0), 0.040_118_134_265_949_23, 1e-14, REFERENCE)],
        eval: |p, at| Ok(schlick::schlick(p.number("f0")?, p.number("f90")?, libm::cos(at.wi_theta))),
    },
    FunctionInfo {
        id: "fresnel-schlick-generalised",
        title: "Schlick's Fresnel factor with a free exponent",
        formula: "F0 + (F90 - F0)(1 - c)^p",
        sources: &[(cite::HOFFMAN_2019, "section 2")],
        params: &[F0, F90, EXPONENT],
        inputs: &[INCIDENCE],
        unit: "1",
        range: [0.0, 1.0],
        notes: "The exponent 5 is Schlick's own.",
        also: &[alias("fresnel_schlick_generalised")],
        known: &[known(
            &[("f0", "0.25"), ("exponent", "1.5")],
            theta(1.25),
            0.674_903_666_529_991_9,
            1e-14,
            REFERENCE,
        )],
        eval: |p, at| {
            let cos = libm::cos(at.wi_theta);
            Ok(schlick::schlick_generalised(p.number("f0")?, p.number("f90")?, p.number("exponent")?, cos))
        },
    },
    FunctionInfo {
        id: "fresnel-f82-tint",
        title: "F82 tint, clamped to [0, 1]",
        formula: "F0 + (1 - F0)(1 - c)^5 - b c (1 - c)^6, b = F_schlick(1/7)(1 - tint) / (1/7 (6/7)^6)",
        sources: &[(cite::KUTZ_2021, "section 2.3"), (cite::HOFFMAN_2019, "section 3")],
        params: &[F0, TINT],
        inputs: &[INCIDENCE],
        unit: "1",
        range: [0.0, 1.0],
        notes: "Clamped as renderers do; `fresnel-f82-tint-unclamped` is the formula itself.",
        also: &[],
        known: &[known(
            &[("f0", "0.0625"), ("tint", "0.5")],
            theta(1.0),
            0.059_414_149_156_872_306,
            1e-13,
            REFERENCE,
        )],
        eval: |p, at| Ok(schlick::f82_tint(p.number("f0")?, p.number("tint")?, libm::cos(at.wi_theta))),
    },
    FunctionInfo {
        id: "fresnel-f82-tint-unclamped",
        title: "F82 tint as printed",
        formula: "F0 + (1 - F0)(1 - c)^5 - b c (1 - c)^6, b = F_schlick(1/7)(1 - tint) / (1/7 (6/7)^6)",
        sources: &[(cite::KUTZ_2021, "section 2.3"), (cite::HOFFMAN_2019, "section 3")],
        params: &[F0, TINT],
        inputs: &[INCIDENCE],
        unit: "1",
        range: [-0.127, 1.0],
        notes: "Negative for small f0 and tint: -0.127 at f0 = tint = 0, cos = 0.261.",
        also: &[alias("fresnel_f82_tint_unclamped")],
        known: &[known(
            &[("f0", "0.875"), ("tint", "0.25")],
            theta(1.5),
            0.399_116_124_276_276_46,
            1e-14,
            REFERENCE,
        )],
        eval: |p, at| {
            Ok(schlick::f82_tint_unclamped(p.number("f0")?, p.number("tint")?, libm::cos(at.wi_theta)))
        },
    },
    FunctionInfo {
        id: "f82-tint-conductor",
        title: "F82 tint from the index of a metal",
        formula: "F(1/7) / (F0 + (1 - F0)(6/7)^5)",
        sources: &[(cite::KUTZ_2021, "section 2.3")],
        params: &[N, K],
        inputs: &[],
        unit: "1",
        range: [0.0, 2.0],
        notes: "With f0-conductor the two colours of `fresnel-f82-tint`. Above 1 where the material reflects more than Schlick's curve.",
        also: &[],
        known: &[known(
            &[("n", "0.43"), ("k", "2.455")],
            NO_ANGLES,
            0.993_370_329_153_847_28,
            1e-13,
            "formula in 50-digit arithmetic",
        )],
        eval: |p, _| {
            let f = |cos: f64| -> Result<f64, ParamError> {
                Ok(fresnel::conductor(cos, p.number("n")?, p.number("k")?).unpolarised())
            };
            Ok(schlick::tint_of(f(1.0)?, f(schlick::MU_82)?))
        },
    },
    FunctionInfo {
        id: "fresnel-lazanyi",
        title: "Schlick's factor corrected for metals",
        formula: "F0 + (1 - F0)(1 - c)^5 - a c (1 - c)^q, F0 = ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2)",
        sources: &[(cite::LAZANYI_2005, "the formula with its compensating term")],
        params: &[N, K, DIP, DIP_EXPONENT],
        inputs: &[INCIDENCE],
        unit: "1",
        range: [-100.0, 1.0],
        notes: "a and q are fitted for each metal; a large a makes it negative.",
        also: &[alias("fresnel_lazanyi")],
        known: &[known(
            &[("n", "1.375"), ("k", "7.625"), ("a", "1.5")],
            theta(0.25),
            0.913_767_762_093_455_6,
            1e-14,
            REFERENCE,
        )],
        eval: |p, at| {
            let cos = libm::cos(at.wi_theta);
            Ok(lazanyi::lazanyi(p.number("n")?, p.number("k")?, p.number("a")?, p.number("exponent")?, cos))
        },
    },
    FunctionInfo {
        id: "gulbrandsen",
        title: "Index of a metal from reflectance and edge tint",
        formula: "n = g n_min + (1 - g) n_max, k^2 = (n_max - n)(n - 1 / n_max), n_min = (1 - r)/(1 + r), n_max = (1 + sqrt r)/(1 - sqrt r)",
        sources: &[(
            cite::GULBRANDSEN_2014,
            "Eq. 12 (n), Eq. 2 solved for k (numbers as implementations quote them)",
        )],
        params: &[
            Param::choice("part", "the real part n or the extinction k", &["n", "k"]),
            number("r", "reflectance at normal incidence", [0.0, gulbrandsen::R_MAX], 0.9),
            number("g", "edge tint", [0.0, 1.0], 0.5),
        ],
        inputs: &[],
        unit: "1",
        range: [0.0, 4.1e6],
        notes: "n_max has no bound as r approaches 1, hence the end of its range.",
        also: &[alias_with("gulbrandsen_n", &[("part", "n")]), alias_with("gulbrandsen_k", &[("part", "k")])],
        known: &[known(
            &[("part", "\"k\""), ("r", "0.75"), ("g", "1")],
            NO_ANGLES,
            0.989_743_318_610_787,
            1e-14,
            REFERENCE,
        )],
        eval: |p, _| {
            let (n, k) = gulbrandsen::index(p.number("r")?, p.number("g")?);
            Ok(if p.choice("part")? == "n" { n } else { k })
        },
    },
    FunctionInfo {
        id: "gulbrandsen-inverse",
        title: "Reflectance and edge tint from the index of a metal",
        formula: "r = ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2), g = (n_max - n) / (n_max - n_min)",
        sources: &[(cite::GULBRANDSEN_2014, "Eq. 14 and 15 (numbers as implementations quote them)")],
        params: &[Param::choice("part", "the reflectance r or the tint g", &["r", "g"]), N, K],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "The inverse of `gulbrandsen`. n = 1, k = 0 has no tint; it gives 0.",
        also: &[],
        known: &[known(
            &[("part", "\"g\""), ("n", "2.4"), ("k", "1.1135528725660044")],
            NO_ANGLES,
            0.25,
            1e-13,
            "inverse of a reference value",
        )],
        eval: |p, _| {
            let (r, g) = gulbrandsen::tint(p.number("n")?, p.number("k")?);
            Ok(if p.choice("part")? == "r" { r } else { g })
        },
    },
];
