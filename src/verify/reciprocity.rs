//! Helmholtz reciprocity of the lobes of a table at seeded direction pairs: f(wo, wi) = f(wi, wo).

use super::lobes::{self, Lobes};
use super::{Case, Law, Outcome, Watch, seeds};
use crate::math::frame;
use crate::models::Brdf;
use crate::tables::role::Side;
use glam::DVec3;
use std::f64::consts::TAU;

/// The law.
pub static LAW: Law = Law {
    id: "reciprocity",
    statement: "f(wo, wi) = f(wi, wo), of every lobe of the table",
    margin: "what roundings of the directions change plus 1e-12, minus the difference, both relative; over 8 parameter sets and \
        64 seeded pairs each",
    code: 3001,
    formal: false,
    concerns: |spec| lobes::lobes_of(spec).into_iter().any(|lobe| lobe.info(spec).is_some()),
    check,
};

/// A few dozen roundings of the value itself.
const ROUNDING: f64 = 1e-12;

/// How many roundings of a direction the value must bear: those of its own making, of the half vector and of both projections.
const ROUNDINGS: f64 = 16.0;

/// Values below this are rounding noise of a vanished tail.
const NEGLIGIBLE: f64 = 1e-20;

/// Values of a model for a pair of directions and for the same pair turned round, if they differ: the first such pair of a few.
#[must_use]
pub fn asymmetry(model: &dyn Brdf) -> Option<(f64, f64)> {
    let mut seeds = seeds::Seeds::new(0x2ec1);
    (0..64).find_map(|_| {
        let mut direction = || frame::spherical(libm::acos(seeds.unit().sqrt()), TAU * seeds.unit());
        let (a, b) = (direction(), direction());
        let (forth, back) = (model.eval(a, b), model.eval(b, a));
        let scale = forth.abs().max(back.abs());
        let same = (forth - back).abs() <= ROUNDING * scale + resolved(model, a, b);
        (scale > NEGLIGIBLE && !same).then_some((forth, back))
    })
}

fn check(case: &Case<'_>) -> Outcome {
    let lobes = Lobes::new(case.spec());
    let mut seeds = seeds::Seeds::new(0x2ec1);
    let mut watch = Watch::default();
    for lobe in lobes::lobes_of(case.spec()) {
        for texel in seeds::texels(case.table, 8, 0x2ec2).into_iter().take_while(|_| case.goes_on()) {
            let point = case.table.grid.texel(texel);
            let Some(model) = lobes.build(lobe, point.values(), Side::Above) else { continue };
            for _ in 0..64 {
                let mut direction = || frame::spherical(libm::acos(seeds.unit().sqrt()), TAU * seeds.unit());
                let (a, b) = (direction(), direction());
                let (forth, back) = (model.eval(a, b), model.eval(b, a));
                let scale = forth.abs().max(back.abs());
                if scale <= NEGLIGIBLE && scale.is_finite() {
                    continue;
                }
                let bound = ROUNDING + resolved(&*model, a, b) / scale;
                watch.see(bound - (forth - back).abs() / scale, || {
                    format!(
                        "f = {forth:.9e} and {back:.9e} between ({:.4}, {:.4}, {:.4}) and ({:.4}, {:.4}, {:.4}), {}",
                        a.x,
                        a.y,
                        a.z,
                        b.x,
                        b.y,
                        b.z,
                        crate::tables::place(&case.table.grid, texel)
                    )
                });
            }
        }
    }
    watch.outcome("its lobes are mirrors, without a value, at every texel that was looked at")
}

/// By how much f changes where a component of a direction is rounded otherwise: what no comparison can resolve.
pub(super) fn resolved(model: &dyn Brdf, a: DVec3, b: DVec3) -> f64 {
    const STEP: f64 = ROUNDINGS * f64::EPSILON;
    let here = model.eval(a, b);
    let steps = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| STEP * axis);
    let moved = steps.iter().flat_map(|s| [(a + *s, b), (a - *s, b), (a, b + *s), (a, b - *s)]);
    let sum: f64 = moved.map(|(a, b)| (model.eval(a, b) - here).abs()).sum();
    if sum.is_finite() { sum } else { 0.0 }
}
