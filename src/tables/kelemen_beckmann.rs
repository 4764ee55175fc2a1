//! The Kelemen/Szirmay-Kalos specular texture of GPU Gems 3: the Beckmann distribution, compressed by a tenth root.
//!
//! A shader reads `PH = (2 texel)^10` and shades `max(PH F / |L + V|^2, 0) * ndotl * rho_s`. PH is pi D: it has no
//! 1 / pi, as the chapter's lights carry it.

use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Quantity, Texel};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::terms::kelemen;

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "kelemen-beckmann",
    title: "Kelemen/Szirmay-Kalos Beckmann texture (GPU Gems 3)",
    formula: "texel = PH^0.1 / 2, PH = exp(-tan^2(acos mu_m) / m^2) / (m^2 mu_m^4)",
    sources: &[
        Source::new(cite::DEON_LUEBKE_2007, "section 14.2.3, listing 14-1"),
        Source::new(cite::KELEMEN_2001, "section 2, the Beckmann factor"),
    ],
    coordinates: &["mu_m", "m"],
    layouts: &[Layout {
        id: "tenth-root",
        doc: "PH = (2 texel)^10",
        channels: &[ChannelInfo {
            id: "kelemen.texel",
            meaning: "0.5 PH(mu_m, m)^0.1",
            range: [0.0, 1.0],
            role: Role::DistributionRoot,
        }],
    }],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &[],
    laws: &["finite", "range", "normalised", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "m below 1/32 does not fit: the texel at mu_m = 1 would exceed 1, which is a finding, not a clamp.",
    bind,
};

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    let axis = |id: &str, domain| Quantity::find(id).map(|q| Axis::new(q, 512, Texel::Center).over(domain));
    [axis("mu_m", [0.0, 1.0]), axis("m", [0.0, 1.0])]
        .into_iter()
        .flatten()
        .map(|a| if a.quantity.id == "m" { Axis { clamp: Some([1.0 / 32.0, 1.0]), ..a } } else { a })
        .collect()
}

struct Texture {
    mu: usize,
    m: usize,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Texture { mu: spec.coordinate("mu_m")?, m: spec.coordinate("m")? }))
}

impl Baker for Texture {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let mut value = [0.0; MAX_CHANNELS];
        value[0] = kelemen::encode(at[self.mu], at[self.m]);
        Ok(Estimate::exact(value))
    }

    fn rule(&self) -> String {
        "closed form, in logarithms".to_owned()
    }
}
