//! Light that diffuses below a surface: profiles, transmittance of thin parts, the specular of skin.

use super::{FunctionInfo, Input, NO_ANGLES, REFERENCE, alias, alias_with, known, measured, number};
use crate::cite;
use crate::models::{Param, ParamError, Params};
use crate::terms::burley_diffusion::{self, ShapeFit};
use crate::terms::dipole::Dipole;
use crate::terms::skin::{self, Channel};
use crate::terms::skin_specular;

const SIGMA_A: Param = measured("sigma_a", "1/length", "absorption", [0.0, 1e9], 0.01);
const SIGMA_S: Param =
    measured("sigma_s_prime", "1/length", "reduced scattering, (1 - g) sigma_s", [1e-9, 1e9], 1.0);
const ETA: Param = number("eta", "relative index of the medium", [1.0, 3.0], 1.3);
const DISTANCE: Param = measured("r", "length", "distance from the point of entry", [0.0, 1e9], 1.0);
const CHANNEL: Param = Param::choice("channel", "red, green or blue", &["R", "G", "B"]);
const ALBEDO: Param = number("albedo", "albedo of the surface", [0.0, 1.0], 0.8).also(&["A"]);
const LENGTH: Param = measured("length", "length", "mean free path", [1e-9, 1e9], 1.0).also(&["l"]);
const FIT: Param =
    Param::choice("fit", "how the scale follows from the albedo", &["searchlight", "diffuse", "dmfp"]);

fn dipole(p: &Params) -> Result<Dipole, ParamError> {
    Ok(Dipole { sigma_a: p.number("sigma_a")?, sigma_s: p.number("sigma_s_prime")?, eta: p.number("eta")? })
}

fn channel(p: &Params) -> Result<Channel, ParamError> {
    Ok(match p.choice("channel")? {
        "R" => Channel::Red,
        "G" => Channel::Green,
        _ => Channel::Blue,
    })
}

fn fit(p: &Params) -> Result<ShapeFit, ParamError> {
    Ok(match p.choice("fit")? {
        "searchlight" => ShapeFit::Searchlight,
        "diffuse" => ShapeFit::Diffuse,
        _ => ShapeFit::DiffuseMeanFreePath,
    })
}

/// The family.
pub static ALL: &[FunctionInfo] = &[
    FunctionInfo {
        id: "dipole-reflectance",
        title: "Diffuse reflectance of the dipole at a distance",
        formula: "alpha' / (4 pi) sum z (1 + sigma_tr d) exp(-sigma_tr d) / d^3, over the source and its image",
        sources: &[(cite::JENSEN_2002, "the dipole, both terms"), (cite::JENSEN_2001, "Eq. 4")],
        params: &[SIGMA_A, SIGMA_S, ETA, DISTANCE],
        inputs: &[],
        unit: "1/length^2",
        range: [0.0, f64::MAX],
        notes: "The form of 2002; the second term printed in 2001 has the wrong dimension.",
        also: &[alias("dipole_Rd")],
        known: &[known(
            &[("sigma_a", "0.1"), ("sigma_s_prime", "2"), ("r", "0.25")],
            NO_ANGLES,
            0.224_078_378_722_152_53,
            1e-13,
            REFERENCE,
        )],
        eval: |p, _| Ok(dipole(p)?.reflectance(p.number("r")?)),
    },
    FunctionInfo {
        id: "dipole-total",
        title: "Total diffuse reflectance of the dipole",
        formula: "(alpha' / 2)(1 + exp(-4 A s / 3)) exp(-s), s = sqrt(3 (1 - alpha'))",
        sources: &[(cite::JENSEN_2002, "the total diffuse reflectance")],
        params: &[SIGMA_A, SIGMA_S, ETA],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "1 for every index if nothing absorbs.",
        also: &[alias("dipole_total_diffuse_albedo")],
        known: &[known(&[("sigma_a", "0")], NO_ANGLES, 1.0, 1e-15, "closed form: nothing absorbs")],
        eval: |p, _| Ok(dipole(p)?.total()),
    },
    FunctionInfo {
        id: "skin-profile",
        title: "Diffusion profile of skin, six Gaussians",
        formula: "sum w_i exp(-r^2 / (2 v_i)) / (2 pi v_i)",
        sources: &[(cite::DEON_LUEBKE_2007, "Fig. 14-13")],
        params: &[CHANNEL, measured("r_mm", "mm", "distance", [0.0, 1e6], 1.0)],
        inputs: &[],
        unit: "1/mm^2",
        range: [0.0, f64::MAX],
        notes: "Each channel integrates to 1: the albedo comes from a texture.",
        also: &[alias("deon_luebke_R")],
        known: &[known(&[("r_mm", "0.25")], NO_ANGLES, 0.361_152_939_742_374_95, 1e-14, REFERENCE)],
        eval: |p, _| Ok(skin::profile(channel(p)?, p.number("r_mm")?)),
    },
    FunctionInfo {
        id: "skin-transmittance",
        title: "Transmittance of thin skin by the six Gaussians",
        formula: "sum w_i exp(-d^2 / (2 v_i)) (GPU Gems 3), or exp(-d^2 / v_i) (Jimenez)",
        sources: &[
            (cite::DEON_LUEBKE_2007, "section 14.5.6"),
            (cite::JIMENEZ_2010, "the transmittance profile"),
        ],
        params: &[
            Param::choice("convention", "whose exponent", &["gpu-gems", "jimenez"]),
            CHANNEL,
            measured("d_mm", "mm", "thickness", [0.0, 1e6], 1.0),
        ],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0 + 1e-12],
        notes: "The two conventions differ by a factor 2 in the exponent and are not interchangeable.",
        also: &[
            alias_with("skin_transmit_exp_d2_over_2v", &[("convention", "gpu-gems")]),
            alias_with("skin_transmit_exp_d2_over_v", &[("convention", "jimenez")]),
        ],
        known: &[known(&[("d_mm", "1")], NO_ANGLES, 0.406_299_753_930_596_7, 1e-14, REFERENCE)],
        eval: |p, _| {
            let (channel, d) = (channel(p)?, p.number("d_mm")?);
            let jimenez = p.choice("convention")? == "jimenez";
            Ok(if jimenez {
                skin::transmittance_jimenez(channel, d)
            } else {
                skin::transmittance(channel, d)
            })
        },
    },
    FunctionInfo {
        id: "skin-specular",
        title: "Specular of skin as the shader of GPU Gems 3 returns it",
        formula: "(n . l) rho_s PH F / |l + v|^2, PH = pi D of Beckmann, F = F0 + (1 - F0)(1 - h . v)^5",
        sources: &[
            (cite::DEON_LUEBKE_2007, "section 14.3, KS_Skin_Specular"),
            (cite::KELEMEN_2001, "section 2"),
        ],
        params: &[
            number("m", "roughness, Beckmann's alpha", [1e-6, 1.0], 0.3),
            number("rho_s", "strength", [0.0, 1.0], 0.18),
            number("f0", "reflectance at normal incidence", [0.0, 1.0], skin_specular::F0).also(&["F0"]),
        ],
        inputs: &[Input::Wi("the light direction l"), Input::Wo("the view direction v")],
        unit: "1",
        range: [0.0, f64::MAX],
        notes: "A shading value: it holds the cosine, and pi times the reflected radiance, for lights whose intensity carries pi. \
            The model `kelemen-skin` is the BRDF.",
        also: &[alias("gpugems3_ks_skin_result")],
        known: &[known(
            &[("m", "0.3125"), ("rho_s", "0.1875")],
            [0.5, 0.0, 0.5, 3.140_625],
            0.015_329_404_718_887_1,
            1e-12,
            REFERENCE,
        )],
        eval: |p, at| {
            Ok(skin_specular::shading(p.number("m")?, p.number("rho_s")?, p.number("f0")?, at.wo, at.wi))
        },
    },
    FunctionInfo {
        id: "burley-diffusion",
        title: "Normalised diffusion",
        formula: "A (s / l)(exp(-x) + exp(-x / 3)) / (8 pi r), x = s r / l",
        sources: &[(cite::CHRISTENSEN_BURLEY_2015, "Eq. 3, 5, 6 and 8")],
        params: &[
            FIT,
            ALBEDO,
            LENGTH,
            measured("r", "length", "distance from the point of entry", [1e-300, 1e9], 1.0),
        ],
        inputs: &[],
        unit: "1/length^2",
        range: [0.0, f64::MAX],
        notes: "Grows as 1/r towards 0. Integrates to the albedo exactly.",
        also: &[alias("burley2015_R")],
        known: &[known(
            &[("albedo", "0.5"), ("r", "0.25")],
            NO_ANGLES,
            0.191_083_910_235_258_11,
            1e-14,
            REFERENCE,
        )],
        eval: |p, _| {
            let (albedo, length) = (p.number("albedo")?, p.number("length")?);
            Ok(burley_diffusion::profile(fit(p)?, albedo, length, p.number("r")?))
        },
    },
    FunctionInfo {
        id: "burley-diffusion-inside",
        title: "Part of normalised diffusion inside a radius",
        formula: "1 - exp(-x) / 4 - 3 exp(-x / 3) / 4, x = s r / l",
        sources: &[(cite::CHRISTENSEN_BURLEY_2015, "Eq. 11 (number as MoonRay quotes it)")],
        params: &[FIT, ALBEDO, LENGTH, DISTANCE],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "The cumulative distribution that importance sampling inverts.",
        also: &[alias("burley2015_irradiance_disk_fraction")],
        known: &[known(
            &[("albedo", "0.5"), ("r", "0.25")],
            NO_ANGLES,
            0.170_119_724_997_888_22,
            1e-14,
            REFERENCE,
        )],
        eval: |p, _| {
            let scale = burley_diffusion::scale(fit(p)?, p.number("albedo")?);
            Ok(burley_diffusion::cdf(scale * p.number("r")? / p.number("length")?))
        },
    },
    FunctionInfo {
        id: "burley-diffusion-inverse",
        title: "Exact inverse of the cumulative distribution of normalised diffusion",
        formula: "x = -3 ln t, t = 2 sinh(asinh(2 (1 - xi)) / 3), r = x l / s",
        sources: &[(cite::CHRISTENSEN_BURLEY_2015, "Eq. 11, inverted here in closed form")],
        params: &[number("xi", "random number", [0.0, 1.0], 0.5)],
        inputs: &[],
        unit: "1",
        range: [0.0, 112.0],
        notes: "The value is x = s r / l. xi = 1 counts as 1 - 2^-53.",
        also: &[alias("burley2015_cdf_inverse")],
        known: &[known(&[("xi", "0.5")], NO_ANGLES, 1.552_183_263_544_17, 1e-14, REFERENCE)],
        eval: |p, _| Ok(burley_diffusion::cdf_inverse(p.number("xi")?)),
    },
];
