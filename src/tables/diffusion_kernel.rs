//! The line integral of a diffusion profile: the kernel of a blur along one direction.
//!
//! `L(x) = int R(sqrt(x^2 + y^2)) dy` is what a straight shadow edge differentiates to, and the exact kernel for light
//! that varies along one direction only. Two passes of it blur a Gaussian exactly and other profiles approximately.
//! `C(x) = int_-x^x L` gives the weight of a tap that covers [a, b] as (C(b) - C(a))/2: weights made so sum to 1.
//!
//! With F the part inside a radius, `C(x) = (2/pi) int_0^(pi/2) F(x / cos phi) dphi`: the strip |X| < x cuts rings of
//! radius r > x down to the part (2/pi) asin(x/r), integrated by parts. L substitutes y = h sinh t, h the larger of x and
//! the least length of the profile. Gaussians are closed forms.

use super::default_axes::axis;
use super::profile::{self, Profile, Rgb};
use super::role::Band;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, Role, Setting, Source, Spec, TableInfo, TexelError,
};
use crate::cite;
use crate::grid::{Axis, Warp};
use crate::integrate::{Estimate, MAX_CHANNELS, Sums, line};
use std::f64::consts::{FRAC_PI_2, PI};

const fn channel(id: &'static str, meaning: &'static str, role: Role) -> ChannelInfo {
    let most = if matches!(role, Role::KernelWithin(_)) { 1.0 } else { 3.4e38 };
    ChannelInfo { id, meaning, range: [0.0, most], role }
}

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "diffusion-kernel",
    title: "Separable kernel of a diffusion profile",
    formula: "C(x) = int_-x^x L, or L(x) = int R(sqrt(x^2 + y^2)) dy, with 2 pi int R r dr = 1",
    sources: &SOURCES,
    coordinates: &["offset"],
    layouts: &[
        Layout {
            id: "cumulative",
            doc: "weight of the taps between -x and x; a tap over [a, b] weighs (C(b) - C(a)) / 2",
            channels: &[
                channel("within.r", "int_-x^x L, red", Role::KernelWithin(Band::Red)),
                channel("within.g", "int_-x^x L, green", Role::KernelWithin(Band::Green)),
                channel("within.b", "int_-x^x L, blue", Role::KernelWithin(Band::Blue)),
            ],
        },
        Layout {
            id: "line",
            doc: "density of the kernel; profile burley is infinite at 0: start its axis above",
            channels: &[
                channel("line.r", "L, 1/mm, red", Role::Kernel(Band::Red)),
                channel("line.g", "L, 1/mm, green", Role::Kernel(Band::Green)),
                channel("line.b", "L, 1/mm, blue", Role::Kernel(Band::Blue)),
            ],
        },
    ],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: profile::PARAMS,
    laws: &["finite", "range", "total", "monotone", "honest"],
    axes: default_axes,
    least_tolerance: |_| 0.0,
    blended: true,
    notes: profile::NOTES,
    bind,
};

/// Own sources, and those of profiles.
static SOURCES: [Source; 2 + profile::SOURCES.len()] = profile::with_sources([
    Source::new(cite::JIMENEZ_2015, "section 4, the artist-friendly and the pre-integrated kernel"),
    Source::new(cite::DEON_LUEBKE_2007, "section 14.4.3"),
]);

fn default_axes(_: &Setting<'_>) -> Vec<Axis> {
    axis("offset", 256, [0.0, 16.0], Warp::Power(0.25)).into_iter().collect()
}

struct Kernel {
    offset: usize,
    profile: Profile,
    cumulative: bool,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Kernel {
        offset: spec.coordinate("offset")?,
        profile: Profile::new(spec)?,
        cumulative: spec.roles().iter().any(|role| matches!(role, Role::KernelWithin(_))),
    }))
}

impl Baker for Kernel {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let x = at[self.offset];
        if let Profile::Gaussians { lobes, .. } = &self.profile {
            let mut value = [0.0; MAX_CHANNELS];
            value[..3].copy_from_slice(&gaussians(lobes, x, self.cumulative));
            return super::closed_form(value, 3);
        }
        super::finite(if self.cumulative { self.within(x, tolerance) } else { self.density(x, tolerance) }, 3)
    }

    fn rule(&self) -> String {
        match self.profile {
            Profile::Gaussians { .. } => "closed form".to_owned(),
            _ => "adaptive Gauss-Kronrod (7, 15), split at the scales of the profile".to_owned(),
        }
    }
}

fn gaussians(lobes: &[(f64, Rgb)], x: f64, cumulative: bool) -> Rgb {
    let mut out = [0.0; 3];
    for (variance, weights) in lobes {
        let value = if cumulative {
            libm::erf(x / (2.0 * variance).sqrt())
        } else {
            libm::exp(-0.5 * x * x / variance) / (2.0 * PI * variance).sqrt()
        };
        for (o, w) in out.iter_mut().zip(weights) {
            *o += w * value;
        }
    }
    out
}

impl Kernel {
    fn within(&self, x: f64, tolerance: f64) -> Estimate {
        let mut breaks = vec![0.0];
        breaks.extend(self.profile.scales().into_iter().filter(|s| *s > x).map(|s| libm::acos(x / s)));
        breaks.push(FRAC_PI_2);
        line::integrate(&breaks, 3, tolerance, &mut |phi, out: &mut Sums| {
            let inside = self.profile.inside(x / libm::cos(phi));
            for (o, f) in out.iter_mut().zip(inside) {
                *o = 2.0 / PI * f;
            }
        })
    }

    fn density(&self, x: f64, tolerance: f64) -> Estimate {
        let scales = self.profile.scales();
        let h = x.max(scales[0]);
        let mut lengths = scales;
        // towards y = 0 the integrand changes on the scale x
        let mut y = x;
        while y > 0.0 && y < h {
            lengths.push(y);
            y *= 4.0;
        }
        let mut breaks: Vec<f64> = lengths.iter().map(|y| libm::asinh(y / h)).collect();
        breaks.push(0.0);
        breaks.sort_by(f64::total_cmp);
        line::integrate(&breaks, 3, tolerance, &mut |t, out: &mut Sums| {
            let (y, slope) = (h * libm::sinh(t), h * libm::cosh(t));
            let density = self.profile.at(libm::hypot(x, y));
            for (o, d) in out.iter_mut().zip(density) {
                *o = 2.0 * slope * d;
            }
        })
    }
}
