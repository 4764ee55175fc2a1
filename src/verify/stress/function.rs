//! Functions at their extremes: values, declared ranges, digits.

use super::grid::sets;
use super::{LEAST_DIGITS, Stress, noise};
use crate::cancel::{Cancel, Cancelled};
use crate::functions::{Angles, FunctionError, FunctionInfo, Input};
use std::f64::consts::{FRAC_PI_2, PI};

/// Polar angles, from the normal to the other side.
const THETA: [f64; 9] = [0.0, 1e-8, 1e-3, 0.3, 1.0, 1.5, FRAC_PI_2 - 1e-8, FRAC_PI_2, PI];
/// Azimuths of the light.
const PHI: [f64; 3] = [0.0, 1.0, PI];
/// How far beyond its range a value may be, as a part of the end.
const ROUNDING: f64 = 1e-12;

pub(super) fn stress(info: &'static FunctionInfo, cancel: &Cancel) -> Result<Stress, Cancelled> {
    let mut found = Stress::new("function", info.id);
    let uses = |input: fn(&Input) -> bool| info.inputs.iter().any(input);
    let both = uses(|i| matches!(i, Input::Wo(_)));
    let turned = both || uses(|i| matches!(i, Input::Wi(_)));
    let light = turned || uses(|i| matches!(i, Input::WiTheta(_) | Input::Incidence(_)));
    for (label, params) in sets(info.id, info.params) {
        cancel.check()?;
        for (i, theta) in THETA.into_iter().enumerate().take(if light { THETA.len() } else { 1 }) {
            for phi in PHI.into_iter().take(if turned { PHI.len() } else { 1 }) {
                let view = THETA[(i + 3) % 7];
                let angles = |theta: f64| Angles::all([theta, phi, view, 0.0]);
                let at =
                    || format!("{label}, wi_theta = {theta:.6}, wi_phi = {phi:.3}, wo_theta = {view:.6}");
                found.points += 1;
                match info.value(&params, &angles(theta)) {
                    Ok(v) => {
                        let [lo, hi] = info.range;
                        let slack = |end: f64| ROUNDING * end.abs().max(1.0);
                        if v < lo - slack(lo) || v > hi + slack(hi) {
                            found.blame("out of range", format!("{v:e} outside [{lo}, {hi}]"), at);
                        }
                        let along = |x: f64| info.value(&params, &angles(x)).ok();
                        // a step to the inside, so that a neighbour has a value
                        let from = if theta >= FRAC_PI_2 - 1e-12 { theta - 1e-3 } else { theta };
                        if light && let Some(kept) = noise::digits(along, from, 1.0) {
                            found.digits(kept, at);
                            if kept < LEAST_DIGITS {
                                let most = noise::MOST_DIGITS;
                                found.blame("digits lost", format!("{kept:.1} of {most:.1} digits kept"), at);
                            }
                        }
                    }
                    Err(FunctionError::NotFinite { value, .. }) => {
                        found.blame("not finite", format!("the value is {value}"), at);
                    }
                    Err(_) => found.refused += 1,
                }
            }
        }
    }
    Ok(found)
}
