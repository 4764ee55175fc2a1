//! Samplers at fixed random numbers, and the density of visible normals.

use super::ndf::{ALPHA, ALPHA_X, ALPHA_Y, GAMMA, ROUGHNESS};
use super::{
    COMPONENTS, FunctionError, FunctionInfo, Input, NO_ANGLES, REFERENCE, alias, alias_with, component,
    known, number,
};
use crate::cite;
use crate::math::frame;
use crate::models::{Param, ParamError, Params};
use crate::terms::beckmann::Beckmann;
use crate::terms::ggx::Ggx;
use crate::terms::smith::Ndf;
use crate::terms::student_t::StudentT;
use crate::terms::{blinn_phong, charlie, gtr};
use glam::{DVec2, DVec3};

const U: Param = number("u", "random number", [0.0, 1.0], 0.5).also(&["xi"]);
const U1: Param = number("u1", "first random number", [0.0, 1.0], 0.5);
const U2: Param = number("u2", "second random number", [0.0, 1.0], 0.5);
const NU: Param = number("nu", "exponent along the tangent", [0.0, 1e7], 10.0);
const NV: Param = number("nv", "exponent along the bitangent", [0.0, 1e7], 10.0);
const AZIMUTH: &str = "The azimuth is 2 pi times a second random number.";

/// (u, 0): the azimuth does not matter.
fn draw(p: &Params) -> Result<DVec2, ParamError> {
    Ok(DVec2::new(p.number("u")?, 0.0))
}

/// The family.
pub static ALL: &[FunctionInfo] = &[
    FunctionInfo {
        id: "sample-ggx",
        title: "tan^2 of a GGX normal",
        formula: "alpha^2 u / (1 - u)",
        sources: &[(cite::WALTER_2007, "Eq. 35")],
        params: &[ALPHA, U],
        inputs: &[],
        unit: "1",
        range: [0.0, f64::MAX],
        notes: AZIMUTH,
        also: &[alias("sample_ggx_D_tan2theta")],
        known: &[known(&[("alpha", "0.125"), ("u", "0.5")], NO_ANGLES, 0.015_625, 1e-14, "closed form")],
        eval: |p, _| {
            let wm = Ggx::isotropic(p.number("alpha")?).sample_d(draw(p)?);
            if wm.z <= 0.0 {
                let why = "u = 1 draws a normal in the horizon, where tan^2 is infinite";
                return Err(FunctionError::Undefined { function: "sample-ggx", why });
            }
            Ok(frame::tan2_theta(wm))
        },
    },
    FunctionInfo {
        id: "sample-beckmann",
        title: "tan^2 of a Beckmann normal",
        formula: "-alpha^2 ln(1 - u)",
        sources: &[(cite::WALTER_2007, "Eq. 28")],
        params: &[ALPHA, U],
        inputs: &[],
        unit: "1",
        range: [0.0, f64::MAX],
        notes: AZIMUTH,
        also: &[alias("sample_beckmann_D_tan2theta")],
        known: &[known(
            &[("alpha", "1"), ("u", "0.5")],
            NO_ANGLES,
            std::f64::consts::LN_2,
            1e-14,
            "closed form: ln 2",
        )],
        eval: |p, _| Ok(frame::tan2_theta(Beckmann::isotropic(p.number("alpha")?).sample_d(draw(p)?))),
    },
    FunctionInfo {
        id: "sample-blinn-phong",
        title: "Cosine of a Blinn-Phong normal, density D cos",
        formula: "u^(1 / (n + 2))",
        sources: &[(cite::WALTER_2007, "Eq. 31")],
        params: &[number("n", "exponent", [0.0, 1e7], 64.0), U],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: AZIMUTH,
        also: &[alias("sample_blinn_D_costheta")],
        known: &[known(&[("n", "0"), ("u", "0.25")], NO_ANGLES, 0.5, 1e-15, "closed form: sqrt(u) at n = 0")],
        eval: |p, _| Ok(blinn_phong::sample_d(p.number("n")?, draw(p)?).z),
    },
    FunctionInfo {
        id: "sample-gtr",
        title: "cos^2 of a GTR normal",
        formula: "(1 - (alpha^(2(1 - gamma)) (1 - u) + u)^(1 / (1 - gamma))) / (1 - alpha^2)",
        sources: &[(cite::BURLEY_2012, "App. B Eq. 2 and 5")],
        params: &[ALPHA, number("gamma", "exponent of the tail", [0.0, 10.0], 2.0), U],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: AZIMUTH,
        also: &[alias("sample_gtr_cos2theta"), alias_with("sample_gtr1_cos2theta", &[("gamma", "1")])],
        known: &[known(
            &[("alpha", "0.125"), ("gamma", "1"), ("u", "0.5")],
            NO_ANGLES,
            8.0 / 9.0,
            1e-14,
            "closed form: (1 - alpha) / (1 - alpha^2)",
        )],
        eval: |p, _| Ok(frame::cos2_theta(gtr::sample_d(p.number("alpha")?, p.number("gamma")?, draw(p)?))),
    },
    FunctionInfo {
        id: "sample-student-t",
        title: "tan^2 of a Student's t normal",
        formula: "alpha^2 (gamma - 1)((1 - u)^(1 / (1 - gamma)) - 1)",
        sources: &[(cite::RIBARDIERE_2017, "inverse of the integral of Eq. 4")],
        params: &[ALPHA, GAMMA, U],
        inputs: &[],
        unit: "1",
        range: [0.0, f64::MAX],
        notes: AZIMUTH,
        also: &[alias("sample_std_tan2theta")],
        known: &[known(
            &[("alpha", "0.125"), ("gamma", "3"), ("u", "0.5")],
            NO_ANGLES,
            0.012_944_173_824_159_22,
            1e-14,
            REFERENCE,
        )],
        eval: |p, _| {
            let ndf = StudentT::isotropic(p.number("alpha")?, p.number("gamma")?);
            Ok(frame::tan2_theta(ndf.sample_d(draw(p)?)))
        },
    },
    FunctionInfo {
        id: "sample-charlie",
        title: "Sine of a Charlie normal, density D cos",
        formula: "u^(r / (2 r + 1))",
        sources: &[(cite::ESTEVEZ_KULLA_2017, "inverse of the integral of Eq. 2")],
        params: &[ROUGHNESS, U],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: AZIMUTH,
        also: &[alias("sample_charlie_sintheta")],
        known: &[known(
            &[("roughness", "0.5"), ("u", "0.25")],
            NO_ANGLES,
            std::f64::consts::FRAC_1_SQRT_2,
            1e-15,
            "closed form: u^(1/4)",
        )],
        eval: |p, _| Ok(frame::sin_theta(charlie::sample_d(p.number("roughness")?, draw(p)?))),
    },
    FunctionInfo {
        id: "d-visible-ggx",
        title: "Density of the GGX normals that a direction sees",
        formula: "G1(w) max(0, w . m) D(m) / mu",
        sources: &[(cite::HEITZ_2014, "Eq. 16"), (cite::HEITZ_2018, "Eq. 2")],
        params: &[ALPHA, ALPHA_X, ALPHA_Y],
        inputs: &[Input::Wi("the direction w"), Input::Wo("the facet normal m")],
        unit: "1/sr",
        range: [0.0, f64::MAX],
        notes: "Its integral over m is 1. A reflected direction then has this over 4 w . m as its density.",
        also: &[alias("vndf_ggx")],
        known: &[known(
            &[("alpha", "0.25")],
            [0.5, 0.0, 0.5, 3.140_625],
            0.157_772_199_897_863_92,
            1e-13,
            REFERENCE,
        )],
        eval: |p, at| Ok(Ggx::new(p.number("alpha_x")?, p.number("alpha_y")?).d_visible(at.wi, at.wo)),
    },
    FunctionInfo {
        id: "sample-visible-ggx",
        title: "A GGX normal that a direction sees",
        formula: "normalize of the unstretched c + v, c uniform on the cap z > -v.z; or the routine of 2018",
        sources: &[(cite::DUPUY_BENYOUB_2023, "listing 3"), (cite::HEITZ_2018, "listing 1")],
        params: &[
            Param::choice("component", "which coordinate of the normal", COMPONENTS),
            Param::choice("routine", "which map from random numbers", &["cap", "hemisphere"]),
            ALPHA,
            ALPHA_X,
            ALPHA_Y,
            U1,
            U2,
        ],
        inputs: &[Input::Wi("the direction w, above the surface")],
        unit: "1",
        range: [-1.0, 1.0],
        notes: "Both routines have the same density, but map (u1, u2) differently.",
        also: &[
            alias_with("vndf_cap_sample_mx", &[("component", "x")]),
            alias_with("vndf_cap_sample_my", &[("component", "y")]),
            alias_with("vndf_cap_sample_mz", &[("component", "z")]),
        ],
        known: &[known(
            &[("component", "\"z\""), ("alpha", "0.25"), ("u1", "0.125"), ("u2", "0.25")],
            [0.5, 0.0, 0.0, 0.0],
            0.987_193_197_689_648_2,
            1e-13,
            REFERENCE,
        )],
        eval: |p, at| {
            let ndf = Ggx::new(p.number("alpha_x")?, p.number("alpha_y")?);
            let u = DVec2::new(p.number("u1")?, p.number("u2")?);
            let hemisphere = p.choice("routine")? == "hemisphere";
            let m: DVec3 =
                if hemisphere { ndf.sample_visible_2018(at.wi, u) } else { ndf.sample_visible(at.wi, u) };
            Ok(component(p, m)?)
        },
    },
    FunctionInfo {
        id: "sample-ashikhmin-shirley-phi",
        title: "Azimuth of an Ashikhmin-Shirley half vector, first quadrant",
        formula: "atan(sqrt((nu + 1) / (nv + 1)) tan(pi u1 / 2))",
        sources: &[
            (cite::ASHIKHMIN_SHIRLEY_2000, "the azimuth of the half vector"),
            (cite::CYCLES, "`bsdf_ashikhmin_shirley.h`: the same"),
        ],
        params: &[NU, NV, U1],
        inputs: &[],
        unit: "rad",
        range: [0.0, std::f64::consts::FRAC_PI_2],
        notes: "u1 runs over one quadrant here.",
        also: &[alias("sample_ashikhmin_shirley_h_phi")],
        known: &[known(
            &[("nu", "100"), ("nv", "10"), ("u1", "0.5")],
            NO_ANGLES,
            1.252_033_885_720_838_4,
            1e-15,
            REFERENCE,
        )],
        eval: |p, _| Ok(ashikhmin_shirley_phi(p)?),
    },
    FunctionInfo {
        id: "sample-ashikhmin-shirley-cosine",
        title: "Cosine of an Ashikhmin-Shirley half vector",
        formula: "(1 - u2)^(1 / (e + 1)), e = nu cos^2 phi + nv sin^2 phi",
        sources: &[
            (cite::ASHIKHMIN_SHIRLEY_2000, "the cosine of the half vector"),
            (cite::CYCLES, "`bsdf_ashikhmin_shirley.h`: the same"),
        ],
        params: &[NU, NV, U1, U2],
        inputs: &[],
        unit: "1",
        range: [0.0, 1.0],
        notes: "phi is that of `sample-ashikhmin-shirley-phi`.",
        also: &[alias("sample_ashikhmin_shirley_h_costheta")],
        known: &[known(
            &[("nu", "1"), ("nv", "1"), ("u2", "0.75")],
            NO_ANGLES,
            0.5,
            1e-15,
            "closed form: sqrt(1 - u2) at nu = nv = 1",
        )],
        eval: |p, _| {
            let (sin, cos) = libm::sincos(ashikhmin_shirley_phi(p)?);
            let exponent = p.number("nu")? * cos * cos + p.number("nv")? * sin * sin;
            Ok(libm::exp(libm::log1p(-p.number("u2")?) / (exponent + 1.0)))
        },
    },
];

fn ashikhmin_shirley_phi(p: &Params) -> Result<f64, ParamError> {
    let ratio = ((p.number("nu")? + 1.0) / (p.number("nv")? + 1.0)).sqrt();
    let (sin, cos) = libm::sincos(std::f64::consts::FRAC_PI_2 * p.number("u1")?);
    Ok(libm::atan2(ratio * sin, cos))
}
