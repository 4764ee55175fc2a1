//! White isotropic GGX albedo as a one-dimensional integral: the azimuth of wi is done in closed form.
//!
//! ```text
//! E(mu) = (a^2 / (2 mu)) int_0^1 G2(mu, m) [1 + 2 b w / R + b^2 w^2 C / R^3] dm,   b = 1 - a^2,
//! w = (mu + m)^2,  C = s^2 + t^2 + a^2 w,  R^2 = ((s - t)^2 + a^2 w)((s + t)^2 + a^2 w),
//! s^2 = 1 - mu^2,  t^2 = 1 - m^2
//! ```
//!
//! Derivation: `f mu_i dwi = D G2 / (4 mu_o) dm dp` with `D = a^2 |H|^4 / (pi (|H|^2 - b w)^2)` and
//! `|H|^2 = 2 (1 + mu m + s t cos p)`; with `A = 2 (1 + mu m) - b w = C` and `B = 2 s t` the azimuth integral of
//! `(1 + b w / (A + B cos p))^2` is `2 pi (1 + 2 b w / R + b^2 w^2 C / R^3)`, `R = sqrt(A^2 - B^2)`.
//!
//! The integrand peaks at m = mu with width `d = a s + a^2` and has the corners of Smith masking at m = 0 on the
//! scale min(mu, a): three graded panels.

use super::Masking;
use crate::integrate::Estimate;
use crate::integrate::graded::{Order, Shared, shared};
use crate::integrate::stop::{Level, Trust, climb_sure};
use crate::math::lanes::{Kernel, LANES, Lanes, wide};

const ORDER: Order = Order(1.0, 0.4);

/// Views below this part of alpha see the limit of grazing views: E moves by about `mu / alpha ln(alpha / mu)`.
const LIMIT: f64 = 1e-18;

/// Trust in it.
const TRUST: Trust = Trust { gain: &[3.0], memory: &[0.2, 0.2, 0.05] };

const LEVELS: [f64; 9] = [2.0, 2.8, 4.0, 5.6, 8.0, 11.2, 16.0, 22.4, 31.0];

/// The white albedo to an absolute tolerance; `None` for the mirror.
pub(super) fn white_ggx(mu: f64, alpha: f64, masking: Masking, tolerance: f64) -> Option<Estimate> {
    if alpha <= 0.0 {
        return None;
    }
    // E has left its limit at mu = 0 by less than rounding; below that squares would underflow
    let mu = if mu < LIMIT * alpha.min(1.0) { 0.0 } else { mu };
    let first = match tolerance {
        t if t >= 1e-5 => 0,
        t if t >= 1e-9 => 1,
        _ => 2,
    };
    let integrand = Integrand::new(mu, alpha, masking);
    Some(climb_sure(TRUST, first..LEVELS.len(), 1, tolerance, |j, level| integrand.sums(LEVELS[j], level)))
}

#[derive(Clone, Copy)]
struct Integrand {
    mu: f64,
    s: f64,
    a: f64,
    root_o: f64,
    masking: Masking,
}

impl Integrand {
    fn new(mu: f64, a: f64, masking: Masking) -> Integrand {
        let s2 = (1.0 - mu) * (1.0 + mu);
        Integrand { mu, s: s2.sqrt(), a, root_o: (mu * mu + a * a * s2).sqrt(), masking }
    }

    fn sums(&self, level: f64, out: &mut Level) {
        let (mu, a) = (self.mu, self.a);
        let peak = a * self.s + a * a;
        let near_zero = if mu > 0.0 { mu.min(a) } else { a };
        let near_peak = if mu > 0.0 { peak.min(2.0 * mu) } else { peak };
        // (from, to, scale): graded towards `from`
        let panels = [(0.0, 0.5 * mu, near_zero), (mu, 0.5 * mu, near_peak), (mu, 1.0, near_peak)];
        for (panel, (from, to, scale)) in panels.into_iter().enumerate() {
            let length: f64 = to - from;
            if length.abs() <= 0.0 {
                continue;
            }
            let rule = shared((scale / length.abs()).min(1e3), ORDER, level);
            out.count(rule.rule.node.len());
            // the distance to the peak is exact: it is the variable of the panel
            let to_peak = if (from - mu).abs() <= 0.0 { 0.0 } else { from - mu };
            let part = wide(Panel { integrand: *self, rule, from, to_peak, length });
            out.panel(panel)[0] = length.abs() * part;
        }
    }

    /// The integrand at `m`, `from_peak = m - mu`, with one division: that of `R` as well as that of G2.
    #[inline(always)]
    fn at(&self, m: Lanes, from_peak: Lanes) -> Lanes {
        let (mu, s, a2) = (self.mu, self.s, self.a * self.a);
        let b = 1.0 - a2;
        // 1 - m by the exact distance to the peak: at normal incidence the peak is a^2 wide, below the steps of m itself
        let t2 = (((1.0 - mu) - from_peak) * (1.0 + m)).map(|x| x.max(0.0));
        let t = t2.sqrt();
        let sum = mu + m;
        let w = sum * sum;
        let plus = s + t;
        let plus2 = plus * plus;
        // R (s + t), since s - t = (m - mu)(m + mu) / (s + t)
        let r = (w * (from_peak * from_peak + a2 * plus2) * (plus2 + a2 * w)).sqrt();
        let c = s * s + t2 + a2 * w;
        let u = b * w;
        let root_i = (m * m + a2 * t2).sqrt();
        // G2 / mu, finite at mu = 0
        let (above, below) = match self.masking {
            Masking::Correlated => (2.0 * m, mu * root_i + m * self.root_o),
            Masking::Separable => (4.0 * m, (m + root_i) * (mu + self.root_o)),
        };
        let both = 1.0 / (below * r);
        let inverse = plus * (both * below);
        (0.5 * a2) * (above * (both * r)) * (1.0 + u * inverse * (2.0 + u * c * inverse * inverse))
    }
}

/// A panel: from `from` on, which is `to_peak` from the peak.
struct Panel {
    integrand: Integrand,
    rule: &'static Shared,
    from: f64,
    to_peak: f64,
    length: f64,
}

impl Kernel for Panel {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let (node, weight) = (&self.rule.rule.node, &self.rule.rule.weight);
        let mut total = Lanes::all(0.0);
        let mut add = |x: Lanes, w: Lanes| {
            let step = self.length * x;
            total = total + w * self.integrand.at(self.from + step, self.to_peak + step);
        };
        let (nodes, weights) = (node.chunks_exact(LANES), weight.chunks_exact(LANES));
        let rest = nodes.remainder().iter().zip(weights.remainder());
        for (n, v) in nodes.clone().zip(weights.clone()) {
            add(Lanes([n[0], n[1], n[2], n[3]]), Lanes([v[0], v[1], v[2], v[3]]));
        }
        if let Some(first) = nodes.remainder().first() {
            // filled up with its own first node, of weight 0
            let (mut x, mut w) = (Lanes::all(*first), Lanes::all(0.0));
            for (lane, (n, v)) in rest.enumerate() {
                (x.0[lane], w.0[lane]) = (*n, *v);
            }
            add(x, w);
        }
        (total.0[0] + total.0[1]) + (total.0[2] + total.0[3])
    }
}
