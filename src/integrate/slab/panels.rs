//! Panels of the polar angle from the normal to the horizon, with Gauss nodes, and the polynomials through them.

use crate::integrate::gauss;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// Panels halve from the middle down to this angle above the horizon.
const HORIZON: f64 = 1e-3;

/// Nodes on panels that are graded towards the normal and the horizon.
#[derive(Debug, Clone)]
pub(super) struct Panels {
    /// Polar angles in [0, pi/2], rising.
    pub(super) edges: Vec<f64>,
    /// Nodes a panel.
    pub(super) order: usize,
    /// Polar angles of the nodes.
    pub(super) theta: Vec<f64>,
    /// Weights of the nodes for integrals over the angle.
    pub(super) width: Vec<f64>,
    /// Weights of the barycentric formula on the unit interval.
    weights: Vec<f64>,
}

/// Longest panel, in radians: reflectances of thin fibres fall by orders of magnitude between normal and horizon.
const LONGEST: f64 = 0.2;

/// The edges with those of the halves of panels that are too long.
fn split(edges: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0];
    for pair in edges.windows(2) {
        if pair[1] - pair[0] > LONGEST {
            out.push(0.5 * (pair[0] + pair[1]));
        }
        out.push(pair[1]);
    }
    out
}

impl Panels {
    /// Panels that resolve `scale` radians round the normal.
    pub(super) fn new(scale: f64, order: usize) -> Panels {
        let mut edges = vec![FRAC_PI_4];
        let mut at = FRAC_PI_4;
        while at > 0.7 * scale {
            at *= 0.5;
            edges.push(at);
        }
        edges.push(0.0);
        edges.reverse();
        at = FRAC_PI_4;
        while at > HORIZON {
            at *= 0.5;
            edges.push(FRAC_PI_2 - at);
        }
        edges.push(FRAC_PI_2);
        let edges = split(&edges);
        let rule = gauss::rule(order);
        let (mut theta, mut width) = (Vec::new(), Vec::new());
        for pair in edges.windows(2) {
            theta.extend(rule.nodes.iter().map(|x| pair[0] + (pair[1] - pair[0]) * x));
            width.extend(rule.weights.iter().map(|w| (pair[1] - pair[0]) * w));
        }
        let difference = |j: usize, k: usize| rule.nodes[j] - rule.nodes[k];
        let product = |j: usize| (0..order).filter(|&k| k != j).map(|k| difference(j, k)).product::<f64>();
        let weights = (0..order).map(|j| 1.0 / product(j)).collect();
        Panels { edges, order, theta, width, weights }
    }

    /// Number of panels.
    pub(super) fn count(&self) -> usize {
        self.edges.len() - 1
    }

    /// The values at `x` in [0, 1] of the polynomials that are 1 at one node and 0 at the others.
    pub(super) fn basis(&self, x: f64, out: &mut [f64]) {
        let nodes = &gauss::rule(self.order).nodes;
        let mut sum = 0.0;
        for ((value, node), weight) in out.iter_mut().zip(nodes).zip(&self.weights) {
            // at a node the limit is reached to rounding
            let distance = if (x - node).abs() < 1e-15 { 1e-15 } else { x - node };
            *value = weight / distance;
            sum += *value;
        }
        out.iter_mut().for_each(|v| *v /= sum);
    }

    /// The first node of the panel of an angle, and the factors of its nodes.
    pub(super) fn locate(&self, theta: f64) -> (usize, Vec<f64>) {
        let panel = self.edges.iter().skip(1).take(self.count() - 1).filter(|e| **e <= theta).count();
        let (a, b) = (self.edges[panel], self.edges[panel + 1]);
        let mut factors = vec![0.0; self.order];
        self.basis((theta - a) / (b - a), &mut factors);
        (panel * self.order, factors)
    }
}
