//! Masking and shadowing.

use super::ndf::{ALPHA, ALPHA_X, ALPHA_Y, GAMMA, ROUGHNESS};
use super::{At, FunctionInfo, Input, REFERENCE, alias, known, number, theta};
use crate::cite;
use crate::math::frame;
use crate::models::{Param, ParamError, Params};
use crate::terms::beckmann::Beckmann;
use crate::terms::ggx::Ggx;
use crate::terms::smith::Ndf;
use crate::terms::student_t::StudentT;
use crate::terms::{charlie, schlick_masking, vcavity};

const DIRECTION: Input = Input::Wi("the direction");
const PAIR: &[Input] = &[Input::Wi("one direction"), Input::Wo("the other direction")];
const AT_HORIZON: &str = "Infinite at the horizon, which is an error here. Below it, the same as above.";
const COMBINED: Param =
    Param::choice("masking", "how masking of the two directions is combined", &["correlated", "separable"]);

fn g2(p: &Params, ndf: &dyn Ndf, at: &At) -> Result<f64, ParamError> {
    Ok(if p.choice("masking")? == "separable" {
        ndf.g2_separable(at.wo, at.wi)
    } else {
        ndf.g2(at.wo, at.wi)
    })
}

/// The family.
pub static ALL: &[FunctionInfo] = &[
    FunctionInfo {
        id: "lambda-ggx",
        title: "Smith's Lambda of GGX",
        formula: "t / (2 (1 + sqrt(1 + t))), t = (ax tan cos_phi)^2 + (ay tan sin_phi)^2",
        sources: &[(cite::HEITZ_2014, "Eq. 72")],
        params: &[ALPHA, ALPHA_X, ALPHA_Y],
        inputs: &[DIRECTION],
        unit: "1",
        range: [0.0, f64::MAX],
        notes: AT_HORIZON,
        also: &[alias("Lambda_ggx")],
        known: &[known(&[("alpha", "1")], theta(1.0), 0.425_407_858_840_462_8, 1e-14, REFERENCE)],
        eval: |p, at| Ok(Ggx::new(p.number("alpha_x")?, p.number("alpha_y")?).lambda(at.wi)),
    },
    FunctionInfo {
        id: "lambda-beckmann",
        title: "Smith's Lambda of Beckmann",
        formula: "(exp(-a^2) / (a sqrt(pi)) - erfc(a)) / 2, a = 1 / (alpha tan)",
        sources: &[(cite::HEITZ_2014, "section 5.2")],
        params: &[ALPHA, ALPHA_X, ALPHA_Y],
        inputs: &[DIRECTION],
        unit: "1",
        range: [0.0, f64::MAX],
        notes: "Exact, not the rational fit of Walter 2007 (which is off by up to 0.0062 in G1). Infinite at the horizon, an error.",
        also: &[alias("Lambda_beckmann")],
        known: &[known(&[("alpha", "1")], theta(1.0), 0.108_976_690_034_705_06, 1e-13, REFERENCE)],
        eval: |p, at| Ok(Beckmann::new(p.number("alpha_x")?, p.number("alpha_y")?).lambda(at.wi)),
    },
    FunctionInfo {
        id: "lambda-student-t",
        title: "Smith's Lambda of Student's t distribution",
        formula: "R / sqrt(pi) int_s^inf (u / s - 1)(1 + u^2)^(1/2 - gamma) du, R = Gamma(gamma - 1/2) / Gamma(gamma - 1)",
        sources: &[(cite::RIBARDIERE_2017, "Eq. 13 to 15")],
        params: &[ALPHA, ALPHA_X, ALPHA_Y, GAMMA],
        inputs: &[DIRECTION],
        unit: "1",
        range: [0.0, f64::MAX],
        notes: "Exact, not their fit (0.7 % in G1). Infinite at the horizon, an error.",
        also: &[alias("Lambda_std")],
        known: &[known(
            &[("alpha", "1"), ("gamma", "10")],
            theta(1.0),
            0.125_583_209_978_469_08,
            1e-13,
            REFERENCE,
        )],
        eval: |p, at| {
            Ok(StudentT::new(p.number("alpha_x")?, p.number("alpha_y")?, p.number("gamma")?).lambda(at.wi))
        },
    },
    FunctionInfo {
        id: "lambda-charlie",
        title: "The fitted Lambda of Charlie",
        formula: "exp(L(mu)) below 1/2, exp(2 L(1/2) - L(1 - mu)) above, L(x) = a / (1 + b x^p) + d x + e",
        sources: &[(cite::ESTEVEZ_KULLA_2017, "Eq. 3 and its table")],
        params: &[ROUGHNESS],
        inputs: &[Input::WiTheta("the polar angle of the direction")],
        unit: "1",
        range: [0.0, f64::MAX],
        notes: "A fit by its authors, finite at the horizon.",
        also: &[alias("Lambda_charlie_fit")],
        known: &[known(&[("roughness", "1")], theta(1.0), 0.615_014_766_407_357_5, 1e-13, REFERENCE)],
        eval: |p, at| Ok(charlie::lambda(p.number("roughness")?, libm::cos(at.wi_theta).abs())),
    },
    FunctionInfo {
        id: "g2-ggx",
        title: "Smith's masking and shadowing of GGX",
        formula: "1 / (1 + Lambda_o + Lambda_i), or G1(wo) G1(wi)",
        sources: &[(cite::HEITZ_2014, "Eq. 98 and 99"), (cite::WALTER_2007, "Eq. 23 and 34")],
        params: &[ALPHA, ALPHA_X, ALPHA_Y, COMBINED],
        inputs: PAIR,
        unit: "1",
        range: [0.0, 1.0],
        notes: "Of two directions on the same side. 0 where one is at the horizon.",
        also: &[],
        known: &[known(
            &[("alpha", "1"), ("masking", "\"separable\"")],
            [std::f64::consts::FRAC_PI_3, 0.0, std::f64::consts::FRAC_PI_3, 0.0],
            4.0 / 9.0,
            1e-14,
            "closed form: G1 = 2 mu / (1 + mu) at alpha = 1",
        )],
        eval: |p, at| Ok(g2(p, &Ggx::new(p.number("alpha_x")?, p.number("alpha_y")?), at)?),
    },
    FunctionInfo {
        id: "g2-beckmann",
        title: "Smith's masking and shadowing of Beckmann",
        formula: "1 / (1 + Lambda_o + Lambda_i), or G1(wo) G1(wi)",
        sources: &[(cite::HEITZ_2014, "Eq. 98 and 99, section 5.2")],
        params: &[ALPHA, ALPHA_X, ALPHA_Y, COMBINED],
        inputs: PAIR,
        unit: "1",
        range: [0.0, 1.0],
        notes: "Of two directions on the same side. 0 where one is at the horizon.",
        also: &[],
        known: &[known(
            &[("alpha", "1")],
            [1.0, 2.5, 0.0, 0.0],
            1.0 / 1.108_976_690_034_705_1,
            1e-13,
            REFERENCE,
        )],
        eval: |p, at| Ok(g2(p, &Beckmann::new(p.number("alpha_x")?, p.number("alpha_y")?), at)?),
    },
    FunctionInfo {
        id: "g2-vcavity",
        title: "Masking and shadowing of V-shaped grooves",
        formula: "min(1, 2 h.z mu_o / (wo . h), 2 h.z mu_i / (wi . h))",
        sources: &[(cite::TORRANCE_SPARROW_1967, "Eq. 16 to 18"), (cite::COOK_TORRANCE_1982, "section 2")],
        params: &[],
        inputs: PAIR,
        unit: "1",
        range: [0.0, 1.0],
        notes: "h is the half vector. 0 unless both directions are above the surface. Independent of the roughness.",
        also: &[],
        known: &[known(
            &[],
            [1.25, 0.0, 0.0, 0.0],
            2.0 * 0.315_322_362_395_268_7,
            1e-14,
            "closed form: 2 cos(1.25) when the other direction is the normal",
        )],
        eval: |_, at| {
            Ok(match frame::half_vector(at.wo, at.wi) {
                Some(h) => vcavity::g2(at.wo, at.wi, h.wh, h.cos_d),
                None => 0.0,
            })
        },
    },
    FunctionInfo {
        id: "g1-schlick",
        title: "Schlick's masking",
        formula: "mu / (mu (1 - k) + k)",
        sources: &[(cite::SCHLICK_1994, "Eq. 19"), (cite::KARIS_2013, "Eq. 4")],
        params: &[number(
            "k",
            "alpha sqrt(2 / pi) (Schlick), alpha / 2 (split sums), (r + 1)^2 / 8 (lights)",
            [0.0, 2.0],
            0.125,
        )],
        inputs: &[Input::WiTheta("the polar angle of the direction")],
        unit: "1",
        range: [0.0, 1.0],
        notes: "An approximation of Smith's; it breaks the weak white furnace.",
        also: &[],
        known: &[known(
            &[("k", "1")],
            theta(1.0),
            0.540_302_305_868_139_8,
            1e-14,
            "closed form: mu at k = 1",
        )],
        eval: |p, at| Ok(schlick_masking::g1(p.number("k")?, libm::cos(at.wi_theta).abs())),
    },
];
