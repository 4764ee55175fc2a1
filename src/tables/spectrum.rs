//! Integrals over the visible spectrum, to linear sRGB.
//!
//! The light and the sensitivity of the eye are smooth but for kinks at known wavelengths, and the reflectances of thin
//! films wave: between two kinks Gauss rules of rising order, all made once, until three of them agree.

use crate::integrate::stop::{Trust, climb_sure};
use crate::integrate::{Estimate, gauss};
use crate::terms::blackbody::{WYMAN_BREAKS, wyman_xyz, xyz_to_srgb};
use crate::terms::metals;
use std::sync::OnceLock;

/// The rule in words, for metadata.
pub const RULE: &str =
    "Gauss-Legendre between the kinks of light and eye, 360 to 830 nm, orders raised until three agree";

/// Orders between two kinks.
const ORDERS: [usize; 10] = [1, 2, 3, 5, 8, 13, 21, 34, 55, 89];

/// Trust in them.
const TRUST: Trust = Trust { gain: &[0.5], memory: &[0.1] };

/// A wavelength in nm, and what unit reflectance there adds to red, green and blue.
type Node = (f64, [f64; 3]);

/// Nodes for each order.
#[derive(Debug)]
pub struct Spectrum {
    levels: Vec<Vec<Node>>,
    /// Wavelengths and weights of the highest order, without eye and light.
    finest: Vec<(f64, f64)>,
}

/// Light D65 seen by the standard observer; unit reflectance is (1, 1, 1).
///
/// Source: [CIE11664-2](crate::cite::CIE_11664_2) Table B.1 in steps of 10 nm, [Wyman2013](crate::cite::WYMAN_2013) Eq. 4.
pub fn daylight() -> &'static Spectrum {
    static MADE: OnceLock<Spectrum> = OnceLock::new();
    MADE.get_or_init(|| daylight_with([]))
}

/// [`daylight`] for reflectances that have kinks of their own, at wavelengths in nm.
pub fn daylight_with(kinks: impl IntoIterator<Item = f64>) -> Spectrum {
    let tens = (36..=83).map(|i| 10.0 * f64::from(i));
    let inside = kinks.into_iter().filter(|k| (360.0..830.0).contains(k));
    Spectrum::new(tens.chain(WYMAN_BREAKS).chain(inside).collect(), &|lambda| metals::d65(lambda), true)
}

/// Unit light, not divided by its white: for sources that bring their own spectrum.
pub fn plain() -> &'static Spectrum {
    static MADE: OnceLock<Spectrum> = OnceLock::new();
    MADE.get_or_init(|| Spectrum::new(WYMAN_BREAKS.to_vec(), &|_| 1.0, false))
}

impl Spectrum {
    fn new(mut breaks: Vec<f64>, light: &dyn Fn(f64) -> f64, white: bool) -> Spectrum {
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        let bare = |order: usize| -> Vec<(f64, f64)> {
            let rule = gauss::rule(order);
            let panel = |pair: &[f64]| -> Vec<(f64, f64)> {
                let (from, length) = (pair[0], pair[1] - pair[0]);
                rule.nodes.iter().zip(&rule.weights).map(|(x, w)| (from + length * x, length * w)).collect()
            };
            breaks.windows(2).flat_map(panel).collect()
        };
        let nodes = |order: usize| -> Vec<Node> {
            let seen = |(lambda, w): (f64, f64)| {
                (lambda, xyz_to_srgb(wyman_xyz(lambda)).map(|v| w * v * light(lambda)))
            };
            bare(order).into_iter().map(seen).collect()
        };
        let mut levels: Vec<Vec<Node>> = ORDERS.into_iter().map(nodes).collect();
        if white {
            let sum = sums(&levels[ORDERS.len() - 1], &mut |_| 1.0);
            for (_, weight) in levels.iter_mut().flatten() {
                for (w, s) in weight.iter_mut().zip(sum) {
                    *w /= s;
                }
            }
        }
        Spectrum { levels, finest: bare(ORDERS[ORDERS.len() - 1]) }
    }

    /// `int f dlambda` over 360 to 830 nm, lambda in nm, by the highest order.
    pub fn integral(&self, f: &mut dyn FnMut(f64) -> f64) -> f64 {
        self.finest.iter().map(|(lambda, w)| w * f(*lambda)).sum()
    }

    /// Red, green and blue of a spectrum, each to `tolerance` (absolute), in the first three channels.
    ///
    /// The rounding of a spectrum is taken to be 1e-14 of unit light.
    pub fn colour(&self, tolerance: f64, f: &mut dyn FnMut(f64) -> f64) -> Estimate {
        climb_sure(TRUST, 0..self.levels.len(), 3, tolerance, |j, level| {
            level.count(self.levels[j].len());
            level.panel(0)[..3].copy_from_slice(&sums(&self.levels[j], f));
            level.inner[..3].fill(1e-14);
        })
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
