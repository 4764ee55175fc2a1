//! No surface reflects more than it receives: E <= 1 within the error estimate, at every texel.

use super::{Case, Law, Outcome, Watch};
use crate::tables::role::{Light, Lobe, Side, Weight};
use crate::tables::{Role, Spec, place};

/// The law.
pub static LAW: Law = Law {
    id: "energy",
    statement: "E <= 1 (R + T <= 1) within the error estimate at every texel, from every side",
    margin: "1 - E plus the error estimate",
    code: 2001,
    formal: false,
    concerns: |spec| !albedos(spec).is_empty(),
    check,
};

/// A sum of channels that is the part of the light along a view, or its mean, that a lobe does not lose.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sum {
    /// Of which lobe.
    pub(super) lobe: Lobe,
    /// From which side.
    pub(super) side: Side,
    /// The mean over the hemisphere?
    pub(super) average: bool,
    constant: f64,
    terms: Vec<(usize, f64)>,
}

impl Sum {
    /// Its value and error at a texel.
    pub(super) fn at(&self, case: &Case<'_>, texel: usize) -> (f64, f64) {
        self.terms.iter().fold((self.constant, 0.0), |(value, error), (c, factor)| {
            let (v, e) = case.at(texel, *c);
            (value + factor * v, error + factor.abs() * e)
        })
    }
}

/// The albedos that the channels of a table make: one channel, reflected plus transmitted parts, or scale plus bias.
///
/// A lobe beside the model that does not claim to be passive is left out: that its albedo exceeds 1 is its definition, and its
/// range says how far.
pub(super) fn albedos(spec: &Spec) -> Vec<Sum> {
    let roles = spec.roles();
    let mut sums = Vec::new();
    let mut add = |lobe, side, average, constant, terms: Vec<(usize, f64)>| {
        if !terms.is_empty() {
            sums.push(Sum { lobe, side, average, constant, terms });
        }
    };
    for lobe in super::lobes::lobes_of(spec) {
        if matches!(lobe, Lobe::Other(other) if !other.info.laws.passive) {
            continue;
        }
        let find = |wanted: &dyn Fn(Role) -> Option<f64>| -> Vec<(usize, f64)> {
            roles.iter().enumerate().filter_map(|(i, r)| Some((i, wanted(*r)?))).collect()
        };
        let part = |weight: Weight| {
            find(&|r| match r {
                Role::Split(l, w, factor) if l == lobe && w == weight => Some(1.0 / factor),
                _ => None,
            })
        };
        for one in part(Weight::One) {
            add(lobe, Side::Above, false, 0.0, vec![one]);
        }
        let (scale, bias) = (part(Weight::SchlickComplement), part(Weight::Schlick));
        if let (Some(scale), Some(bias)) = (scale.first(), bias.first()) {
            add(lobe, Side::Above, false, 0.0, vec![*scale, *bias]);
        }
        for side in [Side::Above, Side::Inside] {
            let whole = |r| (r == Role::Albedo(lobe, Light::All, side)).then_some(1.0);
            let mean = |r| (r == Role::Average(lobe, Light::All, side)).then_some(1.0);
            let loss = |r| (r == Role::Complement(lobe, side)).then_some(-1.0);
            add(lobe, side, false, 0.0, find(&whole));
            add(lobe, side, true, 0.0, find(&mean));
            add(lobe, side, false, 1.0, find(&loss));
            let either = |light| light != Light::All;
            let parts = find(&|r| match r {
                Role::Albedo(l, light, s) if l == lobe && s == side && either(light) => Some(1.0),
                _ => None,
            });
            let means = find(&|r| match r {
                Role::Average(l, light, s) if l == lobe && s == side && either(light) => Some(1.0),
                _ => None,
            });
            add(lobe, side, false, 0.0, parts);
            add(lobe, side, true, 0.0, means);
        }
    }
    sums
}

fn check(case: &Case<'_>) -> Outcome {
    let mut watch = Watch::default();
    for sum in albedos(case.spec()) {
        for texel in (0..case.table.grid.len()).take_while(|_| case.goes_on()) {
            let (e, error) = sum.at(case, texel);
            watch.see(1.0 - e + error, || format!("E = {e:.6}, {}", place(&case.table.grid, texel)));
        }
    }
    watch.outcome("no albedo among the channels")
}
