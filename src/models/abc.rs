//! ABC facets in V-shaped grooves: a peak and a tail of their own, fitted to many measured materials.
//!
//! `b` sets how narrow the peak is (facets at the angle `sqrt(2 / b)` are where it falls off), `c` how steep the tail: 0.5 to 1.5 is
//! usual for measured metals and paints, whose tails are longer than those of GGX; a large `c` nears a Gaussian. The scale `A` of the
//! paper is not a parameter: it is the norm that a distribution of normals has, so that the lobe conserves energy.
//!
//! Recipe: `model = "abc"`, `params = { b = 1000, c = 1, f0 = 0.04 }`.

use super::facets::{Facets, HalfVectorLobe, vcavity_visibility};
use super::grooves;
use super::microfacet::{F0, F90, Fresnel};
use super::{Brdf, DefaultValue, Known, KnownValue, Laws, ModelInfo, Param, ParamError, Params};
use crate::cite;
use crate::integrate::Chart;
use crate::math::frame::HalfVector;
use crate::math::root;
use crate::math::special::{circle, exprel};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Registry entry.
pub static INFO: ModelInfo = ModelInfo {
    id: "abc",
    title: "ABC facets in V-cavities (Low and others 2012)",
    formula: "f = F(wo.wh) A (1 + b (1 - h.z))^(-c) G / (4 mu_o mu_i), int D cos = 1, G = min(1, 2 h.z mu_o / v, 2 h.z mu_i / v)",
    sources: &[
        (cite::LOW_2012, "Eq. 15, by BBM (the microfacet model; its A is normalised here)"),
        (cite::BBM, "`ndf/low.h`, `maskingshadowing/vgroove.h`: the same D and G"),
        (cite::TORRANCE_SPARROW_1967, "Eq. 16 to 18 (G)"),
    ],
    params: &[
        Param::number("b", "b", "sharpness of the peak", [1.0, 1e7], DefaultValue::Value(1000.0)),
        Param::number("c", "c", "steepness of the tail", [0.1, 20.0], DefaultValue::Value(1.0)),
        F0,
        F90,
    ],
    laws: Laws { reciprocal: true, passive: true, isotropic: true },
    notes: "Fits of the paper carry their own A, which need not conserve energy; take b and c from them. V-cavity masking has kinks.",
    also: &[],
    known: &[
        Known {
            what: KnownValue::Value([0.5, 0.0, 0.5, 3.140_625]),
            params: &[("b", "100"), ("c", "1")],
            value: 1.411_076_931_579_924_813,
            relative: 1e-12,
            source: "formula in 50-digit arithmetic",
        },
        Known {
            what: KnownValue::Albedo(1.0),
            params: &[("b", "1"), ("c", "1"), ("f0", "1")],
            value: 0.440_869_153_775_126_178,
            relative: 1e-10,
            source: "one-dimensional integral in 50-digit arithmetic: 2 pi int D z min(1, 4 z^2 - 2) dz over z in (1/sqrt 2, 1)",
        },
    ],
    splits: true,
    build,
};

#[derive(Debug)]
struct Abc {
    b: f64,
    c: f64,
    /// A: the value of D at the normal.
    peak: f64,
}

fn build(params: &Params) -> Result<Box<dyn Brdf>, ParamError> {
    let (b, c) = (params.number("b")?, params.number("c")?);
    Ok(Box::new(HalfVectorLobe {
        facets: Abc { b, c, peak: 0.5 / (PI * below(b, c, libm::log1p(b)).0) },
        fresnel: Fresnel::Schlick { f0: params.number("f0")?, f90: params.number("f90")? },
        flat: false,
    }))
}

/// `int_0^t (1 - x) (1 + b x)^(-c) dx` and its derivative, by `v = ln(1 + b t)`.
///
/// With `u = 1 + b x` it is `int (1 + b - u) u^(-c) du / b^2`, and each power integrates to `v exprel(p v)`, which is regular where
/// the exponent p is 0. `b >= 1` keeps the difference from cancelling.
fn below(b: f64, c: f64, v: f64) -> (f64, f64) {
    let sum = (1.0 + b) * exprel((1.0 - c) * v) - exprel((2.0 - c) * v);
    let slope = (1.0 + b - libm::exp(v)) * libm::exp((1.0 - c) * v);
    (v * sum / (b * b), slope / (b * b))
}

/// Widths of the peak from which on a tail is a long one.
const LONG: f64 = 30.0;

/// Growth of the panels that lead from the peak into its tail.
const GROWTH: f64 = 8.0;

impl Abc {
    /// Width of the peak as a slope: a high power falls on a finer scale.
    fn width(&self) -> f64 {
        let narrow = 0.5 * self.b;
        (1.0 / (1.0 + narrow * (1.0 + (self.c - 2.0).max(0.0)))).sqrt()
    }

    /// The angle at which D has fallen to `exp(-decay)` of its peak.
    fn reach(&self, decay: f64) -> f64 {
        let t = libm::expm1(decay / self.c) / self.b;
        if t < 1.0 { libm::acos(1.0 - t) } else { FRAC_PI_2 }
    }
}

impl Facets for Abc {
    /// `A (1 + b (1 - h.z))^(-c)`; the difference is taken from the sine for normals near the macronormal.
    fn d(&self, wm: DVec3) -> f64 {
        if wm.z <= 0.0 {
            return 0.0;
        }
        let t = (wm.x * wm.x + wm.y * wm.y) / (1.0 + wm.z);
        self.peak * libm::exp(-self.c * libm::log1p(self.b * t))
    }

    /// By inversion of the integral of `D cos`, a monotone function of `ln(1 + b t)`.
    fn sample_d(&self, u: DVec2) -> DVec3 {
        let end = libm::log1p(self.b);
        let target = u.x * below(self.b, self.c, end).0;
        let v = root::solve(0.0, end, |v| {
            let (value, slope) = below(self.b, self.c, v);
            (value - target, slope)
        });
        let t = (libm::expm1(v) / self.b).min(1.0);
        let (cos, sin) = circle(u.y);
        let r = (t * (2.0 - t)).sqrt();
        DVec3::new(r * cos, r * sin, 1.0 - t)
    }

    fn visibility(&self, wo: DVec3, wi: DVec3, h: &HalfVector) -> f64 {
        vcavity_visibility(wo, wi, h)
    }

    fn chart(&self) -> Option<Chart> {
        let alpha = self.width();
        let widths = libm::tan(self.reach(grooves::DECAY)) / alpha;
        let reach = if widths < LONG { widths } else { f64::INFINITY };
        Some(Chart::HalfVector { alpha, reach, kinks: true, slope: f64::INFINITY, layer: 3.0 * alpha })
    }

    fn groove_reach(&self) -> Option<f64> {
        Some(self.reach(grooves::DECAY))
    }

    /// A long tail has no end: panels grow from the peak to the horizon.
    fn groove_heights(&self) -> Vec<f64> {
        let reach = self.reach(grooves::DECAY);
        let mut heights = Vec::new();
        let mut angle = 2.0 * self.width();
        while angle < 0.5 * reach {
            heights.push(libm::cos(angle));
            angle *= GROWTH;
        }
        heights
    }
}
