//! Newton's method with a damped Hessian (Levenberg and Marquardt's damping), in four, two or one parameters.
//!
//! Each step multiplies the inverse matrix from the left by P (see [`objective`](super::objective)) and starts anew from
//! there, so a step is relative to the lobe's own widths. The sets of matrices of every [`Family`] are closed under their steps.

use super::Family;
use super::objective::{N, Objective, Slices, gradient, objective};
use crate::terms::ltc::Inverse;

/// Most evaluations of the objective.
const EVALUATIONS: usize = 60;

/// Longest step in a parameter.
const LONGEST: f64 = 0.4;

/// The search ends where the next step is expected to be shorter than this.
const SHORTEST: f64 = 1e-8;

/// Damping relative to the diagonal: at the start, and where the search gives up.
const DAMPING: [f64; 2] = [1e-6, 1e10];

/// [`refine`] gives up if its first step is longer than this, or after this many.
const NEARBY: f64 = 0.03;
const STEPS: usize = 4;

/// [`refine`] ends where the next step is expected to be shorter than this.
const ENOUGH: f64 = 1e-6;

/// The end of a search.
#[derive(Debug, Clone, Copy)]
pub(super) struct Optimum {
    pub(super) inverse: Inverse,
    /// At the last matrix but for the last step.
    pub(super) at: Objective,
    pub(super) evaluations: u32,
    /// The lengths of all steps together: beyond a part of 1 the lobe is another than the one that the nodes were made for.
    pub(super) way: f64,
}

/// `P M^-1`, its middle entry brought back to 1.
pub(super) fn step(b: &Inverse, d: [f64; N]) -> Inverse {
    let m22 = (1.0 + d[1]) * b.m22;
    Inverse {
        m11: (1.0 + d[0]) * b.m11 + d[2] * b.m31,
        m13: (1.0 + d[0]) * b.m13 + d[2] * b.m33,
        m22,
        m31: d[3] * b.m11 + b.m31,
        m33: d[3] * b.m13 + b.m33,
    }
    .scaled(1.0 / m22)
}

/// The nearest local minimum below `start`, or the first matrix that is further than `reach` from it.
pub(super) fn minimise(nodes: &Slices, start: Inverse, family: Family, reach: f64) -> Optimum {
    let mut inverse = start.scaled(1.0 / start.m22);
    let mut here = objective(nodes, &inverse);
    let mut damping = DAMPING[0];
    let mut evaluations = 1;
    let (mut before, mut way) = (0.0, 0.0);
    while evaluations < EVALUATIONS && damping < DAMPING[1] && way <= reach {
        let Some(d) = direction(&here, family, damping) else {
            damping *= 10.0;
            continue;
        };
        let length = d.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let next = step(&inverse, d);
        let there = objective(nodes, &next);
        evaluations += 1;
        // NaN is no improvement
        if next.minor() > 0.0 && next.m22 > 0.0 && there.value <= here.value {
            (inverse, here) = (next, there);
            way += length;
            damping *= 0.1;
            // near the minimum each step is the square of the one before, or half of it if the fit is perfect
            if length * (length / before).min(1.0) < SHORTEST {
                break;
            }
            before = length;
        } else {
            if length < SHORTEST {
                break;
            }
            damping = (damping * 10.0).max(1e-3);
        }
    }
    let evaluations = u32::try_from(evaluations * nodes.len()).unwrap_or(u32::MAX);
    Optimum { inverse, at: here, evaluations, way }
}

/// The minimum again, on other nodes: a few steps with the Hessian that is known; `None` if they do not converge.
///
/// The Hessians of two levels differ by their quadrature errors, a percent or so, so each step leaves that part of the
/// distance.
pub(super) fn refine(nodes: &Slices, last: &Optimum, family: Family) -> Option<Optimum> {
    let mut optimum = *last;
    let mut before = NEARBY;
    for _ in 0..STEPS {
        (optimum.at.value, optimum.at.gradient) = gradient(nodes, &optimum.inverse);
        let Some(d) = direction(&optimum.at, family, 0.0) else { break };
        let length = d.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        if length.is_nan() || length >= before {
            break;
        }
        optimum.inverse = step(&optimum.inverse, d);
        optimum.evaluations += u32::try_from(nodes.len()).unwrap_or(u32::MAX);
        if length * (length / before) < ENOUGH {
            return Some(optimum);
        }
        before = 0.5 * length;
    }
    None
}

/// The damped Newton step, no longer than [`LONGEST`]; `None` if the damped Hessian is not positive.
fn direction(at: &Objective, family: Family, damping: f64) -> Option<[f64; N]> {
    let basis = family.basis();
    let k = basis.len();
    let dot = |u: &[f64; N], v: &[f64; N]| -> f64 { u.iter().zip(v).map(|(a, b)| a * b).sum() };
    let (mut h, mut g) = ([[0.0; N]; N], [0.0; N]);
    for (i, u) in basis.iter().enumerate() {
        g[i] = -dot(u, &at.gradient);
        for (j, v) in basis.iter().enumerate() {
            h[i][j] = dot(u, &at.hessian.map(|row| dot(&row, v)));
        }
    }
    for (i, row) in h.iter_mut().enumerate().take(k) {
        row[i] += damping * row[i].abs().max(f64::MIN_POSITIVE);
    }
    let x = solve(&mut h, g, k)?;
    let mut d = [0.0; N];
    for (u, x) in basis.iter().zip(&x) {
        for (d, u) in d.iter_mut().zip(u) {
            *d += x * u;
        }
    }
    let length = d.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    if length > LONGEST {
        d.iter_mut().for_each(|x| *x *= LONGEST / length);
    }
    length.is_finite().then_some(d)
}

/// Solves `h x = g` in the first `k` entries by Cholesky's factors; `None` if h is not positive.
fn solve(h: &mut [[f64; N]; N], mut x: [f64; N], k: usize) -> Option<[f64; N]> {
    for i in 0..k {
        for j in 0..=i {
            let known: f64 = h[i][..j].iter().zip(&h[j][..j]).map(|(a, b)| a * b).sum();
            let sum = h[i][j] - known;
            if i == j {
                if sum <= 0.0 || sum.is_nan() {
                    return None;
                }
                h[i][i] = sum.sqrt();
            } else {
                h[i][j] = sum / h[j][j];
            }
        }
    }
    for i in 0..k {
        for j in 0..i {
            x[i] -= h[i][j] * x[j];
        }
        x[i] /= h[i][i];
    }
    for i in (0..k).rev() {
        for j in i + 1..k {
            x[i] -= h[j][i] * x[j];
        }
        x[i] /= h[i][i];
    }
    Some(x)
}
