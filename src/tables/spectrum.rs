//! Integrals over the visible spectrum, to linear sRGB.
//!
//! The reflectances of metals and thin films are smooth between known wavelengths, but for waves; light and eye are tables of straight
//! pieces. Of daylight, each piece of 10 nm therefore has rules with light and eye in their weights: the reflectance at Gauss nodes is
//! interpolated, and what interpolates it is integrated against them without error, whatever their kinks. Orders rise until three agree.

use crate::integrate::stop::{Trust, climb_sure};
use crate::integrate::{Estimate, gauss};
use crate::terms::blackbody::{WYMAN_BREAKS, wyman_xyz, xyz_to_srgb};
use crate::terms::colour::{cie_xyz, d65};
use std::sync::OnceLock;

/// The rule of light that has its own spectrum in words, for metadata.
pub const RULE: &str =
    "Gauss-Legendre between the kinks of the eye, 360 to 830 nm, orders raised until three agree";

/// The rule of daylight.
pub const DAYLIGHT_RULE: &str = "interpolation at Gauss nodes of 10 nm, integrated against D65 and the CIE 1931 observer, 360 to 830 nm, orders raised until three agree";

/// Orders between two kinks.
const ORDERS: [usize; 10] = [1, 2, 3, 5, 8, 13, 21, 34, 55, 89];

/// Trust in them.
const TRUST: Trust = Trust { gain: &[0.5], memory: &[0.1] };

/// A wavelength in nm, and what unit reflectance there adds to red, green and blue.
type Node = (f64, [f64; 3]);

/// Light and eye.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Seen {
    /// D65 and the CIE 1931 observer, a perfect mirror being 1.
    Daylight,
    /// Unit light and the fit of Wyman and others.
    Fitted,
    /// Unit light and the CIE 1931 observer.
    Plain,
}

/// Nodes for each order.
#[derive(Debug)]
pub struct Spectrum {
    breaks: Vec<f64>,
    seen: Seen,
    /// Unit reflectance as it is seen.
    white: [f64; 3],
    levels: [OnceLock<Vec<Node>>; ORDERS.len()],
}

/// Light D65 seen by the CIE 1931 standard observer; unit reflectance is (1, 1, 1).
///
/// Source: [CIE11664-2](crate::cite::CIE_11664_2) Table B.1 in steps of 10 nm, [CIE11664-1](crate::cite::CIE_11664_1) Table 1 in steps of 1 nm.
pub fn daylight() -> &'static Spectrum {
    static MADE: OnceLock<Spectrum> = OnceLock::new();
    MADE.get_or_init(|| daylight_with([]))
}

/// [`daylight`] for reflectances that have kinks of their own, at wavelengths in nm.
pub fn daylight_with(kinks: impl IntoIterator<Item = f64>) -> Spectrum {
    let tens = (36..=83).map(|i| 10.0 * f64::from(i));
    let inside = kinks.into_iter().filter(|k| (360.0..830.0).contains(k));
    let mut spectrum = Spectrum::new(tens.chain(inside).collect(), Seen::Daylight);
    spectrum.white = sums(&spectrum.nodes(ORDERS[0]), &mut |_| 1.0);
    spectrum
}

/// Unit light seen by the fit of Wyman and others, not divided by its white: for sources that bring their own spectrum.
pub fn fitted() -> &'static Spectrum {
    static MADE: OnceLock<Spectrum> = OnceLock::new();
    MADE.get_or_init(|| Spectrum::new(WYMAN_BREAKS.to_vec(), Seen::Fitted))
}

/// The same seen by the CIE 1931 observer, whose kinks are at whole nm.
pub fn plain() -> &'static Spectrum {
    static MADE: OnceLock<Spectrum> = OnceLock::new();
    MADE.get_or_init(|| Spectrum::new((360..=830).map(f64::from).collect(), Seen::Plain))
}

impl Spectrum {
    fn new(mut breaks: Vec<f64>, seen: Seen) -> Spectrum {
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        Spectrum { breaks, seen, white: [1.0; 3], levels: [const { OnceLock::new() }; ORDERS.len()] }
    }

    /// Wavelengths and weights without eye and light.
    fn bare(&self, order: usize) -> impl Iterator<Item = (f64, f64)> {
        let rule = gauss::rule(order);
        self.breaks.windows(2).flat_map(move |pair| {
            let (from, length) = (pair[0], pair[1] - pair[0]);
            rule.nodes.iter().zip(&rule.weights).map(move |(x, w)| (from + length * x, length * w))
        })
    }

    /// The nodes of an order, not divided by the white.
    fn nodes(&self, order: usize) -> Vec<Node> {
        if self.seen != Seen::Daylight {
            let seen = |(lambda, w): (f64, f64)| (lambda, xyz_to_srgb(self.eye(lambda)).map(|v| w * v));
            return self.bare(order).map(seen).collect();
        }
        let nodes = &gauss::rule(order).nodes;
        let scales = barycentric(nodes);
        self.breaks.windows(2).flat_map(|pair| moments(pair[0], pair[1], nodes, &scales)).collect()
    }

    fn level(&self, j: usize) -> &[Node] {
        self.levels[j].get_or_init(|| {
            let mut nodes = self.nodes(ORDERS[j]);
            for (_, weight) in &mut nodes {
                for (w, white) in weight.iter_mut().zip(self.white) {
                    *w /= white;
                }
            }
            nodes
        })
    }

    /// The eye that sees it.
    fn eye(&self, lambda: f64) -> [f64; 3] {
        if self.seen == Seen::Fitted { wyman_xyz(lambda) } else { cie_xyz(lambda) }
    }

    /// Luminance `int f y dlambda` of a smooth spectrum over 360 to 830 nm, lambda in nm, by a high order.
    pub fn luminance(&self, f: &mut dyn FnMut(f64) -> f64) -> f64 {
        let order = if self.seen == Seen::Fitted { ORDERS[ORDERS.len() - 1] } else { 5 };
        self.bare(order).map(|(lambda, w)| w * f(lambda) * self.eye(lambda)[1]).sum()
    }

    /// Red, green and blue of a spectrum, each to `tolerance` (absolute), in the first three channels.
    ///
    /// The rounding of a spectrum is taken to be 1e-14 of unit light.
    pub fn colour(&self, tolerance: f64, f: &mut dyn FnMut(f64) -> f64) -> Estimate {
        climb_sure(TRUST, 0..ORDERS.len(), 3, tolerance, |j, level| {
            let nodes = self.level(j);
            level.count(nodes.len());
            level.panel(0)[..3].copy_from_slice(&sums(nodes, f));
            level.inner[..3].fill(1e-14);
        })
    }
}

/// `1 / prod (x_j - x_i)` over the other nodes: the scales of Lagrange's polynomials in the barycentric form.
fn barycentric(nodes: &[f64]) -> Vec<f64> {
    let others = |j: usize| nodes.iter().enumerate().filter(move |(i, _)| *i != j);
    // the capacity of [0, 1] is 1/4: times 4 the product neither over- nor underflows
    let one = |(j, x): (usize, &f64)| 1.0 / others(j).map(|(_, y)| 4.0 * (x - y)).product::<f64>();
    nodes.iter().enumerate().map(one).collect()
}

/// Nodes on [from, to], each with the integral of its Lagrange polynomial against daylight and eye, which have kinks at whole nm only.
fn moments(from: f64, to: f64, nodes: &[f64], scales: &[f64]) -> Vec<Node> {
    let length = to - from;
    let mut out: Vec<Node> = nodes.iter().map(|x| (from + length * x, [0.0; 3])).collect();
    // the polynomial, and two straight pieces
    let rule = gauss::rule(nodes.len() / 2 + 2);
    let mut lagrange = vec![0.0; nodes.len()];
    let mut low = from;
    while low < to {
        let high = (low.floor() + 1.0).min(to);
        for (x, w) in rule.nodes.iter().zip(&rule.weights) {
            let lambda = low + (high - low) * x;
            let light = (high - low) * w * d65(lambda);
            let seen = xyz_to_srgb(cie_xyz(lambda)).map(|v| light * v);
            lagrange_at(nodes, scales, (lambda - from) / length, &mut lagrange);
            for ((_, weight), l) in out.iter_mut().zip(&lagrange) {
                for (w, v) in weight.iter_mut().zip(seen) {
                    *w += l * v;
                }
            }
        }
        low = high;
    }
    out
}

/// Lagrange's polynomials at x.
fn lagrange_at(nodes: &[f64], scales: &[f64], x: f64, out: &mut [f64]) {
    if let Some(hit) = nodes.iter().position(|node| (x - node).abs() == 0.0) {
        out.fill(0.0);
        out[hit] = 1.0;
        return;
    }
    for ((o, node), scale) in out.iter_mut().zip(nodes).zip(scales) {
        *o = scale / (x - node);
    }
    let sum: f64 = out.iter().sum();
    for o in out {
        *o /= sum;
    }
}

fn sums(nodes: &[Node], f: &mut dyn FnMut(f64) -> f64) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (lambda, weight) in nodes {
        let value = f(*lambda);
        for (s, w) in sum.iter_mut().zip(weight) {
            *s += value * w;
        }
    }
    sum
}
