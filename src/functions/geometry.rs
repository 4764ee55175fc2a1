//! Directions: mirrors, refraction, the angles of Snell and Brewster.

use super::{
    At, COMPONENTS, FunctionError, FunctionInfo, Input, NO_ANGLES, REFERENCE, alias, alias_with, component,
    known, number,
};
use crate::cite;
use crate::math::frame;
use crate::models::{Param, Params};
use crate::terms::fresnel;

const ETA: Param = number("eta", "relative index of refraction, far side over near side", [1e-3, 1e3], 1.5)
    .also(&["eta_t_over_i", "ior"]);
const COMPONENT: Param = Param::choice("component", "which coordinate of the direction", COMPONENTS);
const NORMAL: Input = Input::Wo("the normal of the facet");

/// The family.
pub static ALL: &[FunctionInfo] = &[
    FunctionInfo {
        id: "reflect",
        title: "Mirror direction",
        formula: "2 (w . m) m - w",
        sources: &[(cite::WALTER_2007, "Eq. 39")],
        params: &[COMPONENT],
        inputs: &[Input::Wi("the direction w, away from the surface"), NORMAL],
        unit: "1",
        range: [-1.0, 1.0],
        notes: "The result points away from the facet, as w does.",
        also: &[
            alias_with("reflect_x", &[("component", "x")]),
            alias_with("reflect_y", &[("component", "y")]),
            alias_with("reflect_z", &[("component", "z")]),
        ],
        known: &[known(
            &[("component", "\"z\"")],
            [0.5, 0.0, 0.125, 3.140_625],
            0.731_688_924_405_090_8,
            1e-14,
            REFERENCE,
        )],
        eval: |p, at| Ok(component(p, frame::reflect(at.wi, at.wo))?),
    },
    FunctionInfo {
        id: "refract",
        title: "Refracted direction",
        formula: "(r c - sign(c) cos_t) m - r w, c = w . m, r = 1 / eta for c > 0, eta for c < 0",
        sources: &[(cite::WALTER_2007, "Eq. 40")],
        params: &[COMPONENT, ETA],
        inputs: &[Input::Wi("the direction w, away from the surface"), NORMAL],
        unit: "1",
        range: [-1.0, 1.0],
        notes: "No value under total internal reflection. eta is the index below the facet over that above it.",
        also: &[
            alias_with("refract_x", &[("component", "x")]),
            alias_with("refract_y", &[("component", "y")]),
            alias_with("refract_z", &[("component", "z")]),
        ],
        known: &[known(
            &[("component", "\"z\""), ("eta", "1.5")],
            [0.5, 0.0, 0.125, 3.140_625],
            -0.962_234_321_732_86,
            1e-14,
            REFERENCE,
        )],
        eval: refract,
    },
    FunctionInfo {
        id: "critical-angle",
        title: "Critical angle of total internal reflection, from the denser side",
        formula: "asin(1 / eta) = atan2(1, sqrt((eta - 1)(eta + 1))), eta the denser index over the rarer",
        sources: &[(cite::BORN_WOLF_1999, "section 1.5.4")],
        params: &[number("eta", "denser index over the rarer one", [1.0, 1e3], 1.5)
            .also(&["eta_dense_over_rare", "ior"])],
        inputs: &[],
        unit: "rad",
        range: [0.0, std::f64::consts::FRAC_PI_2],
        notes: "pi / 2 at eta = 1, approached like a square root.",
        also: &[alias("critical_angle_rad")],
        known: &[known(&[("eta", "1.5")], NO_ANGLES, 0.729_727_656_226_966_3, 1e-15, REFERENCE)],
        eval: |p, _| {
            let eta = p.number("eta")?;
            Ok(libm::atan2(1.0 / eta, fresnel::cos_critical(eta)))
        },
    },
    FunctionInfo {
        id: "brewster-angle",
        title: "Brewster's angle, where p-polarised light is not reflected",
        formula: "atan(eta)",
        sources: &[(cite::BORN_WOLF_1999, "section 1.5.3")],
        params: &[ETA],
        inputs: &[],
        unit: "rad",
        range: [0.0, std::f64::consts::FRAC_PI_2],
        notes: "Seen from the side of the index that eta is relative to.",
        also: &[alias("brewster_angle_rad")],
        known: &[known(&[("eta", "1.5")], NO_ANGLES, 0.982_793_723_247_329, 1e-15, REFERENCE)],
        eval: |p, _| Ok(libm::atan(p.number("eta")?)),
    },
    FunctionInfo {
        id: "radiance-scale",
        title: "Radiance across a smooth interface at normal incidence",
        formula: "(1 - F0) eta^2",
        sources: &[(cite::WALTER_2007, "section 4.2 (the factor of the transmitted solid angle)")],
        params: &[ETA],
        inputs: &[],
        unit: "1",
        range: [0.0, f64::MAX],
        notes: "L / n^2 is what a lossless interface keeps. Transport of importance has no eta^2.",
        also: &[alias("radiance_scale_T_times_eta2_normal_incidence")],
        known: &[known(&[("eta", "1.5")], NO_ANGLES, 2.16, 1e-15, "closed form: 0.96 * 2.25")],
        eval: |p, _| {
            let eta = p.number("eta")?;
            Ok(fresnel::dielectric_transmittance(1.0, eta).unpolarised() * eta * eta)
        },
    },
];

fn refract(params: &Params, at: &At) -> Result<f64, FunctionError> {
    let undefined = FunctionError::Undefined {
        function: "refract",
        why: "total internal reflection: nothing is refracted",
    };
    let through = fresnel::refract(at.wi, at.wo, params.number("eta")?).ok_or(undefined)?;
    Ok(component(params, through)?)
}
