//! Linear functionals of a reflectance model: every channel of a table that is an integral over incident directions.
//!
//! `I_j = int f(wo, wi) g_j(wo . wh) mu_i dwi`, all channels over the same nodes in one pass.

use super::TexelError;
use crate::integrate::{BATCH, Estimate, MAX_CHANNELS, Nodes, Sums, ladder};
use crate::models::Brdf;

/// The weight g_j of a channel, a function of `v = wo . wh`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Functional {
    /// g = 1: the directional albedo.
    One,
    /// g = (1 - v)^5: the part that follows F90.
    Schlick,
    /// g = 1 - (1 - v)^5: the part that follows F0.
    SchlickComplement,
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
        }
    }

    /// The channel from the two sums that every functional is made of.
    fn of(self, sums: Batch) -> f64 {
        match self {
            Functional::One => sums.one,
            Functional::Schlick => sums.schlick,
            Functional::SchlickComplement => sums.one - sums.schlick,
        }
    }
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

/// Integrates the functionals of a model at a view cosine to an absolute tolerance.
///
/// # Errors
/// [`TexelError::NoChart`] if the model declares none, [`TexelError::NotFinite`] with the channel otherwise.
pub fn integrate(
    model: &dyn Brdf,
    id: &'static str,
    mu_o: f64,
    functionals: &[Functional],
    tolerance: f64,
) -> Result<Estimate, TexelError> {
    debug_assert!(functionals.len() <= MAX_CHANNELS);
    if let Some(e) = model.mirror(mu_o) {
        let mut value = [0.0; MAX_CHANNELS];
        for (v, g) in value.iter_mut().zip(functionals) {
            *v = e * g.at(mu_o);
        }
        return Ok(Estimate::exact(value));
    }
    if functionals == [Functional::One]
        && let Some(e) = model.reduced_albedo(mu_o, tolerance)
    {
        return finite(e, 1);
    }
    let chart = model.chart().ok_or(TexelError::NoChart { model: id })?;
    let mut values = [0.0; BATCH];
    let mut add = |nodes: &Nodes, sums: &mut Sums| {
        model.eval_nodes(nodes, &mut values);
        let batch = Batch::new(&values, nodes);
        for (s, g) in sums.iter_mut().zip(functionals) {
            *s += g.of(batch);
        }
    };
    finite(ladder::integrate(&chart, mu_o, functionals.len(), tolerance, &mut add), functionals.len())
}

fn finite(estimate: Estimate, channels: usize) -> Result<Estimate, TexelError> {
    for (channel, (&value, &error)) in estimate.value.iter().zip(&estimate.error).take(channels).enumerate() {
        if !(value.is_finite() && error.is_finite()) {
            return Err(TexelError::NotFinite { channel, value });
        }
    }
    Ok(estimate)
}
