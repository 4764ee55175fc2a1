//! A density of one variable as pieces of Legendre series: integrated exactly, so that it can be inverted.
//!
//! Each panel is sampled at the nodes of a Gauss rule; its coefficients are sums over them, exact for polynomials. The
//! last two coefficients tell how much the series leaves out. The panel that leaves out most is halved.

use super::gauss;
use super::stop::Trust;
use crate::math::root::solve;

/// Trust in what the last two coefficients say of those left out: one may vanish by symmetry, so both count alike.
const TRUST: Trust = Trust { gain: &[2.0], memory: &[1.0] };

/// Coefficients of a panel.
const ORDER: usize = 12;

/// Most panels.
pub const MAX_PANELS: usize = 400;

#[derive(Debug, Clone)]
struct Panel {
    from: f64,
    length: f64,
    /// Of P_k(2x - 1), x from 0 to 1 over the panel.
    coefficients: [f64; ORDER],
    /// What the integral of the panel may be off by, with the errors of the samples.
    error: f64,
    /// Integrals and errors of the panels before.
    before: [f64; 2],
}

/// A piecewise density on an interval, not normalised.
#[derive(Debug, Clone)]
pub struct Density {
    panels: Vec<Panel>,
    /// Its integral.
    pub total: f64,
    /// Estimated error of the integral of any part, absolute.
    pub error: f64,
    /// Evaluations spent, as the samples told.
    pub evaluations: u32,
}

/// A sample: value, its error, and the evaluations that it took.
pub type Sampled = (f64, f64, u32);

impl Density {
    /// From the first break to the last, until the integral of every part is within `tolerance` (absolute).
    ///
    /// May miss the tolerance: [`Density::error`] then says so. Breaks that are not increasing are left out.
    pub fn new(breaks: &[f64], tolerance: f64, f: &mut dyn FnMut(f64) -> Sampled) -> Density {
        let mut evaluations = 0u32;
        let mut make = |from: f64, to: f64| {
            let (panel, n) = Panel::new(from, to - from, f);
            evaluations = evaluations.saturating_add(n);
            panel
        };
        let mut panels: Vec<Panel> = Vec::new();
        let mut from = breaks.first().copied().unwrap_or(0.0);
        for &to in breaks {
            if to > from {
                panels.push(make(from, to));
                from = to;
            }
        }
        while panels.len() < MAX_PANELS && panels.iter().map(|p| p.error).sum::<f64>() > tolerance {
            let worst = (0..panels.len()).max_by(|&i, &j| panels[i].error.total_cmp(&panels[j].error));
            let Some(worst) = worst else { break };
            let (a, half) = (panels[worst].from, 0.5 * panels[worst].length);
            if !(panels[worst].error.is_finite() && a + half > a) {
                break;
            }
            let second = make(a + half, a + 2.0 * half);
            panels[worst] = make(a, a + half);
            panels.insert(worst + 1, second);
        }
        let (mut total, mut error) = (0.0, 0.0);
        for panel in &mut panels {
            panel.before = [total, error];
            total += panel.length * panel.coefficients[0];
            error += panel.error;
        }
        Density { panels, total, error, evaluations }
    }

    /// The x below which the part u lies, and how far the errors of the integrals may move it.
    #[must_use]
    pub fn quantile(&self, u: f64) -> (f64, f64) {
        let x = self.invert(u);
        if u <= 0.0 || u >= 1.0 {
            return (x, 0.0);
        }
        // the error of a ratio of integrals: what lies below counts with 1 - u, what lies above with u
        let panel = &self.panels[self.find(u)];
        let below = panel.before[1] + panel.error;
        let above = self.error - panel.before[1];
        let off = ((1.0 - u) * below + u * above) / self.total;
        let (low, high) = (self.invert((u - off).max(0.0)), self.invert((u + off).min(1.0)));
        (x, (x - low).max(high - x))
    }

    fn find(&self, u: f64) -> usize {
        let target = u * self.total;
        self.panels.partition_point(|p| p.before[0] <= target).saturating_sub(1)
    }

    fn invert(&self, u: f64) -> f64 {
        let (Some(first), Some(last)) = (self.panels.first(), self.panels.last()) else { return f64::NAN };
        if u <= 0.0 {
            return first.from;
        }
        if u >= 1.0 {
            return last.from + last.length;
        }
        let panel = &self.panels[self.find(u)];
        let rest = (u * self.total - panel.before[0]) / panel.length;
        let x = solve(0.0, 1.0, |x| {
            let (integral, value) = panel.series(x);
            (integral - rest, value)
        });
        panel.from + panel.length * x
    }
}

impl Panel {
    fn new(from: f64, length: f64, f: &mut dyn FnMut(f64) -> Sampled) -> (Panel, u32) {
        let rule = gauss::rule(ORDER);
        let mut coefficients = [0.0; ORDER];
        let (mut uncertain, mut evaluations) = (0.0, 0u32);
        for (&x, &w) in rule.nodes.iter().zip(&rule.weights) {
            let (value, error, n) = f(from + length * x);
            uncertain += w * error;
            evaluations = evaluations.saturating_add(n);
            let (mut p, mut next) = (1.0, 2.0 * x - 1.0);
            for (k, c) in coefficients.iter_mut().enumerate() {
                let k = k as f64;
                *c += (2.0 * k + 1.0) * w * value * p;
                (p, next) = (next, ((2.0 * k + 3.0) * (2.0 * x - 1.0) * next - (k + 1.0) * p) / (k + 2.0));
            }
        }
        let tail = TRUST.error(1, coefficients[ORDER - 2].abs(), coefficients[ORDER - 1].abs());
        let error = length * (tail + uncertain);
        (Panel { from, length, coefficients, error, before: [0.0; 2] }, evaluations)
    }

    /// Integral from 0 to x, and value at x, both of the series. `int P_k(2x - 1) dx = (P_(k+1) - P_(k-1))/(4k + 2)`.
    fn series(&self, x: f64) -> (f64, f64) {
        let t = 2.0 * x - 1.0;
        let (mut below, mut p, mut next) = (-1.0, 1.0, t);
        let (mut integral, mut value) = (0.0, 0.0);
        for (k, c) in self.coefficients.iter().enumerate() {
            let k = k as f64;
            value += c * p;
            integral += c * (next - below) / (4.0 * k + 2.0);
            (below, p, next) = (p, next, ((2.0 * k + 3.0) * t * next - (k + 1.0) * p) / (k + 2.0));
        }
        (integral, value)
    }
}
