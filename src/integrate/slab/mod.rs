//! Light in a plane slab of unit depth that scatters and does not absorb: radiative transfer without random numbers.
//!
//! ```text
//! mu dI/dz = -sigma(theta) I + int K(w', w) I(w') dw'
//! ```
//! over black ground, with an extinction that depends on the direction. The medium is even about the horizon and round about the
//! normal, so the Fourier modes of the azimuth part. In the polar angle the radiance is a polynomial on each of the
//! panels of `panels.rs`, discontinuous at their ends (Galerkin's method; the kernel's peak is integrated in `galerkin.rs`).
//!
//! With u and v the sum and the difference of the light that goes up and down, scaled by `sqrt(mu w)`,
//! `du/dz = F v` and `dv/dz = G u` for two symmetric positive matrices. With `F = L L'`, `G = C C'` and the singular values k of
//! `C' L`, light that enters alike on both sides (or with opposite signs) leaves as `2 / (1 + Z) - 1` of it, with
//! `Z = Y k tanh(k / 2) Y'` (or coth), `Y = L'^-1 V`: exact in depth, symmetric, stable for any optical depth. Half the sum
//! is reflected, half the difference transmitted.
//!
//! What one scattering event reflects is known in closed form, and is not smooth: only the rest is returned by modes.
//! Errors fall as the order of the polynomials rises: compare two orders.

mod galerkin;
mod panels;

use crate::math::square::{Square, dot};
use panels::Panels;
use std::f64::consts::TAU;

/// What a slab is filled with. Polar angles from 0 to pi, measured from the normal, of the direction of travel.
pub trait Medium {
    /// Extinction per unit depth along a direction; the same for the mirrored one.
    fn extinction(&self, theta: f64) -> f64;

    /// Fourier coefficients `K_m = 1/(2 pi) int K cos(m phi) dphi`, m = 0, 1, ..., of what is scattered from one direction to
    /// another, per length and sr, with phi between their azimuths. `difference` is `to - from` without rounding.
    fn kernel(&self, from: f64, to: f64, difference: f64, modes: &mut [f64]);

    /// The angle, in radians, over which extinction and kernel change.
    fn width(&self) -> f64;
}

/// A slab that was solved.
#[derive(Debug, Clone)]
pub struct Slab {
    panels: Panels,
    reflected: Vec<f64>,
    transmitted: Vec<f64>,
    multiple: Vec<Square>,
    /// Largest difference of `int K` and the extinction, over all nodes, before it was made up: an error of the kernel's integrals.
    pub unbalance: f64,
}

/// The light reflected towards one view after two scattering events or more, for all directions of incidence.
#[derive(Debug, Clone)]
pub struct Multiple<'a> {
    panels: &'a Panels,
    rows: Vec<Vec<f64>>,
}

/// The matrices of one mode, scaled by `sqrt(mu w)` on either side.
struct Mode {
    reflected: Square,
    transmitted: Square,
    once: Square,
}

/// The slab before its modes are solved.
struct System {
    kernel: galerkin::Kernel,
    extinction: Square,
    /// `sqrt(mu w)` and `sigma / mu` at the nodes.
    root: Vec<f64>,
    depth: Vec<f64>,
}

impl Slab {
    /// Solves with polynomials of `order` coefficients on each panel, and `modes` Fourier modes.
    ///
    /// `None` where rounding leaves a matrix that is not positive, which no medium of a width above 1e-4 has shown.
    #[must_use]
    pub fn solve(medium: &dyn Medium, order: usize, modes: usize) -> Option<Slab> {
        let modes = modes.max(1);
        let panels = Panels::new(medium.width(), order);
        let (system, unbalance) = System::new(medium, &panels, modes);
        let n = panels.theta.len();
        let root = &system.root;
        let mut slab =
            Slab { panels, reflected: Vec::new(), transmitted: Vec::new(), multiple: Vec::new(), unbalance };
        for m in 0..modes {
            let mode = system.solve(m)?;
            if m == 0 {
                let over = |s: &Square| s.times(root).iter().zip(root).map(|(e, r)| e / r).collect();
                (slab.reflected, slab.transmitted) = (over(&mode.reflected), over(&mode.transmitted));
            }
            // both directions of a BRDF point away: azimuths differ by pi from those of travel
            let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
            let value = |i: usize, j: usize| {
                let rest = mode.reflected.row(i)[j] - mode.once.row(i)[j];
                sign * rest / (TAU * root[i] * root[j])
            };
            slab.multiple.push(Square::from_fn(n, value));
        }
        Some(slab)
    }

    /// The part of the light that is reflected: the directional albedo at a polar angle in [0, pi/2].
    #[must_use]
    pub fn reflected(&self, theta: f64) -> f64 {
        self.mean(theta, &self.reflected)
    }

    /// The part of the light that leaves on the far side.
    #[must_use]
    pub fn transmitted(&self, theta: f64) -> f64 {
        self.mean(theta, &self.transmitted)
    }

    fn mean(&self, theta: f64, values: &[f64]) -> f64 {
        let (first, factors) = self.panels.locate(theta);
        dot(&factors, &values[first..first + factors.len()])
    }

    /// Multiple scattering towards a view.
    #[must_use]
    pub fn multiple(&self, theta: f64) -> Multiple<'_> {
        let (first, factors) = self.panels.locate(theta);
        let row = |matrix: &Square| {
            let mut row = vec![0.0; matrix.order()];
            for (k, f) in factors.iter().enumerate() {
                row.iter_mut().zip(matrix.row(first + k)).for_each(|(r, m)| *r += f * m);
            }
            row
        };
        Multiple { panels: &self.panels, rows: self.multiple.iter().map(row).collect() }
    }

    /// Ends of the panels between which everything is smooth, rising from 0 to pi/2.
    #[must_use]
    pub fn edges(&self) -> &[f64] {
        &self.panels.edges
    }
}

impl Multiple<'_> {
    /// Fourier coefficients at an incident polar angle: `f = c_0 + 2 sum c_m cos(m phi)` in 1/sr, without the cosine, phi
    /// between the azimuths of the two directions, both of which point away from the slab.
    pub fn modes(&self, theta: f64, out: &mut Vec<f64>) {
        let (first, factors) = self.panels.locate(theta);
        out.clear();
        out.extend(self.rows.iter().map(|row| dot(&factors, &row[first..first + factors.len()])));
    }
}

impl System {
    fn new(medium: &dyn Medium, panels: &Panels, modes: usize) -> (System, f64) {
        let kernel = galerkin::assemble(medium, panels, modes);
        let mut extinction = galerkin::extinction(medium, panels);
        let (mut root, mut depth) = (Vec::new(), Vec::new());
        let mut unbalance = 0.0f64;
        for (i, (&theta, &width)) in panels.theta.iter().zip(&panels.width).enumerate() {
            let weight = width * libm::sin(theta);
            let gained =
                kernel.same[0].row(i).iter().sum::<f64>() + kernel.across[0].row(i).iter().sum::<f64>();
            let excess = gained - extinction.row(i).iter().sum::<f64>();
            // nothing is absorbed: what is scattered away arrives
            extinction.row_mut(i)[i] += excess;
            unbalance = unbalance.max((excess / weight).abs());
            root.push((libm::cos(theta) * weight).sqrt());
            depth.push(medium.extinction(theta) / libm::cos(theta));
        }
        (System { kernel, extinction, root, depth }, unbalance)
    }

    fn solve(&self, m: usize) -> Option<Mode> {
        let n = self.root.len();
        let (same, across) = (&self.kernel.same[m], &self.kernel.across[m]);
        let entry = |i: usize, j: usize, sign: f64| {
            let sum = self.extinction.row(i)[j] - same.row(i)[j] + sign * across.row(i)[j];
            sum / (self.root[i] * self.root[j])
        };
        let lower = Square::from_fn(n, |i, j| entry(i, j, 1.0)).cholesky(false)?;
        let other = Square::from_fn(n, |i, j| entry(i, j, -1.0)).cholesky(true)?;
        let mut vectors = other.transposed_times(&lower);
        vectors.orthogonalise();
        let (even, odd) = self.operators(&lower, vectors, m == 0)?;
        let reflected =
            Square::from_fn(n, |i, j| even.row(i)[j] + odd.row(i)[j] - if i == j { 1.0 } else { 0.0 });
        let transmitted = Square::from_fn(n, |i, j| even.row(i)[j] - odd.row(i)[j]);
        let once = Square::from_fn(n, |i, j| {
            let depth = self.depth[i] + self.depth[j];
            across.row(i)[j] / (self.root[i] * self.root[j]) * -libm::expm1(-depth) / depth
        });
        Some(Mode { reflected, transmitted, once })
    }

    /// `(1 + Z)^-1` for light that enters alike on both sides, and with opposite signs.
    ///
    /// In a conservative mode constant radiance is a solution: its singular value is 0, and its vector is known.
    fn operators(&self, lower: &Square, mut vectors: Square, conserves: bool) -> Option<(Square, Square)> {
        let n = self.root.len();
        let lengths: Vec<f64> = vectors.rows().map(|r| dot(r, r).sqrt()).collect();
        let least = (0..n).min_by(|&i, &j| lengths[i].total_cmp(&lengths[j]));
        let identity = Square::from_fn(n, |i, j| if i == j { 1.0 } else { 0.0 });
        let (mut even, mut odd) = (identity.clone(), identity);
        for (j, &k) in lengths.iter().enumerate() {
            let row = vectors.row_mut(j);
            if conserves && least == Some(j) {
                row.copy_from_slice(&self.root);
                lower.forward(row);
                let length = dot(row, row).sqrt();
                row.iter_mut().for_each(|x| *x /= length);
                lower.backward(row);
                odd.add_outer(2.0, row);
                continue;
            }
            if k <= 0.0 {
                return None;
            }
            row.iter_mut().for_each(|x| *x /= k);
            lower.backward(row);
            let tanh = libm::tanh(0.5 * k);
            even.add_outer(k * tanh, row);
            odd.add_outer(k / tanh, row);
        }
        Some((even.inverse_positive()?, odd.inverse_positive()?))
    }
}
