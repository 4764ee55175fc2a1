//! E(mu) of a lobe as a curve: what coupled and compensated models need at both directions of every pair.
//!
//! Piecewise polynomials on panels that halve towards mu = 0, where E behaves like mu ln mu and has corners on the scale of
//! the roughness: each panel sees every singularity at a distance of its own length, so a fixed degree serves all. The last one is a
//! polynomial in sqrt(1 - mu), which is as smooth as the angle: of cloth E has a term in the cube of the angle.

use super::Brdf;
use super::integral::directional_albedo;
use crate::integrate::{Estimate, gauss};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::{Arc, Mutex};

/// Nodes of a panel.
const ORDER: usize = 16;

/// Octaves: [2^-21, 2^-20], ..., [1/2, 1], the last in two halves; one more panel reaches down to 0.
const OCTAVES: usize = 21;

/// Lebesgue constant of the points, rounded up: how much errors at the nodes may grow between them.
const LEBESGUE: f64 = 3.0;

/// Absolute tolerance of each node where nothing else is asked for.
pub const TOLERANCE: f64 = 1e-10;

/// The directional albedo of a lobe, as 1 - E.
#[derive(Debug, Clone, PartialEq)]
pub struct AlbedoCurve {
    /// From the horizon up.
    panels: Vec<Panel>,
    /// `2 int (1 - E) mu dmu` of this very curve.
    average: f64,
}

/// A polynomial between two cosines.
#[derive(Debug, Clone, PartialEq)]
struct Panel {
    lo: f64,
    hi: f64,
    /// 1 - E at the Chebyshev points.
    missing: [f64; ORDER],
    /// Estimated error: of the nodes, and of what the polynomial leaves out.
    error: f64,
}

/// Ends of the panels: 0, the cosine below which a model is flat (0 where it has none), and octaves up to 1.
fn ends(floor: f64) -> Vec<f64> {
    let mut ends: Vec<f64> =
        std::iter::successors(Some(1.0), |hi: &f64| Some(0.5 * hi)).take(OCTAVES + 1).collect();
    while floor > 0.0 && ends[ends.len() - 1] > 2.0 * floor {
        ends.push(0.5 * ends[ends.len() - 1]);
    }
    if floor > 0.0 {
        ends.push(floor);
    }
    ends.push(0.0);
    ends.insert(1, 0.75);
    ends.reverse();
    ends
}

/// Chebyshev point of the first kind, in (-1, 1).
fn point(i: usize) -> f64 {
    -libm::cos(PI * (i as f64 + 0.5) / ORDER as f64)
}

/// The end in sqrt(1 - mu) of a panel that reaches the normal.
fn upright(lo: f64, hi: f64) -> Option<f64> {
    (hi >= 1.0).then(|| (1.0 - lo).sqrt())
}

/// The cosine at a point of a panel: even in mu, or in sqrt(1 - mu).
fn cosine(lo: f64, hi: f64, x: f64) -> f64 {
    match upright(lo, hi) {
        Some(end) => {
            let t = 0.5 * end * (1.0 - x);
            1.0 - t * t
        }
        None => 0.5 * ((lo + hi) + (hi - lo) * x),
    }
}

/// Curves that were made lately: the texels of a table share the few lobes of its rows.
static RECENT: Mutex<BTreeMap<String, Arc<AlbedoCurve>>> = Mutex::new(BTreeMap::new());

/// Most curves that are kept.
const KEPT: usize = 512;

impl AlbedoCurve {
    /// The curve of a lobe that `key` names in full (model and parameters), made once for a tolerance.
    #[must_use]
    pub fn shared(key: &str, model: &dyn Brdf, tolerance: f64) -> Arc<AlbedoCurve> {
        let key = format!("{key} {tolerance:e}");
        let lock = || RECENT.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(curve) = lock().get(&key) {
            return Arc::clone(curve);
        }
        // Made without the lock: two threads may make the same curve, with the same bits.
        let curve = Arc::new(AlbedoCurve::new(model, tolerance));
        let mut recent = lock();
        if recent.len() >= KEPT {
            recent.clear();
        }
        recent.insert(key, Arc::clone(&curve));
        curve
    }

    /// The curve of a lobe, with an absolute tolerance of each node.
    #[must_use]
    pub fn new(model: &dyn Brdf, tolerance: f64) -> AlbedoCurve {
        let ends = ends(model.chart().map_or(0.0, |chart| chart.floor()));
        let nodes: Vec<(f64, f64)> = (0..(ends.len() - 1) * ORDER)
            .into_par_iter()
            .map(|i| {
                let (lo, hi) = (ends[i / ORDER], ends[i / ORDER + 1]);
                let mu = cosine(lo, hi, point(i % ORDER));
                let e = directional_albedo(model, mu, tolerance);
                (1.0 - e.value[0], e.error[0])
            })
            .collect();
        let panels = ends.windows(2).zip(nodes.chunks(ORDER)).map(|(ends, nodes)| Panel::new(ends, nodes));
        let mut curve = AlbedoCurve { panels: panels.collect(), average: 0.0 };
        curve.panels[0].meet_horizon(&directional_albedo(model, 0.0, tolerance));
        // degree ORDER - 1 times mu, or in t = sqrt(1 - mu) times 2 t mu: Gauss-Legendre of this order is exact
        let rule = gauss::rule(ORDER);
        let share = |p: &Panel| match p.upright() {
            Some(end) => rule.integrate(0.0, end, |t| 4.0 * t * (1.0 - t * t) * p.at(1.0 - t * t)),
            None => rule.integrate(p.lo, p.hi, |mu| 2.0 * mu * p.at(mu)),
        };
        curve.average = curve.panels.iter().map(share).sum();
        curve
    }

    fn panel(&self, mu: f64) -> &Panel {
        let above = self.panels.partition_point(|p| p.lo <= mu);
        &self.panels[above.max(1) - 1]
    }

    /// 1 - E(mu).
    #[must_use]
    pub fn missing(&self, mu: f64) -> f64 {
        self.panel(mu).at(mu.clamp(0.0, 1.0))
    }

    /// E(mu).
    #[must_use]
    pub fn albedo(&self, mu: f64) -> f64 {
        1.0 - self.missing(mu)
    }

    /// 1 - `E_avg` of this curve.
    #[must_use]
    pub fn missing_average(&self) -> f64 {
        self.average
    }

    /// Largest estimated absolute error of [`AlbedoCurve::missing`].
    #[must_use]
    pub fn error(&self) -> f64 {
        self.panels.iter().map(|p| p.error).fold(0.0, f64::max)
    }

    /// Estimated absolute error of [`AlbedoCurve::missing`] at a cosine.
    #[must_use]
    pub fn error_at(&self, mu: f64) -> f64 {
        self.panel(mu).error
    }

    /// Estimated absolute error of [`AlbedoCurve::missing_average`].
    #[must_use]
    pub fn average_error(&self) -> f64 {
        self.panels.iter().map(|p| (p.hi - p.lo) * (p.hi + p.lo) * p.error).sum()
    }
}

impl Panel {
    fn new(ends: &[f64], nodes: &[(f64, f64)]) -> Panel {
        let mut missing = [0.0; ORDER];
        for (m, (value, _)) in missing.iter_mut().zip(nodes) {
            *m = *value;
        }
        // the polynomial between the nodes magnifies their errors a little
        let error = LEBESGUE * nodes.iter().map(|(_, error)| *error).fold(0.0, f64::max);
        // in the panel that holds the singularity coefficients fall like a power, and what is left out adds up
        let rest = if ends[0] > 0.0 { 1.0 } else { 2.0 * ORDER as f64 };
        Panel { lo: ends[0], hi: ends[1], missing, error: error + rest * tail(&missing) }
    }

    /// A view in the horizon, which no node is: where E falls there like a small power of mu, coefficients do not tell what is left out.
    fn meet_horizon(&mut self, e: &Estimate) {
        let off = (1.0 - e.value[0] - self.at(0.0)).abs() + e.error[0];
        // some lobes have no E there
        if off.is_finite() {
            self.error = self.error.max(off);
        }
    }

    /// The end in sqrt(1 - mu) of the panel that reaches the normal.
    fn upright(&self) -> Option<f64> {
        upright(self.lo, self.hi)
    }

    /// By the barycentric formula.
    fn at(&self, mu: f64) -> f64 {
        let x = match self.upright() {
            Some(end) => 1.0 - 2.0 * (1.0 - mu).sqrt() / end,
            None => (2.0 * mu - (self.lo + self.hi)) / (self.hi - self.lo),
        };
        let (mut above, mut below) = (0.0, 0.0);
        for (i, v) in self.missing.iter().enumerate() {
            let node = point(i);
            let distance = x - node;
            if distance == 0.0 {
                return *v;
            }
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            let weight = sign * ((1.0 - node) * (1.0 + node)).sqrt() / distance;
            above += weight * v;
            below += weight;
        }
        above / below
    }
}

/// The last two Chebyshev coefficients: the size of what is left out.
fn tail(values: &[f64; ORDER]) -> f64 {
    let coefficient = |k: usize| {
        let sum: f64 = values
            .iter()
            .enumerate()
            .map(|(i, v)| v * libm::cos(PI * k as f64 * (i as f64 + 0.5) / ORDER as f64))
            .sum();
        2.0 / ORDER as f64 * sum.abs()
    };
    coefficient(ORDER - 1).max(coefficient(ORDER - 2))
}

#[cfg(test)]
mod tests {
    use super::{AlbedoCurve, TOLERANCE};
    use crate::models::{Params, ggx, kelemen};
    use serde_json::json;

    fn curve(info: &'static crate::models::ModelInfo, given: serde_json::Value) -> AlbedoCurve {
        let given = given.as_object().cloned().unwrap_or_default();
        let params =
            Params::resolve(info.id, info.params, given.iter().map(|(k, v)| (k.as_str(), v))).unwrap();
        AlbedoCurve::new(&*(info.build)(&params).unwrap(), TOLERANCE)
    }

    #[test]
    fn lommel_seeliger_is_met() {
        let c = curve(&ggx::INFO, json!({ "alpha": 1 }));
        assert!(c.error() < 1e-8, "{:e}", c.error());
        for mu in [1e-9, 1e-7, 1e-5, 1e-3, 0.03, 0.3, 0.77, 1.0] {
            let expected = mu * libm::log1p(1.0 / mu);
            assert!((c.missing(mu) - expected).abs() <= c.error(), "{mu}: {:e}", c.missing(mu) - expected);
        }
        let average = 1.0 - 4.0 / 3.0 * (1.0 - std::f64::consts::LN_2);
        assert!((c.missing_average() - average).abs() < 1e-9, "{:e}", c.missing_average() - average);
    }

    #[test]
    fn narrow_lobes_have_their_corner() {
        for alpha in [1e-3, 0.03] {
            let c = curve(&ggx::INFO, json!({ "alpha": alpha }));
            assert!(c.error() < 1e-6, "{alpha}: {:e}", c.error());
        }
        let c = curve(&kelemen::INFO, json!({ "alpha": 0.3 }));
        assert!(c.error() < 1e-7, "{:e}", c.error());
    }
}
