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

/// Value, gradient and Hessian on nodes that cover the sphere.
pub(super) fn objective(nodes: &[Node], inverse: &Inverse) -> Objective {
    let det = FRAC_1_PI * inverse.minor() * inverse.m22;
    let (mut value, mut gradient, mut upper) = (0.0, [0.0; N], [0.0; 10]);
    for node in nodes {
        let v = inverse.apply(node.w);
        if v.z <= 0.0 {
            value += node.weight * (node.lobe * node.lobe) * node.lobe;
            continue;
        }
        let inv = 1.0 / v.length_squared();
        let c = det * (inv * inv);
        let d = c * v.z;
        let (xx, yy, zz, xz) = (v.x * v.x * inv, v.y * v.y * inv, v.z * v.z * inv, v.x * v.z * inv);
        let cx = c * v.x;
        let first = [d * (1.0 - 4.0 * xx), d * (1.0 - 4.0 * yy), -4.0 * d * xz, cx * (1.0 - 4.0 * zz)];
        let second = [
            d * xx * (24.0 * xx - 12.0),
            d * (1.0 - 4.0 * xx - 4.0 * yy + 24.0 * xx * yy),
            d * xz * (24.0 * xx - 8.0),
            cx * (1.0 - 4.0 * xx) + d * xz * (24.0 * xx - 4.0),
            d * yy * (24.0 * yy - 12.0),
            d * xz * (24.0 * yy - 4.0),
            cx * (1.0 - 4.0 * yy) + d * xz * (24.0 * yy - 4.0),
            d * zz * (24.0 * xx - 4.0),
            d * (24.0 * xx * zz - 4.0 * xx - 1.0),
            d * xx * (24.0 * zz - 12.0),
        ];
        let r = node.lobe - d;
        let once = node.weight * r.abs();
        let slope = once * r;
        value += slope.abs() * r.abs();
        for (g, e) in gradient.iter_mut().zip(&first) {
            *g -= 3.0 * slope * e;
        }
        for ((h, &(i, j)), s) in upper.iter_mut().zip(&PAIRS).zip(&second) {
            *h += 6.0 * once * (first[i] * first[j]) - 3.0 * slope * s;
        }
    }
    let mut hessian = [[0.0; N]; N];
    for (h, &(i, j)) in upper.iter().zip(&PAIRS) {
        hessian[i][j] = *h;
        hessian[j][i] = *h;
    }
    Objective { value, gradient, hessian }
}

/// `int max(0, f mu_i / E - D)`: half the integral of the difference, since both integrate to 1.
pub(super) fn variation(nodes: &[Node], inverse: &Inverse) -> f64 {
    nodes.iter().map(|n| n.weight * (n.lobe - inverse.density(n.w)).max(0.0)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

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
        let at = objective(&nodes, &b);
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
