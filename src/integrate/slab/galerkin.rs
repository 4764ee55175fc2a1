//! The scattering kernel between the polynomials of two panels.
//!
//! `B_ij = 2 pi int int l_i(t) l_j(t') K_m(t, t') sin t sin t' dt dt'`. The kernel has a kink, and a peak of the medium's width,
//! where the angles are equal. Between panels that touch, the outer variable is the difference of the angles, graded
//! towards 0; all others are far enough apart for the product of their rules.

use super::Medium;
use super::panels::Panels;
use crate::integrate::gauss;
use crate::math::square::Square;
use std::f64::consts::{PI, TAU};

/// Nodes of a panel that the inner rules have more than the panels.
const FINER: usize = 4;

/// Growth of the pieces of the difference of two angles.
const GROWTH: f64 = 2.2;

/// The kernel within the upper hemisphere (`same`) and across to the lower one (`across`), a matrix for each mode.
#[derive(Debug)]
pub(super) struct Kernel {
    pub(super) same: Vec<Square>,
    pub(super) across: Vec<Square>,
}

/// One pair of panels: where they are, and what is summed.
struct Pair<'a> {
    medium: &'a dyn Medium,
    panels: &'a Panels,
    first: [f64; 2],
    second: [f64; 2],
    modes: usize,
}

pub(super) fn assemble(medium: &dyn Medium, panels: &Panels, modes: usize) -> Kernel {
    let (n, count) = (panels.order, panels.count());
    let size = n * count;
    let mut same = vec![Square::zero(size); modes];
    let mut across = vec![Square::zero(size); modes];
    let mut block = vec![0.0; modes * n * n];
    let edge = |k: usize| if k <= count { panels.edges[k] } else { PI - panels.edges[2 * count - k] };
    for a in 0..count {
        // the kernel is symmetric, also under a mirror in the horizon
        for b in a..2 * count - a {
            let pair =
                Pair { medium, panels, first: [edge(a), edge(a + 1)], second: [edge(b), edge(b + 1)], modes };
            block.fill(0.0);
            if b - a <= 1 {
                pair.touching(&mut block)
            } else {
                pair.far(&mut block)
            }
            for (m, part) in block.chunks_exact(n * n).enumerate() {
                for i in 0..n {
                    for j in 0..n {
                        let (p, value) = (a * n + i, part[i * n + j]);
                        if b < count {
                            same[m].row_mut(p)[b * n + j] = value;
                            same[m].row_mut(b * n + j)[p] = value;
                        } else {
                            let q = 2 * size - 1 - (b * n + j);
                            across[m].row_mut(p)[q] = value;
                            across[m].row_mut(q)[p] = value;
                        }
                    }
                }
            }
        }
    }
    Kernel { same, across }
}

impl Pair<'_> {
    /// The product of the two rules.
    fn far(&self, block: &mut [f64]) {
        let n = self.panels.order;
        let rule = gauss::rule(n);
        let (w, v) = (self.first[1] - self.first[0], self.second[1] - self.second[0]);
        let mut modes = vec![0.0; self.modes];
        for i in 0..n {
            let x = self.first[0] + w * rule.nodes[i];
            for j in 0..n {
                let y = self.second[0] + v * rule.nodes[j];
                self.medium.kernel(x, y, y - x, &mut modes);
                let weight = TAU * w * v * rule.weights[i] * rule.weights[j] * libm::sin(x) * libm::sin(y);
                for (m, k) in modes.iter().enumerate() {
                    block[(m * n + i) * n + j] = weight * k;
                }
            }
        }
    }

    /// Panels that are one or touch: pieces of the difference d = t' - t, smallest at d = 0.
    fn touching(&self, block: &mut [f64]) {
        let ([a, b], [c, d]) = (self.first, self.second);
        let mut ends = [c - b, c - a, d - b, d - a, 0.0];
        ends.sort_by(f64::total_cmp);
        // equal ends but for rounding
        let least = 1e-14 * (d - a);
        for pair in ends.windows(2).filter(|p| p[1] - p[0] > least) {
            let (low, high) = (pair[0].abs().min(pair[1].abs()), pair[0].abs().max(pair[1].abs()));
            let sign = if pair[1] > least { 1.0 } else { -1.0 };
            let smallest = 0.7 * self.medium.width();
            let mut from = if low < least { 0.0 } else { low };
            while from < high {
                let mut to = (from * GROWTH).max(smallest);
                if to > high || high - to < 0.3 * (to - from) {
                    to = high;
                }
                self.strip(sign, from, to, block);
                from = to;
            }
        }
    }

    /// Differences between `from` and `to`.
    fn strip(&self, sign: f64, from: f64, to: f64, block: &mut [f64]) {
        let n = self.panels.order;
        let rule = gauss::rule(n + FINER);
        let ([a, b], [c, d]) = (self.first, self.second);
        let (mut modes, mut left, mut right) = (vec![0.0; self.modes], vec![0.0; n], vec![0.0; n]);
        for (u, wu) in rule.nodes.iter().zip(&rule.weights) {
            let difference = sign * (from + (to - from) * u);
            let (low, high) = (a.max(c - difference), b.min(d - difference));
            for (v, wv) in rule.nodes.iter().zip(&rule.weights) {
                let x = low + (high - low) * v;
                let y = x + difference;
                self.medium.kernel(x, y, difference, &mut modes);
                self.panels.basis((x - a) / (b - a), &mut left);
                self.panels.basis((y - c) / (d - c), &mut right);
                let weight =
                    TAU * (to - from) * wu * (high - low).max(0.0) * wv * libm::sin(x) * libm::sin(y);
                for (k, part) in modes.iter().zip(block.chunks_exact_mut(n * n)) {
                    for (l, row) in left.iter().zip(part.chunks_exact_mut(n)) {
                        let factor = weight * k * l;
                        row.iter_mut().zip(&right).for_each(|(p, r)| *p += factor * r);
                    }
                }
            }
        }
    }
}

/// The extinction between the polynomials of each panel, `int l_i l_j sigma sin`, which is not quite diagonal.
pub(super) fn extinction(medium: &dyn Medium, panels: &Panels) -> Square {
    let n = panels.order;
    let rule = gauss::rule(n + 12);
    let mut out = Square::zero(panels.theta.len());
    let mut basis = vec![0.0; n];
    for (p, edge) in panels.edges.windows(2).enumerate() {
        for (x, w) in rule.nodes.iter().zip(&rule.weights) {
            let theta = edge[0] + (edge[1] - edge[0]) * x;
            let weight = w * (edge[1] - edge[0]) * libm::sin(theta) * medium.extinction(theta);
            panels.basis(*x, &mut basis);
            for (i, a) in basis.iter().enumerate() {
                let row = &mut out.row_mut(p * n + i)[p * n..(p + 1) * n];
                row.iter_mut().zip(&basis).for_each(|(r, b)| *r += weight * a * b);
            }
        }
    }
    out
}
