//! Energy that single scattering loses: the factors that give it back.

use super::fresnel::F0;
use super::{FunctionError, FunctionInfo, NO_ANGLES, REFERENCE, alias_with, known, number};
use crate::cite;
use crate::models::Param;
use crate::terms::multiple_scattering as ms;

/// How far a sum of two integrals may be above 1 before it is no albedo: what storing them as half floats adds.
const ROUNDING: f64 = 1.0 / 1024.0;

const E_MU: Param = number("e", "directional albedo of the white lobe at the view cosine", [1e-9, 1.0], 0.7);
const SCALE: Param = number("scale", "channel A of a split-sum table", [0.0, 1.0], 0.6).also(&["A"]);
const BIAS: Param = number("bias", "channel B of a split-sum table", [0.0, 1.0], 0.05).also(&["B"]);

/// The family.
pub static ALL: &[FunctionInfo] = &[
    FunctionInfo {
        id: "kulla-conty-colour",
        title: "Colour of the multiple-scattering lobe",
        formula: "slides: F E / (1 - F (1 - E)); series: F^2 E / (1 - F (1 - E)), F and E the averages",
        sources: &[(cite::KULLA_CONTY_2017, "slide on F_ms"), (cite::HILL_2018, "the series of bounces")],
        params: &[
            Param::choice("form", "as on the slides, or by the series of bounces", &["slides", "series"]),
            number("f_avg", "average Fresnel factor", [0.0, 1.0], 0.9).also(&["Favg"]),
            number("e_avg", "average albedo of the white lobe", [0.0, 1.0], 0.7).also(&["Eavg"]),
        ],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "The two differ by a factor f_avg and agree at f_avg = 1.",
        also: &[
            alias_with("kulla_conty_fms_slides", &[("form", "slides")]),
            alias_with("fms_geometric_series", &[("form", "series")]),
        ],
        known: &[known(
            &[("form", "\"series\""), ("f_avg", "0.5"), ("e_avg", "0.9")],
            NO_ANGLES,
            0.225 / 0.95,
            1e-14,
            "closed form",
        )],
        eval: |p, _| {
            let (f, e) = (p.number("f_avg")?, p.number("e_avg")?);
            Ok(if p.choice("form")? == "slides" { ms::colour_slides(f, e) } else { ms::colour_series(f, e) })
        },
    },
    FunctionInfo {
        id: "kulla-conty-lobe",
        title: "The white multiple-scattering lobe",
        formula: "(1 - E_o)(1 - E_i) / (pi (1 - E_avg))",
        sources: &[(cite::KULLA_CONTY_2017, "slide on f_ms"), (cite::KELEMEN_2001, "the matte part")],
        params: &[
            number("missing_o", "1 - E at the view cosine", [0.0, 1.0], 0.3),
            number("missing_i", "1 - E at the light cosine", [0.0, 1.0], 0.3),
            number("missing_avg", "1 - E_avg", [1e-300, 1.0], 0.3),
        ],
        inputs: &[],
        unit: "1/sr",
        range: [0.0, f64::MAX],
        notes: "Takes the missing energy, which has digits where E is 1 to rounding.",
        also: &[],
        known: &[known(
            &[("missing_o", "0.5"), ("missing_i", "0.5"), ("missing_avg", "0.25")],
            NO_ANGLES,
            std::f64::consts::FRAC_1_PI,
            1e-15,
            "closed form",
        )],
        eval: |p, _| {
            Ok(ms::kulla_conty(p.number("missing_o")?, p.number("missing_i")?, p.number("missing_avg")?))
        },
    },
    FunctionInfo {
        id: "turquin-factor",
        title: "Turquin's factor of the single-scattering lobe",
        formula: "1 + F0 (1 - E) / E",
        sources: &[
            (cite::TURQUIN_2019, "Eq. 16, by MaterialX"),
            (cite::MATERIALX, "`mx_ggx_energy_compensation`: the same factor"),
        ],
        params: &[F0, E_MU],
        inputs: &[],
        unit: "1",
        range: [1.0, f64::MAX],
        notes: "View side only, so the result is not reciprocal.",
        also: &[],
        known: &[known(&[("f0", "0.5"), ("e", "0.5")], NO_ANGLES, 1.5, 1e-15, "closed form")],
        eval: |p, _| Ok(ms::turquin(p.number("f0")?, p.number("e")?)),
    },
    FunctionInfo {
        id: "fdez-aguera-weights",
        title: "Weights of the split sum with multiple scattering",
        formula: "single F0 A + B; multiple single F_avg E_ms / (1 - F_avg E_ms), E_ms = 1 - A - B; rest 1 - single - multiple",
        sources: &[(cite::FDEZ_AGUERA_2019, "the split sum with multiple scattering")],
        params: &[
            Param::choice(
                "part",
                "specular, its multiple scattering, or what is left",
                &["single", "multiple", "rest"],
            ),
            F0,
            SCALE,
            BIAS,
        ],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "F_avg = F0 + (1 - F0) / 21. F0 = 1 gives single + multiple = 1.",
        also: &[],
        known: &[
            known(
                &[("part", "\"multiple\""), ("f0", "1"), ("scale", "0.5"), ("bias", "0.125")],
                NO_ANGLES,
                0.375,
                1e-14,
                "closed form: 1 - (A + B) at F0 = 1",
            ),
            known(
                &[("part", "\"multiple\""), ("f0", "0.04"), ("scale", "0.6"), ("bias", "0.05")],
                NO_ANGLES,
                0.002_288_659_793_814_433,
                1e-13,
                REFERENCE,
            ),
        ],
        eval: |p, _| {
            let (scale, bias) = (p.number("scale")?, p.number("bias")?);
            if scale + bias > 1.0 + ROUNDING {
                let why = "scale + bias is above 1, more than a lobe can reflect";
                return Err(FunctionError::Undefined { function: "fdez-aguera-weights", why });
            }
            let parts = ms::fdez_aguera(p.number("f0")?, scale, bias);
            Ok(match p.choice("part")? {
                "single" => parts.single,
                "multiple" => parts.multiple,
                _ => parts.rest,
            })
        },
    },
];
