//! What a transformed cosine is fitted to: the lobe `f mu_i / E` at the nodes of the model's own chart.

use super::super::TexelError;
use super::objective::Slices;
use super::proposal;
use crate::integrate::{BATCH, Chart, Nodes, View};
use crate::models::Brdf;
use crate::terms::ltc::Inverse;
use glam::DVec3;

/// A node: a direction, the lobe there, and the weight in sr.
#[derive(Debug, Clone, Copy)]
pub(super) struct Node {
    pub(super) w: DVec3,
    pub(super) lobe: f64,
    pub(super) weight: f64,
}

/// Factor on the cube of the lobe's density where nodes are shared: where both agree, the chart has 8 parts in 9.
const FAVOUR: f64 = 0.125;

/// Nodes that hold less than this of the integral of the cube are left out: the tails.
const NEGLIGIBLE: f64 = 1e-13;

/// A normalised lobe on nodes that cover the hemisphere.
pub(super) struct Target<'a> {
    parts: Vec<(f64, &'a dyn Brdf)>,
    view: View,
    level: f64,
    pub(super) nodes: Vec<Node>,
    /// `E = int f mu_i dwi`.
    pub(super) albedo: f64,
    /// `int (f mu_i / E)^3 dwi`.
    pub(super) cube: f64,
}

impl<'a> Target<'a> {
    /// At one level of the charts of the model's lobes.
    ///
    /// The nodes of several charts share the hemisphere in the ratio of the cubes of their lobes, so that each
    /// covers what its chart resolves. Errors: a mirror has no width to fit; a value that is not finite.
    pub(super) fn new(model: &'a dyn Brdf, view: View, level: f64) -> Result<Target<'a>, TexelError> {
        let parts = model.parts().unwrap_or_else(|| vec![(1.0, model)]);
        let parts: Vec<_> = parts.into_iter().filter(|p| p.0 > 0.0).collect();
        if parts.iter().any(|(_, part)| part.mirror(view.mu).is_some()) {
            return Err(TexelError::NoWidth);
        }
        let mut target = Target { parts, view, level, nodes: Vec::new(), albedo: 0.0, cube: 0.0 };
        for own in 0..target.parts.len() {
            target.gather(own);
        }
        target.normalise()
    }

    /// Appends the nodes of the chart of one part.
    fn gather(&mut self, own: usize) {
        let (parts, nodes) = (&self.parts, &mut self.nodes);
        let chart = parts[own].1.chart().unwrap_or(Chart::Broad { kinks: true, floor: 0.0 });
        let (mut values, mut sum, mut cubes, mut mine) =
            ([0.0; BATCH], [0.0; BATCH], [0.0; BATCH], [0.0; BATCH]);
        chart.visit(self.view, self.level, &mut |batch| {
            sum.fill(0.0);
            cubes.fill(0.0);
            for (k, &(factor, part)) in parts.iter().enumerate() {
                part.eval_nodes(batch, &mut values);
                for i in 0..batch.len {
                    let value = factor * values[i] * batch.mu_i[i];
                    sum[i] += value;
                    cubes[i] += cube(value);
                    if k == own {
                        mine[i] = cube(value);
                    }
                }
            }
            for i in 0..batch.len {
                let share = if parts.len() == 1 {
                    1.0
                } else if cubes[i] > 0.0 {
                    mine[i] / cubes[i]
                } else {
                    1.0 / parts.len() as f64
                };
                if batch.weight[i] > 0.0 {
                    nodes.push(Node { w: batch.wi(i), lobe: sum[i], weight: batch.weight[i] * share });
                }
            }
        });
    }

    fn normalise(mut self) -> Result<Target<'a>, TexelError> {
        let albedo: f64 = self.nodes.iter().map(|n| n.weight * n.lobe).sum();
        if !(albedo.is_finite() && albedo >= 0.0) {
            return Err(TexelError::NotFinite { channel: 0, value: albedo });
        }
        self.albedo = albedo;
        let scale = if albedo > 0.0 { 1.0 / albedo } else { 0.0 };
        for node in &mut self.nodes {
            node.lobe *= scale;
            self.cube += node.weight * cube(node.lobe);
        }
        Ok(self)
    }

    /// Nodes over the whole sphere for the difference of the target and a lobe like `proposal`.
    ///
    /// Nodes of the model's chart and of the lobe's own share the upper hemisphere in the ratio of the cubes of the two
    /// densities: where one has a peak that the other's nodes may step over, its own nodes count.
    pub(super) fn nodes_for(&self, proposal: &Inverse, out: &mut Slices) {
        let (mut above, mut below) = (Vec::new(), Vec::new());
        proposal::nodes(proposal, self.level, &mut above, &mut below);
        self.evaluate(&mut above);
        out.clear();
        let least = NEGLIGIBLE * self.cube;
        let mut add = |node: &Node, is_chart: bool| {
            let (t, d) = (cube(node.lobe), cube(proposal.density(node.w)));
            let shared = t + FAVOUR * d;
            let chart = if shared > 0.0 { t / shared } else { 1.0 };
            let weight = node.weight * if is_chart { chart } else { 1.0 - chart };
            if weight * (t + d) > least {
                out.push(&Node { weight, ..*node });
            }
        };
        self.nodes.iter().for_each(|n| add(n, true));
        above.iter().for_each(|n| add(n, false));
        below.iter().for_each(|n| add(n, false));
        out.pad();
    }

    /// `1/2 int |f mu_i / E - D| = int max(0, f mu_i / E - D) = 1 - int min(f mu_i / E, D)`, since both integrate to 1.
    ///
    /// The nodes of one chart follow the lobe, and D with it: the second form. Those of several do not where D is a thin sheet across
    /// the broadest of them: the third, on the nodes of D; a peak of the target between these is above D and counts for nothing.
    pub(super) fn variation(&self, inverse: &Inverse) -> f64 {
        if self.parts.len() == 1 {
            return super::objective::variation(&self.nodes, inverse);
        }
        let (mut above, mut below) = (Vec::new(), Vec::new());
        proposal::nodes(inverse, self.level, &mut above, &mut below);
        self.evaluate(&mut above);
        1.0 - above.iter().map(|n| n.weight * n.lobe.min(inverse.density(n.w))).sum::<f64>()
    }

    /// Sets the lobe at nodes above the horizon.
    fn evaluate(&self, nodes: &mut [Node]) {
        let mut batch = Nodes::new(self.view);
        let mut values = [0.0; BATCH];
        for run in nodes.chunks_mut(BATCH) {
            batch.len = run.len();
            for (i, node) in run.iter().enumerate() {
                let w = node.w;
                batch.set(i, DVec3::new(w.x, w.y, w.z.max(0.0)), node.weight);
            }
            for &(factor, part) in &self.parts {
                part.eval_nodes(&batch, &mut values);
                for (i, node) in run.iter_mut().enumerate() {
                    node.lobe += factor / self.albedo * values[i] * batch.mu_i[i];
                }
            }
        }
    }

    /// True if the surface reflects nothing at this view.
    pub(super) fn is_dark(&self) -> bool {
        self.albedo <= f64::MIN_POSITIVE
    }

    /// A lobe with the mean direction and the widths of the square of the target.
    ///
    /// The square, since a power-law tail has no second moment of its own. For a narrow lobe of widths s across,
    /// `D^2 ~ (1 + u^2)^-4` has the variance `s^2 / 4`.
    pub(super) fn moments(&self) -> Inverse {
        let (mut mean, mut total) = (DVec3::ZERO, 0.0);
        for n in &self.nodes {
            let m = n.weight * n.lobe * n.lobe;
            mean += m * n.w;
            total += m;
        }
        let length = (mean.x * mean.x + mean.z * mean.z).sqrt();
        if !(total > 0.0 && length > 0.0) {
            return Inverse::COSINE;
        }
        let axis = DVec3::new(mean.x / length, 0.0, mean.z / length);
        let across = DVec3::new(axis.z, 0.0, -axis.x);
        let (mut xx, mut yy) = (0.0, 0.0);
        for n in &self.nodes {
            let m = n.weight * n.lobe * n.lobe / total;
            let x = n.w.dot(across);
            xx += m * x * x;
            yy += m * n.w.y * n.w.y;
        }
        let width = |variance: f64| 2.0 * variance.sqrt().clamp(1e-12, 0.5);
        let (sx, sy) = (width(xx), width(yy));
        Inverse { m11: across.x / sx, m13: across.z / sx, m22: 1.0 / sy, m31: axis.x, m33: axis.z }
    }
}

fn cube(x: f64) -> f64 {
    x * x * x
}
