//! Values of a lobe at directions made anew, and directions that sample one: the baked direction is put into cumulative
//! distributions that are added up here, and moved by what they miss.

use super::quad::{self, Sum, WIDE};
use super::{Asked, Truth};
use crate::integrate::View;
use crate::models::Brdf;
use crate::tables::role::{Component, Lobe, Side};
use crate::tables::{Role, Spec};
use crate::verify::lobes::Lobes;
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::{Mutex, PoisonError};

/// Roundings of a value in closed form.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Most steps of Newton's method from a baked angle.
const STEPS: usize = 3;

/// Most panels of a sum over the polar angle, and of one over the azimuth.
const MOST: [usize; 2] = [48, 64];

/// The lobes of a table; its albedos by the sum over both angles, which texels of one view share.
#[derive(Debug)]
pub(super) struct Directions {
    lobes: Lobes,
    albedos: Mutex<BTreeMap<Vec<u64>, (f64, f64)>>,
}

/// A lobe seen from somewhere.
struct Seen<'a> {
    model: &'a dyn Brdf,
    view: View,
    wo: DVec3,
}

impl Seen<'_> {
    /// Light at an angle to the normal and an azimuth from the view's.
    fn light(&self, theta: f64, phi: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(theta);
        let (sin_p, cos_p) = libm::sincos(self.view.phi + phi);
        DVec3::new(sin * cos_p, sin * sin_p, cos.max(0.0))
    }

    fn at(&self, theta: f64, phi: f64) -> f64 {
        self.model.eval(self.wo, self.light(theta, phi))
    }

    /// `int f dphi` from the azimuth of the view to another one; it peaks there and half a turn on.
    fn around(&self, theta: f64, end: f64, target: f64) -> Sum {
        let last = end / PI;
        // where a model is clamped (the cosine of Oren and Nayar) it has corners in the cross plane
        let mut halves = vec![0.0];
        halves.extend([0.5, 1.0, 1.5].into_iter().filter(|b| *b < last));
        halves.push(last);
        quad::integrate(&halves, 1, &[target; WIDE], MOST[1], &mut |y| {
            let turn = y.floor().min(1.0);
            // the last part ends where it is told to, not at the end of its half
            let (part, slope) = if turn < 1.0 && end < PI || turn >= 1.0 && end < TAU {
                (y - turn, 1.0)
            } else {
                quad::spread(y - turn)
            };
            Sum::single(PI * slope * self.at(theta, PI * (turn + part)))
        })
    }

    /// `int sin cos int f dphi dtheta` up to an angle.
    fn up_to(&self, end: f64, target: f64) -> (f64, f64) {
        let own = libm::acos(self.view.mu.clamp(0.0, 1.0));
        let mut breaks = vec![0.0, end];
        for near in [0.0, 0.02, 0.1, 0.4] {
            breaks.extend([own - near, own + near].into_iter().filter(|b| *b > 0.0 && *b < end));
        }
        breaks.sort_by(f64::total_cmp);
        let sum = quad::integrate(&breaks, 1, &[0.5 * target; WIDE], MOST[0], &mut |theta| {
            let (sin, cos) = libm::sincos(theta);
            let measure = sin * cos.max(0.0);
            let mut row = self.around(theta, TAU, 0.3 * target / measure.max(1e-3));
            row.scale(measure);
            row
        });
        (sum.value[0], sum.error[0])
    }
}

impl Directions {
    pub(super) fn new(spec: &Spec) -> Directions {
        Directions { lobes: Lobes::new(spec), albedos: Mutex::default() }
    }

    /// Roles of this file; a direction is found once for all of its components.
    pub(super) fn truths(&self, asked: &Asked<'_>, roles: &[Role]) -> Vec<Option<Truth>> {
        let mut drawn: Option<Option<Drawn>> = None;
        let target = asked.targets.iter().copied().fold(f64::INFINITY, f64::min);
        let mut of = |(c, role): (usize, &Role)| match *role {
            Role::Value(lobe, band) => {
                let factor = asked.spec.params.number(["red", "green", "blue"][band.index()]).ok()?;
                let truth = self.value(lobe, asked)?;
                Some(Truth { value: factor * truth.value, error: factor * truth.error })
            }
            Role::Direction(lobe, component) => {
                let drawn = drawn.get_or_insert_with(|| self.direction(lobe, asked, target));
                drawn.map(|d| d.component(component))
            }
            Role::DirectionDensity(lobe) => self.density(lobe, asked, asked.targets[c]),
            _ => None,
        };
        roles.iter().enumerate().map(&mut of).collect()
    }

    /// f at half and difference angles: `wi` by rotations, `wo` its mirror image.
    fn value(&self, lobe: Lobe, asked: &Asked<'_>) -> Option<Truth> {
        let at = |id: &str| asked.spec.axis(id).map(|i| asked.at[i]);
        let (half, turn, apart) = (at("theta_h")?, at("phi_d")?, at("theta_d")?);
        let model = self.lobes.build(lobe, asked.at, Side::Above)?;
        let (sin, cos) = libm::sincos(apart);
        let (sin_p, cos_p) = libm::sincos(turn);
        let (sin_h, cos_h) = libm::sincos(half);
        let before = DVec3::new(sin * cos_p, sin * sin_p, cos);
        let wi =
            DVec3::new(cos_h * before.x + sin_h * before.z, before.y, cos_h * before.z - sin_h * before.x);
        let wh = DVec3::new(sin_h, 0.0, cos_h);
        let wo = 2.0 * wi.dot(wh) * wh - wi;
        let value = model.eval(wo, wi);
        let error = ROUNDING * value.abs() + crate::verify::reciprocity::resolved(&*model, wo, wi);
        Some(Truth { value, error })
    }

    /// The albedo of the view of a point, by sums over both angles.
    fn albedo(&self, seen: &Seen<'_>, asked: &Asked<'_>, target: f64) -> (f64, f64) {
        let numbers = |id: &str| asked.spec.axis(id).unwrap_or(usize::MAX);
        let own = [numbers("u"), numbers("v")];
        let rest = asked.at.iter().enumerate().filter(|(i, _)| !own.contains(i)).map(|(_, v)| v.to_bits());
        let key: Vec<u64> = rest.chain([target.to_bits()]).collect();
        let lock = || self.albedos.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = lock().get(&key) {
            return *known;
        }
        let made = seen.up_to(FRAC_PI_2, target);
        lock().insert(key, made);
        made
    }

    fn density(&self, lobe: Lobe, asked: &Asked<'_>, target: f64) -> Option<Truth> {
        let model = self.lobes.build(lobe, asked.at, Side::Above)?;
        let seen = see(&*model, self.lobes.view(lobe, asked.at));
        let wi = DVec3::from_slice(&stored(asked)?);
        let f = seen.model.eval(seen.wo, wi) * wi.z;
        let (rough, _) = self.albedo(&seen, asked, 1e-3);
        let (albedo, error) =
            self.albedo(&seen, asked, (0.3 * target * rough * rough / f.max(1e-9)).max(1e-12));
        let value = f / albedo;
        Some(Truth { value, error: value * (error / albedo + ROUNDING) })
    }

    /// The direction that two numbers choose.
    fn direction(&self, lobe: Lobe, asked: &Asked<'_>, target: f64) -> Option<Drawn> {
        let model = self.lobes.build(lobe, asked.at, Side::Above)?;
        let seen = see(&*model, self.lobes.view(lobe, asked.at));
        let at = |id: &str| asked.spec.axis(id).map(|i| asked.at[i]);
        let (u, v) = (at("u")?, at("v")?);
        let [mut theta, mut phi] = angles(asked, &seen)?;
        // the polar angle: by what its distribution misses; its slope need not be sharp, but then a far step is taken twice
        let slope_at = |theta: f64| {
            let (sin, cos) = libm::sincos(theta);
            sin * cos * seen.around(theta, TAU, f64::INFINITY).value[0]
        };
        let mut theta_error = f64::INFINITY;
        for _ in 0..STEPS {
            let slope = slope_at(theta);
            if slope.is_nan() || slope <= 0.0 {
                return None;
            }
            let aim = (0.2 * target * slope).max(1e-13);
            let (whole, whole_error) = self.albedo(&seen, asked, power_of_two(aim));
            let (part, part_error) = seen.up_to(theta, aim);
            let step = (part - u * whole) / slope;
            let bent = bend(step, |x| slope_at(theta - x) / slope);
            theta_error = (part_error + u * whole_error) / slope + bent;
            theta -= step;
            if bent <= 0.1 * target {
                break;
            }
        }
        // the azimuth at that angle
        let mut phi_error = f64::INFINITY;
        for _ in 0..STEPS {
            let density = seen.at(theta, phi);
            if density.is_nan() || density <= 0.0 {
                return None;
            }
            let aim = (0.2 * target * density).max(1e-13);
            let missed = |theta: f64| {
                let (turn, some) = (seen.around(theta, TAU, aim), seen.around(theta, phi, aim));
                (some.value[0] - v * turn.value[0], some.error[0] + v * turn.error[0])
            };
            let (miss, miss_error) = missed(theta);
            let step = miss / density;
            let bent = bend(step, |x| seen.at(theta, phi - x) / density);
            phi_error = (miss_error + (missed(theta + theta_error).0 - miss).abs()) / density + bent;
            phi -= step;
            if bent <= 0.1 * target {
                break;
            }
        }
        Some(Drawn { wi: seen.light(theta, phi), theta, phi, error: [theta_error, phi_error] })
    }
}

/// A direction with the errors of its angles.
#[derive(Debug, Clone, Copy)]
struct Drawn {
    wi: DVec3,
    theta: f64,
    phi: f64,
    error: [f64; 2],
}

impl Drawn {
    fn component(&self, component: Component) -> Truth {
        let ([theta, phi], sin) = (self.error, libm::sin(self.theta));
        let apart = theta + sin * phi + ROUNDING;
        match component {
            Component::X => Truth { value: self.wi.x, error: apart },
            Component::Y => Truth { value: self.wi.y, error: apart },
            Component::Z => Truth { value: self.wi.z, error: (sin + theta) * theta + ROUNDING },
            Component::Azimuth => Truth { value: self.phi, error: phi + ROUNDING },
        }
    }
}

/// What the slope changes over a step is of second order; it is itself known to 5 %.
fn bend(step: f64, ratio: impl Fn(f64) -> f64) -> f64 {
    let change = 0.05 + (ratio(step) - 1.0).abs().max((ratio(0.5 * step) - 1.0).abs());
    step.abs() * if change.is_finite() { change } else { 1.0 }
}

/// The next smaller power of two, so that texels share what is made to it.
fn power_of_two(x: f64) -> f64 {
    libm::exp2(libm::log2(x).floor())
}

fn see(model: &dyn Brdf, view: View) -> Seen<'_> {
    let wo = view.direction();
    Seen { model, view, wo: DVec3::new(wo.x, wo.y, wo.z.max(1e-150)) }
}

/// The baked x, y and z.
fn stored(asked: &Asked<'_>) -> Option<[f64; 3]> {
    let of = |component: Component| {
        let is = |role: Role| matches!(role, Role::Direction(_, c) if c == component);
        asked.spec.roles().into_iter().position(is).map(|c| asked.baked[c])
    };
    Some([of(Component::X)?, of(Component::Y)?, of(Component::Z)?])
}

/// The baked angle to the normal and azimuth from the view's.
fn angles(asked: &Asked<'_>, seen: &Seen<'_>) -> Option<[f64; 2]> {
    if let Some([x, y, z]) = stored(asked) {
        let phi = libm::atan2(y, x) - seen.view.phi;
        return Some([libm::atan2(libm::hypot(x, y), z), phi - TAU * (phi / TAU).floor()]);
    }
    let of = |component: Component| {
        let is = |role: Role| matches!(role, Role::Direction(_, c) if c == component);
        asked.spec.roles().into_iter().position(is).map(|c| asked.baked[c])
    };
    Some([libm::acos(of(Component::Z)?.clamp(0.0, 1.0)), of(Component::Azimuth)?])
}
