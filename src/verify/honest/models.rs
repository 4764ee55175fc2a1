//! Channels that are made of integrals of a lobe: the integrals by [`super::hemisphere`], means over the hemisphere by one more sum,
//! and the channels put together with the errors of their parts.

use super::hemisphere::Flux;
use super::integrals::{How, ROUNDING, integrate, mean};
use super::weight::weight;
use super::{Asked, Route, Truth, fresnel, quad};
use crate::models::Brdf;
use crate::tables::integral::Functional;
use crate::tables::role::{Light, Lobe, Side};
use crate::tables::{Role, Spec};
use crate::verify::linear;
use crate::verify::lobes::Lobes;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::{Mutex, PoisonError};

/// How often a finer sum is asked for.
const TRIES: usize = 3;

/// The lobes of a table, and the means that its texels share.
#[derive(Debug)]
pub(super) struct Models {
    lobes: Lobes,
    means: Mutex<BTreeMap<Vec<u64>, Option<Truth>>>,
}

/// An integral that a channel is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Base {
    lobe: Lobe,
    side: Side,
    flux: Flux,
    functional: Functional,
    /// Its mean over the hemisphere?
    mean: bool,
}

/// Integrals with their values at a point.
type Known = Vec<(Base, Option<Truth>)>;

impl Models {
    pub(super) fn new(spec: &Spec) -> Models {
        Models { lobes: Lobes::new(spec), means: Mutex::default() }
    }

    /// The channels that are made of integrals of lobes; nothing for others.
    pub(super) fn truths(&self, asked: &Asked<'_>, roles: &[Role]) -> Vec<Option<Truth>> {
        let needed = self.needed(asked, roles);
        let unused = |role: &Role| (*role == Role::Unused).then_some(Truth { value: 0.0, error: 0.0 });
        let mut truths: Vec<Option<Truth>> = roles.iter().map(unused).collect();
        if needed.is_empty() {
            return truths;
        }
        let target = |c: usize| asked.targets[c];
        let mut aim = (0..roles.len()).map(target).fold(f64::INFINITY, f64::min);
        for _ in 0..TRIES {
            let known = self.solve(asked, &needed, aim);
            for (c, role) in roles.iter().enumerate() {
                truths[c] = combine(*role, asked, &known);
            }
            // a sum that missed what it aimed at will not do better
            let short = |(_, t): &(Base, Option<Truth>)| t.is_none_or(|t| t.error > 2.0 * aim);
            if asked.route == Route::Drawn || known.iter().any(short) {
                break;
            }
            // quotients magnify: ask for what they need
            let excess = |(c, t): (usize, &Option<Truth>)| t.map_or(0.0, |t| t.error / (1.05 * target(c)));
            let worst = truths.iter().enumerate().map(excess).fold(0.0, f64::max);
            if worst <= 1.0 || !worst.is_finite() {
                break;
            }
            aim *= (0.7 / worst).max(1e-4);
        }
        truths
    }

    /// The integrals that the channels need, each once.
    fn needed(&self, asked: &Asked<'_>, roles: &[Role]) -> Vec<Base> {
        let mut all: Vec<Base> = Vec::new();
        for role in roles {
            for base in self.bases(*role, asked) {
                if !all.contains(&base) {
                    all.push(base);
                }
            }
        }
        all
    }

    fn bases(&self, role: Role, asked: &Asked<'_>) -> Vec<Base> {
        let base = |lobe, side, flux, functional, mean| Base { lobe, side, flux, functional, mean };
        let light = |lobe, light, side, mean| -> Vec<Base> {
            let crosses = light != Light::Reflected && self.crosses(lobe, side, asked);
            let reflected = light != Light::Transmitted;
            let part = |flux, wanted: bool| wanted.then(|| base(lobe, side, flux, Functional::One, mean));
            [part(Flux::Reflected, reflected), part(Flux::Crossing, crosses)].into_iter().flatten().collect()
        };
        let reflected = |lobe, g| base(lobe, Side::Above, Flux::Reflected, g, false);
        match role {
            Role::Albedo(lobe, which, side) => light(lobe, which, side, false),
            Role::Average(lobe, which, side) => light(lobe, which, side, true),
            Role::Complement(lobe, side) => light(lobe, Light::All, side, false),
            Role::AverageComplement(lobe, side) => light(lobe, Light::All, side, true),
            // what a lobe leaves to the one below counts what it reflects
            Role::Scaling(lobe) => light(lobe, Light::Reflected, Side::Above, false),
            Role::KeptAlbedo(lobe, _) | Role::Gain(lobe) => light(lobe, Light::All, Side::Above, false),
            Role::CompensationLobe(lobe) => {
                let mut both: Vec<Base> = light(lobe, Light::All, Side::Above, false);
                both.extend(light(lobe, Light::All, Side::Above, true));
                both
            }
            Role::ReflectedShare(lobe, _) => {
                let mut both: Vec<Base> = light(lobe, Light::All, Side::Above, true);
                both.extend(light(lobe, Light::All, Side::Inside, true));
                both
            }
            Role::Split(lobe, weight, _) => {
                let g = weight.functional().or_else(|| linear::curve(asked.spec, asked.at));
                g.map(|g| reflected(lobe, g)).into_iter().collect()
            }
            Role::SplitRest(lobe) => {
                vec![reflected(lobe, Functional::Schlick), reflected(lobe, Functional::One)]
            }
            Role::SplitMean(lobe) => {
                let curve = linear::curve(asked.spec, asked.at);
                curve.into_iter().chain([Functional::One]).map(|g| reflected(lobe, g)).collect()
            }
            Role::SampledMean(lobe) => {
                let g = linear::curve(asked.spec, asked.at);
                g.map(|g| base(lobe, Side::Above, Flux::Drawn, g, false)).into_iter().collect()
            }
            _ => Vec::new(),
        }
    }

    /// Relative index that a lobe is seen with; NaN where it has none.
    fn eta(&self, base: &Base, asked: &Asked<'_>) -> f64 {
        let sweep = self.lobes.sweep(base.lobe);
        let eta = sweep.and_then(|s| s.params(asked.at).ok()?.number("eta").ok()).unwrap_or(f64::NAN);
        if base.side == Side::Inside { 1.0 / eta } else { eta }
    }

    fn crosses(&self, lobe: Lobe, side: Side, asked: &Asked<'_>) -> bool {
        self.lobes.build(lobe, asked.at, side).is_some_and(|m| m.transmission().is_some())
    }

    /// The integrals, those of one lobe and flux in one pass.
    fn solve(&self, asked: &Asked<'_>, needed: &[Base], aim: f64) -> Known {
        let mut known: Known = Vec::new();
        for first in needed {
            if known.iter().any(|(b, _)| b == first) {
                continue;
            }
            let same = |b: &&Base| {
                (b.lobe, b.side, b.flux, b.mean) == (first.lobe, first.side, first.flux, first.mean)
            };
            let group: Vec<Base> = needed.iter().filter(same).copied().collect();
            let functionals: Vec<Functional> = group.iter().map(|b| b.functional).collect();
            let values = match (first.mean, self.lobes.build(first.lobe, asked.at, first.side)) {
                (_, None) => None,
                (true, Some(model)) => self.mean(asked, first, &*model, aim).map(|t| vec![t]),
                (false, Some(model)) => {
                    let view = self.lobes.view(first.lobe, asked.at);
                    let how = How { aim, route: asked.route, eta: self.eta(first, asked) };
                    integrate(&*model, view, first.flux, &functionals, how)
                }
            };
            for (i, base) in group.into_iter().enumerate() {
                known.push((base, values.as_ref().and_then(|v| v.get(i).copied())));
            }
        }
        known
    }

    /// `2 int E mu dmu`, over the azimuths too where the lobe turns; one for all texels that differ in the view only.
    fn mean(&self, asked: &Asked<'_>, base: &Base, model: &dyn Brdf, aim: f64) -> Option<Truth> {
        let of_view = |i: usize| ["mu", "phi"].contains(&asked.spec.grid.axes()[i].quantity.base_id());
        let rest = asked.at.iter().enumerate().filter(|(i, _)| !of_view(*i)).map(|(_, v)| v.to_bits());
        let words = [base.side as u64, base.flux as u64, asked.route as u64, aim.to_bits()];
        let key: Vec<u64> = rest.chain(words).collect();
        let lock = || self.means.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = lock().get(&key) {
            return *known;
        }
        // without the lock: two threads may find the same value, with the same bits
        let how = How { aim, route: asked.route, eta: self.eta(base, asked) };
        let made = mean(model, base.flux, how);
        lock().insert(key, made);
        made
    }
}

/// A channel from the integrals that it is made of.
fn combine(role: Role, asked: &Asked<'_>, known: &Known) -> Option<Truth> {
    let get = |lobe: Lobe, side: Side, flux: Flux, mean: bool, g: Functional| {
        let wanted = Base { lobe, side, flux, functional: g, mean };
        known.iter().find(|(b, _)| *b == wanted).map(|(_, t)| *t)
    };
    let light = |lobe, light, side, mean| {
        let mut sum: Option<Truth> = None;
        for (flux, wanted) in
            [(Flux::Reflected, light != Light::Transmitted), (Flux::Crossing, light != Light::Reflected)]
        {
            // a lobe that lets nothing through has no integral of that
            if let Some(part) = get(lobe, side, flux, mean, Functional::One).filter(|_| wanted) {
                let (part, before) = (part?, sum.unwrap_or(Truth { value: 0.0, error: 0.0 }));
                sum = Some(Truth { value: before.value + part.value, error: before.error + part.error });
            }
        }
        sum
    };
    let split = |lobe, g| get(lobe, Side::Above, Flux::Reflected, false, g).flatten();
    let all = |lobe| light(lobe, Light::All, Side::Above, false);
    let times = |t: Truth, factor: f64, constant: f64| Truth {
        value: constant + factor * t.value,
        error: factor.abs() * t.error + ROUNDING,
    };
    let kept = |t: Truth, lo: f64, hi: f64| Truth { value: t.value.clamp(lo, hi), error: t.error };
    match role {
        Role::Albedo(lobe, which, side) => light(lobe, which, side, false),
        Role::Average(lobe, which, side) => light(lobe, which, side, true),
        Role::Complement(lobe, side) => {
            Some(kept(times(light(lobe, Light::All, side, false)?, -1.0, 1.0), floor(role, asked), 1.0))
        }
        Role::AverageComplement(lobe, side) => {
            Some(kept(times(light(lobe, Light::All, side, true)?, -1.0, 1.0), 0.0, 1.0))
        }
        Role::KeptAlbedo(lobe, divisor) => {
            let channel = asked.spec.layout.channels.iter().find(|c| c.role == role)?;
            Some(kept(times(all(lobe)?, 1.0 / divisor, 0.0), channel.range[0], channel.range[1]))
        }
        Role::Scaling(lobe) => {
            let sheen = asked.spec.params.number("sheen").ok()?;
            let e = light(lobe, Light::Reflected, Side::Above, false)?;
            Some(kept(times(e, -sheen, 1.0), 0.0, f64::INFINITY))
        }
        Role::Gain(lobe) => {
            let e = all(lobe)?;
            let missing = (1.0 - e.value).max(0.0);
            Some(Truth { value: missing / e.value, error: (e.error + ROUNDING) / (e.value * e.value) })
        }
        Role::CompensationLobe(lobe) => {
            let (e, mean) = (all(lobe)?, light(lobe, Light::All, Side::Above, true)?);
            let (missing, lost) = ((1.0 - e.value).max(0.0), (1.0 - mean.value).max(0.0));
            let root = (PI * lost).sqrt();
            let value = if lost > 0.0 { missing / root } else { 0.0 };
            let error = (e.error + ROUNDING) / root + 0.5 * value * (mean.error + ROUNDING) / lost;
            Some(Truth { value, error })
        }
        Role::ReflectedShare(lobe, side) => shares(
            side,
            light(lobe, Light::All, Side::Above, true)?,
            light(lobe, Light::All, Side::Inside, true)?,
            asked,
        ),
        Role::Split(lobe, weight, factor) => {
            let g = weight.functional().or_else(|| linear::curve(asked.spec, asked.at))?;
            Some(times(split(lobe, g)?, factor, 0.0))
        }
        Role::SplitRest(lobe) => {
            let mu = asked.spec.axis("mu").map_or(1.0, |i| asked.at[i]);
            let (part, whole) = (split(lobe, Functional::Schlick)?, split(lobe, Functional::One)?);
            let mirror = weight(Functional::Schlick, mu);
            Some(Truth {
                value: part.value - mirror * whole.value,
                error: part.error + mirror * whole.error + ROUNDING,
            })
        }
        Role::SplitMean(lobe) => {
            let g = linear::curve(asked.spec, asked.at)?;
            let (part, whole) = (split(lobe, g)?, split(lobe, Functional::One)?);
            if whole.value <= 0.0 {
                return Some(Truth { value: 0.0, error: 0.0 });
            }
            let value = part.value / whole.value;
            Some(Truth { value, error: (part.error + value * whole.error) / whole.value + ROUNDING })
        }
        Role::SampledMean(lobe) => {
            get(lobe, Side::Above, Flux::Drawn, false, linear::curve(asked.spec, asked.at)?).flatten()
        }
        Role::Unused => Some(Truth { value: 0.0, error: 0.0 }),
        _ => None,
    }
}

/// What is missing is kept from falling below 0 by rounding, unless the table says that more leaves than arrives.
fn floor(role: Role, asked: &Asked<'_>) -> f64 {
    let channel = asked.spec.layout.channels.iter().position(|c| c.role == role);
    let below = channel.and_then(|c| asked.baked.get(c)).is_some_and(|v| *v < 0.0);
    if below { f64::NEG_INFINITY } else { 0.0 }
}

/// The reflected share of the added light, `1 - x (1 - F_avg)`, from what both sides miss.
fn shares(side: Side, above: Truth, inside: Truth, asked: &Asked<'_>) -> Option<Truth> {
    let eta = match asked.spec.axis("eta") {
        Some(i) => asked.at[i],
        None => asked.spec.model.as_ref()?.1.number("eta").ok()?,
    };
    let [a, b] = [above, inside].map(|t| (1.0 - t.value).max(0.0));
    let sum = a + b;
    let x = if sum > 0.0 { b / sum } else { 0.5 };
    let dx = if sum > 0.0 { (x * above.error + (1.0 - x) * inside.error) / sum } else { 0.0 };
    let passing = |eta: f64| {
        let mut breaks = vec![0.0, 1.0];
        if eta < 1.0 {
            breaks.insert(1, ((1.0 - eta) * (1.0 + eta)).sqrt());
        }
        quad::integral(&breaks, 1e-12, &mut |mu| 2.0 * mu * (1.0 - fresnel::dielectric(mu, eta).mean().value))
    };
    let (part, (through, error)) = match side {
        Side::Above => (x, passing(eta)),
        Side::Inside => (1.0 - x, passing(1.0 / eta)),
    };
    Some(Truth { value: 1.0 - part * through, error: dx * through + part * error + ROUNDING })
}
