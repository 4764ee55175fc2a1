//! Linearly transformed cosines, and the sheen that is fitted with them.

use super::{FunctionInfo, Input, REFERENCE, alias, known, number, theta};
use crate::cite;
use crate::math::frame;
use crate::models::Param;
use crate::terms::ltc::Ltc;
use crate::terms::ltc_sheen::Sheen;
use glam::DVec3;

const ROUGHNESS: Param = number("roughness", "roughness of the cloth", [0.01, 1.0], 0.5);

/// The family.
pub static ALL: &[FunctionInfo] = &[
    FunctionInfo {
        id: "ltc-density",
        title: "Density of a linearly transformed cosine",
        formula: "max(0, z(v / |v|)) / pi |det M^-1| / |v|^3, v = M^-1 w, M = [[m11, 0, m13], [0, m22, 0], [m31, 0, 1]]",
        sources: &[(cite::HEITZ_2016, "Eq. 1 and 3")],
        params: &[
            number("m11", "stretch along x", [1e-6, 1e6], 1.0),
            number("m22", "stretch along y", [1e-6, 1e6], 1.0),
            number("m13", "shear of x by z", [-1e6, 1e6], 0.0),
            number("m31", "shear of z by x", [-1e6, 1e6], 0.0),
        ],
        inputs: &[Input::Wi("the direction w")],
        unit: "1/sr",
        range: [0.0, f64::MAX],
        notes: "Its integral over the sphere is 1. 0 for a matrix that mirrors (m11 - m13 m31 <= 0).",
        also: &[alias("ltc_density")],
        known: &[known(&[], theta(0.125), 0.315_826_326_527_590_3, 1e-14, REFERENCE)],
        eval: |p, at| {
            let lobe = Ltc {
                m11: p.number("m11")?,
                m22: p.number("m22")?,
                m13: p.number("m13")?,
                m31: p.number("m31")?,
            };
            Ok(lobe.density(at.wi))
        },
    },
    FunctionInfo {
        id: "ltc-sheen-fit",
        title: "Zeltner's sheen as MaterialX fits it, not clamped",
        formula: "R(mu_o, r) D_LTC(wi) / mu_i, M^-1 = [[A, 0, B], [0, A, 0], [0, 0, 1]]",
        sources: &[(cite::ZELTNER_2022, "section 3; rational fits of MaterialX mx_zeltner_sheen")],
        params: &[ROUGHNESS],
        inputs: &[Input::Wi("the light direction"), Input::Wo("the view direction")],
        unit: "1/sr",
        range: [-1.0, f64::MAX],
        notes: "The fit of R dips below 0 (by 2e-5) at small roughness; the model `ltc-sheen` clamps it. Not reciprocal.",
        also: &[alias("zeltner_ltc_materialx_fit")],
        known: &[known(
            &[("roughness", "1")],
            [0.0, 0.0, 0.75, 0.0],
            0.100_438_783_871_286_9,
            1e-12,
            REFERENCE,
        )],
        eval: |p, at| {
            if !frame::both_above(at.wo, at.wi) {
                return Ok(0.0);
            }
            let sheen = Sheen::new(at.wo.z, p.number("roughness")?);
            let (wi, sin) = (at.wi, frame::sin_theta(at.wo));
            // the frame in which wo has azimuth 0
            let (c, s) = if sin > 0.0 { (at.wo.x / sin, at.wo.y / sin) } else { (1.0, 0.0) };
            let turned = DVec3::new(c * wi.x + s * wi.y, c * wi.y - s * wi.x, wi.z);
            Ok(sheen.reflectance * sheen.lobe().density(turned) / wi.z)
        },
    },
    FunctionInfo {
        id: "ltc-sheen-albedo",
        title: "Directional albedo of Zeltner's sheen as MaterialX fits it",
        formula: "exp(-((mu - m) / s)^2 / 2) / (s sqrt(2 pi)) + o, with rational m, s, o of the roughness",
        sources: &[(cite::ZELTNER_2022, "section 3; rational fits of MaterialX mx_zeltner_sheen")],
        params: &[ROUGHNESS],
        inputs: &[Input::Incidence("the polar angle of the view direction")],
        unit: "1",
        range: [-1e-4, 1.0],
        notes: "The weight of the base below the sheen is 1 minus this.",
        also: &[],
        known: &[known(&[("roughness", "1")], theta(0.0), 0.344_619_027_497_392_2, 1e-13, REFERENCE)],
        eval: |p, at| Ok(Sheen::new(libm::cos(at.wi_theta).max(0.0), p.number("roughness")?).reflectance),
    },
];
