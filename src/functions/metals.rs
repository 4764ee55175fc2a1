//! Measured metals.

use super::{FunctionError, FunctionInfo, NO_ANGLES, known, measured};
use crate::cite;
use crate::models::{Param, Params};
use crate::terms::metals::{self, Metal};
use crate::terms::{fresnel, schlick};

const METAL: Param =
    Param::choice("metal", "symbol of the element", &["au", "ag", "al", "cu", "fe", "ni", "ti", "w"]);
const WAVELENGTH: Param = measured("lambda_nm", "nm", "wavelength in vacuum", [368.0, 815.0], 550.0);
const SOURCES: &[(cite::Cite, &str)] = &[
    (cite::JOHNSON_CHRISTY_1972, "Table I (Au, Ag, Cu)"),
    (cite::JOHNSON_CHRISTY_1974, "Table I (Fe, Ni, Ti)"),
    (cite::RAKIC_1995, "the table of n and k (Al)"),
    (cite::RAKIC_1998, "the Brendel-Bormann fit (W)"),
    (cite::POLYANSKIY_2024, "the transcription of all rows"),
];

fn metal(params: &Params, function: &'static str) -> Result<&'static Metal, FunctionError> {
    metals::find(params.choice("metal")?)
        .ok_or(FunctionError::Undefined { function, why: "no such metal has been measured here" })
}

fn tint(n: f64, k: f64) -> f64 {
    let f = |mu: f64| fresnel::conductor(mu, n, k).unpolarised();
    schlick::tint_of(f(1.0), f(schlick::MU_82))
}

/// The family.
pub static ALL: &[FunctionInfo] = &[
    FunctionInfo {
        id: "metal-index",
        title: "Measured index of a metal",
        formula: "n or k, linear between the rows of the source",
        sources: SOURCES,
        params: &[
            METAL,
            Param::choice("part", "the real part n or the extinction k", &["n", "k"]),
            WAVELENGTH,
        ],
        inputs: &[],
        unit: "1",
        range: [0.0, 10.0],
        notes: "Evaporated films at room temperature. Red, green and blue of three-channel renderers: 650, 550 and 450 nm.",
        also: &[],
        known: &[
            known(
                &[("metal", "\"au\""), ("part", "\"k\""), ("lambda_nm", "520.9")],
                NO_ANGLES,
                2.081,
                1e-15,
                "a row of the source",
            ),
            known(
                &[("metal", "\"al\""), ("part", "\"n\""), ("lambda_nm", "652.25")],
                NO_ANGLES,
                1.5724,
                1e-15,
                "a row of the source",
            ),
        ],
        eval: |p, _| {
            let (n, k) = metal(p, "metal-index")?.index(p.number("lambda_nm")?);
            Ok(if p.choice("part")? == "n" { n } else { k })
        },
    },
    FunctionInfo {
        id: "metal-f0",
        title: "Reflectance of a measured metal at normal incidence",
        formula: "((n - 1)^2 + k^2) / ((n + 1)^2 + k^2)",
        sources: SOURCES,
        params: &[METAL, WAVELENGTH],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "In vacuum. At one wavelength; `metal-f0-srgb` is its colour.",
        also: &[],
        known: &[known(
            &[("metal", "\"fe\""), ("lambda_nm", "549")],
            NO_ANGLES,
            (1.95 * 1.95 + 2.93 * 2.93) / (3.95 * 3.95 + 2.93 * 2.93),
            1e-14,
            "closed form at a row of the source",
        )],
        eval: |p, _| Ok(metal(p, "metal-f0")?.f0(p.number("lambda_nm")?)),
    },
    FunctionInfo {
        id: "metal-f82-tint",
        title: "F82 tint of a measured metal",
        formula: "F(1/7) / (F0 + (1 - F0)(6/7)^5)",
        sources: &[
            (cite::KUTZ_2021, "section 2.3"),
            (cite::JOHNSON_CHRISTY_1972, "Table I (Au, Ag, Cu)"),
            (cite::JOHNSON_CHRISTY_1974, "Table I (Fe, Ni, Ti)"),
            (cite::RAKIC_1995, "the table of n and k (Al)"),
            (cite::RAKIC_1998, "the Brendel-Bormann fit (W)"),
            (cite::POLYANSKIY_2024, "the transcription of all rows"),
        ],
        params: &[METAL, WAVELENGTH],
        inputs: &[],
        unit: "1",
        range: [0.0, 2.0],
        notes: "What OpenPBR calls the specular colour of a metal. At one wavelength; 650, 550 and 450 nm are red, green and blue.",
        also: &[],
        known: &[known(
            &[("metal", "\"au\""), ("lambda_nm", "548.6")],
            NO_ANGLES,
            0.993_370_329_153_847_28,
            1e-13,
            "formula in 50-digit arithmetic, at a row of the source",
        )],
        eval: |p, _| {
            let (n, k) = metal(p, "metal-f82-tint")?.index(p.number("lambda_nm")?);
            Ok(tint(n, k))
        },
    },
    FunctionInfo {
        id: "metal-f0-srgb",
        title: "Colour of a measured metal at normal incidence, linear sRGB under D65",
        formula: "M int F0 S (x, y, z) d lambda over that of a perfect mirror, channel by channel",
        sources: SOURCES,
        params: &[METAL, Param::choice("channel", "channel of linear sRGB", &["R", "G", "B"])],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.2],
        notes: "S is D65, the eye the CIE 1931 observer. Not clamped: gold and copper leave the gamut a little.",
        also: &[],
        known: &[known(
            &[("metal", "\"au\""), ("channel", "\"G\"")],
            NO_ANGLES,
            0.728_354_447_847_513_8,
            1e-12,
            "the same sums over the same rows in another program",
        )],
        eval: |p, _| {
            let rgb = metal(p, "metal-f0-srgb")?.f0_srgb();
            Ok(match p.choice("channel")? {
                "R" => rgb[0],
                "G" => rgb[1],
                _ => rgb[2],
            })
        },
    },
];
