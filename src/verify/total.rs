//! What is spread out adds up: diffusion moves light and makes none, a density integrates to 1, weights sum to 1.
//!
//! The sums are taken over fresh values at the nodes of another rule, in another variable than the baker's.

use super::lobes::Lobes;
use super::{Case, Law, Outcome, Watch, seeds};
use crate::integrate::{Sums, line};
use crate::tables::integral::{Functional, integrate};
use crate::tables::phase_function::Swept;
use crate::tables::profile::Profile;
use crate::tables::role::{Lobe, Per, Side};
use crate::tables::{Role, Spec, diffusion_profile, importance, place};
use std::f64::consts::PI;

/// The law.
pub static LAW: Law = Law {
    id: "total",
    statement: "the integral over the whole domain is what the formula promises (a mean, an albedo, 1)",
    margin: "the errors of both sides minus the difference, over the rows of the table that were checked",
    code: 2006,
    formal: false,
    concerns: |spec| subject(spec).is_some(),
    check,
};

/// Most rows of a table that are checked.
const ROWS: usize = 8;

/// Relative rounding of a sum.
const ROUNDING: f64 = 1e-12;

/// What there is to add up.
enum Subject {
    Skin,
    Radial(Per),
    Kernel,
    /// A cumulative distribution: its ends.
    Ends,
    Weights,
    Sphere,
    Albedo(Lobe),
}

/// What the channels of a table are, if that has a whole.
fn subject(spec: &Spec) -> Option<Subject> {
    spec.roles().into_iter().find_map(|role| match role {
        Role::BlurredLight(_) => Some(Subject::Skin),
        Role::Profile(per, _) => Some(Subject::Radial(per)),
        Role::Kernel(_) => Some(Subject::Kernel),
        Role::ProfileWithin(_) | Role::KernelWithin(_) => Some(Subject::Ends),
        Role::GaussianWeight(_) => Some(Subject::Weights),
        Role::Phase { .. } => Some(Subject::Sphere),
        Role::Direction(lobe, _) | Role::DirectionDensity(lobe) => Some(Subject::Albedo(lobe)),
        _ => None,
    })
}

fn check(case: &Case<'_>) -> Outcome {
    match subject(case.spec()) {
        Some(Subject::Skin) => skin(case),
        Some(Subject::Radial(per)) => radial(case, per),
        Some(Subject::Kernel) => kernel(case),
        Some(Subject::Ends) => ends(case),
        Some(Subject::Weights) => weights(case),
        Some(Subject::Sphere) => sphere(case),
        Some(Subject::Albedo(lobe)) => albedo(case, lobe),
        None => nothing(),
    }
}

fn nothing() -> Outcome {
    Outcome::NotChecked("nothing to add up".to_owned())
}

/// Over ring: `int_0^pi D dtheta = 1`; over the sphere: `int_0^pi D sin dtheta = 1/2`; as clamp(N.L).
fn skin(case: &Case<'_>) -> Outcome {
    let spec = &case.bound.spec;
    let (Some(ndotl), Some(curvature)) = (spec.axis("ndotl"), spec.axis("curvature")) else {
        return Outcome::NotChecked("no axis of angle or curvature".to_owned());
    };
    let sphere = match spec.params.choice("over") {
        Ok(word) => word == "sphere",
        Err(e) => return Outcome::NotChecked(e.to_string()),
    };
    let expected = if sphere { 0.5 } else { 1.0 };
    let mut watch = Watch::default();
    for value in rows(case, curvature) {
        let mut at = vec![0.0; spec.grid.axes().len()];
        at[curvature] = value;
        let measure = |theta: f64| if sphere { libm::sin(theta) } else { 1.0 };
        let near = (3.0 * value).min(0.5);
        let breaks = [0.0, 0.5 * PI - near, 0.5 * PI, 0.5 * PI + near, PI];
        let sum = add_up(case, &breaks, 3, case.tolerance, |theta| {
            at[ndotl] = libm::cos(theta);
            (at.clone(), measure(theta))
        });
        tighten(&mut watch, &sum, 0..3, expected, || format!("curvature = {value:.6}"));
    }
    watch.outcome("no row")
}

/// `int ring dr`, or `2 pi int area r dr`, is what the table says that it is scaled to.
fn radial(case: &Case<'_>, per: Per) -> Outcome {
    let spec = &case.bound.spec;
    let Ok(profile) = Profile::new(spec) else { return nothing() };
    let expected = diffusion_profile::factor(spec, &profile);
    let area = per == Per::Area;
    let sum = add_up(case, &outwards(&profile), 3, case.tolerance, |r| {
        (vec![r], if area { 2.0 * PI * r } else { 1.0 })
    });
    let mut watch = Watch::default();
    for (c, expected) in expected.iter().enumerate() {
        tighten(&mut watch, &sum, c..c + 1, *expected, || "all distances".to_owned());
    }
    watch.outcome("no row")
}

/// `2 int L dx = 1`.
fn kernel(case: &Case<'_>) -> Outcome {
    let Ok(profile) = Profile::new(&case.bound.spec) else { return nothing() };
    let sum = add_up(case, &outwards(&profile), 3, case.tolerance, |x| (vec![x], 2.0));
    let mut watch = Watch::default();
    tighten(&mut watch, &sum, 0..3, 1.0, || "all offsets".to_owned());
    watch.outcome("no row")
}

/// `2 pi int p sin theta dtheta = 1`, of the density also where the table holds it relative to its peak.
fn sphere(case: &Case<'_>) -> Outcome {
    let spec = &case.bound.spec;
    let Ok(swept) = Swept::new(spec) else { return nothing() };
    let corner: Vec<f64> = case.table.grid.texel(0).values().to_vec();
    let place = |axis: usize, value: f64| {
        let mut at = corner.clone();
        at[axis] = value;
        at
    };
    let lines = swept.axes().iter();
    let mut places: Vec<Vec<f64>> =
        lines.flat_map(|(i, _)| rows(case, *i).into_iter().map(|v| place(*i, v))).collect();
    if places.is_empty() {
        places.push(corner.clone());
    }
    let mut watch = Watch::default();
    for start in places {
        let Ok(phase) = swept.at(&start) else { return nothing() };
        let relative = spec.roles().contains(&Role::Phase { relative: true });
        let peak = if relative { phase.largest() } else { 1.0 };
        let deflection = spec.axis("deflection").unwrap_or(0);
        // peaks are as narrow as 1 - |g|, on either side
        let near = [0.0, 1e-4, 1e-3, 1e-2, 0.1, 0.5];
        let breaks: Vec<f64> =
            near.into_iter().chain([PI / 2.0]).chain(near.into_iter().rev().map(|x| PI - x)).collect();
        let sum = add_up(case, &breaks, 1, 1e-10, |theta| {
            let mut at = start.clone();
            at[deflection] = theta;
            (at, 2.0 * PI * libm::sin(theta) * peak)
        });
        let told = || match swept.axes() {
            [] => "all angles".to_owned(),
            axes => axes.iter().map(|(i, id)| format!("{id} = {}", start[*i])).collect::<Vec<_>>().join(", "),
        };
        tighten(&mut watch, &sum, 0..1, 1.0, told);
    }
    watch.outcome("no row")
}

/// What the marginal density adds up to is the directional albedo, by the model's own chart; at [`ROWS`] texels.
fn albedo(case: &Case<'_>, lobe: Lobe) -> Outcome {
    let lobes = Lobes::new(case.spec());
    let mut watch = Watch::default();
    for texel in seeds::texels(case.table, ROWS, 0x1a9b).into_iter().take_while(|_| case.goes_on()) {
        let point = case.table.grid.texel(texel);
        let Some(model) = lobes.build(lobe, point.values(), Side::Above) else { continue };
        let view = lobes.view(lobe, point.values());
        let marginal = importance::marginal(&*model, view, 1e-5);
        let Ok(chart) = integrate(&*model, view, &[Functional::One], 1e-5) else { continue };
        let (a, b) = (marginal.total, chart.value[0]);
        let error = marginal.error + chart.error[0] + ROUNDING;
        watch.see(error - (a - b).abs(), || {
            format!("{a:.9} against {b:.9}, {}", place(&case.table.grid, texel))
        });
    }
    watch.outcome("no texel with an albedo")
}

/// A cumulative table is 0 at 0 and everything far out.
fn ends(case: &Case<'_>) -> Outcome {
    let spec = &case.bound.spec;
    let Ok(profile) = Profile::new(spec) else { return nothing() };
    let radial = spec.roles().iter().any(|role| matches!(role, Role::ProfileWithin(_)));
    let all = if radial { diffusion_profile::factor(spec, &profile) } else { [1.0; 3] };
    let end = outwards(&profile).last().copied().unwrap_or(0.0);
    let mut watch = Watch::default();
    for (at, part) in [(0.0, 0.0), (1e3 * end, 1.0)] {
        match case.bound.baker.texel(&[at], case.tolerance) {
            Ok(e) => {
                for (c, all) in all.iter().enumerate() {
                    // beyond the end of the profile less than 1e-17 leaves, of the kernel of a slow tail a little more
                    let margin = e.error[c] + 1e-10 - (e.value[c] - part * all).abs();
                    watch.see(margin, || format!("channel {c}: {} at {at}", e.value[c]));
                }
            }
            Err(_) => watch.see(f64::NAN, || format!("no value at {at}")),
        }
    }
    watch.outcome("no row")
}

fn outwards(profile: &Profile) -> Vec<f64> {
    let mut breaks = vec![0.0];
    breaks.extend(profile.scales());
    breaks
}

/// The weights of each channel sum to 1.
fn weights(case: &Case<'_>) -> Outcome {
    let channels = case.table.channels.len();
    let mut watch = Watch::default();
    let weights = case.spec().roles().into_iter().enumerate();
    for (c, _) in weights.filter(|(_, role)| matches!(role, Role::GaussianWeight(_))) {
        let sum: f64 = (0..case.table.grid.len()).map(|t| case.table.values[t * channels + c]).sum();
        watch.see(ROUNDING - (sum - 1.0).abs(), || format!("{} sum to {sum}", case.table.channels[c].id));
    }
    watch.outcome("no row")
}

/// Up to [`ROWS`] values of an axis, spread over it.
pub(super) fn rows(case: &Case<'_>, axis: usize) -> Vec<f64> {
    let grid = &case.bound.spec.grid;
    let stride: usize = grid.axes()[..axis].iter().map(|a| a.len).product();
    let len = grid.axes()[axis].len;
    let count = len.min(ROWS);
    (0..count).map(|i| grid.texel(stride * (i * (len - 1) / (count - 1).max(1))).values()[axis]).collect()
}

/// A sum over fresh texels, with its own error and the largest that the baker admits, times the measure.
struct Total {
    value: Sums,
    error: Sums,
}

/// `int values(x) measure(x) dx` over the breaks; `place` gives the point of the grid and the measure.
fn add_up(
    case: &Case<'_>,
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
        match case.bound.baker.texel(&at, tolerance) {
            // what was stopped is thrown away: a NaN ends the sum soonest
            _ if !case.goes_on() => out[..channels].fill(f64::NAN),
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

fn tighten(
    watch: &mut Watch,
    sum: &Total,
    channels: std::ops::Range<usize>,
    expected: f64,
    at: impl Fn() -> String,
) {
    for c in channels {
        let (value, error) = (sum.value[c], sum.error[c] + ROUNDING);
        watch.see(error - (value - expected).abs(), || {
            format!("channel {c}: {value:.12} against {expected}, {}", at())
        });
    }
}
