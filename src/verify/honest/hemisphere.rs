//! Integrals of a lobe over directions, by rules that share nothing with the bakers: no chart, no reduction, no ladder.
//!
//! Light is added up over half vectors in polar coordinates round the normal: for every azimuth the angles are known between which
//! the ray leaves on its side of the surface, and where total reflection begins. How narrow the lobe is is found by looking along some
//! azimuths. Both sums are adaptive ([`super::quad`]). A second sum in other panels, and drawing from the model, may bear out what the
//! first one finds.

use super::quad::{self, Sum, WIDE};
use super::weight::weight;
use crate::integrate::View;
use crate::integrate::sobol::replicate_mean;
use crate::models::{Brdf, Btdf};
use crate::tables::integral::Functional;
use glam::{DVec2, DVec3};
use std::cell::Cell;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Which light is added up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Flux {
    /// `int f g mu_i dwi` on the side of the view, for each functional.
    Reflected,
    /// The part of the flux along the view that crosses, in the first channel.
    Crossing,
    /// `int p g dwi`, p the density of the model's sampler.
    Drawn,
}

/// What is integrated.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted<'a> {
    pub(super) model: &'a dyn Brdf,
    pub(super) view: View,
    pub(super) flux: Flux,
    pub(super) functionals: &'a [Functional],
    /// Relative index of an interface; NaN where there is none.
    pub(super) eta: f64,
    /// Error to aim at.
    pub(super) target: f64,
    /// Values of the lobe that are left to spend.
    pub(super) budget: &'a Cell<u32>,
}

/// Values of a lobe that one integral may take: what is dearer is not checked.
pub(super) const BUDGET: u32 = 300_000;

/// A view in the horizon stands for the limit of grazing views.
const JUST_ABOVE: f64 = 1e-150;

/// Part of the width of a lobe below which a view cosine stands for 0: what turns so fast holds no more than that part of the light.
const IN_THE_HORIZON: f64 = 1e-13;

/// Least scale of the azimuth at such a view.
const LEAST_TURN: f64 = 1e-3;

/// Scramblings, and points in each, where the model is drawn from.
const DRAWS: [u32; 2] = [16, 512];

/// Most panels of an outer and of an inner sum.
const MOST: [usize; 2] = [48, 96];

/// Angles of half vectors that are looked at along an azimuth, from the least one on, and azimuths of half a turn.
const LOOKS: [u32; 2] = [24, 8];
const LEAST_ANGLE: f64 = 1e-9;

/// Part of the largest contribution from which on a lobe counts as seen.
const SEEN: f64 = 0.03;

impl Wanted<'_> {
    fn wo(&self) -> DVec3 {
        let wo = self.view.direction();
        DVec3::new(wo.x, wo.y, wo.z.max(JUST_ABOVE))
    }

    fn channels(&self) -> usize {
        self.functionals.len()
    }

    /// The integrals; `again` in other panels, and finer.
    pub(super) fn sum(&self, again: bool) -> Sum {
        let finer = if again { 0.1 } else { 1.0 };
        Wanted { target: finer * self.target, ..*self }.over_half_vectors(again)
    }

    /// The same by drawing: means with their standard errors, and what so few draws may have missed.
    pub(super) fn drawn(&self, seed: u64) -> Sum {
        let wo = self.wo();
        let means = replicate_mean(seed, DRAWS[0], DRAWS[1], |u| self.draw(wo, u).value);
        let mut sum = Sum::ZERO;
        for (c, mean) in means.iter().enumerate() {
            sum.value[c] = mean.mean;
            sum.error[c] = 6.0 * mean.standard_error + 2.0 / f64::from(DRAWS[0] * DRAWS[1]);
        }
        sum
    }

    /// One draw: the weight of the sample in every channel.
    fn draw(&self, wo: DVec3, u: DVec2) -> Sum {
        if self.flux == Flux::Crossing {
            let Some(t) = self.model.transmission() else { return Sum::ZERO };
            let Some(s) = t.sample(wo, u).filter(|s| s.pdf > 0.0) else { return Sum::ZERO };
            // the flux along wo: light from wo, seen from the drawn side
            return Sum::single(t.eval(s.wi, wo) * s.wi.z.abs() / s.pdf);
        }
        let Some(s) = self.model.sample(wo, u).filter(|s| s.pdf > 0.0) else { return Sum::ZERO };
        let value = if self.flux == Flux::Drawn { 1.0 } else { self.model.eval(wo, s.wi) * s.wi.z / s.pdf };
        self.weighed(value, 0.5 * (wo + s.wi).length())
    }

    /// A contribution with its weights.
    fn weighed(&self, value: f64, v: f64) -> Sum {
        let mut sum = Sum::ZERO;
        for (s, g) in sum.value.iter_mut().zip(self.functionals) {
            *s = value * weight(*g, v);
        }
        sum
    }

    fn over_half_vectors(&self, again: bool) -> Sum {
        let wo = self.wo();
        let n = self.channels();
        let quarters: u32 = if self.model.turns() { 4 } else { 2 };
        let narrow = self.narrow(wo, quarters);
        let mut breaks: Vec<f64> = (0..=quarters).map(f64::from).collect();
        if again {
            breaks.extend((0..quarters).map(|q| f64::from(q) + 0.6));
            breaks.sort_by(f64::total_cmp);
        }
        // the horizon turns within mu of a quarter and three quarters of a turn; of a view that is as good as in it, nowhere
        let steep = Spread::new(if wo.z < IN_THE_HORIZON * narrow { narrow.max(LEAST_TURN) } else { wo.z });
        // total reflection leaves the plane of the view at some azimuth
        let critical = ((1.0 - self.eta) * (1.0 + self.eta)).max(0.0);
        let turn = (critical - wo.z * wo.z).max(0.0).sqrt() / self.view.sine();
        if self.eta < 1.0 && turn < 1.0 {
            let x = steep.inverse(1.0 - libm::acos(turn) / FRAC_PI_2);
            breaks.extend(
                (0..quarters / 2)
                    .flat_map(|half| [f64::from(2 * half) + 1.0 - x, f64::from(2 * half) + 1.0 + x]),
            );
            breaks.sort_by(f64::total_cmp);
        }
        let target = [0.4 * self.target; WIDE];
        let share = 4.0 / f64::from(quarters);
        quad::integrate(&breaks, n, &target, MOST[0], &mut |x| {
            let quarter = x.floor().min(f64::from(quarters) - 1.0);
            // each quarter is graded towards the cross plane
            let odd = quarter.rem_euclid(2.0) > 0.5;
            let (part, slope) = steep.at(if odd { x - quarter } else { 1.0 - (x - quarter) });
            let psi = FRAC_PI_2 * (quarter + if odd { part } else { 1.0 - part });
            let measure = share * FRAC_PI_2 * slope;
            let mut row = self.row(wo, psi, narrow, 0.4 * self.target / (TAU * slope.max(1e-2)), again);
            row.scale(measure);
            row
        })
    }

    /// The sum along an azimuth.
    fn row(&self, wo: DVec3, psi: f64, narrow: f64, target: f64, again: bool) -> Sum {
        let along = self.view.sine() * libm::cos(psi);
        let azimuth = libm::sincos(self.view.phi + psi);
        let mut total = Sum::ZERO;
        for [from, to] in self.spans(wo.z, along) {
            let length = to - from;
            if length <= 0.0 {
                continue;
            }
            // from the normal outwards graded at the lobe, towards the other end at the edge of the horizon
            let near = Spread::new(if from > 0.0 { 0.05 } else { (2.0 * narrow / length).min(1.0) });
            let far = Spread::new(0.05);
            let rows: &[f64] = if again { &[0.0, 0.55, 1.0, 1.45, 2.0] } else { &[0.0, 1.0, 2.0] };
            let most = if self.budget.get() > 0 { MOST[1] } else { 0 };
            let sum = quad::integrate(rows, self.channels(), &[target; WIDE], most, &mut |y| {
                let (part, slope) = if y < 1.0 { near.at(y) } else { far.at(2.0 - y) };
                let step = 0.5 * length * part;
                let t = if y < 1.0 { from + step } else { to - step };
                let mut one = self.facet(wo, azimuth, t);
                one.scale(0.5 * length * slope);
                one
            });
            total.add(&sum, 1.0);
        }
        total
    }

    /// Angles of half vectors that matter along an azimuth, split where total reflection begins. `v = r cos(t - d)` is the cosine of
    /// the view to the facet.
    fn spans(&self, mu: f64, along: f64) -> Vec<[f64; 2]> {
        let (r, d) = (libm::hypot(mu, along), libm::atan2(along, mu));
        let crossing = self.flux == Flux::Crossing;
        // reflected rays are above the horizon where sin(2 t + p) > 0, p the angle of (along, mu)
        let end = if crossing { (d + FRAC_PI_2).min(FRAC_PI_2) } else { 0.5 * (PI - libm::atan2(mu, along)) };
        // without an interface there is no critical angle
        let critical = ((1.0 - self.eta) * (1.0 + self.eta)).sqrt();
        if self.eta.is_nan() || self.eta >= 1.0 {
            return vec![[0.0, end]];
        }
        if critical >= r {
            return if crossing { Vec::new() } else { vec![[0.0, end]] };
        }
        let reach = libm::acos(critical / r);
        let (first, last) = ((d - reach).clamp(0.0, end), (d + reach).clamp(0.0, end));
        if crossing { vec![[first, last]] } else { vec![[0.0, first], [first, last], [last, end]] }
    }

    /// The integrand at a half vector at angle `t` to the normal; sine and cosine of its azimuth.
    fn facet(&self, wo: DVec3, (sin_p, cos_p): (f64, f64), t: f64) -> Sum {
        self.budget.set(self.budget.get().saturating_sub(1));
        let (sin, cos) = libm::sincos(t);
        let wh = DVec3::new(sin * cos_p, sin * sin_p, cos);
        let v = wo.dot(wh);
        if v <= 0.0 {
            return Sum::ZERO;
        }
        if self.flux == Flux::Crossing {
            return self.model.transmission().map_or(Sum::ZERO, |b| self.refracted(b, wo, wh, v, sin));
        }
        let wi = 2.0 * v * wh - wo;
        if wi.z <= 0.0 {
            return Sum::ZERO;
        }
        let f =
            if self.flux == Flux::Drawn { self.model.pdf(wo, wi) } else { self.model.eval(wo, wi) * wi.z };
        self.weighed(f * 4.0 * v * sin, v)
    }

    /// Light along the view that a facet refracts: `dwi = (v - eta c)^2 / (eta^2 c) dwh`, c the refracted cosine.
    fn refracted(&self, btdf: &dyn Btdf, wo: DVec3, wh: DVec3, v: f64, sin: f64) -> Sum {
        let eta = self.eta;
        let square = 1.0 - (1.0 - v) * (1.0 + v) / (eta * eta);
        if square <= 0.0 {
            return Sum::ZERO;
        }
        let c = square.sqrt();
        let wi = (v / eta - c) * wh - wo / eta;
        if wi.z >= 0.0 {
            return Sum::ZERO;
        }
        let jacobian = (v - eta * c) * (v - eta * c) / (eta * eta * c);
        Sum::single(btdf.eval(wi, wo) * -wi.z * jacobian * sin)
    }

    /// The least angle of half vectors at which the lobe is seen, over some azimuths: what the sums are graded at.
    fn narrow(&self, wo: DVec3, quarters: u32) -> f64 {
        let mut seen: Vec<(f64, f64)> = Vec::new();
        for i in 0..=LOOKS[1] * quarters / 2 {
            let azimuth = libm::sincos(self.view.phi + PI * f64::from(i) / f64::from(LOOKS[1]));
            for j in 0..=LOOKS[0] {
                let t = LEAST_ANGLE * libm::pow(1.5 / LEAST_ANGLE, f64::from(j) / f64::from(LOOKS[0]));
                // per decade of the angle
                seen.push((t, t * self.facet(wo, azimuth, t).value[0].abs()));
            }
        }
        let largest = seen.iter().map(|s| s.1).fold(0.0, f64::max);
        let least = seen.iter().filter(|s| s.1 > SEEN * largest).map(|s| s.0).fold(1.5, f64::min);
        least.max(LEAST_ANGLE)
    }
}

/// A map of [0, 1] to itself that is even up to a scale and logarithmic beyond: `s sinh(c x)`, `c = asinh(1 / s)`.
#[derive(Debug, Clone, Copy)]
struct Spread {
    scale: f64,
    bend: f64,
}

impl Spread {
    fn new(scale: f64) -> Spread {
        let scale = scale.clamp(1e-10, 1.0);
        Spread { scale, bend: libm::asinh(1.0 / scale) }
    }

    /// The x of a value.
    fn inverse(self, value: f64) -> f64 {
        libm::asinh(value / self.scale) / self.bend
    }

    /// Value and slope.
    fn at(self, x: f64) -> (f64, f64) {
        // e^y - 1, of which both are made without a difference
        let more = libm::expm1(self.bend * x);
        let below = 1.0 / (1.0 + more);
        let (sinh, cosh) = (0.5 * (more + more * below), 0.5 * (1.0 + more + below));
        (self.scale * sinh, self.scale * self.bend * cosh)
    }
}
