//! The error of a fit and its derivatives: `int |f mu_i / E - D|^3 dwi` over the whole sphere.
//!
//! The derivatives are taken in a factor P on the left of the inverse matrix, at P = 1:
//! `P = [[1 + d1, 0, d3], [0, 1 + d2, 0], [d4, 0, 1]]`. With `v = M^-1 w` and x, y, z its unit vector,
//! ```text
//! D  = c z,   c = det / (pi |v|^3)
//! D1 = D (1 - 4 x^2),  D2 = D (1 - 4 y^2),  D3 = -4 D x z,  D4 = c x (1 - 4 z^2)
//! ```
//! so the four numbers are of the size of 1 for every lobe, however narrow.

use super::target::Node;
use crate::terms::ltc::Inverse;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Number of parameters.
pub(super) const N: usize = 4;

/// Pairs (i, j), i <= j, in the order in which second derivatives are summed.
const PAIRS: [(usize, usize); 10] =
    [(0, 0), (0, 1), (0, 2), (0, 3), (1, 1), (1, 2), (1, 3), (2, 2), (2, 3), (3, 3)];

/// The objective at a matrix.
#[derive(Debug, Clone, Copy)]
pub(super) struct Objective {
    /// `int |f mu_i / E - D|^3`.
    pub(super) value: f64,
    pub(super) gradient: [f64; N],
    pub(super) hessian: [[f64; N]; N],
}

/// Nodes side by side, so that the sums are a plain loop over slices.
#[derive(Debug, Clone, Default)]
pub(super) struct Slices {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    lobe: Vec<f64>,
    weight: Vec<f64>,
}

/// Nodes summed at a time.
const LANES: usize = 4;

impl Slices {
    /// Appends a node.
    pub(super) fn push(&mut self, node: &Node) {
        self.x.push(node.w.x);
        self.y.push(node.w.y);
        self.z.push(node.w.z);
        self.lobe.push(node.lobe);
        self.weight.push(node.weight);
    }

    /// Number of nodes.
    pub(super) fn len(&self) -> usize {
        self.x.len()
    }

    pub(super) fn clear(&mut self) {
        for part in [&mut self.x, &mut self.y, &mut self.z, &mut self.lobe, &mut self.weight] {
            part.clear();
        }
    }

    /// Nodes without weight up to a whole number of lanes.
    pub(super) fn pad(&mut self) {
        while !self.len().is_multiple_of(LANES) {
            self.push(&Node { w: DVec3::Z, lobe: 0.0, weight: 0.0 });
        }
    }
}

/// Value, gradient and Hessian on padded nodes that cover the sphere.
pub(super) fn objective(nodes: &Slices, inverse: &Inverse) -> Objective {
    let mut sums = [[0.0; LANES]; 15];
    for i in (0..nodes.len()).step_by(LANES) {
        add(nodes, i, inverse, &mut sums);
    }
    let total = |k: usize| (sums[k][0] + sums[k][1]) + (sums[k][2] + sums[k][3]);
    let mut hessian = [[0.0; N]; N];
    for (k, &(i, j)) in PAIRS.iter().enumerate() {
        hessian[i][j] = total(5 + k);
        hessian[j][i] = hessian[i][j];
    }
    Objective { value: total(0), gradient: std::array::from_fn(|k| total(1 + k)), hessian }
}

/// Value and gradient alone, for a third of the work.
pub(super) fn gradient(nodes: &Slices, m: &Inverse) -> (f64, [f64; N]) {
    let mut sums = [[0.0; LANES]; 1 + N];
    let det = FRAC_1_PI * m.minor() * m.m22;
    for i in (0..nodes.len()).step_by(LANES) {
        let at = i..i + LANES;
        let (x, y, z) = (&nodes.x[at.clone()], &nodes.y[at.clone()], &nodes.z[at.clone()]);
        let (lobe, weight) = (&nodes.lobe[at.clone()], &nodes.weight[at]);
        for l in 0..LANES {
            let (vx, vy, vz) = (m.m11 * x[l] + m.m13 * z[l], m.m22 * y[l], m.m31 * x[l] + m.m33 * z[l]);
            let inv = 1.0 / (vx * vx + vy * vy + vz * vz);
            let c = if vz > 0.0 { det * (inv * inv) } else { 0.0 };
            let (d, cx) = (c * vz, c * vx);
            let r = lobe[l] - d;
            let once = weight[l] * r.abs();
            let slope = -3.0 * once * r;
            sums[0][l] += once * (r * r);
            sums[1][l] += slope * (d - 4.0 * d * (vx * vx * inv));
            sums[2][l] += slope * (d - 4.0 * d * (vy * vy * inv));
            sums[3][l] += slope * (-4.0 * d * (vx * vz * inv));
            sums[4][l] += slope * (cx - 4.0 * cx * (vz * vz * inv));
        }
    }
    let total = |k: usize| (sums[k][0] + sums[k][1]) + (sums[k][2] + sums[k][3]);
    (total(0), std::array::from_fn(|k| total(1 + k)))
}

/// Adds the nodes from `i` on: the value, the gradient and the upper half of the Hessian.
#[inline]
fn add(nodes: &Slices, i: usize, m: &Inverse, sums: &mut [[f64; LANES]; 15]) {
    let at = i..i + LANES;
    let (x, y, z) = (&nodes.x[at.clone()], &nodes.y[at.clone()], &nodes.z[at.clone()]);
    let (lobe, weight) = (&nodes.lobe[at.clone()], &nodes.weight[at]);
    let det = FRAC_1_PI * m.minor() * m.m22;
    for l in 0..LANES {
        let (vx, vy, vz) = (m.m11 * x[l] + m.m13 * z[l], m.m22 * y[l], m.m31 * x[l] + m.m33 * z[l]);
        let inv = 1.0 / (vx * vx + vy * vy + vz * vz);
        // behind the lobe's own horizon everything is 0
        let c = if vz > 0.0 { det * (inv * inv) } else { 0.0 };
        let (d, cx) = (c * vz, c * vx);
        let (xx, yy, zz, xz) = (vx * vx * inv, vy * vy * inv, vz * vz * inv, vx * vz * inv);
        let (e0, e1) = (d - 4.0 * d * xx, d - 4.0 * d * yy);
        let (e2, e3) = (-4.0 * d * xz, cx - 4.0 * cx * zz);
        let r = lobe[l] - d;
        let once = weight[l] * r.abs();
        // minus first and plus second derivative of |r|^3 by r
        let (slope, bend) = (-3.0 * once * r, 6.0 * once);
        let (dxx, dyy, dxz, x24, y24) = (d * xx, d * yy, d * xz, 24.0 * xx, 24.0 * yy);
        sums[0][l] += once * (r * r);
        sums[1][l] += slope * e0;
        sums[2][l] += slope * e1;
        sums[3][l] += slope * e2;
        sums[4][l] += slope * e3;
        sums[5][l] += bend * e0 * e0 + slope * (dxx * (x24 - 12.0));
        sums[6][l] += bend * e0 * e1 + slope * (e1 - 4.0 * dxx + 24.0 * dxx * yy);
        sums[7][l] += bend * e0 * e2 + slope * (dxz * (x24 - 8.0));
        sums[8][l] += bend * e0 * e3 + slope * (cx - 4.0 * cx * xx + dxz * (x24 - 4.0));
        sums[9][l] += bend * e1 * e1 + slope * (dyy * (y24 - 12.0));
        sums[10][l] += bend * e1 * e2 + slope * (dxz * (y24 - 4.0));
        sums[11][l] += bend * e1 * e3 + slope * (cx - 4.0 * cx * yy + dxz * (y24 - 4.0));
        sums[12][l] += bend * e2 * e2 + slope * (d * zz * (x24 - 4.0));
        sums[13][l] += bend * e2 * e3 + slope * (dxx * (24.0 * zz - 4.0) - d);
        sums[14][l] += bend * e3 * e3 + slope * (dxx * (24.0 * zz - 12.0));
    }
}

/// `int max(0, f mu_i / E - D)`: half the integral of the difference, since both integrate to 1.
///
/// The nodes of the model's chart are enough: a peak of D between them counts for nothing.
pub(super) fn variation(nodes: &[Node], inverse: &Inverse) -> f64 {
    nodes.iter().map(|n| n.weight * (n.lobe - inverse.density(n.w)).max(0.0)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(b: &Inverse, d: [f64; N]) -> Inverse {
        super::super::newton::step(b, d)
    }

    /// Derivatives against differences, for nodes on both sides and a lobe that leans.
    #[test]
    fn derivatives_agree_with_differences() {
        let mut nodes = Vec::new();
        let mut seeds = 1u64;
        let mut unit = || {
            seeds = seeds.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seeds >> 11) as f64 / (1u64 << 53) as f64
        };
        for _ in 0..300 {
            let w = DVec3::new(unit() - 0.5, unit() - 0.5, unit()).normalize();
            nodes.push(Node { w, lobe: unit(), weight: 0.01 });
        }
        let b = Inverse { m11: 1.3, m13: 0.2, m22: 0.8, m31: 0.1, m33: 0.7 };
        let mut slices = Slices::default();
        nodes.iter().for_each(|n| slices.push(n));
        slices.pad();
        let at = objective(&slices, &b);
        for i in 0..N {
            let mut d = [0.0; N];
            let h = 1e-5;
            d[i] = h;
            let (up, down) = (step(&b, d), step(&b, d.map(|x| -x)));
            let sum = |b: &Inverse| -> f64 {
                nodes.iter().map(|n| n.weight * libm::pow((n.lobe - b.density(n.w)).abs(), 3.0)).sum()
            };
            let slope = (sum(&up) - sum(&down)) / (2.0 * h);
            assert!((slope - at.gradient[i]).abs() < 1e-7, "{i}: {slope} {}", at.gradient[i]);
            let second = (sum(&up) - 2.0 * sum(&b) + sum(&down)) / (h * h);
            assert!((second - at.hessian[i][i]).abs() < 1e-4, "{i}: {second} {}", at.hessian[i][i]);
            for j in 0..i {
                let mixed = |si: f64, sj: f64| {
                    let mut d = [0.0; N];
                    d[i] = si * 1e-4;
                    d[j] = sj * 1e-4;
                    sum(&step(&b, d))
                };
                let m = (mixed(1.0, 1.0) - mixed(1.0, -1.0) - mixed(-1.0, 1.0) + mixed(-1.0, -1.0)) / 4e-8;
                assert!((m - at.hessian[i][j]).abs() < 1e-4, "{i}{j}: {m} {}", at.hessian[i][j]);
            }
        }
    }
}
