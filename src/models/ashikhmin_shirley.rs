//! Ashikhmin-Shirley, the anisotropic Phong model: a coloured substrate under a glossy, brushed interface.
//!
//! The parts are models of their own: [`ashikhmin_shirley_specular`](super::ashikhmin_shirley_specular) and
//! [`ashikhmin_shirley_diffuse`](super::ashikhmin_shirley_diffuse). Typical: rd = 0.5, rs = 0.05, nu = nv = 100 for
//! plastic; rs = 0.9, nu = 10, nv = 1000 for brushed metal.
//!
//! Recipe: `model = "ashikhmin-shirley"`, `params = { rd = 0.5, rs = 0.05, nu = 1000, nv = 10 }`.

use super::ashikhmin_shirley_diffuse::{RD, RS, Substrate};
use super::ashikhmin_shirley_specular::{NU, NV, Specular};
use super::lobes::{Diffuse, Part, Sum};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, ParamError, Params};
use crate::cite;
use crate::terms::schlick;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "ashikhmin-shirley",
    title: "Ashikhmin-Shirley",
    formula: "f = f_s + f_d, as in `ashikhmin-shirley-specular` and `ashikhmin-shirley-diffuse`",
    sources: &[
        (cite::ASHIKHMIN_SHIRLEY_2000, "the specular and the diffuse term"),
        (cite::BBM, "`ashikhminshirleyfull.h`: the same form"),
    ],
    params: &[RD, RS, NU, NV],
    laws: Laws { reciprocal: true, passive: true, isotropic: false },
    notes: "E <= 1 was found in every scan (0.982 at most with rd = 1), not proved; of the specular part it is proved. Kink at mu_i = mu_o.",
    also: &[Alias { name: "ashikhmin_shirley_total", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("rd", "0.5"), ("rs", "0.046875"), ("nu", "100"), ("nv", "10")],
            value: 0.141_198_322_192_353_6,
            relative: 1e-13,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("rd", "0"), ("rs", "1"), ("nu", "10"), ("nv", "10")],
            value: 0.695_707_244_140_319_9,
            relative: 1e-11,
            source: "two quadratures in extended precision",
        },
    ],
    splits: false,
    build,
};

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let (rd, rs) = (params.number("rd")?, params.number("rs")?);
    let mut matte = Part::new(1.0, Diffuse(Substrate::new(params)?));
    matte.chance = rd * (1.0 - rs);
    let mut gloss = Part::new(1.0, Specular::new(params)?);
    gloss.chance = schlick::schlick_average(rs, 1.0);
    Ok(Box::new(Sum::new(vec![matte, gloss])))
}
