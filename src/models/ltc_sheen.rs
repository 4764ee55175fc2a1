//! The sheen of Zeltner, Burley and Chiang: multiple scattering in a layer of fibres, as one transformed cosine.
//!
//! Recipe: `model = "ltc-sheen"`, `params = { roughness = 0.3 }`. Its albedo is in closed form; the base below it is scaled by
//! one minus that.

use super::cloth::{Cloth, ClothLobe};
use super::{Brdf, DefaultValue, Functional, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::integrate::Estimate;
use crate::math::frame;
use crate::terms::ltc_sheen::Sheen;
use glam::DVec3;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "ltc-sheen",
    title: "Sheen by a linearly transformed cosine (Zeltner)",
    formula: "f = R(mu_o, r) D(wi) / mu_i, D = max(0, v.z) / pi (A / |v|^2)^2, v = (A x + B z, A y, z) in the frame of wo",
    sources: &[
        (cite::ZELTNER_2022, "section 3; rational fits of MaterialX mx_zeltner_sheen"),
        (cite::HEITZ_2016, "Eq. 1"),
    ],
    params: &[Param::number(
        "roughness",
        "r",
        "roughness of the fibres",
        [0.01, 1.0],
        DefaultValue::Value(0.5),
    )
    .also(&["r"])
    .swept("roughness", [0.03, 1.0], 1.0)],
    laws: Laws { reciprocal: false, passive: true, isotropic: true },
    notes: "Not reciprocal (asymmetry up to 27 %). The fit of R dips to -2e-5 near roughness 0.1 and is clamped to 0 here; \
        the function `ltc-sheen-fit` does not clamp. E = R exactly.",
    also: &[],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("roughness", "0.5")],
            value: 0.010_918_162_934_908_076,
            relative: 1e-12,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("roughness", "1")],
            value: 0.344_619_027_497_392_2,
            relative: 1e-9,
            source: "formula of R in 30-digit arithmetic; the lobe is normalised",
        },
    ],
    splits: false,
    build,
};

#[derive(Debug)]
struct Fibres {
    roughness: f64,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(ClothLobe(Fibres { roughness: params.number("roughness")? })))
}

impl Cloth for Fibres {
    fn value(&self, wo: DVec3, wi: DVec3) -> f64 {
        let sheen = Sheen::new(wo.z, self.roughness);
        sheen.reflectance.max(0.0) * sheen.lobe().density(turn(wo, wi)) / wi.z
    }

    fn reduced(&self, mu_o: f64, functionals: &[Functional], _tolerance: f64) -> Option<Estimate> {
        let [Functional::One] = functionals else { return None };
        let mut e = Estimate::exact_one(Sheen::new(mu_o, self.roughness).reflectance.max(0.0));
        e.error[0] = 1e-15;
        Some(e)
    }
}

/// `wi` in the frame in which `wo` has azimuth 0.
fn turn(wo: DVec3, wi: DVec3) -> DVec3 {
    let sin = frame::sin_theta(wo);
    let (c, s) = if sin > 0.0 { (wo.x / sin, wo.y / sin) } else { (1.0, 0.0) };
    DVec3::new(c * wi.x + s * wi.y, c * wi.y - s * wi.x, wi.z)
}
