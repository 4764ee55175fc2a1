//! What a transformed cosine is fitted to: the lobe `f mu_i / E` at the nodes of the model's own chart.

use super::super::TexelError;
use crate::integrate::{BATCH, Chart, View};
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

/// A normalised lobe on nodes that cover the hemisphere.
#[derive(Debug, Clone, Default)]
pub(super) struct Target {
    pub(super) nodes: Vec<Node>,
    /// `E = int f mu_i dwi`.
    pub(super) albedo: f64,
    /// `int (f mu_i / E)^3 dwi`.
    pub(super) cube: f64,
}

impl Target {
    /// At one level of the charts of the model's lobes.
    ///
    /// The nodes of several charts share the hemisphere in the ratio of the cubes of their lobes, so that each
    /// covers what its chart resolves. Errors: a mirror has no width to fit; a value that is not finite.
    pub(super) fn new(model: &dyn Brdf, view: View, level: f64) -> Result<Target, TexelError> {
        let mut target = Target::default();
        match model.parts() {
            None => target.gather(model, view, level)?,
            Some(parts) => {
                let parts: Vec<_> = parts.into_iter().filter(|p| p.0 > 0.0).collect();
                for (own, &(_, part)) in parts.iter().enumerate() {
                    let from = target.nodes.len();
                    target.gather(part, view, level)?;
                    for node in &mut target.nodes[from..] {
                        share(node, &parts, own, view.direction());
                    }
                }
            }
        }
        target.normalise()
    }

    /// Appends the nodes of one chart.
    fn gather(&mut self, model: &dyn Brdf, view: View, level: f64) -> Result<(), TexelError> {
        if model.mirror(view.mu).is_some() {
            return Err(TexelError::NoWidth);
        }
        let mut values = [0.0; BATCH];
        let nodes = &mut self.nodes;
        model.chart().unwrap_or(Chart::Broad { kinks: true }).visit(view, level, &mut |batch| {
            model.eval_nodes(batch, &mut values);
            for (i, value) in values[..batch.len].iter().enumerate() {
                let weight = batch.weight[i];
                if weight > 0.0 {
                    nodes.push(Node { w: batch.wi(i), lobe: value * batch.mu_i[i], weight });
                }
            }
        });
        Ok(())
    }

    fn normalise(mut self) -> Result<Target, TexelError> {
        let albedo: f64 = self.nodes.iter().map(|n| n.weight * n.lobe).sum();
        if !(albedo.is_finite() && albedo >= 0.0) {
            return Err(TexelError::NotFinite { channel: 0, value: albedo });
        }
        self.albedo = albedo;
        let scale = if albedo > 0.0 { 1.0 / albedo } else { 0.0 };
        for node in &mut self.nodes {
            node.lobe *= scale;
            self.cube += node.weight * (node.lobe * node.lobe) * node.lobe;
        }
        Ok(self)
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

/// Sets a node of one part's chart to the whole lobe, and its weight to the share of that chart.
fn share(node: &mut Node, parts: &[(f64, &dyn Brdf)], own: usize, wo: DVec3) {
    let cube = |x: f64| x * x * x;
    let (mut sum, mut cubes, mut mine) = (0.0, 0.0, 0.0);
    for (k, &(factor, part)) in parts.iter().enumerate() {
        // the part's own value stays as its chart computed it
        let value =
            if k == own { factor * node.lobe } else { factor * part.eval(wo, node.w) * node.w.z };
        sum += value;
        cubes += cube(value);
        if k == own {
            mine = cube(value);
        }
    }
    node.lobe = sum;
    node.weight *= if cubes > 0.0 { mine / cubes } else { 1.0 / parts.len() as f64 };
}
