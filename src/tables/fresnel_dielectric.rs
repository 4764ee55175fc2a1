//! Reflectance of a smooth dielectric interface over angle and relative index, from one side or both.

use super::default_axes::axis;
use super::role::{Polarisation, Side};
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::terms::fresnel::{self, Polarised};

const UNIT: [f64; 2] = [0.0, 1.0];

const fn channel(id: &'static str, meaning: &'static str, p: Polarisation, side: Side) -> ChannelInfo {
    ChannelInfo { id, meaning, range: UNIT, role: Role::Dielectric(p, side) }
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "fresnel-dielectric",
    title: "Dielectric Fresnel reflectance",
    formula: "F = (R_s + R_p) / 2, R_s = ((mu - g) / (mu + g))^2, R_p = ((eta^2 mu - g) / (eta^2 mu + g))^2, g^2 = eta^2 - 1 + mu^2; F = 1 if g^2 < 0",
    sources: &[
        Source::new(cite::BORN_WOLF_1999, "section 1.5.2, Eq. 20-21"),
        Source::new(cite::WALTER_2007, "Eq. 22"),
    ],
    coordinates: &["mu", "eta"],
    layouts: &[
        Layout {
            id: "unpolarised",
            doc: "one channel, light from above",
            channels: &[channel("fresnel.f", "(R_s + R_p) / 2 at eta", Polarisation::None, Side::Above)],
        },
        Layout {
            id: "polarised",
            doc: "s, p and unpolarised, light from above",
            channels: &[
                channel("fresnel.s", "R_s at eta", Polarisation::S, Side::Above),
                channel("fresnel.p", "R_p at eta", Polarisation::P, Side::Above),
                channel("fresnel.f", "(R_s + R_p) / 2 at eta", Polarisation::None, Side::Above),
            ],
        },
        Layout {
            id: "both-sides",
            doc: "unpolarised, from above (eta) and from below (1 / eta, with total internal reflection)",
            channels: &[
                channel("fresnel.outside", "(R_s + R_p) / 2 at eta", Polarisation::None, Side::Above),
                channel("fresnel.inside", "(R_s + R_p) / 2 at 1 / eta", Polarisation::None, Side::Inside),
            ],
        },
        Layout {
            id: "both-sides-polarised",
            doc: "s and p from above (eta), then s and p from below (1 / eta)",
            channels: &[
                channel("fresnel.outside.s", "R_s at eta", Polarisation::S, Side::Above),
                channel("fresnel.outside.p", "R_p at eta", Polarisation::P, Side::Above),
                channel("fresnel.inside.s", "R_s at 1 / eta", Polarisation::S, Side::Inside),
                channel("fresnel.inside.p", "R_p at 1 / eta", Polarisation::P, Side::Inside),
            ],
        },
    ],
    mix: Mix::Free(&[]),
    model: ModelUse::None,
    params: &[],
    laws: &["finite", "range", "fresnel-reversible", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "Closed form: the integration error is rounding. Bilinear reading loses an order at the critical angle, where F has a \
        vertical tangent; put the eta axis on one side of 1. Both-sides layouts want eta > 1.",
    bind,
};

fn default_axes(setting: &Setting<'_>) -> Vec<Axis> {
    let (len, warp) = match setting.layout.id {
        "unpolarised" => (128, Warp::OneMinusPower(2.0)),
        "polarised" => (128, Warp::Power(0.5)),
        // from inside F has a vertical tangent at the critical angle, which moves with eta
        _ => (256, Warp::OneMinusPower(0.5)),
    };
    let axes = [axis("mu", len, UNIT, warp), axis("eta", 64, [1.2, 2.5], Warp::Power(0.5))];
    axes.into_iter().flatten().collect()
}

struct Table {
    mu: usize,
    eta: usize,
    /// Which factor each channel is.
    channels: Vec<(Polarisation, Side)>,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let channels = spec.each(|role| match role {
        Role::Dielectric(p, side) => Some((p, side)),
        _ => None,
    })?;
    Ok(Box::new(Table { mu: spec.coordinate("mu")?, eta: spec.coordinate("eta")?, channels }))
}

/// One of the two polarised factors, or their mean.
pub(super) fn part(factors: Polarised, p: Polarisation) -> f64 {
    match p {
        Polarisation::S => factors.s,
        Polarisation::P => factors.p,
        Polarisation::None => factors.unpolarised(),
    }
}

impl Baker for Table {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let (mu, eta) = (at[self.mu], at[self.eta]);
        let above = fresnel::dielectric(mu, eta);
        let below = fresnel::dielectric(mu, 1.0 / eta);
        let mut value = [0.0; MAX_CHANNELS];
        for (v, (p, side)) in value.iter_mut().zip(&self.channels) {
            *v = part(if *side == Side::Above { above } else { below }, *p);
        }
        Ok(Estimate::exact(value))
    }

    fn rule(&self) -> String {
        "closed form".to_owned()
    }
}
