//! Media: what passes, what glows, how bright a cloud is.

use super::{FunctionInfo, NO_ANGLES, REFERENCE, alias, alias_with, known, measured, number};
use crate::cite;
use crate::integrate::gauss;
use crate::models::{Param, ParamError, Params};
use crate::terms::{blackbody, medium};

const SIGMA_T: Param = measured("sigma_t", "1/length", "extinction", [0.0, 1e12], 1.0);
const PATH: Param = measured("d", "length", "length of the path", [0.0, 1e12], 1.0);
const G: Param = number("g", "mean cosine of the phase function", [-0.999_999, 0.999_999], 0.0);
const TEMPERATURE: Param = measured("t_k", "K", "temperature", [1.0, 1e7], 6500.0).also(&["T_K"]);

/// The family.
pub static ALL: &[FunctionInfo] = &[
    FunctionInfo {
        id: "beer-lambert",
        title: "Transmittance of a homogeneous medium",
        formula: "exp(-sigma_t d)",
        sources: &[(cite::CHANDRASEKHAR_1960, "section 7")],
        params: &[SIGMA_T, PATH],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "Along the refracted path, not the vertical depth.",
        also: &[alias("beer_lambert_T")],
        known: &[known(
            &[("sigma_t", "0.5"), ("d", "2")],
            NO_ANGLES,
            0.367_879_441_171_442_33,
            1e-15,
            "closed form: 1 / e",
        )],
        eval: |p, _| Ok(medium::transmittance(p.number("sigma_t")?, p.number("d")?)),
    },
    FunctionInfo {
        id: "beer-lambert-loss",
        title: "What a homogeneous medium takes",
        formula: "1 - exp(-sigma_t d)",
        sources: &[(cite::CHANDRASEKHAR_1960, "section 7")],
        params: &[SIGMA_T, PATH],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "Without the subtraction: it keeps its digits in thin media.",
        also: &[alias("beer_lambert_1_minus_T")],
        known: &[known(&[("d", "0.0009765625")], NO_ANGLES, 0.000_976_085_818_024_337_7, 1e-15, REFERENCE)],
        eval: |p, _| Ok(medium::loss(p.number("sigma_t")?, p.number("d")?)),
    },
    FunctionInfo {
        id: "slab-emission",
        title: "Radiance of a glowing slab: fire, smoke",
        formula: "(j / sigma_t)(1 - exp(-sigma_t d))",
        sources: &[(cite::CHANDRASEKHAR_1960, "section 7 (the formal solution)")],
        params: &[measured("j", "1/length", "emission per length", [0.0, 1e12], 1.0), SIGMA_T, PATH],
        inputs: &[],
        unit: "that of j times length",
        range: [0.0, f64::MAX],
        notes: "j d where nothing absorbs.",
        also: &[],
        known: &[known(
            &[("j", "2"), ("sigma_t", "0.5"), ("d", "3")],
            NO_ANGLES,
            3.107_479_359_406_281,
            1e-14,
            REFERENCE,
        )],
        eval: |p, _| Ok(medium::slab_emission(p.number("j")?, p.number("sigma_t")?, p.number("d")?)),
    },
    FunctionInfo {
        id: "half-space-albedo",
        title: "Diffuse reflectance of a semi-infinite medium (van de Hulst's fit)",
        formula: "(1 - s)(1 - 0.139 s) / (1 + 1.17 s), s = sqrt((1 - alpha) / (1 - alpha g))",
        sources: &[(cite::KULLA_CONTY_2017, "slides on volumes, after van de Hulst")],
        params: &[number("alpha", "single-scattering albedo", [0.0, 1.0], 0.9), G],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "Index-matched boundary.",
        also: &[alias("albedo_vdh_C_of_alpha")],
        known: &[known(&[("alpha", "0.5")], NO_ANGLES, 0.144_531_942_095_001_28, 1e-14, REFERENCE)],
        eval: |p, _| Ok(medium::half_space_albedo(p.number("alpha")?, p.number("g")?)),
    },
    FunctionInfo {
        id: "single-scattering-albedo",
        title: "Single-scattering albedo that gives a diffuse reflectance",
        formula: "(1 - s^2) / (1 - g s^2) with s(c) the inverse of `half-space-albedo`, or Kulla and Conty's fit; or Chiang's 1 - exp(-5.09406 c + 2.61188 c^2 - 4.31805 c^3)",
        sources: &[
            (cite::KULLA_CONTY_2017, "slides on volumes"),
            (cite::CHIANG_2016, "the fit of the albedo inversion"),
        ],
        params: &[
            Param::choice("fit", "which inverse", &["exact", "kulla-conty", "chiang"]),
            number("c", "diffuse reflectance", [0.0, 1.0], 0.5).also(&["C", "A"]),
            G,
        ],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "exact inverts the fit of van de Hulst, kulla-conty is their fit of that (within 5e-6 in s), chiang is for isotropic scattering.",
        also: &[
            alias_with("albedo_vdh_exact_inverse_alpha_of_C", &[("fit", "exact")]),
            alias_with("albedo_kulla_conty_alpha_of_C", &[("fit", "kulla-conty")]),
            alias_with("albedo_chiang2016_alpha_of_A", &[("fit", "chiang")]),
        ],
        known: &[known(&[("c", "0.5")], NO_ANGLES, 0.911_706_642_634_525_7, 1e-14, REFERENCE)],
        eval: |p, _| {
            let (c, g) = (p.number("c")?, p.number("g")?);
            Ok(match p.choice("fit")? {
                "exact" => medium::single_scattering_exact(c, g),
                "kulla-conty" => medium::single_scattering_kulla_conty(c, g),
                _ => medium::single_scattering_chiang(c),
            })
        },
    },
    FunctionInfo {
        id: "planck",
        title: "Spectral radiance of a black body",
        formula: "2 h c^2 / lambda^5 / (exp(h c / (lambda k T)) - 1)",
        sources: &[(cite::PLANCK_1901, "with the exact SI constants of 2019")],
        params: &[measured("lambda_nm", "nm", "wavelength", [1.0, 1e9], 550.0), TEMPERATURE],
        inputs: &[],
        unit: "W/(sr m^3)",
        range: [0.0, f64::MAX],
        notes: "Per metre of wavelength; 1e-9 of it per nanometre.",
        also: &[alias("planck_radiance")],
        known: &[known(
            &[("lambda_nm", "400"), ("t_k", "6500")],
            NO_ANGLES,
            46_138_831_949_969.013,
            1e-13,
            REFERENCE,
        )],
        eval: |p, _| Ok(blackbody::planck(p.number("lambda_nm")?, p.number("t_k")?)),
    },
    FunctionInfo {
        id: "blackbody-srgb",
        title: "Colour of a black body, linear sRGB at luminance 1",
        formula: "M int B(lambda, T) (x, y, z)(lambda) d lambda / int B y d lambda, 360 to 830 nm",
        sources: &[(cite::PLANCK_1901, "B"), (cite::WYMAN_2013, "Eq. 4 (x, y, z)"), (cite::LINDBLOOM, "M")],
        params: &[
            Param::choice("channel", "channel of linear sRGB", &["R", "G", "B"]),
            measured("t_k", "K", "temperature", [300.0, 1e7], 6500.0).also(&["T_K"]),
        ],
        inputs: &[],
        unit: "1",
        range: [-10.0, 100.0],
        notes: "Not clamped: blue is negative below about 1900 K.",
        also: &[alias("blackbody_linear_srgb")],
        known: &[known(
            &[("channel", "\"G\""), ("t_k", "6500")],
            NO_ANGLES,
            0.984_663_137_257_957_1,
            1e-12,
            REFERENCE,
        )],
        eval: |p, _| Ok(blackbody_srgb(p)?),
    },
];

/// Gauss-Legendre between the kinks of the colour matching functions, smooth on each side of which.
fn blackbody_srgb(p: &Params) -> Result<f64, ParamError> {
    let temperature = p.number("t_k")?;
    let rule = gauss::rule(64);
    let mut xyz = [0.0; 3];
    for (channel, sum) in xyz.iter_mut().enumerate() {
        for pair in blackbody::WYMAN_BREAKS.windows(2) {
            *sum += rule.integrate(pair[0], pair[1], |lambda| {
                blackbody::planck(lambda, temperature) * blackbody::wyman_xyz(lambda)[channel]
            });
        }
    }
    let rgb = blackbody::xyz_to_srgb(xyz.map(|v| v / xyz[1]));
    Ok(match p.choice("channel")? {
        "R" => rgb[0],
        "G" => rgb[1],
        _ => rgb[2],
    })
}
