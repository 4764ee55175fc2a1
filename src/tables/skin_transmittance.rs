//! Transmittance of thin parts (ears, nostrils) over their thickness, from a diffusion profile.
//!
//! Light that enters everywhere on the far side of a slab of thickness d, and spreads by the profile over the distance
//! `sqrt(r^2 + d^2)`: `T(d) = 2 pi int R(sqrt(r^2 + d^2)) r dr`, which is the part of the profile beyond radius d.

use super::default_axes::axis;
use super::profile::{self, Profile};
use super::role::Band;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use std::f64::consts::SQRT_2;

/// T at a factor times the thickness.
const fn channels(factor: f64) -> [ChannelInfo; 3] {
    [
        channel("transmitted.r", "T(d), red", Role::ProfileBeyond(factor, Band::Red)),
        channel("transmitted.g", "T(d), green", Role::ProfileBeyond(factor, Band::Green)),
        channel("transmitted.b", "T(d), blue", Role::ProfileBeyond(factor, Band::Blue)),
    ]
}

const fn channel(id: &'static str, meaning: &'static str, role: Role) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 1.0], role }
}

const PLAIN: [ChannelInfo; 3] = channels(1.0);
const STRETCHED: [ChannelInfo; 3] = channels(SQRT_2);

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "skin-transmittance",
    title: "Transmittance of thin parts by a diffusion profile",
    formula: "T(d) = 2 pi int R(sqrt(r^2 + d^2)) r dr; of Gaussians sum w_i exp(-d^2 / (2 v_i))",
    sources: &SOURCES,
    coordinates: &["thickness"],
    layouts: &[
        Layout { id: "gpu-gems", doc: "sum w_i exp(-d^2 / (2 v_i))", channels: &PLAIN },
        Layout {
            id: "jimenez",
            doc: "sum w_i exp(-d^2 / v_i): T at the thickness sqrt(2) d",
            channels: &STRETCHED,
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: profile::PARAMS,
    laws: &["finite", "range", "monotone", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "The two layouts differ by a factor 2 in the exponent and are not interchangeable. Other profiles than Gaussians follow the same \
        reasoning: the part beyond d.",
    bind,
};

fn is_stretched(role: Role) -> bool {
    matches!(role, Role::ProfileBeyond(factor, _) if factor > 1.0)
}

/// Own sources, and those of profiles.
static SOURCES: [Source; 2 + profile::SOURCES.len()] = profile::with_sources([
    Source::new(cite::DEON_LUEBKE_2007, "section 14.5.6"),
    Source::new(cite::JIMENEZ_2010, "the transmittance profile (layout jimenez)").of(is_stretched),
]);

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    axis("thickness", 256, [0.0, 8.0], Warp::Power(0.25)).into_iter().collect()
}

struct Table {
    thickness: usize,
    profile: Profile,
    factor: f64,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let factors = spec.each(|role| match role {
        Role::ProfileBeyond(factor, _) => Some(factor),
        _ => None,
    })?;
    let factor = factors.first().copied().unwrap_or(1.0);
    Ok(Box::new(Table { thickness: spec.coordinate("thickness")?, profile: Profile::new(spec)?, factor }))
}

impl Baker for Table {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let mut value = [0.0; MAX_CHANNELS];
        value[..3].copy_from_slice(&self.profile.outside(self.factor * at[self.thickness]));
        super::closed_form(value, 3)
    }

    fn rule(&self) -> String {
        "closed form".to_owned()
    }
}
