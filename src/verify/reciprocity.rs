//! Helmholtz reciprocity of the model at seeded direction pairs: f(wo, wi) = f(wi, wo).

use super::{Case, Law, Outcome, seeds};
use crate::math::frame;
use crate::models::Brdf;
use crate::tables::sweep::Sweep;
use std::f64::consts::TAU;

/// The law.
pub static LAW: Law = Law {
    id: "reciprocity",
    statement: "f(wo, wi) = f(wi, wo)",
    margin: "1e-9 minus the relative difference, over 8 parameter sets and 64 seeded pairs each",
    code: 3001,
    check,
};

/// Relative difference that rounding may cause: the half vector of a narrow lobe amplifies it by 1 / alpha.
const BOUND: f64 = 1e-9;

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
        ((scale > NEGLIGIBLE || !scale.is_finite()) && !((forth - back).abs() <= BOUND * scale)).then_some((forth, back))
    })
}

fn check(case: &Case<'_>) -> Outcome {
    let Ok(sweep) = Sweep::new(&case.bound.spec, false) else { return Outcome::vacuous("no model") };
    let mut seeds = seeds::Seeds::new(0x2ec1);
    let mut outcome = Outcome::start();
    for texel in seeds::texels(case.table, 8, 0x2ec2) {
        let point = case.table.grid.texel(texel);
        let Ok(model) = sweep.model(point.values()) else { continue };
        for _ in 0..64 {
            let mut direction = || frame::spherical(libm::acos(seeds.unit().sqrt()), TAU * seeds.unit());
            let (a, b) = (direction(), direction());
            let (forth, back) = (model.eval(a, b), model.eval(b, a));
            let scale = forth.abs().max(back.abs());
            if scale > NEGLIGIBLE || !scale.is_finite() {
                outcome.tighten(BOUND - (forth - back).abs() / scale, || {
                    format!(
                        "f = {forth:.9e} and {back:.9e} between ({:.4}, {:.4}, {:.4}) and ({:.4}, {:.4}, {:.4}), {}",
                        a.x, a.y, a.z, b.x, b.y, b.z, crate::tables::place(&case.table.grid, texel)
                    )
                });
            }
        }
    }
    if outcome.at.is_empty() { Outcome::vacuous("a mirror at every checked texel") } else { outcome }
}
