//! Where the lobes of a footprint are compared: directions drawn to the lobe that is sought, in f32 so that eight fit a register.
//!
//! D, the total variation of two densities p and q over the upper hemisphere, is (∫p + ∫q)/2 − ∫ min(p, q). Both masses are
//! known in closed form, and the minimum is nowhere larger than the one lobe: nodes that are dense where that lobe is serve
//! it, whatever the footprint has elsewhere. A quadrature of |p − q| would have to find every facet of the footprint.
//!
//! The nodes are a Fibonacci lattice in the square (u, φ), u uniform under GGX (tan²θ = α² u/(1 − u)).
//! Only + − × ÷ √ are used after the lattice is made: the same bits on every processor.

use super::lobe::Facet;
use glam::{DMat3, DVec3};
use std::f32::consts::{FRAC_1_PI, PI};

/// Numbers that are summed side by side.
const LANES: usize = 8;

/// Slopes of a unit GGX lobe at the nodes of a lattice.
#[derive(Debug, Clone)]
pub(super) struct Lattice(Vec<[f32; 2]>);

impl Lattice {
    /// A lattice of `n` nodes, a multiple of eight.
    #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
    pub(super) fn new(n: usize) -> Lattice {
        let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let node = |i: usize| {
            let u = (i as f64 + 0.5) / n as f64;
            let tangent = (u / (1.0 - u)).sqrt();
            let (sin, cos) = libm::sincos(golden * i as f64);
            [(tangent * cos) as f32, (tangent * sin) as f32]
        };
        Lattice((0..n).map(node).collect())
    }
}

/// The nodes of one comparison; the buffers are kept from one to the next.
#[derive(Debug, Clone, Default)]
pub(super) struct Nodes {
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    /// The footprint's density.
    truth: Vec<f32>,
    /// Solid angle of the node; 0 below the mesh.
    weight: Vec<f32>,
}

/// A lobe as the nodes see it, in their frame: `u = l₁ x + l₂ y`, `v = l₃ y` in its own axes; q = u² + v² + cos².
#[derive(Debug, Clone, Copy)]
pub(super) struct Local {
    /// Tangent, bitangent and normal, in the frame of the nodes.
    pub(super) axes: [DVec3; 3],
    /// l₁, l₂, l₃; the density is l₁ l₃ cos/(π q²).
    pub(super) shape: [f64; 3],
}

/// ∫ min(truth, lobe) and what it changes by.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Overlap {
    /// The integral.
    pub(super) value: f64,
    /// Half the difference between the sums over every other node: how far the integral can be trusted.
    pub(super) doubt: f64,
    /// Derivatives to l₁, l₂, l₃.
    pub(super) shape: [f64; 3],
    /// Derivatives to turning the directions about the lobe's own axes.
    pub(super) turn: [f64; 3],
}

#[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
fn single(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

impl Nodes {
    /// Places the nodes for lobes near the charts `[α along x, α along y]`, in the frame `base`, and evaluates the footprint there.
    #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
    pub(super) fn place(
        &mut self,
        base: &[DVec3; 3],
        charts: &[[f64; 2]],
        lattice: &Lattice,
        facets: &[Facet],
    ) {
        let total = lattice.0.len() * charts.len();
        for list in [&mut self.x, &mut self.y, &mut self.z, &mut self.truth, &mut self.weight] {
            list.clear();
            list.resize(total, 0.0);
        }
        let slots = self.x.iter_mut().zip(&mut self.y).zip(&mut self.z);
        let slopes =
            charts.iter().flat_map(|c| lattice.0.iter().map(|s| [c[0] as f32 * s[0], c[1] as f32 * s[1]]));
        for (((x, y), z), [sx, sy]) in slots.zip(slopes) {
            *z = 1.0 / (1.0 + sx * sx + sy * sy).sqrt();
            (*x, *y) = (sx * *z, sy * *z);
        }
        self.weigh(charts, [base[0].z as f32, base[1].z as f32, base[2].z as f32]);
        let to_base = DMat3::from_cols(base[0], base[1], base[2]).transpose();
        for facet in facets {
            let normal = single(to_base * facet.normal);
            if facet.is_round() {
                self.add(normal, facet.alpha as f32, facet.weight as f32);
            } else {
                let along = single(to_base * facet.lobe().axes()[0]);
                let widths = [facet.alpha_max as f32, facet.alpha as f32];
                self.add_stretched(normal, along, widths, facet.weight as f32);
            }
        }
    }

    /// Solid angles: one over the density of the nodes, which is the mean of the charts'.
    #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
    fn weigh(&mut self, charts: &[[f64; 2]], up: [f32; 3]) {
        let scaled: Vec<[f32; 3]> = charts
            .iter()
            .map(|[a, b]| [1.0 / a, 1.0 / b, 1.0 / (std::f64::consts::PI * a * b)].map(|v| v as f32))
            .collect();
        let share = charts.len() as f32 / self.x.len() as f32;
        for (((w, &x), &y), &z) in self.weight.iter_mut().zip(&self.x).zip(&self.y).zip(&self.z) {
            let mut density = 0.0;
            for [a, b, k] in &scaled {
                let (u, v) = (x * a, y * b);
                let q = u * u + v * v + z * z;
                density += k * z / (q * q);
            }
            let above = up[0] * x + up[1] * y + up[2] * z > 0.0;
            *w = if above { share / density } else { 0.0 };
        }
    }

    /// Adds a facet to the footprint's density; see [`Facet::density`].
    fn add(&mut self, n: [f32; 3], alpha: f32, weight: f32) {
        let inverse = 1.0 / (alpha * alpha);
        let scale = weight * inverse * FRAC_1_PI;
        for (((t, &x), &y), &z) in self.truth.iter_mut().zip(&self.x).zip(&self.y).zip(&self.z) {
            let (dx, dy, dz) = (x - n[0], y - n[1], z - n[2]);
            let d = dx * dx + dy * dy + dz * dz;
            let cos = 1.0 - 0.5 * d;
            let q = d * (1.0 - 0.25 * d) * inverse + cos * cos;
            let cos = if cos > 0.0 { cos } else { 0.0 };
            *t += scale * cos / (q * q);
        }
    }

    /// The same of a facet of two widths, the first along `along`.
    fn add_stretched(&mut self, n: [f32; 3], along: [f32; 3], [wide, narrow]: [f32; 2], weight: f32) {
        let (a, b) = (1.0 / (wide * wide), 1.0 / (narrow * narrow));
        let scale = weight / (wide * narrow) * FRAC_1_PI;
        for (((t, &x), &y), &z) in self.truth.iter_mut().zip(&self.x).zip(&self.y).zip(&self.z) {
            let (dx, dy, dz) = (x - n[0], y - n[1], z - n[2]);
            let d = dx * dx + dy * dy + dz * dz;
            let cos = 1.0 - 0.5 * d;
            // along and n are perpendicular: the difference keeps the digits
            let u = along[0] * dx + along[1] * dy + along[2] * dz;
            let rest = d * (1.0 - 0.25 * d) - u * u;
            let rest = if rest > 0.0 { rest } else { 0.0 };
            let q = u * u * a + rest * b + cos * cos;
            let cos = if cos > 0.0 { cos } else { 0.0 };
            *t += scale * cos / (q * q);
        }
    }

    /// ∫ min(truth, lobe) of a lobe of one width 1/l in the frame of the nodes; its slope to ln l, and how far the
    /// integral can be trusted, as [`overlap`](Nodes::overlap) has it.
    #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
    pub(super) fn round(&self, l: f64) -> (f64, f64, f64) {
        let square = (l * l) as f32;
        let k = square / PI;
        let [mut value, mut scale, mut steep] = [[0f32; LANES]; 3];
        let lists = [&self.z, &self.truth, &self.weight];
        let [zs, ts, ws] = lists.map(|list| list.chunks_exact(LANES));
        for ((zs, ts), ws) in zs.zip(ts).zip(ws) {
            for i in 0..LANES {
                let z = zs[i];
                let sin2 = 1.0 - z * z;
                let inverse = 1.0 / (square * sin2 + z * z);
                let density = k * z * inverse * inverse;
                let below = density < ts[i];
                value[i] += ws[i] * if below { density } else { ts[i] };
                let own = if below { ws[i] * density } else { 0.0 };
                scale[i] += own;
                steep[i] += own * inverse * sin2;
            }
        }
        let sum = |s: &[f32; LANES]| s.iter().map(|v| f64::from(*v)).sum::<f64>();
        let doubt = value.chunks_exact(2).map(|p| f64::from(p[0]) - f64::from(p[1])).sum::<f64>().abs();
        // d density / d ln l = density (2 - 4 l^2 sin^2 / q)
        let slope = 2.0 * sum(&scale) - 4.0 * l * l * sum(&steep);
        (sum(&value), slope, doubt)
    }

    /// ∫ min(truth, pair) of two lobes of the widths 1/l about a normal in the frame of the nodes, the second with its share; and how far
    /// it can be trusted.
    #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
    pub(super) fn two(&self, normal: DVec3, l: [f64; 2], share: f64) -> (f64, f64) {
        let [nx, ny, nz] = single(normal);
        let squares = l.map(|l| (l * l) as f32);
        let parts = [(1.0 - share) as f32 * squares[0] / PI, share as f32 * squares[1] / PI];
        let mut value = [0f32; LANES];
        let lists = [&self.x, &self.y, &self.z, &self.truth, &self.weight];
        let [xs, ys, zs, ts, ws] = lists.map(|list| list.chunks_exact(LANES));
        for ((((xs, ys), zs), ts), ws) in xs.zip(ys).zip(zs).zip(ts).zip(ws) {
            for i in 0..LANES {
                let c = nx * xs[i] + ny * ys[i] + nz * zs[i];
                let cos2 = c * c;
                let sin2 = 1.0 - cos2;
                let (a, b) = (1.0 / (squares[0] * sin2 + cos2), 1.0 / (squares[1] * sin2 + cos2));
                let density = c * (parts[0] * a * a + parts[1] * b * b);
                let density = if density > 0.0 { density } else { 0.0 };
                value[i] += ws[i] * if density < ts[i] { density } else { ts[i] };
            }
        }
        let sum = value.iter().map(|v| f64::from(*v)).sum::<f64>();
        let doubt = value.chunks_exact(2).map(|p| f64::from(p[0]) - f64::from(p[1])).sum::<f64>().abs();
        (sum, doubt)
    }

    /// The integral and its derivatives. Without `TURNS` the lobe stands in the frame of the nodes.
    #[allow(clippy::cast_possible_truncation, reason = "rounded to f32 on purpose")]
    pub(super) fn overlap<const TURNS: bool>(&self, lobe: &Local) -> Overlap {
        let [t, b, n] = lobe.axes.map(single);
        let [l1, l2, l3] = lobe.shape.map(|l| l as f32);
        let k = l1 * l3 / PI;
        let mut sums = [[0f32; LANES]; 8];
        let [value, scale, s1, s2, s3, rx, ry, rz] = &mut sums;
        let lists = [&self.x, &self.y, &self.z, &self.truth, &self.weight];
        let [xs, ys, zs, ts, ws] = lists.map(|list| list.chunks_exact(LANES));
        for ((((xs, ys), zs), ts), ws) in xs.zip(ys).zip(zs).zip(ts).zip(ws) {
            for i in 0..LANES {
                let h = [xs[i], ys[i], zs[i]];
                let along = |a: [f32; 3]| a[0] * h[0] + a[1] * h[1] + a[2] * h[2];
                let [x, y, c] = if TURNS { [along(t), along(b), along(n)] } else { h };
                let (u, v) = (l1 * x + l2 * y, l3 * y);
                let inverse = 1.0 / (u * u + v * v + c * c);
                let c = if c > 0.0 { c } else { 0.0 };
                let steep = k * inverse * inverse;
                let density = steep * c;
                let below = density < ts[i];
                value[i] += ws[i] * if below { density } else { ts[i] };
                let own = if below { ws[i] * density } else { 0.0 };
                scale[i] += own;
                let p = own * inverse;
                s1[i] += p * u * x;
                s2[i] += p * u * y;
                s3[i] += p * v * y;
                if TURNS {
                    let (dx, dy) = (-4.0 * p * u * l1, -4.0 * p * (u * l2 + v * l3));
                    let dc = if below { ws[i] * steep } else { 0.0 } - 4.0 * p * c;
                    rx[i] += y * dc - c * dy;
                    ry[i] += c * dx - x * dc;
                    rz[i] += x * dy - y * dx;
                }
            }
        }
        let sum = |s: &[f32; LANES]| s.iter().map(|v| f64::from(*v)).sum::<f64>();
        let doubt = value.chunks_exact(2).map(|p| f64::from(p[0]) - f64::from(p[1])).sum::<f64>().abs();
        let scale = sum(scale);
        Overlap {
            value: sum(value),
            doubt,
            shape: [
                scale / lobe.shape[0] - 4.0 * sum(s1),
                -4.0 * sum(s2),
                scale / lobe.shape[2] - 4.0 * sum(s3),
            ],
            turn: [sum(rx), sum(ry), sum(rz)],
        }
    }
}
