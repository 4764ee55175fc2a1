//! The specular part of Ashikhmin and Shirley alone: an anisotropic Phong lobe of the half vector with a Fresnel factor.
//!
//! `nu` and `nv` are the exponents along the tangent and across it; 10 is dull, 1000 polished. There is no masking, but
//! the larger of the two cosines below bounds the growth at grazing.
//!
//! Recipe: `model = "ashikhmin-shirley-specular"`, `params = { rs = 0.05, nu = 1000, nv = 10 }`.

use super::ashikhmin_shirley_diffuse::RS;
use super::{
    Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params, Sample,
};
use crate::cite;
use crate::integrate::{BATCH, Chart, Edge, FacetLobe, Nodes};
use crate::math::{frame, special};
use crate::terms::{blinn_phong, schlick};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "ashikhmin-shirley-specular",
    title: "Ashikhmin-Shirley, specular part",
    formula: "f = sqrt((nu + 1)(nv + 1)) / (8 pi) (n.wh)^e F(v) / (v max(mu_i, mu_o)), v = wi.wh, \
        e = (nu wh.x^2 + nv wh.y^2) / (wh.x^2 + wh.y^2), F = Rs + (1 - Rs)(1 - v)^5",
    sources: &[
        (cite::ASHIKHMIN_SHIRLEY_2000, "the specular term"),
        (cite::CYCLES, "`bsdf_ashikhmin_shirley.h`, without F: the same form"),
        (cite::SCHLICK_1994, "Eq. 15 (F)"),
    ],
    params: &[RS, NU, NV],
    laws: Laws { reciprocal: true, passive: true, isotropic: false },
    notes: "E -> F as the exponents grow. The azimuth of wh is undefined at the normal, where (n.wh)^e = 1. Kink at mu_i = mu_o.",
    also: &[Alias { name: "ashikhmin_shirley_specular", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("rs", "0.046875"), ("nu", "100"), ("nv", "10")],
            value: 0.000_103_563_216_540_786_91,
            relative: 1e-12,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("rs", "1"), ("nu", "10"), ("nv", "10")],
            value: 0.695_707_244_140_319_9,
            relative: 1e-11,
            source: "two quadratures in extended precision",
        },
    ],
    splits: false,
    build,
};

/// `nu`.
pub(super) const NU: Param =
    Param::number("nu", "nu", "exponent along the tangent", [0.0, 1e7], DefaultValue::Value(100.0)).swept(
        "nu",
        [1.0, 1000.0],
        0.25,
    );
/// `nv`.
pub(super) const NV: Param =
    Param::number("nv", "nv", "exponent along the bitangent", [0.0, 1e7], DefaultValue::Of("nu"));

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(Specular::new(params)?))
}

/// `-ln` of the part of its peak below which the lobe is left out of integrals.
const END: f64 = 42.0;

/// The lobe; also the specular part of the whole model.
#[derive(Debug)]
pub(super) struct Specular {
    rs: f64,
    nu: f64,
    nv: f64,
}

impl Specular {
    pub(super) fn new(params: &Params) -> Result<Specular, ParamError> {
        Ok(Specular { rs: params.number("rs")?, nu: params.number("nu")?, nv: params.number("nv")? })
    }

    fn root(&self) -> f64 {
        ((self.nu + 1.0) * (self.nv + 1.0)).sqrt()
    }

    /// `(n.wh)^e`; 1 at the normal, whatever the azimuth.
    fn power(&self, wh: DVec3) -> f64 {
        let (x2, y2) = (wh.x * wh.x, wh.y * wh.y);
        let sin2 = x2 + y2;
        if sin2 > 0.0 {
            special::cos_pow(wh.z, sin2, self.nu * (x2 / sin2) + self.nv * (y2 / sin2))
        } else {
            1.0
        }
    }

    fn value(&self, wh: DVec3, cos_d: f64, greater: f64) -> f64 {
        self.root() / (8.0 * PI) * self.power(wh) * schlick::schlick(self.rs, 1.0, cos_d) / (cos_d * greater)
    }
}

impl Brdf for Specular {
    /// Guard: where both directions graze the value may leave the range of f64; it is capped at 1e300.
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        match frame::half_vector(wo, wi) {
            Some(h) if frame::both_above(wo, wi) => self.value(h.wh, h.cos_d, wo.z.max(wi.z)).min(1e300),
            _ => 0.0,
        }
    }

    /// The half vector: `tan phi = sqrt((nu + 1)/(nv + 1)) tan(2 pi u2)`, `cos theta = (1 - u1)^(1/(e + 1))`; mirrored.
    ///
    /// Source: [Ashikhmin and Shirley 2000](crate::cite::ASHIKHMIN_SHIRLEY_2000), all four quadrants at once.
    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let (cos, sin) = special::circle(u.y);
        let (x, y) = ((self.nv + 1.0).sqrt() * cos, (self.nu + 1.0).sqrt() * sin);
        let square = x * x + y * y;
        let e = (self.nu * x * x + self.nv * y * y) / square;
        let log_cos = libm::log1p(-u.x.clamp(0.0, 1.0 - 0.5 * f64::EPSILON)) / (e + 1.0);
        let sin_h = (-libm::expm1(2.0 * log_cos)).max(0.0).sqrt() / square.sqrt();
        let wh = DVec3::new(sin_h * x, sin_h * y, libm::exp(log_cos));
        let wi = frame::reflect(wo, wh);
        (wi.z > 0.0 && wo.dot(wh) > 0.0).then(|| Sample { wi, pdf: self.pdf(wo, wi) })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        match frame::half_vector(wo, wi) {
            Some(h) if frame::both_above(wo, wi) => self.root() / TAU * self.power(h.wh) / (4.0 * h.cos_d),
            _ => 0.0,
        }
    }

    fn chart(&self) -> Option<Chart> {
        let alpha = [self.nu, self.nv].map(blinn_phong::equivalent_alpha);
        let least = self.nu.min(self.nv);
        let reach = if least > 1.0 {
            libm::expm1(2.0 * END / least).sqrt() / blinn_phong::equivalent_alpha(least)
        } else {
            f64::INFINITY
        };
        Some(Chart::Ellipse(FacetLobe { edge: Edge::Smooth, fold: true, ..FacetLobe::smith(alpha, reach) }))
    }

    fn turns(&self) -> bool {
        (self.nu - self.nv).abs() > 0.0
    }

    fn eval_nodes(&self, nodes: &Nodes, out: &mut [f64; BATCH]) {
        for (i, o) in out[..nodes.len].iter_mut().enumerate() {
            *o = self.value(nodes.wh(i), nodes.cos_d[i], nodes.mu_o.max(nodes.mu_i[i]));
        }
    }
}
