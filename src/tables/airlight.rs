//! Light that fog scatters once on its way from a lamp: the lookup of Sun and others, 2005.
//!
//! A lamp of intensity I at the distance D in a homogeneous medium of extinction beta, isotropic scattering of albedo 1. Along a ray
//! at the angle gamma from the lamp, with `T = beta D` and `xi = pi/4 + eta/2` of the angle eta under which a point of the ray is seen
//! from the lamp,
//!
//! ```text
//! L = beta I e^(-T cos gamma) / (2 pi D sin gamma) (F(T sin gamma, xi_end) - F(T sin gamma, gamma / 2))
//! F(u, v) = int_0^v exp(-u tan(xi)) dxi,  F(0, v) = v
//! ```
//! and xi_end = pi/2 where the ray does not end.

use super::default_axes::axis;
use super::{
    Baker, BindError, ChannelInfo, Layout, Mix, ModelUse, OwnNumber, Role, Source, Spec, TableInfo,
    TexelError,
};
use crate::cite;
use crate::grid::Warp;
use crate::integrate::{Estimate, line};
use std::f64::consts::FRAC_PI_2;

/// Registry entry.
pub static INFO: TableInfo = TableInfo {
    id: "airlight",
    title: "Light that fog scatters once towards the eye",
    formula: "F(tau, xi) = int_0^xi exp(-tau tan x) dx",
    sources: &[Source::new(
        cite::SUN_2005,
        "section 4, the function F; derived again in the docs of the kind",
    )],
    coordinates: &["tau", "xi"],
    layouts: &[Layout {
        id: "ray",
        doc: "F: the fog between the eye and a surface, by two lookups",
        channels: &[ChannelInfo {
            id: "airlight.f",
            meaning: "F(tau, xi)",
            range: [0.0, FRAC_PI_2],
            role: Role::Own(&RAY),
        }],
    }],
    mix: Mix::Layouts,
    model: ModelUse::None,
    params: &[],
    laws: &["finite", "range", "monotone", "honest"],
    axes: |_| {
        let tau = axis("tau", 64, [0.0, 10.0], Warp::Power(0.25));
        tau.into_iter().chain(axis("xi", 64, [0.0, FRAC_PI_2], Warp::Linear)).collect()
    },
    least_tolerance: |_| 0.0,
    blended: true,
    notes: "Scattering is isotropic with albedo 1: multiply by the albedo of the medium. tau is beta D sin(gamma), D the distance of the \
        lamp, gamma the angle between it and the ray.",
    bind,
};

static RAY: OwnNumber = OwnNumber {
    name: "integral of airlight",
    trend: Some(("xi", 1.0)),
    truth: |spec, at, target, quad| {
        let (tau, xi) = (at[spec.axis("tau")?], at[spec.axis("xi")?]);
        // t = tan(x) = y / (1 - y)
        let (sin, cos) = libm::sincos(xi);
        let end = sin / (sin + cos);
        let breaks = inner_breaks(0.0, end, [0.1, 1.0, 10.0, 40.0].map(|k| k / (k + tau)));
        Some(quad(&breaks, target, &mut |y| {
            let z = 1.0 - y;
            libm::exp(-tau * y / z) / (z * z + y * y)
        }))
    },
};

/// Sorted breaks between two ends.
pub(super) fn inner_breaks(from: f64, to: f64, between: [f64; 4]) -> Vec<f64> {
    let mut all = vec![from, to];
    all.extend(between.into_iter().filter(|b| *b > from && *b < to));
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

struct Ray {
    tau: usize,
    xi: usize,
}

fn bind(spec: &Spec) -> Result<Box<dyn Baker>, BindError> {
    Ok(Box::new(Ray { tau: spec.coordinate("tau")?, xi: spec.coordinate("xi")? }))
}

/// Depths `tau tan(x)` between which the exponential falls, the last where nothing is left.
const DEPTHS: [f64; 5] = [0.3, 2.0, 8.0, 20.0, 45.0];

/// `int exp(-tau (tan x - tan from)) dx` from an angle to another one, at most pi/2.
pub(super) fn fading(tau: f64, from: f64, to: f64, tolerance: f64) -> Estimate {
    let start = libm::tan(from);
    let mut breaks = vec![from];
    breaks.extend(DEPTHS.map(|k| libm::atan(start + k / tau).min(to)));
    // a medium too thin for its end to lie before `to`
    if start + DEPTHS[4] / tau > libm::tan(to) {
        breaks.push(to);
    }
    line::integrate(&breaks, 1, tolerance, &mut |x, out| {
        out[0] = libm::exp(-tau * (libm::tan(x) - start));
    })
}

impl Baker for Ray {
    fn texel(&self, at: &[f64], tolerance: f64) -> Result<Estimate, TexelError> {
        let (tau, xi) = (at[self.tau], at[self.xi]);
        let e = if tau <= 0.0 { Estimate::exact_one(xi) } else { fading(tau, 0.0, xi, tolerance) };
        super::finite(e, 1)
    }

    fn rule(&self) -> String {
        RULE.to_owned()
    }
}

/// How both kinds are integrated.
pub(super) const RULE: &str = "adaptive Gauss-Kronrod (7, 15), split where the exponential falls";
