//! Radii with the density of a diffusion profile: the inverse of its cumulative distribution.

use super::default_axes::axis;
use super::profile::{self, Profile};
use super::role::Band;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Spec, TableInfo, TexelError,
};
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS};
use crate::math::root::solve;
use crate::terms::burley_diffusion;

const fn channel(id: &'static str, meaning: &'static str, band: Band) -> ChannelInfo {
    ChannelInfo { id, meaning, range: [0.0, 3.4e38], role: Role::ProfileRadius(band) }
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "diffusion-sampling",
    title: "Radii that sample a diffusion profile",
    formula: "r(u) with int_0^r 2 pi s R(s) ds = u int_0^inf 2 pi s R(s) ds",
    sources: &profile::SOURCES,
    coordinates: &["u"],
    layouts: &[Layout {
        id: "radius",
        doc: "distance to move along the surface, in mm",
        channels: &[
            channel("radius.r", "r(u), mm, red", Band::Red),
            channel("radius.g", "r(u), mm, green", Band::Green),
            channel("radius.b", "r(u), mm, blue", Band::Blue),
        ],
    }],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: profile::PARAMS,
    laws: &["finite", "range", "monotone", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "u = 1 is infinitely far and counts as 1 - 2^-53. The slope grows towards both ends; the default axis ends at 0.999.",
    bind,
};

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    axis("u", 256, [0.0, 0.999], Warp::OneMinusPower(0.5)).into_iter().collect()
}

struct Table {
    u: usize,
    profile: Profile,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Table { u: spec.coordinate("u")?, profile: Profile::new(spec)? }))
}

impl Baker for Table {
    fn texel(&self, at: &[f64], _tolerance: f64) -> Result<Estimate, TexelError> {
        let u = at[self.u].min(1.0 - 0.5 * f64::EPSILON);
        let mut value = [0.0; MAX_CHANNELS];
        if let Profile::Burley { scale, .. } = &self.profile {
            for (v, l) in value.iter_mut().zip(scale) {
                *v = l * burley_diffusion::cdf_inverse(u);
            }
            return super::closed_form(value, 3);
        }
        let mut e = Estimate::exact(value);
        let end = self.profile.scales().last().copied().unwrap_or(0.0);
        for c in 0..3 {
            // each side of the median keeps its own digits
            let miss = |r: f64| {
                if u < 0.5 { self.profile.inside(r)[c] - u } else { (1.0 - u) - self.profile.outside(r)[c] }
            };
            let r = if u > 0.0 { solve(0.0, end, |r| (miss(r), self.profile.ring(r)[c])) } else { 0.0 };
            let left = miss(r).abs() / self.profile.ring(r)[c];
            e.value[c] = r;
            e.error[c] = 1e-14 * r + if left.is_finite() { left } else { 0.0 };
        }
        e.evaluations = 3 * 8;
        super::finite(e, 3)
    }

    fn rule(&self) -> String {
        match self.profile {
            Profile::Burley { .. } => "closed form",
            _ => "Newton's method in a bracket on the closed cumulative distribution",
        }
        .to_owned()
    }
}
