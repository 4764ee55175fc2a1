//! The layered material of glTF: metallic-roughness base, sheen scaled in by its albedo, clear coat on top.
//!
//! Recipe: `model = "gltf"`, `params = { base_color = 0.8, metallic = 0, roughness = 0.4, clearcoat = 1 }` (one channel; a colour is
//! three bakes). What a viewer that follows the specification to the letter computes, single scattering and all.

use super::albedo_curve::AlbedoCurve;
use super::lobes::{Part, Sum, cosine_pdf, cosine_sample};
use super::microfacet::{Ggx, MASKING, Masking, masking};
use super::{
    Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params, Sample, charlie,
};
use crate::cite;
use crate::integrate::{Chart, ellipse::FacetLobe};
use crate::math::frame;
use crate::terms::schlick::{schlick, weight};
use crate::terms::smith::Ndf;
use glam::{DVec2, DVec3};
use std::f64::consts::FRAC_1_PI;
use std::sync::Arc;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "gltf",
    title: "glTF 2.0 material: metallic-roughness with sheen and clear coat",
    formula: "f = (1 - c F_c(mu_o)) (s f_sheen + (1 - s max(E(mu_o), E(mu_i))) f_base) + c F_c(mu_o) f_coat, f_base = (1 - m)(lerp(rho / pi, DV, 0.04 + 0.96 w)) + m (rho + (1 - rho) w) DV, w = (1 - wo.wh)^5",
    sources: &[
        (cite::GLTF_2, "Appendix B.2 and B.3 (f_base, D, V; height-correlated masking since January 2026)"),
        (cite::KHR_SHEEN, "sheen_brdf and the albedo scaling"),
        (cite::KHR_CLEARCOAT, "the layering by F_c"),
    ],
    params: &[
        Param::number("base_color", "rho", "base colour, one channel", [0.0, 1.0], DefaultValue::Value(0.8)),
        Param::number(
            "metallic",
            "m",
            "0 is a dielectric of index 1.5, 1 a metal",
            [0.0, 1.0],
            DefaultValue::Value(0.0),
        ),
        Param::number(
            "roughness",
            "r",
            "roughness of the base; alpha = r^2",
            [0.01, 1.0],
            DefaultValue::Value(0.5),
        ),
        Param::number("sheen", "s", "sheen colour, one channel", [0.0, 1.0], DefaultValue::Value(0.0)),
        Param::number(
            "sheen_roughness",
            "r_s",
            "roughness of the sheen; Charlie's is its square",
            [0.1, 1.0],
            DefaultValue::Value(0.5),
        ),
        Param::number("clearcoat", "c", "weight of the coat", [0.0, 1.0], DefaultValue::Value(0.0)),
        Param::number(
            "clearcoat_roughness",
            "r_c",
            "roughness of the coat; alpha = r^2",
            [0.01, 1.0],
            DefaultValue::Value(0.1),
        ),
        MASKING,
    ],
    laws: Laws { reciprocal: false, passive: false, isotropic: true },
    notes: "Not reciprocal with a coat, which is weighed by the view cosine alone. Not passive: the diffuse part is weighed by \
        1 - F(wo.wh) and the specular one by F(wo.wh), so a white smooth dielectric reflects nearly twice at grazing. Masking is \
        height-correlated, as in the appendix since January 2026; `masking = \"separable\"` is the text before. E of the sheen is that of Charlie.",
    also: &[],
    known: &[
        Known {
            what: KnownValue::Albedo(0.5),
            params: &[
                ("base_color", "1"),
                ("metallic", "1"),
                ("roughness", "1"),
                ("masking", "\"separable\""),
            ],
            value: 0.409_137_092_586_739_6,
            relative: 1e-7,
            source: "closed form: a white metal is separable GGX at alpha = 1, E(mu) = 2 (1 - ln 2) / (1 + mu)",
        },
        Known {
            what: KnownValue::Albedo(0.5),
            params: &[("base_color", "1"), ("metallic", "1"), ("roughness", "1")],
            value: 0.450_693_855_665_945_1,
            relative: 1e-7,
            source: "closed form: a white metal is correlated GGX at alpha = 1, E(mu) = 1 - mu ln((1 + mu) / mu)",
        },
        Known {
            what: KnownValue::Albedo(0.1),
            params: &[("base_color", "1"), ("metallic", "1"), ("roughness", "1")],
            value: 0.760_210_472_720_163,
            relative: 1e-7,
            source: "closed form: E(mu) = 1 - mu ln((1 + mu) / mu)",
        },
        Known {
            what: KnownValue::Albedo(0.3),
            params: &[
                ("base_color", "0.8"),
                ("roughness", "0.5"),
                ("sheen", "0.5"),
                ("sheen_roughness", "0.5"),
            ],
            value: 0.872_859_057_185_245,
            relative: 1e-8,
            source: "nested double exponential and Gauss-Legendre sums, E of the sheen summed anew at every node",
        },
        Known {
            what: KnownValue::Value([0.0, 0.0, 0.0, 0.0]),
            params: &[("base_color", "0.5"), ("metallic", "0.25"), ("roughness", "1")],
            // w = 0: 0.75 (0.96 * 0.5 / pi + 0.04 / (4 pi)) + 0.25 * 0.5 / (4 pi)
            value: (0.75 * (0.48 + 0.01) + 0.25 * 0.125) * FRAC_1_PI,
            relative: 1e-13,
            source: "closed form: normal incidence, D V = 1 / (4 pi)",
        },
        Known {
            what: KnownValue::Value([0.0, 0.0, 0.0, 0.0]),
            params: &[
                ("base_color", "0.5"),
                ("roughness", "1"),
                ("clearcoat", "1"),
                ("clearcoat_roughness", "1"),
            ],
            value: (0.96 * (0.48 + 0.01) + 0.04 * 0.25) * FRAC_1_PI,
            relative: 1e-13,
            source: "closed form: normal incidence, F_c = 0.04",
        },
    ],
    splits: false,
    build,
};

/// Absolute tolerance of the sheen's albedo.
const SHEEN: f64 = 1e-9;

/// Reflectance of base and coat at normal incidence: index 1.5.
const DIELECTRIC: f64 = 0.04;

/// Everything that the lobes share.
#[derive(Debug)]
struct Material {
    base_color: f64,
    metallic: f64,
    masking: Masking,
    base: Ggx,
    sheen: f64,
    sheen_roughness: f64,
    /// E of the sheen, if there is any.
    curve: Option<Arc<AlbedoCurve>>,
    clearcoat: f64,
    coat: Ggx,
}

/// A lobe of the material.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Specular,
    Diffuse,
    Sheen,
    Coat,
}

#[derive(Debug)]
struct Lobe {
    material: Arc<Material>,
    kind: Kind,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let square = |id: &str| params.number(id).map(|v| v * v);
    let sheen = params.number("sheen")?;
    let sheen_roughness = square("sheen_roughness")?;
    let lobe = charlie::lobe(sheen_roughness);
    let curve =
        (sheen > 0.0).then(|| AlbedoCurve::shared(&format!("charlie {sheen_roughness:e}"), &lobe, SHEEN));
    let material = Arc::new(Material {
        base_color: params.number("base_color")?,
        metallic: params.number("metallic")?,
        masking: masking(params)?,
        base: Ggx::isotropic(square("roughness")?),
        sheen,
        sheen_roughness,
        curve,
        clearcoat: params.number("clearcoat")?,
        coat: Ggx::isotropic(square("clearcoat_roughness")?),
    });
    let part = |kind, chance: f64| Part {
        weight: 1.0,
        chance,
        lobe: Box::new(Lobe { material: Arc::clone(&material), kind }),
    };
    let mut parts = vec![part(Kind::Specular, 0.5)];
    if material.metallic < 1.0 && material.base_color > 0.0 {
        parts.push(part(Kind::Diffuse, 0.5));
    }
    if sheen > 0.0 {
        parts.push(part(Kind::Sheen, 0.2));
    }
    if material.clearcoat > 0.0 {
        parts.push(part(Kind::Coat, 0.2));
    }
    Ok(Box::new(Sum::new(parts)))
}

impl Material {
    /// Weight of the coat, of the view cosine alone.
    fn coated(&self, mu_o: f64) -> f64 {
        self.clearcoat * schlick(DIELECTRIC, 1.0, mu_o)
    }

    /// What the sheen leaves to the base.
    fn below_sheen(&self, mu_o: f64, mu_i: f64) -> f64 {
        self.curve.as_ref().map_or(1.0, |curve| {
            let e = curve.albedo(mu_o).max(curve.albedo(mu_i));
            (1.0 - self.sheen * e).max(0.0)
        })
    }

    fn value(&self, kind: Kind, wo: DVec3, wi: DVec3) -> f64 {
        let Some(h) = frame::half_vector(wo, wi) else { return 0.0 };
        let facets = |ndf: &Ggx| {
            ndf.d(h.wh)
                * match self.masking {
                    Masking::Separable => ndf.visibility_separable(wo, wi),
                    Masking::Correlated => ndf.visibility(wo, wi),
                }
        };
        let (coated, w) = (self.coated(wo.z), weight(h.cos_d));
        let dielectric = DIELECTRIC + (1.0 - DIELECTRIC) * w;
        match kind {
            Kind::Specular => {
                let metal = self.base_color + (1.0 - self.base_color) * w;
                let f = (1.0 - self.metallic) * dielectric + self.metallic * metal;
                (1.0 - coated) * self.below_sheen(wo.z, wi.z) * f * facets(&self.base)
            }
            Kind::Diffuse => {
                let f = (1.0 - self.metallic) * (1.0 - dielectric) * self.base_color;
                (1.0 - coated) * self.below_sheen(wo.z, wi.z) * f * FRAC_1_PI
            }
            Kind::Sheen => (1.0 - coated) * self.sheen * charlie::lobe(self.sheen_roughness).eval(wo, wi),
            Kind::Coat => coated * facets(&self.coat),
        }
    }
}

impl Lobe {
    fn facets(&self) -> &Ggx {
        if self.kind == Kind::Coat { &self.material.coat } else { &self.material.base }
    }
}

impl Brdf for Lobe {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if frame::both_above(wo, wi) { self.material.value(self.kind, wo, wi) } else { 0.0 }
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        match self.kind {
            Kind::Diffuse => cosine_sample(u),
            Kind::Sheen => charlie::lobe(self.material.sheen_roughness).sample(wo, u),
            Kind::Specular | Kind::Coat => {
                let wi = frame::reflect(wo, self.facets().sample_visible(wo, u));
                (wi.z > 0.0).then(|| Sample { wi, pdf: self.pdf(wo, wi) })
            }
        }
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        match self.kind {
            Kind::Diffuse => cosine_pdf(wo, wi),
            Kind::Sheen => charlie::lobe(self.material.sheen_roughness).pdf(wo, wi),
            Kind::Specular | Kind::Coat => match frame::half_vector(wo, wi) {
                Some(h) if frame::both_above(wo, wi) => self.facets().d_visible(wo, h.wh) / (4.0 * h.cos_d),
                _ => 0.0,
            },
        }
    }

    /// Below a sheen the larger of two albedos leaves a kink, and E of cloth changes by mu ln mu: the trust is that of steep lobes.
    fn chart(&self) -> Option<Chart> {
        let alpha = [self.facets().alpha_x(); 2];
        Some(match self.kind {
            Kind::Diffuse if self.material.curve.is_none() => Chart::Broad { kinks: false, floor: 0.0 },
            Kind::Diffuse => Chart::Broad { kinks: true, floor: charlie::HORIZON },
            Kind::Sheen => Chart::Broad { kinks: false, floor: charlie::HORIZON },
            Kind::Specular if self.material.curve.is_some() => Chart::Ellipse(FacetLobe {
                fold: true,
                steep: true,
                ..FacetLobe::smith(alpha, f64::INFINITY)
            }),
            Kind::Specular | Kind::Coat => Chart::facets(FacetLobe::smith(alpha, f64::INFINITY)),
        })
    }

    /// What the sheen leaves is known to the error of its curve.
    fn own_error(&self, _mu_o: f64) -> f64 {
        let below = matches!(self.kind, Kind::Specular | Kind::Diffuse);
        self.material
            .curve
            .as_ref()
            .filter(|_| below)
            .map_or(0.0, |curve| self.material.sheen * curve.error())
    }
}
