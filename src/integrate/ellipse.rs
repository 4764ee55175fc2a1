//! The half-vector chart for two widths, and for lobes whose edges the isotropic chart does not know.
//!
//! The polar part is that of [`half_vector`](super::half_vector), row by row. The azimuth of wm is mapped by
//! `tan(phi) = (alpha_y / alpha_x) tan(psi)`, which makes a distribution of slopes the same for every psi:
//!
//! ```text
//! dphi = (alpha_x alpha_y / w^2) dpsi,   w(psi) = |(alpha_x cos psi, alpha_y sin psi)| = width along phi
//! cos(phi - phi_o) = alpha_x alpha_y sin(psi - psi_1) / (w(psi_1) w(psi)),   phi_1 = phi_o - pi/2
//! ```
//!
//! Panels: the azimuth is split where wm is across wo (`psi_1`, `psi_1 + pi`; there R = mu) and graded towards these on
//! the scale mu / s; each half is split again in its middle. In the plane of a tangent, and for equal widths, the two
//! sides are mirror images and one is taken twice. The polar panels are
//! * graded towards the normal on the scale of the width along phi, up to `t_max / 2`;
//! * graded from the horizon, or in the square root of the distance from it, as the lobe's [`Edge`] says;
//! * ended at the curve `mu_i = mu_o`, which is `t = delta`, for lobes with a kink there.
//!
//! Measured: `tests/quadrature_charts.rs`.

use super::graded::{Graded, Order};
use super::half_vector::{Row, fill, half_tangent};
use super::nodes::Nodes;
use super::view::View;
use std::f64::consts::{FRAC_PI_2, PI};

const AZIMUTH: Order = Order(1.4, 0.25);
const PEAK: Order = Order(1.0, 0.35);
const HORIZON: Order = Order(1.0, 0.25);
const PLAIN: Order = Order(1.5, 0.0);

/// Widest and narrowest scale that the gradings are built for.
const ALPHA_RANGE: [f64; 2] = [1e-8, 4.0];

/// Ratios of the widths above this need no panel end at the narrow axis.
const ROUND: f64 = 0.8;

/// A narrow axis nearer than this to the line across wo shares its panel end.
const CLOSE: f64 = 1e-6;

/// How a lobe of facets behaves at the horizon of wi, and where it has kinks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// `f mu_i` is smooth up to the horizon.
    Smooth,
    /// It has a layer of the width of mu_o or of the distribution there (masking).
    Layer,
    /// It holds `1 / (mu_i + mu_o)`: a layer of the width of mu_o at the horizon, and one in wm at the normal.
    Graze,
    /// It goes as the square root of `mu_i`.
    Root,
    /// It is smooth at the horizon, but has a kink where `mu_i = mu_o`.
    Fold,
}

/// A panel of the azimuth: the psi that it is graded towards, the signed length, and the scale of the grading.
#[derive(Clone, Copy)]
struct Panel {
    from: f64,
    length: f64,
    scale: f64,
}

/// Calls `visit` with batches of nodes that cover the hemisphere for one view.
///
/// `reach`: D vanishes beyond `tan(t) = reach * width`, whatever the azimuth.
pub fn visit(view: View, alpha: [f64; 2], reach: f64, edge: Edge, level: f64, visit: &mut dyn FnMut(&Nodes)) {
    let alpha = alpha.map(|a| a.clamp(ALPHA_RANGE[0], ALPHA_RANGE[1]));
    let isotropic = (alpha[0] - alpha[1]).abs() <= 0.0;
    let view = if isotropic { view.in_plane() } else { view };
    let chart = Ellipse::new(view, alpha, reach, edge, level);
    let mut nodes = Nodes::new(view);
    let mirrored = (nodes.azimuth_o[0] * nodes.azimuth_o[1]).abs() < 1e-15;
    for (i, panel) in chart.panels().into_iter().enumerate() {
        // the mirror image of half of the panels is the other half
        let middle = panel.from + 0.5 * panel.length;
        if mirrored && !(FRAC_PI_2..3.0 * FRAC_PI_2).contains(&middle) {
            continue;
        }
        // at mu = 0 the far half of the azimuth sees no light
        if middle > PI && view.mu <= 0.0 {
            continue;
        }
        chart.panel(panel, if mirrored { 2.0 } else { 1.0 }, 2 * i, &mut nodes, visit);
    }
}

struct Ellipse {
    view: View,
    alpha: [f64; 2],
    reach: f64,
    edge: Edge,
    level: f64,
    /// psi across wo, and the width there.
    psi_1: f64,
    width_1: f64,
}

impl Ellipse {
    fn new(view: View, alpha: [f64; 2], reach: f64, edge: Edge, level: f64) -> Ellipse {
        let [cos, sin] = view.azimuth();
        // phi_1 = phi_o - pi/2 has the direction (sin, -cos)
        let psi_1 = libm::atan2(-cos * alpha[0], sin * alpha[1]);
        let width_1 = 1.0 / (square(sin / alpha[0]) + square(cos / alpha[1])).sqrt();
        Ellipse { view, alpha, reach, edge, level, psi_1, width_1 }
    }

    /// Panels of psi - psi_1 in (0, 2 pi): wm is across wo at 0 and pi, and along the narrow axis at two more angles.
    fn panels(&self) -> Vec<Panel> {
        let [ax, ay] = self.alpha;
        // mu / s in phi, stretched to psi
        let stretch = self.width_1 * self.width_1 / (ax * ay);
        let across = (self.view.mu / self.view.sine().max(1e-9) * stretch).clamp(1e-9, 1e3);
        let mut ends = vec![(0.0, across), (PI, across), (2.0 * PI, across)];
        let ratio = ax.min(ay) / ax.max(ay);
        if ratio < ROUND {
            let axis = if ax < ay { 0.0 } else { FRAC_PI_2 };
            let narrow = (axis - self.psi_1).rem_euclid(PI);
            if narrow < CLOSE || PI - narrow < CLOSE {
                ends.iter_mut().for_each(|end| end.1 = across.min(ratio));
            } else {
                ends.extend([(narrow, ratio), (narrow + PI, ratio)]);
                ends.sort_by(|a, b| a.0.total_cmp(&b.0));
            }
        }
        let halves = ends.windows(2).flat_map(|pair| {
            let half = 0.5 * (pair[1].0 - pair[0].0);
            [(pair[0], half), (pair[1], -half)]
        });
        halves.map(|((from, scale), length)| Panel { from, length, scale }).collect()
    }

    fn panel(
        &self,
        panel: Panel,
        weight: f64,
        index: usize,
        nodes: &mut Nodes,
        visit: &mut dyn FnMut(&Nodes),
    ) {
        let [ax, ay] = self.alpha;
        let (s, mu) = (nodes.sin_o, nodes.mu_o);
        let length = panel.length.abs();
        let azimuth = Graded::new(panel.scale / length, AZIMUTH, self.level);
        for j in 0..azimuth.len {
            let step = panel.length * azimuth.node[j];
            let (sin, cos) = libm::sincos(self.psi_1 + panel.from + step);
            let (x, y) = (ax * cos, ay * sin);
            let width = (x * x + y * y).sqrt();
            let along = s * ax * ay * turned(panel.from, step) / (self.width_1 * width);
            let row = Row::new(x / width, y / width, along, mu);
            let d_phi = length * azimuth.weight[j] * ax * ay / (width * width);
            self.row(&row, width, weight * d_phi, along, index, nodes, visit);
        }
    }

    #[allow(clippy::too_many_arguments, reason = "the state of one row, passed from its only caller")]
    fn row(
        &self,
        row: &Row,
        width: f64,
        weight: f64,
        along: f64,
        panel: usize,
        nodes: &mut Nodes,
        visit: &mut dyn FnMut(&Nodes),
    ) {
        let end = half_tangent(self.reach * width);
        // half tangent of the angle delta at which mu_i = mu_o, in the front half
        let fold = if self.edge == Edge::Fold && along > 0.0 { along / (row.r + nodes.mu_o) } else { -1.0 };
        let peak_end = row.quarter.min(end);
        // mu_i + mu_o vanishes at a negative angle whose tangent is -mu_o / along
        let near_normal =
            if self.edge == Edge::Graze && along > 0.0 { nodes.mu_o / along } else { f64::INFINITY };
        let peak_scale = 0.5 * width.min(near_normal).max(1e-9);
        let mut add = |panel: usize, rule: &Graded, span: [f64; 2], from_horizon: bool| {
            nodes.panel = panel;
            fill(nodes, row, rule, weight, span, from_horizon);
            visit(nodes);
        };
        let at = fold / peak_end;
        for piece in split(at).into_iter().flatten() {
            let rule = Graded::between(peak_scale / peak_end, PEAK, self.level, piece);
            add(panel, &rule, [0.0, peak_end], false);
        }
        let near_end = row.above_horizon(end);
        if near_end < row.quarter {
            let length = row.quarter - near_end;
            let at = if fold > 0.0 { (row.above_horizon(fold) - near_end) / length } else { -1.0 };
            // a fold that wanders from one polar panel to the other leaves errors that cancel exactly: one sum for both
            let upper = if self.edge == Edge::Fold { panel } else { panel + 1 };
            for piece in split(at).into_iter().flatten() {
                add(upper, &self.horizon(row, near_end, length, piece), [near_end, row.quarter], true);
            }
        }
    }

    fn horizon(&self, row: &Row, near_end: f64, length: f64, piece: [f64; 2]) -> Graded {
        match self.edge {
            Edge::Root if near_end <= 0.0 => Graded::root(PLAIN, self.level),
            Edge::Layer | Edge::Graze => {
                let least = self.alpha[0].min(self.alpha[1]);
                let near = (self.view.mu.min(3.0 * least) / (2.0 * row.r)).clamp(1e-9, 1.0);
                Graded::between(0.5 * near / length, HORIZON, self.level, piece)
            }
            _ => Graded::between(1e3, PLAIN, self.level, piece),
        }
    }
}

/// `sin(from + step)`, exact in the step from the ends across wo, where it is what counts.
fn turned(from: f64, step: f64) -> f64 {
    if (from - PI).abs() <= 0.0 {
        -libm::sin(step)
    } else if from <= 0.0 || from >= 2.0 * PI {
        libm::sin(step)
    } else {
        libm::sin(from + step)
    }
}

/// (0, 1) in two pieces if `at` lies within, else in one.
fn split(at: f64) -> [Option<[f64; 2]>; 2] {
    if at > 0.0 && at < 1.0 { [Some([0.0, at]), Some([at, 1.0])] } else { [Some([0.0, 1.0]), None] }
}

fn square(x: f64) -> f64 {
    x * x
}
