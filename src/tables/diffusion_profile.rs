//! Radial diffusion profiles over the distance: per area, per ring, and as a cumulative distribution.

use super::default_axes::axis;
use super::profile::{self, Profile};
use super::role::{Band, Per};
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Spec, TableInfo, TexelError,
};
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::models::Param;

const fn channel(id: &'static str, meaning: &'static str, role: Role) -> ChannelInfo {
    let most = if matches!(role, Role::ProfileWithin(_)) { 1.0 } else { 3.4e38 };
    ChannelInfo { id, meaning, range: [0.0, most], role }
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "diffusion-profile",
    title: "Radial diffusion profile",
    formula: "2 pi r R(r); or R(r); or the part inside, int_0^r 2 pi s R(s) ds; of red, green and blue",
    sources: &profile::SOURCES,
    coordinates: &["radius"],
    layouts: &[
        Layout {
            id: "ring",
            doc: "light per mm of distance: finite at 0 for every profile",
            channels: &[
                channel("ring.r", "2 pi r R, 1/mm, red", Role::Profile(Per::Ring, Band::Red)),
                channel("ring.g", "2 pi r R, 1/mm, green", Role::Profile(Per::Ring, Band::Green)),
                channel("ring.b", "2 pi r R, 1/mm, blue", Role::Profile(Per::Ring, Band::Blue)),
            ],
        },
        Layout {
            id: "area",
            doc: "light per mm^2; profile burley is infinite at 0: start its axis above",
            channels: &[
                channel("area.r", "R, 1/mm^2, red", Role::Profile(Per::Area, Band::Red)),
                channel("area.g", "R, 1/mm^2, green", Role::Profile(Per::Area, Band::Green)),
                channel("area.b", "R, 1/mm^2, blue", Role::Profile(Per::Area, Band::Blue)),
            ],
        },
        Layout {
            id: "inside",
            doc: "part of the light that leaves within the distance",
            channels: &[
                channel("inside.r", "int_0^r 2 pi s R ds, red", Role::ProfileWithin(Band::Red)),
                channel("inside.g", "int_0^r 2 pi s R ds, green", Role::ProfileWithin(Band::Green)),
                channel("inside.b", "int_0^r 2 pi s R ds, blue", Role::ProfileWithin(Band::Blue)),
            ],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &PARAMS,
    laws: &["finite", "range", "total", "monotone", "honest"],
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

/// What the channels hold.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    Density(Per),
    Within,
}

struct Table {
    radius: usize,
    profile: Profile,
    factor: [f64; 3],
    form: Form,
}

/// What the table's values integrate to, of each channel.
#[must_use]
pub fn factor(spec: &Spec, profile: &Profile) -> [f64; 3] {
    // kinds without the choice are not scaled
    let scaled = spec.params.choice("scale").is_ok_and(|word| word == "albedo");
    if scaled { profile.total() } else { [1.0; 3] }
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    let profile = Profile::new(spec)?;
    let factor = factor(spec, &profile);
    let forms = spec.each(|role| match role {
        Role::Profile(per, _) => Some(Form::Density(per)),
        Role::ProfileWithin(_) => Some(Form::Within),
        _ => None,
    })?;
    let form = forms.first().copied().unwrap_or(Form::Within);
    Ok(Box::new(Table { radius: spec.coordinate("radius")?, profile, factor, form }))
}

impl Baker for Table {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let r = at[self.radius];
        let values = match self.form {
            Form::Density(Per::Area) => self.profile.at(r),
            Form::Density(Per::Ring) => self.profile.ring(r),
            Form::Within => self.profile.inside(r),
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
