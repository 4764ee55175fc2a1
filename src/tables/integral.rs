//! Linear functionals of a reflectance model: every channel of a table that is an integral over incident directions.
//!
//! `I_j = int f(wo, wi) g_j(wo . wh) mu_i dwi`, all channels over the same nodes in one pass.

use super::{TexelError, finite};
use crate::integrate::{BATCH, Estimate, MAX_CHANNELS, Nodes, Sums, View, adaptive, ladder};
use crate::models::Brdf;
use crate::terms::{fresnel, schlick};

/// The weight g_j of a channel, a function of `v = wo . wh`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Functional {
    /// g = 1: the directional albedo.
    One,
    /// g = (1 - v)^5: the part that follows F90.
    Schlick,
    /// g = 1 - (1 - v)^5: the part that follows F0.
    SchlickComplement,
    /// g = v (1 - v)^6 / (1/7 (6/7)^6), which is 1 at v = 1/7: the part that follows the deviation from Schlick at 82 degrees.
    F82,
    /// g = (1 - v)^e.
    Power(f64),
    /// g = max(0, (F(v) - F0) / (1 - F0)) of a dielectric of relative index eta; Schlick's cosine replaced by the exact curve, which
    /// dips below F0 near Brewster's angle.
    Dielectric(f64),
}

impl Functional {
    /// The weight at `v`.
    #[must_use]
    pub fn at(self, v: f64) -> f64 {
        let m = 1.0 - v;
        let fc = (m * m) * (m * m) * m;
        match self {
            Functional::One => 1.0,
            Functional::Schlick => fc,
            Functional::SchlickComplement => 1.0 - fc,
            Functional::F82 => v * fc * m * schlick::F82_SCALE,
            Functional::Power(e) => libm::pow(m.max(0.0), e),
            Functional::Dielectric(eta) => relative_fresnel(v, eta),
        }
    }

    /// The channel from the two sums that the usual functionals are made of.
    fn of(self, sums: Batch) -> Option<f64> {
        match self {
            Functional::One => Some(sums.one),
            Functional::Schlick => Some(sums.schlick),
            Functional::SchlickComplement => Some(sums.one - sums.schlick),
            _ => None,
        }
    }

    /// The channel of a batch by its weight at every node.
    fn sum(self, values: &[f64; BATCH], nodes: &Nodes) -> f64 {
        let term = |i: usize| values[i] * (nodes.weight[i] * nodes.mu_i[i]) * self.at(nodes.cos_d[i]);
        (0..nodes.len).map(term).sum()
    }
}

/// `(F - F0) / (1 - F0)`; 0 at eta = 1, where nothing is reflected.
fn relative_fresnel(v: f64, eta: f64) -> f64 {
    let f0 = fresnel::dielectric(1.0, eta).unpolarised();
    ((fresnel::dielectric(v, eta).unpolarised() - f0) / (1.0 - f0)).max(0.0)
}

/// Sums of a batch: of the contributions, and of the contributions times (1 - v)^5.
#[derive(Debug, Clone, Copy)]
struct Batch {
    one: f64,
    schlick: f64,
}

/// Independent partial sums, so that additions need not wait for each other. The order is fixed.
const LANES: usize = 4;

impl Batch {
    /// `values` are f; the contributions are f times weight times `mu_i`.
    fn new(values: &[f64; BATCH], nodes: &Nodes) -> Batch {
        let n = nodes.len;
        let (mut one, mut schlick) = ([0.0; LANES], [0.0; LANES]);
        let whole = n - n % LANES;
        let mut add = |lane: usize, i: usize| {
            let f = values[i] * (nodes.weight[i] * nodes.mu_i[i]);
            let m = 1.0 - nodes.cos_d[i];
            let m2 = m * m;
            one[lane] += f;
            schlick[lane] += f * (m2 * m2 * m);
        };
        for i in (0..whole).step_by(LANES) {
            for lane in 0..LANES {
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

/// Integrates the functionals of a model at a view to an absolute tolerance.
///
/// A number is a view cosine in the plane of the tangent. A sum of lobes is integrated lobe by lobe, a lobe in its
/// chart, and one without a chart by adaptive subdivision.
///
/// # Errors
/// [`TexelError::NotFinite`] with the channel.
pub fn integrate(
    model: &dyn Brdf,
    view: impl Into<View>,
    functionals: &[Functional],
    tolerance: f64,
) -> Result<Estimate, TexelError> {
    debug_assert!(functionals.len() <= MAX_CHANNELS);
    let view = view.into();
    if let Some(parts) = model.parts() {
        return sum(&parts, view, functionals, tolerance);
    }
    if let Some(e) = model.mirror(view.mu) {
        let mut value = [0.0; MAX_CHANNELS];
        for (v, g) in value.iter_mut().zip(functionals) {
            *v = e * g.at(view.mu);
        }
        return Ok(Estimate::exact(value));
    }
    if functionals == [Functional::One]
        && let Some(e) = model.reduced_albedo(view.mu, tolerance)
    {
        return finite(e, 1);
    }
    let mut values = [0.0; BATCH];
    let mut add = |nodes: &Nodes, sums: &mut Sums| {
        model.eval_nodes(nodes, &mut values);
        let batch = Batch::new(&values, nodes);
        for (s, g) in sums.iter_mut().zip(functionals) {
            *s += g.of(batch).unwrap_or_else(|| g.sum(&values, nodes));
        }
    };
    let channels = functionals.len();
    let estimate = match model.chart() {
        Some(chart) => ladder::integrate(&chart, view, channels, tolerance, &mut add),
        None => adaptive::integrate(view, channels, tolerance, &mut add),
    };
    finite(estimate, channels)
}

/// The sum of the parts, each to its share of the tolerance; values and errors add.
fn sum(
    parts: &[(f64, &dyn Brdf)],
    view: View,
    functionals: &[Functional],
    tolerance: f64,
) -> Result<Estimate, TexelError> {
    let mut total = Estimate { value: [0.0; MAX_CHANNELS], error: [0.0; MAX_CHANNELS], evaluations: 0 };
    let share = tolerance / parts.len().max(1) as f64;
    for &(weight, part) in parts {
        if weight <= 0.0 {
            continue;
        }
        let e = integrate(part, view, functionals, share / weight)?;
        for (t, v) in total.value.iter_mut().zip(&e.value) {
            *t += weight * v;
        }
        for (t, v) in total.error.iter_mut().zip(&e.error) {
            *t += weight * v;
        }
        total.evaluations = total.evaluations.saturating_add(e.evaluations);
    }
    finite(total, functionals.len())
}
