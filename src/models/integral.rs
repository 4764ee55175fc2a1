//! Linear functionals of a reflectance model: the one place that decides by which rule they are integrated.
//!
//! `I_j = int f(wo, wi) g_j(wo . wh) mu_i dwi`, all channels over the same nodes in one pass.

use super::microfacet::four;
use super::{Brdf, Functional};
use crate::integrate::{BATCH, Estimate, MAX_CHANNELS, Nodes, Sums, View, adaptive, ladder};
use crate::math::lanes::LANES;

/// Which rules may be taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rules {
    /// All that the model knows: a closed form, a reduction, its chart, or subdivision.
    All,
    /// Nodes in the hemisphere, by its chart or subdivision: to look at the others from outside.
    Nodes,
}

/// The channel from the two sums that the usual functionals are made of.
fn from_sums(g: Functional, sums: Batch) -> Option<f64> {
    match g {
        Functional::One => Some(sums.one),
        Functional::Schlick => Some(sums.schlick),
        Functional::SchlickComplement => Some(sums.one - sums.schlick),
        _ => None,
    }
}

/// The channel of a batch by its weight at every node.
fn weighed(g: Functional, values: &[f64; BATCH], nodes: &Nodes) -> f64 {
    let term = |i: usize| values[i] * (nodes.weight[i] * nodes.mu_i[i]) * g.at(nodes.cos_d[i]);
    (0..nodes.len).map(term).sum()
}

/// Sums of a batch: of the contributions, and of the contributions times (1 - v)^5.
#[derive(Debug, Clone, Copy)]
struct Batch {
    one: f64,
    schlick: f64,
}

/// Independent partial sums, so that additions need not wait for each other. The order is fixed.
const SUMS: usize = 4;

impl Batch {
    /// `values` are f; the contributions are f times weight times `mu_i`.
    fn new(values: &[f64; BATCH], nodes: &Nodes) -> Batch {
        let n = nodes.len;
        let (mut one, mut schlick) = ([0.0; SUMS], [0.0; SUMS]);
        let whole = n - n % SUMS;
        let mut add = |lane: usize, i: usize| {
            let f = values[i] * (nodes.weight[i] * nodes.mu_i[i]);
            let m = 1.0 - nodes.cos_d[i];
            let m2 = m * m;
            one[lane] += f;
            schlick[lane] += f * (m2 * m2 * m);
        };
        for i in (0..whole).step_by(SUMS) {
            for lane in 0..SUMS {
                add(lane, i + lane);
            }
        }
        for i in whole..n {
            add(i - whole, i);
        }
        Batch {
            one: (one[0] + one[1]) + (one[2] + one[3]),
            schlick: (schlick[0] + schlick[1]) + (schlick[2] + schlick[3]),
        }
    }
}

/// Integrates the functionals of a model at a view to an absolute tolerance, each with its estimate.
///
/// A number is a view cosine in the plane of the tangent. A sum of lobes is integrated lobe by lobe, each to its share of the
/// tolerance; a mirror is its value; then a reduction if the model has one for these functionals, its chart, or adaptive subdivision.
/// What the model itself was integrated from ([`Brdf::own_error`]) and what rounds in it ([`Brdf::rounding`]) are in the estimate.
#[must_use]
pub fn integrate(
    model: &dyn Brdf,
    view: impl Into<View>,
    functionals: &[Functional],
    tolerance: f64,
    rules: Rules,
) -> Estimate {
    debug_assert!(functionals.len() <= MAX_CHANNELS);
    let view = view.into();
    if let Some(parts) = model.parts() {
        let mut total = Estimate::ZERO;
        let share = tolerance / parts.len().max(1) as f64;
        for &(weight, part) in parts.iter().filter(|(weight, _)| *weight > 0.0) {
            total.add(weight, &integrate(part, view, functionals, share / weight, rules));
        }
        return total;
    }
    if let Some(e) = model.mirror(view.mu) {
        let mut value = [0.0; MAX_CHANNELS];
        for (v, g) in value.iter_mut().zip(functionals) {
            *v = e * g.at(view.mu);
        }
        return Estimate::exact(value);
    }
    let reduced = || model.reduced(view.mu, functionals, tolerance);
    (rules == Rules::All)
        .then(reduced)
        .flatten()
        .unwrap_or_else(|| by_nodes(model, view, functionals, tolerance))
}

/// [`integrate`] of four models at four views at a time, if the kernel serves them and these functionals.
///
/// The four climb together, so that a value depends on its neighbours within the tolerance: whoever calls groups them by their numbers in
/// a table, never by what a thread happens to hold.
#[must_use]
pub fn integrate_four(
    models: [&dyn Brdf; LANES],
    mu: [f64; LANES],
    functionals: &[Functional],
    tolerance: f64,
) -> Option<[Estimate; LANES]> {
    let mut facets = [models[0].four()?; LANES];
    for (f, model) in facets.iter_mut().zip(models) {
        *f = model.four()?;
    }
    four::integrate(facets, mu, functionals, tolerance)
}

/// E(mu) by [`integrate`], in the plane of the tangent.
#[must_use]
pub fn directional_albedo(model: &dyn Brdf, mu_o: f64, tolerance: f64) -> Estimate {
    integrate(model, mu_o, &[Functional::One], tolerance, Rules::All)
}

/// In the chart of the model, or by subdivision.
fn by_nodes(model: &dyn Brdf, view: View, functionals: &[Functional], tolerance: f64) -> Estimate {
    let mut values = [0.0; BATCH];
    let mut add = |nodes: &Nodes, sums: &mut Sums| {
        model.eval_nodes(nodes, &mut values);
        let batch = Batch::new(&values, nodes);
        for (s, g) in sums.iter_mut().zip(functionals) {
            *s += from_sums(*g, batch).unwrap_or_else(|| weighed(*g, &values, nodes));
        }
    };
    let channels = functionals.len();
    let crease = functionals.iter().find_map(|g| g.crease());
    let mut estimate = match model.chart().map(|chart| chart.creased(crease)) {
        Some(chart) => ladder::integrate(&chart, view, channels, tolerance, &mut add),
        None => adaptive::integrate(view, channels, tolerance, &mut add),
    };
    let (own, rounding) = (model.own_error(view.mu), model.rounding(view));
    for (e, v) in estimate.error[..channels].iter_mut().zip(&estimate.value) {
        *e += own + rounding * v.abs();
    }
    estimate
}
