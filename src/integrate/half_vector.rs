//! The half-vector chart of isotropic models: wm in polar coordinates round the normal, with the horizon as a coordinate line.
//!
//! With `wo = (s, 0, mu)`, `wm = (sin t cos p, sin t sin p, cos t)`, `v = wo . wm` and `wi = 2 v wm - wo`:
//!
//! ```text
//! dwi  = 4 v sin(t) dt dp
//! mu_i = R cos(2 t - delta) = R sin(2 (t_max - t)),  R = hypot(s cos p, mu),  delta = atan2(s cos p, mu),
//! t_max(p) = pi/4 + delta/2
//! ```
//!
//! so the horizon is exactly `t = t_max`, and `mu_i` near it has no cancellation when `d = t_max - t` is the variable.
//! Everything is algebraic in half-angle tangents: no transcendental function is called per node.
//!
//! Panels, each graded by a [`shared`] rule:
//! * azimuth: (0, pi/2) and (pi/2, pi), graded towards pi/2 on the scale `mu / s`, where R changes;
//! * below `t_max / 2`: graded towards t = 0 on the scale `alpha` of the peak of D and its tail, and in front on that of a Fresnel
//!   factor that changes over a width in v: there `v = mu + s t`;
//! * above it: graded towards the horizon on the scale `min(mu, layer) / (2 R)`, where masking changes (Smith's within 3 alpha).
//!
//! Measured on GGX (scale and bias, 600 points with mu and alpha down to 1e-4): the largest error falls by a factor of
//! about ten for each unit of the level, down to 4e-14, at about 9 `level`^2 evaluations (25 `level`^2 when both mu and
//! alpha are tiny).

use super::ellipse::GRAZING;
use super::graded::{Order, Part, Shared, shared};
use super::nodes::{BATCH, Nodes};
use std::cell::Cell;
use std::f64::consts::FRAC_PI_2;

const AZIMUTH_FRONT: Order = Order(1.0, 0.25);
const AZIMUTH_BACK: Order = Order(1.0, 0.15);
const PEAK: Order = Order(1.0, 0.35);
const HORIZON: Order = Order(1.0, 0.25);

/// Widest and narrowest scale that the gradings are built for.
const ALPHA_RANGE: [f64; 2] = [1e-8, 4.0];

/// Geometry of one azimuth of wm: its direction, R, and tangents of t_max / 2 and t_max / 4.
pub(super) struct Row {
    pub(super) cos_phi: f64,
    pub(super) sin_phi: f64,
    /// The part of wo along the azimuth.
    along: f64,
    pub(super) r: f64,
    pub(super) half: f64,
    pub(super) quarter: f64,
    /// 1 - half, which is as small as mu at grazing views.
    rest: f64,
}

impl Row {
    /// From the azimuth of wm and the part `a` of wo along it, `a = sin_o cos(phi - phi_o)`.
    pub(super) fn new(cos_phi: f64, sin_phi: f64, a: f64, mu: f64) -> Row {
        let r = (a * a + mu * mu).sqrt();
        // sin and cos of t_max from cos(2 t_max) = -a / r; the small one of 1 +- a/r as mu^2 / (r (r + |a|)).
        let near = mu / (2.0 * r * (r + a.abs())).sqrt();
        let far = ((r + a.abs()) / (2.0 * r)).sqrt();
        let (sin, cos) = if a >= 0.0 { (far, near) } else { (near, far) };
        let half = sin / (1.0 + cos);
        let rest = cos * (1.0 + sin + cos) / ((1.0 + sin) * (1.0 + cos));
        Row { cos_phi, sin_phi, along: a, r, half, quarter: half / (1.0 + (1.0 + half * half).sqrt()), rest }
    }

    /// From the azimuth of wm relative to wo.
    fn relative(cos_phi: f64, sin_o: f64, mu: f64) -> Row {
        let sin_phi = ((1.0 - cos_phi) * (1.0 + cos_phi)).max(0.0).sqrt();
        Row::new(cos_phi, sin_phi, sin_o * cos_phi, mu)
    }

    /// Tangent of half the angle from the horizon at which D ends, if it ends at half tangent `end`; 0 beyond.
    pub(super) fn above_horizon(&self, end: f64) -> f64 {
        ((self.half - end) / (1.0 + self.half * end)).max(0.0)
    }
}

/// The rules of one side of the azimuth: rows, nodes of a row near the peak, and nodes of a row towards the horizon.
#[derive(Debug, Clone, Copy)]
pub struct Side {
    /// True for the side of `wo`.
    pub front: bool,
    /// Over the azimuth.
    pub azimuth: &'static Shared,
    /// Below `t_max / 2`.
    pub peak: &'static Shared,
    /// Above it.
    pub horizon: &'static Shared,
}

/// Scales of the gradings of a view and a lobe: one for the azimuth, two (front and back) for the others.
#[derive(Debug, Clone, Copy)]
pub struct Scales {
    azimuth: f64,
    peak: [f64; 2],
    horizon: [f64; 2],
}

impl Scales {
    /// For one view cosine; see [`visit`].
    #[must_use]
    pub fn new(mu: f64, [alpha, slope, layer]: [f64; 3], reach: f64) -> Scales {
        let alpha = alpha.clamp(ALPHA_RANGE[0], ALPHA_RANGE[1]);
        let end = half_tangent(reach * alpha);
        let s = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
        // Gradings are shared by the rows of a side; the row at phi = 0 (or pi/2) is the most demanding one.
        let hardest = [1.0, 0.0].map(|cos_phi| Row::relative(cos_phi, s, mu.max(1e-12)));
        let rise = [(mu + slope) / s.max(1e-9), f64::INFINITY];
        let near = |i: usize| 0.5 * alpha.min(rise[i]) / hardest[i].quarter.min(end);
        let far = |i: usize| {
            let row: &Row = &hardest[i];
            let scale = (mu.min(layer.max(ALPHA_RANGE[0])) / (2.0 * row.r)).clamp(1e-9 * alpha.min(1.0), 1.0);
            0.5 * scale / row.quarter
        };
        Scales {
            azimuth: (mu / (s.max(1e-9) * FRAC_PI_2)).clamp(1e-9, 1e3),
            peak: [near(0), near(1)],
            horizon: [far(0), far(1)],
        }
    }

    /// Scales that serve both.
    #[must_use]
    pub fn and(self, other: Scales) -> Scales {
        let least = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].min(b[1])];
        Scales {
            azimuth: self.azimuth.min(other.azimuth),
            peak: least(self.peak, other.peak),
            horizon: least(self.horizon, other.horizon),
        }
    }

    /// The rules of both sides at a level.
    #[must_use]
    pub fn sides(&self, level: f64) -> [Side; 2] {
        [(true, AZIMUTH_FRONT, 0), (false, AZIMUTH_BACK, 1)].map(|(front, order, i)| Side {
            front,
            azimuth: shared(self.azimuth, order, level),
            peak: shared(self.peak[i], PEAK, level),
            horizon: shared(self.horizon[i], HORIZON, level),
        })
    }
}

thread_local! {
    /// The batches of the last call on this thread (near the peak, towards the horizon: rows are gathered until one is full); a nested
    /// call finds none and makes its own. Clearing them would cost as much as a coarse level.
    static SPARE: Cell<Option<Box<[Nodes; 2]>>> = const { Cell::new(None) };
}

/// Calls `visit` with batches of nodes that cover the hemisphere for one view cosine.
///
/// `slope`: the width in v over which F changes at grazing incidence. `layer`: that in `mu_i` over which masking changes. `reach`: D vanishes beyond `tan(t) = reach * alpha` (6.5 for Beckmann, infinite for GGX); no node is spent there.
pub fn visit(mu_o: f64, lobe: [f64; 3], reach: f64, level: f64, visit: &mut dyn FnMut(&Nodes)) {
    let end = half_tangent(reach * lobe[0].clamp(ALPHA_RANGE[0], ALPHA_RANGE[1]));
    let mut space =
        SPARE.take().unwrap_or_else(|| Box::new([Nodes::new(1.0.into()), Nodes::new(1.0.into())]));
    let [near, far] = &mut *space;
    near.reset(mu_o.into());
    far.reset(mu_o.into());
    let (s, mu) = (near.sin_o, mu_o);
    for side in Scales::new(mu, lobe, reach).sides(level) {
        let front = side.front;
        // at mu = 0 the far half of the azimuth sees no light: t_max is 0 there
        if !front && mu < GRAZING {
            continue;
        }
        near.panel = if front { 0 } else { 2 };
        far.panel = near.panel + 1;
        for (&sine, &weight) in side.azimuth.quarter_sine.iter().zip(&side.azimuth.rule.weight) {
            let row = Row::relative(if front { sine } else { -sine }, s, mu);
            // 2 for the mirror half of the azimuth.
            let width = 2.0 * FRAC_PI_2 * weight;
            for part in side.peak.rule.parts() {
                flush(near, part.node.len(), visit);
                fill_peak(near, &row, part, width, row.quarter.min(end));
            }
            // distance from the horizon at which D ends; beyond the half way point nothing is left
            let near_end = row.above_horizon(end);
            if near_end < row.quarter {
                for part in side.horizon.rule.parts() {
                    flush(far, part.node.len(), visit);
                    fill_horizon(far, &row, part, width, [near_end, row.quarter]);
                }
            }
        }
        flush(near, BATCH, visit);
        flush(far, BATCH, visit);
    }
    SPARE.set(Some(space));
}

/// Visits a batch that has no room for `more` nodes, and empties it.
fn flush(nodes: &mut Nodes, more: usize, visit: &mut dyn FnMut(&Nodes)) {
    if nodes.len > 0 && nodes.len + more > BATCH {
        visit(nodes);
        nodes.len = 0;
    }
}

/// `tan(t / 2)` from `tan(t)`; 1 at infinity.
pub(super) fn half_tangent(tan: f64) -> f64 {
    if tan.is_finite() { tan / (1.0 + (1.0 + tan * tan).sqrt()) } else { 1.0 }
}

/// Appends the nodes of one row below `t_max / 2`; `y = tan(t / 2)` runs over (0, end).
///
/// `mu_i` is far from 0 relative to its terms here (at least `mu / 2`), so it is formed directly.
fn fill_peak(nodes: &mut Nodes, row: &Row, part: Part<'_>, width: f64, end: f64) {
    let (a, mu) = (row.along, nodes.mu_o);
    let Part { node, weight } = part;
    let len = node.len();
    let at = nodes.len..nodes.len + len;
    nodes.len += len;
    nodes.cos_phi[at.clone()].fill(row.cos_phi);
    nodes.sin_phi[at.clone()].fill(row.sin_phi);
    let scale = 8.0 * end * width;
    let weight = &weight[..len];
    let (cos_h, sin_h) = (&mut nodes.cos_h[at.clone()], &mut nodes.sin_h[at.clone()]);
    let (mu_i, cos_d) = (&mut nodes.mu_i[at.clone()], &mut nodes.cos_d[at.clone()]);
    let out = &mut nodes.weight[at];
    for i in 0..len {
        let t = end * node[i];
        let sec = 1.0 / (1.0 + t * t);
        let cos = (1.0 - t) * (1.0 + t) * sec;
        let sin = 2.0 * t * sec;
        let v = a * sin + mu * cos;
        cos_h[i] = cos;
        sin_h[i] = sin;
        mu_i[i] = 2.0 * v * cos - mu;
        cos_d[i] = v;
        // 4 v sin dt, dt = 2 sec d(tan(t / 2))
        out[i] = scale * (v * sin) * (sec * weight[i]);
    }
}

/// Appends the nodes of one row above `t_max / 2`; `u = tan((t_max - t) / 2)` runs over `span`.
fn fill_horizon(nodes: &mut Nodes, row: &Row, part: Part<'_>, width: f64, span: [f64; 2]) {
    let (half, rest, mu) = (row.half, row.rest, nodes.mu_o);
    let length = span[1] - span[0];
    let Part { node, weight } = part;
    let len = node.len();
    let at = nodes.len..nodes.len + len;
    nodes.len += len;
    nodes.cos_phi[at.clone()].fill(row.cos_phi);
    nodes.sin_phi[at.clone()].fill(row.sin_phi);
    let scale = 8.0 * length * width;
    let weight = &weight[..len];
    let (cos_h, sin_h) = (&mut nodes.cos_h[at.clone()], &mut nodes.sin_h[at.clone()]);
    let (mu_i, cos_d) = (&mut nodes.mu_i[at.clone()], &mut nodes.cos_d[at.clone()]);
    let out = &mut nodes.weight[at];
    for i in 0..len {
        let u = span[0] + length * node[i];
        let below = 1.0 / (1.0 + half * u);
        let t = (half - u) * below;
        let sec_u = 1.0 / (1.0 + u * u);
        // one division serves 1 / (1 + t^2) and 1 / cos = (1 + t^2) / (1 - t^2)
        let (less, more) = ((rest + u * (1.0 + half)) * below * (1.0 + t), 1.0 + t * t);
        let inverse = 1.0 / (less * more);
        let sec = less * inverse;
        let sin = 2.0 * t * sec;
        let m = row.r * 4.0 * u * (1.0 - u) * (1.0 + u) * (sec_u * sec_u);
        // from mu_i = 2 v cos - mu, free of cancellation where v is small
        let v = 0.5 * (m + mu) * (more * more) * inverse;
        cos_h[i] = less * sec;
        sin_h[i] = sin;
        mu_i[i] = m;
        cos_d[i] = v;
        out[i] = scale * (v * sin) * (sec_u * weight[i]);
    }
}

/// Nodes of one row and panel of a chart with rows of its own: the batch is replaced.
pub(super) fn fill(
    nodes: &mut Nodes,
    row: &Row,
    part: Part<'_>,
    width: f64,
    span: [f64; 2],
    from_horizon: bool,
) {
    nodes.len = 0;
    if from_horizon {
        fill_horizon(nodes, row, part, width, span);
    } else {
        fill_peak(nodes, row, part, width, span[1]);
    }
}
