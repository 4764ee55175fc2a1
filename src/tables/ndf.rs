//! The microfacet distribution over the cosine of the microfacet normal and the width.

use super::default_axes::axis;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::Param;
use crate::terms::smith::Ndf as _;
use crate::terms::{beckmann::Beckmann, ggx::Ggx};
use glam::DVec3;
use std::f64::consts::PI;

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "ndf",
    title: "Microfacet distribution D",
    formula: "D(mu_m, alpha); relative layout: pi alpha^2 D = D / D(1)",
    sources: &[
        Source::new(cite::WALTER_2007, "Eq. 25 (Beckmann)").when("distribution", &["beckmann"]),
        Source::new(cite::WALTER_2007, "Eq. 33 (GGX)").when("distribution", &["ggx"]),
    ],
    coordinates: &["mu_m", "alpha"],
    layouts: &[
        Layout {
            id: "relative",
            doc: "D = texel / (pi alpha^2)",
            channels: &[ChannelInfo {
                id: "ndf.relative",
                meaning: "pi alpha^2 D(mu_m)",
                range: [0.0, 1.5],
                role: Role::Distribution { relative: true },
            }],
        },
        Layout {
            id: "absolute",
            doc: "D in 1/sr; at alpha below 0.0023 its peak does not fit a half float",
            channels: &[ChannelInfo {
                id: "ndf.d",
                meaning: "D(mu_m), 1/sr",
                range: [0.0, 3.4e38],
                role: Role::Distribution { relative: false },
            }],
        },
    ],
    mix: Mix::Free(&[]),
    model: ModelUse::None,
    params: &[Param::choice("distribution", "which distribution", &["ggx", "beckmann"])],
    laws: &["finite", "range", "normalised", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "The peak has the width alpha: spread mu_m with `one-minus-power` (fine near mu_m = 1). At alpha -> 0 no fixed axis resolves it. \
        The relative form of Beckmann reaches 4 / e = 1.47 at alpha = 1, off the normal.",
    bind,
};

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    let axes = [
        axis("mu_m", 128, [0.0, 1.0], Warp::OneMinusPower(0.2)),
        axis("roughness", 128, [0.05, 1.0], Warp::Power(0.5)),
    ];
    axes.into_iter().flatten().collect()
}

struct Ndf {
    mu: usize,
    alpha: usize,
    beckmann: bool,
    /// For each channel: relative to the peak?
    relative: Vec<bool>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Ndf {
        mu: spec.coordinate("mu_m")?,
        alpha: spec.coordinate("alpha")?,
        beckmann: spec.params.choice("distribution")? == "beckmann",
        relative: spec.each(|role| match role {
            Role::Distribution { relative } => Some(relative),
            _ => None,
        })?,
    }))
}

/// D of the named distribution at a cosine.
#[must_use]
pub fn d(beckmann: bool, mu_m: f64, alpha: f64) -> f64 {
    // the terms give 0 at the horizon itself, where a facet has no area to show; a table holds the limit
    let mu_m = mu_m.max(f64::MIN_POSITIVE);
    let wm = DVec3::new(((1.0 - mu_m) * (1.0 + mu_m)).max(0.0).sqrt(), 0.0, mu_m);
    if beckmann { Beckmann::isotropic(alpha).d(wm) } else { Ggx::isotropic(alpha).d(wm) }
}

impl Baker for Ndf {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let (mu, alpha) = (at[self.mu], at[self.alpha]);
        let mut value = [0.0; MAX_CHANNELS];
        let d = d(self.beckmann, mu, alpha);
        for (channel, (v, relative)) in value.iter_mut().zip(&self.relative).enumerate() {
            *v = if *relative { d * (PI * alpha * alpha) } else { d };
            if !v.is_finite() {
                return Err(TexelError::NotFinite { channel, value: *v });
            }
        }
        Ok(Estimate::exact(value))
    }

    fn rule(&self) -> String {
        "closed form".to_owned()
    }
}
