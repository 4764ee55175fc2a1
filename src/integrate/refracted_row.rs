//! The rows of the chart of refraction: facets of one azimuth, from the rarer side in t and from the denser one in x; see
//! [`refracted`](super::refracted).

use super::graded::{Order, shared};
use super::half_vector::half_tangent;
use super::refracted::{Facet, Refraction, Row};
use glam::DVec3;

const ABOVE: Order = Order(1.2, 0.4);
const BELOW: Order = Order(1.5, 0.6);
const LAYER: Order = Order(1.0, 0.25);

/// A scale at the end of a row above this part of it needs no panel.
const SMOOTH: f64 = 0.5;

/// Where the facets of a row begin: x, the half tangent of t, and mu_t.
#[derive(Debug, Clone, Copy)]
struct First {
    sin_x: f64,
    cos_x: f64,
    y: f64,
    mu_t: f64,
}

/// A row from there on.
struct Line {
    from: First,
    /// `wo . wm` there.
    c_0: f64,
}

impl Refraction<'_> {
    /// From the rarer side: half tangents of t, and of the distance from the end where it is not smooth there.
    pub(super) fn above(&mut self, row: &Row) {
        let (mu, eta, a) = (self.view.mu, self.lobe.eta, row.a);
        let reach = self.lobe.reach * row.width;
        let end = half_tangent(if a < 0.0 { reach.min(mu / -a) } else { reach });
        if end <= 0.0 {
            return;
        }
        // c changes by what it is at the normal, or by the width of F at grazing incidence
        let slope = self.critical.min(1.0 / eta);
        let rise = if a > 0.0 { (mu + self.critical) / a } else { f64::INFINITY };
        let r = libm::hypot(a, mu);
        let layer = mu.min(3.0 * row.width) * (a.abs() + libm::hypot(a, self.critical)) / self.contrast;
        let last = layer.min((slope + a.max(0.0)) / r);
        // whether a row is split changes from row to row: both parts are one panel
        let split = 0.5 * last < SMOOTH * end && !self.lobe.reach.is_finite();
        let middle = if split { end / (1.0 + (1.0 + end * end).sqrt()) } else { end };
        let peak = &shared(0.5 * row.width.min(rise) / middle, ABOVE, self.level).rule;
        for (x, w) in peak.node.iter().zip(&peak.weight) {
            self.upper(row, middle * x, middle * w);
        }
        if split {
            let layer = &shared((0.5 * last / middle).max(1e-9), LAYER, self.level).rule;
            for (x, w) in layer.node.iter().zip(&layer.weight) {
                let from_end = middle * x;
                let below = 1.0 / (1.0 + end * from_end);
                let weight = middle * w * (1.0 + end * end) * below * below;
                self.upper(row, (end - from_end) * below, weight);
            }
        }
    }

    fn upper(&mut self, row: &Row, y: f64, weight: f64) {
        let (mu, eta) = (self.view.mu, self.lobe.eta);
        let sec = 1.0 / (1.0 + y * y);
        let (sin, cos) = (2.0 * y * sec, (1.0 - y) * (1.0 + y) * sec);
        let c = row.a * sin + mu * cos;
        let g = (c * c + self.contrast).sqrt();
        let mu_t = (mu + self.contrast / (g + c) * cos) / eta;
        self.emit(row, [sin, cos, c, g, mu_t], 2.0 * sec * sin * weight);
    }

    /// From the denser side: x from the normal, or from the horizon of wt, to the critical cone, or to the end of D.
    pub(super) fn below(&mut self, row: &Row) {
        let (mu, eta, k) = (self.view.mu, self.lobe.eta, self.critical);
        let Row { a, q, .. } = *row;
        if q <= 0.0 {
            return;
        }
        let from = self.first(row);
        let Some(to) = self.last(row) else { return };
        let (ts, te) = (half_of(from.sin_x, from.cos_x), half_of(to[0], to[1]));
        let (apart, sum) = (te - ts, 1.0 + te * ts);
        // a quarter of the range in x
        let end = apart / (sum + libm::hypot(sum, apart));
        if !(apart > 0.0 && end > 0.0) {
            return;
        }
        let g = q * from.cos_x;
        let c = libm::hypot(k, g);
        // x at which t has gone the width of D, or the distance from the normal, if that is more; and mu_t the width of masking
        let slope = 2.0 * libm::atan(from.y);
        let far = libm::hypot(row.width, slope);
        let peak = 2.0 * far * c / (g + (g * g + 2.0 * a.max(0.0) * far * c).sqrt());
        let layer = (2.0 * row.width + from.mu_t) * eta / q;
        let start = 0.25 * peak.min(layer);
        // where g falls below what F knows of it
        let mut last = (eta * eta * k).min(k) + q * to[1];
        if to[1] > 0.0 {
            // the horizon of wm: mu_t is mu / eta there
            let (g, c) = (q * to[1], libm::hypot(k, q * to[1]));
            last = last.min(mu.min(3.0 * row.width) * c * (c + g) / (k * k));
        }
        let last = 0.25 * last / q;
        let split = last < 0.5 * SMOOTH * end && !self.lobe.reach.is_finite();
        let middle = if split { 0.5 * end } else { end };
        let line = Line { from, c_0: c };
        let rule = &shared(start / middle, BELOW, self.level).rule;
        for (x, w) in rule.node.iter().zip(&rule.weight) {
            self.lower(row, &line, middle * x, middle * w);
        }
        if split {
            let rule = &shared((last / middle).max(1e-9), LAYER, self.level).rule;
            for (x, w) in rule.node.iter().zip(&rule.weight) {
                self.lower(row, &line, end - middle * x, middle * w);
            }
        }
    }

    /// Where the facets of a row begin.
    fn first(&self, row: &Row) -> First {
        if self.inside >= 0.0 {
            let g = self.inside.sqrt();
            return First { sin_x: -row.a / row.q, cos_x: g / row.q, y: 0.0, mu_t: g / self.lobe.eta };
        }
        let (up, along) = (-self.inside, self.view.mu * (row.a + row.q));
        let root = libm::hypot(up, along);
        let (sin, cos) = (up / root, along / root);
        First { sin_x: -cos, cos_x: sin, y: sin / (1.0 + cos), mu_t: 0.0 }
    }

    /// Sine and cosine of x where they end; none if D ends before they begin.
    fn last(&self, row: &Row) -> Option<[f64; 2]> {
        let (mu, k) = (self.view.mu, self.critical);
        let reach = self.lobe.reach * row.width;
        let (sin, cos) = if reach.is_finite() {
            let root = libm::hypot(1.0, reach);
            (reach / root, 1.0 / root)
        } else {
            (1.0, 0.0)
        };
        let c = row.a * sin + mu * cos;
        let sin_x = (mu * sin - row.a * cos) / row.q;
        if c > k {
            return Some([sin_x, ((c - k) * (c + k)).sqrt() / row.q]);
        }
        // the end of D lies before the facets that refract, or behind them
        (sin_x > 0.0).then_some([1.0, 0.0])
    }

    /// `z = tan((x - x_0) / 4)`.
    fn lower(&mut self, row: &Row, line: &Line, z: f64, weight: f64) {
        let (q, eta, k) = (row.q, self.lobe.eta, self.critical);
        let First { sin_x: sin_0, cos_x: cos_0, y, .. } = line.from;
        let sec = 1.0 / (1.0 + z * z);
        let (sin_h, cos_h) = (2.0 * z * sec, (1.0 - z) * (1.0 + z) * sec);
        let (sin_d, cos_d) = (2.0 * sin_h * cos_h, 1.0 - 2.0 * sin_h * sin_h);
        let (sin_x, cos_x) = (sin_0 * cos_d + cos_0 * sin_d, cos_0 * cos_d - sin_0 * sin_d);
        let g = q * cos_x;
        let c = (k * k + g * g).sqrt();
        // tan((u - u_0) / 2) = (sin u - sin u_0) / (cos u + cos u_0)
        let turn = 2.0 * q * sin_h * (cos_0 * cos_h - sin_0 * sin_h) / (c + line.c_0);
        let y = (y + turn) / (1.0 - y * turn);
        let sec_t = 1.0 / (1.0 + y * y);
        let (sin, cos) = (2.0 * y * sec_t, (1.0 - y) * (1.0 + y) * sec_t);
        let mu_t = q / eta * (cos_x * cos + sin_x * sin);
        if g > 0.0 && mu_t > 0.0 && cos > 0.0 {
            self.emit(row, [sin, cos, c, g, mu_t], 4.0 * sec * sin * g / c * weight);
        }
    }

    fn emit(&mut self, row: &Row, [sin, cos, c, g, mu_t]: [f64; 5], weight: f64) {
        let eta = self.lobe.eta;
        let wm = DVec3::new(sin * row.cos_phi, sin * row.sin_phi, cos);
        let wt = ((c - g) * wm - self.wo) / eta;
        (self.visit)(&Facet {
            panel: row.panel,
            wm,
            wt: DVec3::new(wt.x, wt.y, -mu_t),
            cos: c,
            cos_t: g / eta,
            weight: weight * row.weight,
        });
    }
}

/// Half tangent from sine and cosine, the cosine not below 0.
fn half_of(sin: f64, cos: f64) -> f64 {
    sin / (1.0 + cos)
}
