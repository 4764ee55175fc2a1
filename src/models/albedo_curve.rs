//! E(mu) of a lobe as a curve: what coupled and compensated models need at both directions of every pair.
//!
//! Piecewise polynomials on panels that halve towards mu = 0, where E behaves like mu ln mu and has corners on the scale of
//! the roughness: each panel sees every singularity at a distance of its own length, so a fixed degree serves all.

use super::Brdf;
use super::integral::directional_albedo;
use crate::integrate::gauss;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::{Arc, Mutex};

/// Nodes of a panel.
const ORDER: usize = 16;

/// Panels: [0, 2^-21], [2^-21, 2^-20], ..., [1/2, 1].
const PANELS: usize = 22;

/// Lebesgue constant of the points, rounded up: how much errors at the nodes may grow between them.
const LEBESGUE: f64 = 3.0;

/// Absolute tolerance of each node.
pub const TOLERANCE: f64 = 1e-10;

/// The directional albedo of a lobe, as 1 - E.
#[derive(Debug, Clone, PartialEq)]
pub struct AlbedoCurve {
    /// 1 - E at the Chebyshev points of each panel.
    missing: Vec<[f64; ORDER]>,
    /// `2 int (1 - E) mu dmu` of this very curve.
    average: f64,
    /// Estimated errors of the panels: of the nodes, and of what the polynomials leave out.
    errors: [f64; PANELS],
}

/// Ends of a panel.
fn ends(panel: usize) -> (f64, f64) {
    let at = |k: usize| (0..k).fold(1.0, |x: f64, _| 0.5 * x);
    let hi = at(PANELS - 1 - panel);
    (if panel == 0 { 0.0 } else { 0.5 * hi }, hi)
}

/// The panel that holds a cosine.
fn panel_of(mu: f64) -> usize {
    let mut panel = PANELS - 1;
    while panel > 0 && mu < ends(panel).0 {
        panel -= 1;
    }
    panel
}

/// Chebyshev point of the first kind, in (-1, 1).
fn point(i: usize) -> f64 {
    -libm::cos(PI * (i as f64 + 0.5) / ORDER as f64)
}

/// Curves that were made lately: the texels of a table share the few lobes of its rows.
static RECENT: Mutex<BTreeMap<String, Arc<AlbedoCurve>>> = Mutex::new(BTreeMap::new());

/// Most curves that are kept.
const KEPT: usize = 512;

impl AlbedoCurve {
    /// The curve of a lobe that `key` names in full (model and parameters), made once.
    #[must_use]
    pub fn shared(key: &str, model: &dyn Brdf) -> Arc<AlbedoCurve> {
        let lock = || RECENT.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(curve) = lock().get(key) {
            return Arc::clone(curve);
        }
        // Made without the lock: two threads may make the same curve, with the same bits.
        let curve = Arc::new(AlbedoCurve::new(model));
        let mut recent = lock();
        if recent.len() >= KEPT {
            recent.clear();
        }
        recent.insert(key.to_owned(), Arc::clone(&curve));
        curve
    }

    /// The curve of a lobe.
    #[must_use]
    pub fn new(model: &dyn Brdf) -> AlbedoCurve {
        let mut errors = [0.0; PANELS];
        let mut missing = Vec::with_capacity(PANELS);
        for (panel, error) in errors.iter_mut().enumerate() {
            let (lo, hi) = ends(panel);
            let mut values = [0.0; ORDER];
            for (i, v) in values.iter_mut().enumerate() {
                let mu = 0.5 * ((lo + hi) + (hi - lo) * point(i));
                let e = directional_albedo(model, mu, TOLERANCE);
                *error = f64::max(*error, e.error[0]);
                *v = 1.0 - e.value[0];
            }
            // the polynomial between the nodes magnifies their errors a little
            *error *= LEBESGUE;
            // in the panel that holds the singularity coefficients fall like a power, and what is left out adds up
            let rest = if panel == 0 { 2.0 * ORDER as f64 } else { 1.0 };
            *error += rest * tail(&values);
            missing.push(values);
        }
        let mut curve = AlbedoCurve { missing, average: 0.0, errors };
        // degree ORDER - 1 times mu: Gauss-Legendre of this order is exact
        let rule = gauss::rule(ORDER);
        curve.average = (0..PANELS)
            .map(|panel| {
                let (lo, hi) = ends(panel);
                rule.integrate(lo, hi, |mu| 2.0 * mu * curve.on(panel, mu))
            })
            .sum();
        curve
    }

    /// 1 - E(mu).
    #[must_use]
    pub fn missing(&self, mu: f64) -> f64 {
        self.on(panel_of(mu), mu.clamp(0.0, 1.0))
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
        self.errors.iter().copied().fold(0.0, f64::max)
    }

    /// Estimated absolute error of [`AlbedoCurve::missing`] at a cosine.
    #[must_use]
    pub fn error_at(&self, mu: f64) -> f64 {
        self.errors[panel_of(mu)]
    }

    /// Estimated absolute error of [`AlbedoCurve::missing_average`].
    #[must_use]
    pub fn average_error(&self) -> f64 {
        let share = |panel: usize| {
            let (lo, hi) = ends(panel);
            (hi - lo) * (hi + lo) * self.errors[panel]
        };
        (0..PANELS).map(share).sum()
    }

    /// The polynomial of a panel, by the barycentric formula.
    fn on(&self, panel: usize, mu: f64) -> f64 {
        let (lo, hi) = ends(panel);
        let x = (2.0 * mu - (lo + hi)) / (hi - lo);
        let (mut above, mut below) = (0.0, 0.0);
        for (i, v) in self.missing[panel].iter().enumerate() {
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
    use super::AlbedoCurve;
    use crate::models::{Params, ggx, kelemen};
    use serde_json::json;

    fn curve(info: &'static crate::models::ModelInfo, given: serde_json::Value) -> AlbedoCurve {
        let given = given.as_object().cloned().unwrap_or_default();
        let params =
            Params::resolve(info.id, info.params, given.iter().map(|(k, v)| (k.as_str(), v))).unwrap();
        AlbedoCurve::new(&*(info.build)(&params).unwrap())
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
