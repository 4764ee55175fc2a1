//! Thin films: spectral truth and its colour.

use super::fresnel::{POLARISATION, polarised};
use super::{FunctionInfo, Input, NO_ANGLES, REFERENCE, alias_with, known, measured, number, theta};
use crate::cite;
use crate::models::{Param, ParamError, Params};
use crate::terms::thin_film::{self, Channel, Film};

const N2: Param = number("n2", "index of the film", [0.1, 10.0], 1.33);
const N3: Param = number("n3", "real part of the index of the substrate", [0.0, 100.0], 1.5);
const K3: Param = number("k3", "extinction coefficient of the substrate", [0.0, 100.0], 0.0);
const THICKNESS: Param = measured("d_nm", "nm", "thickness of the film", [0.0, 1e5], 400.0);
const WAVELENGTH: Param = measured("lambda_nm", "nm", "wavelength in vacuum", [1.0, 1e6], 550.0);
const INCIDENCE: Input = Input::Incidence("the angle of incidence, in vacuum");

fn film(p: &Params) -> Result<Film, ParamError> {
    Ok(Film { n2: p.number("n2")?, n3: p.number("n3")?, k3: p.number("k3")?, d_nm: p.number("d_nm")? })
}

/// The family.
pub static ALL: &[FunctionInfo] = &[
    FunctionInfo {
        id: "thin-film-airy",
        title: "Spectral reflectance of a thin film (Airy)",
        formula: "|r12 + r23 e^(i d)|^2 / |1 + r12 r23 e^(i d)|^2, d = 4 pi n2 d_nm cos2 / lambda_nm",
        sources: &[(cite::BORN_WOLF_1999, "section 7.6.1"), (cite::BELCOUR_BARLA_2017, "section 3")],
        params: &[N2, N3, K3, THICKNESS, WAVELENGTH, POLARISATION],
        inputs: &[INCIDENCE],
        unit: "1",
        range: [0.0, 1.0],
        notes: "Evaluated as the characteristic matrix of the film. d_nm = 0 is the bare substrate. k = n kappa.",
        also: &[
            alias_with("thin_film_airy_s", &[("polarisation", "s")]),
            alias_with("thin_film_airy_p", &[("polarisation", "p")]),
        ],
        known: &[known(
            &[("n2", "2"), ("n3", "1.5"), ("d_nm", "100"), ("lambda_nm", "650"), ("polarisation", "\"s\"")],
            theta(0.5),
            0.238_390_714_897_593_92,
            1e-13,
            REFERENCE,
        )],
        eval: |p, at| {
            let value = thin_film::airy(&film(p)?, libm::cos(at.wi_theta), p.number("lambda_nm")?);
            Ok(polarised(p, value)?)
        },
    },
    FunctionInfo {
        id: "thin-film-sensitivity",
        title: "Sensitivity of the eye as a function of optical path difference",
        formula: "sum v sqrt(2 pi w) cos(m p + shift) exp(-w p^2) / 1.0685e-7, p = 2 pi OPD",
        sources: &[(cite::BELCOUR_BARLA_2017, "section 4 and the published shader")],
        params: &[
            Param::choice("channel", "CIE 1931 colour matching function", &["X", "Y", "Z"]),
            measured("opd_nm", "nm", "optical path difference", [-1e6, 1e6], 0.0),
            measured("shift_rad", "rad", "phase shift of the interfaces", [-1e3, 1e3], 0.0),
        ],
        inputs: &[],
        unit: "1",
        range: [-1.01, 1.01],
        notes: "The Fourier transform of a fit of Gaussians; 1 at 0 within 0.0012.",
        also: &[
            alias_with("belcour_barla_sensitivity_X", &[("channel", "X")]),
            alias_with("belcour_barla_sensitivity_Y", &[("channel", "Y")]),
            alias_with("belcour_barla_sensitivity_Z", &[("channel", "Z")]),
        ],
        known: &[known(
            &[("channel", "\"Y\""), ("opd_nm", "500"), ("shift_rad", "1")],
            NO_ANGLES,
            0.854_955_819_481_881_7,
            1e-13,
            REFERENCE,
        )],
        eval: |p, _| {
            let channel = match p.choice("channel")? {
                "X" => Channel::X,
                "Y" => Channel::Y,
                _ => Channel::Z,
            };
            Ok(thin_film::sensitivity(channel, p.number("opd_nm")?, p.number("shift_rad")?))
        },
    },
    FunctionInfo {
        id: "thin-film-rgb",
        title: "Colour of a thin film in white light (Belcour and Barla)",
        formula: "M (R12 + R* + 2 sum_m C_m S(m OPD, m phi)), R* = T^2 R23 / (1 - R12 R23), C_m = (R* - T)(R12 R23)^(m/2)",
        sources: &[
            (cite::BELCOUR_BARLA_2017, "Eq. 10, by Cycles"),
            (cite::CYCLES, "`iridescence_airy_summation_channel`: the same series"),
        ],
        params: &[
            Param::choice("channel", "channel of linear RGB", &["R", "G", "B"]),
            number("n2", "index of the film", [1.0, 10.0], 1.33),
            N3,
            K3,
            THICKNESS,
            number(
                "orders",
                "orders of interference that are summed; rounded to a whole number",
                [0.0, 100.0],
                2.0,
            ),
        ],
        inputs: &[INCIDENCE],
        unit: "1",
        range: [-0.5, 1.5],
        notes: "Not clamped: a short sum and the matrix overshoot [0, 1] a little. One index for all channels.",
        also: &[],
        known: &[known(
            &[("channel", "\"G\""), ("n2", "1"), ("n3", "1.5"), ("orders", "0")],
            theta(0.0),
            0.04,
            1e-6,
            "closed form: a film of index 1 is no film, and the matrix keeps white",
        )],
        eval: |p, at| {
            let rgb = thin_film::rgb(&film(p)?, libm::cos(at.wi_theta), orders(p)?);
            Ok(match p.choice("channel")? {
                "R" => rgb[0],
                "G" => rgb[1],
                _ => rgb[2],
            })
        },
    },
];

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "declared to lie in [0, 100]")]
fn orders(p: &Params) -> Result<u32, ParamError> {
    Ok(p.number("orders")?.round() as u32)
}
