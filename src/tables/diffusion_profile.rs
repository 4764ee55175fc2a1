//! Radial diffusion profiles over the distance: per area, per ring, and as a cumulative distribution.

use super::profile::{self, Profile};
use super::default_axes::axis;
use super::{Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Setting, Spec, TableInfo, TexelError};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::Param;

const fn channel(id: &'static str, meaning: &'static str, most: f64) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, most] }
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "diffusion-profile",
    title: "Radial diffusion profile",
    formula: "2 pi r R(r); or R(r); or the part inside, int_0^r 2 pi s R(s) ds; of red, green and blue",
    sources: &[
        (cite::DEON_LUEBKE_2007, "Fig. 14-13 (profile skin)"),
        (cite::CHRISTENSEN_BURLEY_2015, "Eq. 3, 5, 6, 8 and 11 (profile burley)"),
        (cite::JENSEN_2002, "Eq. 2 and 3 (profile dipole); the part inside is integrated here"),
    ],
    coordinates: &["radius"],
    layouts: &[
        Layout {
            id: "ring",
            doc: "light per mm of distance: finite at 0 for every profile",
            channels: &[
                channel("ring.r", "2 pi r R, 1/mm, red", 3.4e38),
                channel("ring.g", "2 pi r R, 1/mm, green", 3.4e38),
                channel("ring.b", "2 pi r R, 1/mm, blue", 3.4e38),
            ],
        },
        Layout {
            id: "area",
            doc: "light per mm^2; profile burley is infinite at 0: start its axis above",
            channels: &[
                channel("area.r", "R, 1/mm^2, red", 3.4e38),
                channel("area.g", "R, 1/mm^2, green", 3.4e38),
                channel("area.b", "R, 1/mm^2, blue", 3.4e38),
            ],
        },
        Layout {
            id: "inside",
            doc: "part of the light that leaves within the distance",
            channels: &[
                channel("inside.r", "int_0^r 2 pi s R ds, red", 1.0),
                channel("inside.g", "int_0^r 2 pi s R ds, green", 1.0),
                channel("inside.b", "int_0^r 2 pi s R ds, blue", 1.0),
            ],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &PARAMS,
    laws: &["finite", "range", "total", "monotone"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: profile::NOTES,
    bind,
};

/// Own parameter, and those of profiles.
static PARAMS: [Param; 1 + profile::PARAMS.len()] = profile::with(Param::choice(
    "scale",
    "to what the whole integrates: 1 (the albedo comes from a texture), or the albedo of the profile",
    &["one", "albedo"],
));

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    axis("radius", 256, [0.0, 16.0], Warp::Power(0.25)).into_iter().collect()
}

struct Table {
    radius: usize,
    profile: Profile,
    factor: [f64; 3],
    layout: &'static str,
}

/// What the table's values integrate to, of each channel.
#[must_use]
pub fn factor(spec: &Spec, profile: &Profile) -> [f64; 3] {
    if spec.params.choice("scale") == "albedo" { profile.total() } else { [1.0; 3] }
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let profile = Profile::new(spec)?;
    let factor = factor(spec, &profile);
    Ok(Box::new(Table { radius: spec.coordinate("radius")?, profile, factor, layout: spec.layout.id }))
}

impl Baker for Table {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let r = at[self.radius];
        let values = match self.layout {
            "area" => self.profile.at(r),
            "inside" => self.profile.inside(r),
            _ => self.profile.ring(r),
        };
        let mut value = [0.0; MAX_CHANNELS];
        for (v, (x, f)) in value.iter_mut().zip(values.iter().zip(&self.factor)) {
            *v = x * f;
        }
        super::closed_form(value, 3)
    }

    fn rule(&self) -> String {
        "closed form".to_owned()
    }
}
