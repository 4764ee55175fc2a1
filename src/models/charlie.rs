//! Charlie, the sheen of Estevez and Kulla: fibres that stand up, with a fitted masking.
//!
//! Recipe: `model = "charlie"`, `params = { roughness = 0.3 }`. 0.1 is a thin bright rim, 0.5 velvet, 1 felt. Lay it over a
//! base that is scaled by 1 - E.

use super::cloth::{Cloth, ClothLobe};
use super::{Alias, Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::integrate::{BATCH, Chart, Nodes};
use crate::math::frame;
use crate::terms::charlie;
use glam::DVec3;

/// `roughness` of both Charlies: the r of the paper, a width like alpha. As an axis the word means the same; the roughness of a
/// glTF sheen, its square root, is `sheen_roughness`.
pub(super) const ROUGHNESS: Param = Param::number(
    "roughness",
    "r",
    "r of the cloth; the exponent of the sine is 1 / r; r = sheen_roughness^2",
    [0.01, 1.0],
    DefaultValue::Value(0.5),
)
.also(&["r", "alpha"]);

/// Cosines below this count as this.
pub(super) const HORIZON: f64 = 1e-7;

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "charlie",
    title: "Charlie sheen, fitted masking",
    formula: "f = D(wh) / (4 mu_o mu_i (1 + Lambda(mu_o) + Lambda(mu_i))), D = (2 + 1/r) sin^(1/r) / (2 pi)",
    sources: &[(cite::ESTEVEZ_KULLA_2017, "Eq. 2 (D), 3 (Lambda)")],
    params: &[ROUGHNESS.swept("roughness", [0.073, 1.0], 1.0)],
    laws: Laws { reciprocal: true, passive: false, isotropic: true },
    notes: "Without the softened terminator of Eq. 4, which is not reciprocal. E stays below 1 for roughness >= 0.07 (the clamp of \
        productions) and mu >= 1e-5, and above it elsewhere: the fitted Lambda is finite at the horizon, so f would grow as 1 / mu; \
        cosines below 1e-7 count as that. Lambda behaves like mu^0.17 at the horizon and the normal, with a joint at mu = 1/2.",
    also: &[Alias { name: "charlie_conty_kulla", set: &[] }],
    known: &[
        Known {
            what: KnownValue::Value([0.25, 0.5, 1.0, 2.75]),
            params: &[("roughness", "0.5")],
            value: 0.029_823_788_451_805_99,
            relative: 1e-12,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(0.877_582_561_890_372_7),
            params: &[("roughness", "0.5")],
            value: 0.125_181_317_248_388_62,
            relative: 1e-9,
            source: "quadrature in 80-bit arithmetic by two parametrisations",
        },
    ],
    splits: false,
    build,
};

/// The lobe.
#[derive(Debug)]
pub(super) struct Charlie {
    roughness: f64,
}

/// The lobe of a roughness, for materials that lay it over a base.
pub(super) fn lobe(roughness: f64) -> ClothLobe<Charlie> {
    ClothLobe(Charlie { roughness })
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    Ok(Box::new(lobe(params.number("roughness")?)))
}

impl Cloth for Charlie {
    fn chart(&self) -> Chart {
        Chart::Broad { kinks: false, floor: HORIZON }
    }

    fn value(&self, wo: DVec3, wi: DVec3) -> f64 {
        let Some(h) = frame::half_vector(wo, wi) else { return 0.0 };
        charlie::d(self.roughness, h.wh)
            * charlie::visibility(self.roughness, wo.z.max(HORIZON), wi.z.max(HORIZON))
    }

    /// The chart goes round the normal, so that most neighbours share a cosine, and its masking.
    fn values(&self, nodes: &Nodes, out: &mut [f64; BATCH]) {
        let wo = nodes.wo_above();
        let mu_o = wo.z.max(HORIZON);
        let lambda_o = charlie::lambda(self.roughness, mu_o);
        let (mut mu_i, mut lambda_i) = (mu_o, lambda_o);
        for (i, o) in out[..nodes.len].iter_mut().enumerate() {
            let wi = nodes.wi(i);
            let half = if frame::both_above(wo, wi) { frame::half_vector(wo, wi) } else { None };
            *o = half.map_or(0.0, |h| {
                let above = wi.z.max(HORIZON);
                if above.to_bits() != mu_i.to_bits() {
                    (mu_i, lambda_i) = (above, charlie::lambda(self.roughness, above));
                }
                charlie::d(self.roughness, h.wh) * charlie::visibility_of([mu_o, mu_i], [lambda_o, lambda_i])
            });
        }
    }
}
