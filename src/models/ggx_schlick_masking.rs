//! GGX facets with Schlick's rational masking: the lobe of the first split-sum tables.
//!
//! Recipe: `model = "ggx-schlick-masking"`, `params = { k = "ibl" }`. The table `dfg` with this model is the one that early
//! physically based engines shipped.

use super::microfacet::{ALPHA, F0, F90, Fresnel, Ggx};
use super::{Alias, Brdf, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params, Sample};
use crate::cite;
use crate::integrate::{BATCH, Chart, Nodes};
use crate::math::frame;
use crate::terms::schlick_masking::{self, K};
use crate::terms::smith::Ndf;
use glam::{DVec2, DVec3};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "ggx-schlick-masking",
    title: "GGX with Schlick's masking (Karis)",
    formula: "f = F(wo.wh) D(wh) G1(mu_o) G1(mu_i) / (4 mu_o mu_i), G1 = mu / (mu (1 - k) + k)",
    sources: &[
        (cite::KARIS_2013, "Eq. 3 (D), 4 (G)"),
        (cite::SCHLICK_1994, "the rational forms of G1 and F"),
        (cite::WALTER_2007, "Eq. 33 (D), 20 (f)"),
    ],
    params: &[
        ALPHA,
        F0,
        F90,
        Param::choice(
            "k",
            "alpha / 2 (image-based lighting), (sqrt(alpha) + 1)^2 / 8 (analytic lights), alpha sqrt(2 / pi) (Schlick)",
            &["ibl", "analytic", "schlick"],
        ),
    ],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "Not the masking of any surface: the weak white furnace gives 0.907 (k = ibl) at theta = 1.3, alpha = 0.1. \
        A + B differs from correlated Smith by up to 0.318. alpha = 0 is the mirror (with k = analytic it would be masked).",
    also: &[Alias { name: "ggx_schlickG_karis_ibl", set: &[("k", "ibl")] }],
    known: &[
        Known {
            what: KnownValue::Value([0.5, 0.0, 0.5, 3.140_625]),
            params: &[("alpha", "0.25")],
            value: 1.597_049_604_258_478_5,
            relative: 1e-12,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("alpha", "1")],
            value: 0.306_852_819_440_054_7,
            relative: 1e-10,
            source: "closed form: k = 1/2 is the Smith masking of alpha = 1, E(1) = 1 - ln 2",
        },
    ],
    splits: true,
    build,
};

#[derive(Debug)]
struct SchlickMasked {
    distribution: Ggx,
    alpha: f64,
    k: f64,
    fresnel: Fresnel,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let alpha = params.number("alpha")?;
    let kind = match params.choice("k")? {
        "ibl" => K::Ibl,
        "analytic" => K::Analytic,
        _ => K::Schlick,
    };
    Ok(Box::new(SchlickMasked {
        distribution: Ggx::isotropic(alpha),
        alpha,
        k: schlick_masking::k(kind, alpha),
        fresnel: Fresnel::Schlick { f0: params.number("f0")?, f90: params.number("f90")? },
    }))
}

impl Brdf for SchlickMasked {
    fn eval(&self, wo: DVec3, wi: DVec3) -> f64 {
        if self.alpha <= 0.0 || !frame::both_above(wo, wi) {
            return 0.0;
        }
        let Some(h) = frame::half_vector(wo, wi) else { return 0.0 };
        self.fresnel.at(h.cos_d) * self.distribution.d(h.wh) * schlick_masking::visibility(self.k, wo.z, wi.z)
    }

    fn sample(&self, wo: DVec3, u: DVec2) -> Option<Sample> {
        let wi = frame::reflect(wo, self.distribution.sample_visible(wo, u));
        (wi.z > 0.0).then(|| Sample { wi, pdf: self.pdf(wo, wi) })
    }

    fn pdf(&self, wo: DVec3, wi: DVec3) -> f64 {
        match frame::half_vector(wo, wi) {
            Some(h) if frame::both_above(wo, wi) => self.distribution.d_visible(wo, h.wh) / (4.0 * h.cos_d),
            _ => 0.0,
        }
    }

    fn chart(&self) -> Option<Chart> {
        Some(Chart::HalfVector {
            alpha: self.alpha,
            reach: f64::INFINITY,
            kinks: false,
            slope: f64::INFINITY,
            layer: self.k,
        })
    }

    /// A plain loop: D = a^2 / (pi (a^2 cos^2 + sin^2)^2), V = 1 / (4 (mu (1 - k) + k)(...)).
    fn eval_nodes(&self, nodes: &Nodes, out: &mut [f64; BATCH]) {
        let a2 = self.alpha * self.alpha;
        let facing = |mu: f64| mu * (1.0 - self.k) + self.k;
        let scale = 0.25 * std::f64::consts::FRAC_1_PI * a2 / facing(nodes.mu_o);
        for (i, o) in out[..nodes.len].iter_mut().enumerate() {
            let (c, s) = (nodes.cos_h[i], nodes.sin_h[i]);
            let q = a2 * (c * c) + s * s;
            *o = scale / (q * q * facing(nodes.mu_i[i]));
        }
        self.fresnel.scale_nodes(nodes, out);
    }

    fn mirror(&self, mu_o: f64) -> Option<f64> {
        (self.alpha <= 0.0).then(|| self.fresnel.at(mu_o))
    }
}
