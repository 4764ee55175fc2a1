//! A microfacet distribution projects to the area of the surface: the integral of D cos over the hemisphere is 1.

use super::{Case, Law, Outcome, Watch, total};
use crate::integrate::{Sums, line};
use crate::tables::{Role, Spec};
use std::f64::consts::{FRAC_PI_2, PI};

/// The law.
pub static LAW: Law = Law {
    id: "normalised",
    statement: "the integral of D cos over the hemisphere is 1",
    margin: "the error of the sum, plus the estimates and what roundings of the cosines change (about 2e-16 / alpha^2), plus 1e-13, \
        minus the deviation; over the widths of the table",
    code: 2003,
    formal: false,
    concerns: |spec| subject(spec).is_some(),
    check,
};

/// Additions and the last rounding.
const ROUNDING: f64 = 1e-13;

/// Accuracy that is asked of the sum.
const TOLERANCE: f64 = 1e-12;

/// The channel that holds a distribution, its axes of cosine and width.
fn subject(spec: &Spec) -> Option<(usize, Role, usize, usize)> {
    let cosine = spec.axis("mu_m")?;
    let of = |(c, channel): (usize, &crate::tables::ChannelInfo)| match channel.role {
        role @ Role::Distribution { .. } => Some((c, role, cosine, spec.axis("alpha")?)),
        role @ Role::DistributionRoot => Some((c, role, cosine, spec.axis("m")?)),
        _ => None,
    };
    spec.layout.channels.iter().enumerate().find_map(of)
}

fn check(case: &Case<'_>) -> Outcome {
    let Some((c, role, cosine, width)) = subject(case.spec()) else {
        return Outcome::NotChecked("no distribution over cosine and width".to_owned());
    };
    let mut watch = Watch::default();
    for alpha in total::rows(case, width).into_iter().take_while(|_| case.goes_on()) {
        let mut at = vec![0.0; case.spec().grid.axes().len()];
        at[width] = alpha;
        // D, and what it is for the neighbours of the cosine: a fresh value and its error
        let mut density = |mu: f64| {
            at[cosine] = mu;
            let e = case.bound.baker.texel(&at, case.tolerance).ok()?;
            Some(decode(role, alpha, e.value[c], e.error[c]))
        };
        let mut breaks = vec![0.0];
        let mut next = 0.25 * alpha;
        while next < FRAC_PI_2 {
            breaks.push(next);
            next *= 4.0;
        }
        breaks.push(FRAC_PI_2);
        let sum = line::integrate(&breaks, 2, TOLERANCE, &mut |theta, out: &mut Sums| {
            let (sin, cos) = libm::sincos(theta);
            let measure = 2.0 * PI * sin * cos;
            let near = [cos - f64::EPSILON, cos, cos + f64::EPSILON].map(|mu| density(mu.clamp(0.0, 1.0)));
            let [Some(below), Some(here), Some(above)] = near else {
                out[..2].fill(f64::NAN);
                return;
            };
            out[0] = measure * here.0;
            out[1] = measure * (here.1 + 0.5 * (above.0 - below.0).abs());
        });
        let resolved = sum.error[0] + sum.value[1] + sum.error[1] + ROUNDING;
        watch.see(resolved - (sum.value[0] - 1.0).abs(), || {
            format!("integral = {:.12}, alpha = {alpha:e}", sum.value[0])
        });
    }
    watch.outcome("no width")
}

/// D and its error from what a channel holds.
fn decode(role: Role, alpha: f64, value: f64, error: f64) -> (f64, f64) {
    match role {
        Role::Distribution { relative: true } => {
            let peak = PI * alpha * alpha;
            (value / peak, error / peak)
        }
        Role::DistributionRoot => {
            let d = libm::pow(2.0 * value, 10.0) / PI;
            (d, 10.0 * d * (error / value.max(f64::MIN_POSITIVE) + f64::EPSILON))
        }
        _ => (value, error),
    }
}
