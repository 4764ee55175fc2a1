//! What is spread out adds up: diffusion moves light and makes none, a density integrates to 1, weights sum to 1.
//!
//! The sums are taken over fresh values at the nodes of another rule, in another variable than the baker's.

use super::{Case, Law, Outcome};
use crate::integrate::{Sums, line};
use crate::tables::Baker;
use std::f64::consts::PI;

/// The law.
pub static LAW: Law = Law {
    id: "total",
    statement: "the integral over the whole domain is what the formula promises (a mean, an albedo, 1)",
    margin: "the errors of both sides minus the difference, over the rows of the table that were checked",
    code: 2005,
    check,
};

/// Most rows of a table that are checked.
const ROWS: usize = 8;

/// Relative rounding of a sum.
const ROUNDING: f64 = 1e-12;

fn check(case: &Case<'_>) -> Outcome {
    match case.bound.spec.kind.id {
        "preintegrated-skin" => skin(case),
        _ => Outcome::vacuous("nothing to add up"),
    }
}

/// Over ring: `int_0^pi D dtheta = 1`; over the sphere: `int_0^pi D sin dtheta = 1/2`; as clamp(N.L).
fn skin(case: &Case<'_>) -> Outcome {
    let spec = &case.bound.spec;
    let (Some(ndotl), Some(curvature)) = (spec.axis("ndotl"), spec.axis("curvature")) else {
        return Outcome::vacuous("no angle or curvature");
    };
    let sphere = spec.params.choice("over") == "sphere";
    let expected = if sphere { 0.5 } else { 1.0 };
    let mut outcome = Outcome::start();
    for value in rows(case, curvature) {
        let mut at = vec![0.0; spec.grid.axes().len()];
        at[curvature] = value;
        let measure = |theta: f64| if sphere { libm::sin(theta) } else { 1.0 };
        let near = (3.0 * value).min(0.5);
        let breaks = [0.0, 0.5 * PI - near, 0.5 * PI, 0.5 * PI + near, PI];
        let sum = add_up(&*case.bound.baker, &breaks, 3, case.tolerance, |theta| {
            at[ndotl] = libm::cos(theta);
            (at.clone(), measure(theta))
        });
        tighten(&mut outcome, &sum, 3, expected, || format!("curvature = {value:.6}"));
    }
    outcome
}

/// Up to [`ROWS`] values of an axis, spread over it.
fn rows(case: &Case<'_>, axis: usize) -> Vec<f64> {
    let grid = &case.bound.spec.grid;
    let stride: usize = grid.axes()[..axis].iter().map(|a| a.len).product();
    let len = grid.axes()[axis].len;
    let count = len.min(ROWS);
    (0..count)
        .map(|i| grid.texel(stride * (i * (len - 1) / (count - 1).max(1))).values()[axis])
        .collect()
}

/// A sum over fresh texels, with its own error and the largest that the baker admits, times the measure.
struct Total {
    value: Sums,
    error: Sums,
}

/// `int values(x) measure(x) dx` over the breaks; `place` gives the point of the grid and the measure.
fn add_up(
    baker: &dyn Baker,
    breaks: &[f64],
    channels: usize,
    tolerance: f64,
    mut place: impl FnMut(f64) -> (Vec<f64>, f64),
) -> Total {
    let mut admitted = [0.0f64; 3];
    let mut largest_measure = 0.0f64;
    let e = line::integrate(breaks, channels, tolerance, &mut |x, out| {
        let (at, measure) = place(x);
        largest_measure = largest_measure.max(measure);
        match baker.texel(&at, tolerance) {
            Ok(texel) => {
                for c in 0..channels {
                    out[c] = measure * texel.value[c];
                    admitted[c.min(2)] = admitted[c.min(2)].max(texel.error[c]);
                }
            }
            Err(_) => out[..channels].fill(f64::NAN),
        }
    });
    let length = breaks.last().copied().unwrap_or(0.0) - breaks.first().copied().unwrap_or(0.0);
    let mut error = e.error;
    for (c, error) in error.iter_mut().enumerate().take(channels) {
        *error += admitted[c.min(2)] * length * largest_measure;
    }
    Total { value: e.value, error }
}

fn tighten(outcome: &mut Outcome, sum: &Total, channels: usize, expected: f64, at: impl Fn() -> String) {
    for c in 0..channels {
        let (value, error) = (sum.value[c], sum.error[c] + ROUNDING);
        outcome.tighten(error - (value - expected).abs(), || {
            format!("channel {c}: {value:.12} against {expected}, {}", at())
        });
    }
}
