//! A microfacet distribution projects to the area of the surface: the integral of D cos over the hemisphere is 1.

use super::{Case, Law, Outcome};
use crate::integrate::graded::{Graded, Order};
use crate::tables::ndf;

/// The law.
pub static LAW: Law = Law {
    id: "normalised",
    statement: "the integral of D cos over the hemisphere is 1",
    margin: "1e-10 minus the deviation, over the widths of the table",
    code: 2003,
    check,
};

const BOUND: f64 = 1e-10;

fn check(case: &Case<'_>) -> Outcome {
    let spec = &case.bound.spec;
    let grid = &spec.grid;
    let Some(axis) = spec.axis("alpha") else {
        return Outcome::vacuous("no width axis");
    };
    let beckmann = spec.params.choice("distribution") == "beckmann";
    let stride: usize = grid.axes()[..axis].iter().map(|a| a.len).product();
    let mut outcome = Outcome::start();
    for i in (0..grid.axes()[axis].len).take_while(|_| case.goes_on()) {
        let alpha = grid.texel(i * stride).values()[axis];
        let total = projected(beckmann, alpha);
        outcome
            .tighten(BOUND - (total - 1.0).abs(), || format!("integral = {total:.12}, alpha = {alpha:.6}"));
    }
    outcome
}

/// `2 pi int D(cos t) cos t sin t dt` over the half-angle tangent, graded at alpha.
fn projected(beckmann: bool, alpha: f64) -> f64 {
    let rule = Graded::new(0.5 * alpha, Order(1.0, 0.6), 40.0);
    let mut sum = 0.0;
    for (&t, &w) in rule.node[..rule.len].iter().zip(&rule.weight) {
        let sec = 1.0 / (1.0 + t * t);
        let (cos, sin) = ((1.0 - t) * (1.0 + t) * sec, 2.0 * t * sec);
        sum += w * 2.0 * sec * ndf::d(beckmann, cos, alpha) * cos * sin;
    }
    2.0 * std::f64::consts::PI * sum
}
