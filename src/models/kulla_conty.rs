//! Kulla and Conty's compensation: microfacets, and a second lobe that carries exactly what they lose.
//!
//! Recipe: `model = "kulla-conty"`, `params = { base = "ggx", alpha = 0.5, f0 = 0.9 }`.

use super::compensated::{self, Parts, Rule};
use super::{Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;
use crate::terms::multiple_scattering as ms;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "kulla-conty",
    title: "Microfacets with the multiple scattering of Kulla and Conty",
    formula: "f = f_s + F_ms (1 - E(mu_o))(1 - E(mu_i)) / (pi (1 - E_avg)), F_ms = F_avg^2 E_avg / (1 - F_avg (1 - E_avg))",
    sources: &[
        (cite::KULLA_CONTY_2017, "the slides on energy conservation (f_ms, and F_ms with F_avg once)"),
        (cite::HILL_2018, "F_ms with the square"),
        (cite::KELEMEN_2001, "section 3, the same lobe for a matte base"),
    ],
    params: compensated::PARAMS_WITH_COLOUR,
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "White (f0 = f90 = 1) reflects everything. E is the white albedo of the base, a curve of about 1e-8 that is integrated \
        when the model is built. alpha = 0 is the mirror.",
    also: &[],
    known: &[
        Known {
            what: KnownValue::Albedo(0.3),
            params: &[("alpha", "0.7")],
            value: 1.0,
            relative: 1e-6,
            source: "white furnace",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("alpha", "1"), ("f0", "0.5"), ("f90", "0.5"), ("masking", "\"separable\"")],
            // E = 1 - ln 2, E_avg = 4 (1 - ln 2)^2 = e; F_ms = e / (4 (1 - (1 - e) / 2)) = e / (2 (1 + e))
            value: 0.153_426_409_720_027_36
                + 0.376_634_611_193_243_26 / 2.753_269_222_386_486_5 * std::f64::consts::LN_2,
            relative: 1e-6,
            source: "closed form: separable Smith at alpha = 1",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    compensated::build(INFO.id, params, rule)
}

fn rule(params: &Params, parts: &Parts<'_>) -> Result<Rule, ParamError> {
    let (f_avg, e_avg) = (compensated::f_avg(params)?, parts.e_avg());
    let of = if params.choice("colour")? == "slides" { ms::colour_slides } else { ms::colour_series };
    let rest = 1.0 - f_avg * (1.0 - e_avg);
    // d/dE of F E / (1 - F (1 - E)) is F (1 - F) / rest^2
    let slope = if rest > 0.0 { f_avg * (1.0 - f_avg) / (rest * rest) } else { 0.0 };
    Ok(Rule::KullaConty { colour: of(f_avg, e_avg), slope })
}
