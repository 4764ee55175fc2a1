//! Lobes of every roughness: a metallic-roughness texel has few parameters, so the fit is made once along the roughness and read between.
//!
//! What such a texel reflects is linear in its colours: with s = (1 − v·h)⁵ and GGX's D V,
//! f = F0 · D V (1 − s) + D V s + c (1 − F0) (1 − s)/π, F0 and c (the diffuse colour) of glTF 2.0 Appendix B. Albedos are fitted to each of the
//! three terms; the shapes follow their mixture for the mean colour of the map. Nodes lie evenly along the roughness, each begun from
//! the one before, from the smoothest on. Between nodes ψ, ln n and the albedos are read linearly; what that costs is measured half way
//! between the nodes and is part of every residual.

use super::super::lobe::{LEAST_ALPHA, Lobe};
use super::super::reflected::{Prepared, reflected};
use super::fit::{Fit, Problem, Shape, start};
use super::nodes::Directions;
use super::{CosineLobe, MOST_LOBES, Normalise};
use crate::cancel::{Cancel, Cancelled};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::FRAC_1_PI;

/// Terms of a metallic-roughness texel.
pub const TERMS: usize = 3;

/// Nodes along the roughness.
pub const NODES: usize = 33;

/// Steps of a fit that begins from nothing, and from its neighbour.
const STEPS: [usize; 2] = [60, 25];

/// The factors of the three terms for one channel.
#[must_use]
pub fn mixture(f0: f64, diffuse: f64) -> [f64; TERMS] {
    [f0, 1.0, diffuse * (1.0 - f0)]
}

/// The terms of a roughness r = √α, times the cosine of the viewer, on directions of its own width.
#[must_use]
pub fn problem(roughness: f64, mean: [f64; TERMS], normalise: Normalise) -> Problem {
    let alpha = (roughness * roughness).max(LEAST_ALPHA);
    let directions = Directions::new(alpha);
    let lobe = Prepared::new(&Lobe::isotropic(DVec3::Z, alpha));
    let schlick = |i: DVec3, o: DVec3| {
        let x = 1.0 - i.dot((i + o).normalize());
        x * x * x * x * x
    };
    let targets = [
        directions.sample(|i, o| reflected(&lobe, i, o) * (1.0 - schlick(i, o))),
        directions.sample(|i, o| reflected(&lobe, i, o) * schlick(i, o)),
        directions.sample(|i, o| FRAC_1_PI * o.z * (1.0 - schlick(i, o))),
    ]
    .map(|t| t.into_iter().map(Some).collect());
    Problem::new(directions, &targets, &mean, normalise)
}

/// Fits along the roughness.
#[derive(Debug, Clone)]
pub struct Curve {
    range: [f64; 2],
    fits: Vec<Fit>,
    /// Most that reading between nodes adds to a residual.
    pub between: f64,
    /// What it adds behind each node.
    lost: Vec<f64>,
    /// The mixture that the shapes were fitted to.
    pub mean: [f64; TERMS],
}

/// A lobe of a texel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed {
    /// Its shape.
    pub lobe: CosineLobe,
    /// Its albedo.
    pub albedo: [f64; 3],
    /// One over its largest integral, if it is divided by that; else 1.
    pub constant: f64,
}

/// Lobes of a texel: shapes by falling albedo, and for each the albedos of its channels.
#[derive(Debug, Clone, PartialEq)]
pub struct Texel {
    /// Diffuse albedo.
    pub diffuse: [f64; 3],
    /// Lobes by falling albedo.
    pub lobes: Vec<Placed>,
    /// Relative residual, what reading between nodes costs included.
    pub residual: f64,
}

impl Curve {
    /// Fits `lobes` lobes for roughnesses of a range, the shapes to the mixture `mean`.
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn new(
        range: [f64; 2],
        mean: [f64; TERMS],
        lobes: usize,
        normalise: Normalise,
        cancel: &Cancel,
    ) -> Result<Curve, Cancelled> {
        let count = if range[1] > range[0] { NODES } else { 1 };
        let at = |m: f64| range[0] + (range[1] - range[0]) * m / (count.max(2) - 1) as f64;
        let problems: Vec<Problem> =
            (0..count).into_par_iter().map(|m| problem(at(m as f64), mean, normalise)).collect();
        let mut shapes: Vec<Vec<Shape>> = Vec::with_capacity(count);
        for (m, problem) in problems.iter().enumerate() {
            cancel.check()?;
            let alpha = |m: usize| (at(m as f64) * at(m as f64)).max(LEAST_ALPHA);
            let (first, steps) = match shapes.last() {
                None => (start(alpha(m), lobes.clamp(1, MOST_LOBES)), STEPS[0]),
                Some(last) => {
                    let sharper = 2.0 * libm::log(alpha(m - 1) / alpha(m));
                    (last.iter().map(|s| Shape { log: s.log + sharper, ..*s }).collect(), STEPS[1])
                }
            };
            shapes.push(problem.descend(&first, steps));
        }
        let fits: Vec<Fit> = problems.par_iter().zip(&shapes).map(|(p, s)| p.finish(s)).collect();
        let mut curve = Curve { range, fits, between: 0.0, lost: Vec::new(), mean };
        let lost = |m: usize| {
            let r = at(m as f64 + 0.5);
            let (shapes, albedos, told) = curve.read(r, &mean);
            problem(r, mean, normalise).residual(&shapes, &albedos, &mean) - told
        };
        let lost: Vec<f64> = (0..count - 1).into_par_iter().map(lost).map(|l| l.max(0.0)).collect();
        curve.between = lost.iter().copied().fold(0.0, f64::max);
        curve.lost = lost;
        Ok(curve)
    }

    /// How many lobes there are.
    #[must_use]
    pub fn lobes(&self) -> usize {
        self.fits.first().map_or(0, |f| f.shapes.len())
    }

    /// The node before a roughness, and how far it is to the next one.
    fn place(&self, roughness: f64) -> (usize, f64) {
        let [lo, hi] = self.range;
        let last = self.fits.len() - 1;
        let place = if hi > lo { ((roughness - lo) / (hi - lo)).clamp(0.0, 1.0) * last as f64 } else { 0.0 };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the nodes")]
        let m = (place as usize).min(last.saturating_sub(1));
        (m, place - m as f64)
    }

    /// Shapes, albedos and residual of a mixture of the terms.
    fn read(&self, roughness: f64, mixture: &[f64; TERMS]) -> (Vec<Shape>, Vec<f64>, f64) {
        let (m, t) = self.place(roughness);
        let (a, b) = (&self.fits[m], &self.fits[(m + 1).min(self.fits.len() - 1)]);
        let mix = |x: f64, y: f64| x + (y - x) * t;
        let shape = |(a, b): (&Shape, &Shape)| Shape { angle: mix(a.angle, b.angle), log: mix(a.log, b.log) };
        let albedo =
            |fit: &Fit, j: usize| fit.albedos.iter().zip(mixture).map(|(w, m)| w[j] * m).sum::<f64>();
        let albedos = (0..=a.shapes.len()).map(|j| mix(albedo(a, j), albedo(b, j))).collect();
        let residual = mix(a.relative(mixture), b.relative(mixture));
        (a.shapes.iter().zip(&b.shapes).map(shape).collect(), albedos, residual)
    }

    /// The lobes of a texel, by F0 and diffuse colour.
    #[must_use]
    pub fn texel(&self, roughness: f64, f0: [f64; 3], diffuse: [f64; 3]) -> Texel {
        let channels = [0, 1, 2].map(|c| self.read(roughness, &mixture(f0[c], diffuse[c])));
        let (m, t) = self.place(roughness);
        let (a, b) = (&self.fits[m].constants, &self.fits[(m + 1).min(self.fits.len() - 1)].constants);
        let lobe = |j: usize| Placed {
            lobe: channels[0].0[j].lobe(),
            albedo: [0, 1, 2].map(|c| channels[c].1[j + 1]),
            constant: a[j] * libm::pow(b[j] / a[j], t),
        };
        let mut lobes: Vec<Placed> = (0..self.lobes()).map(lobe).collect();
        sort(&mut lobes);
        let lost = if t > 0.0 { self.lost.get(m).copied().unwrap_or(0.0) } else { 0.0 };
        let residual = channels.iter().map(|c| c.2).fold(0.0, f64::max) + lost;
        Texel { diffuse: [0, 1, 2].map(|c| channels[c].1[0]), lobes, residual }
    }

    /// The largest residual over the nodes, for the mixture of the shapes.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.fits.iter().map(|f| f.relative(&self.mean)).fold(0.0, f64::max) + self.between
    }
}

/// Sorts lobes by falling albedo, that of green counting most as in luminance.
pub fn sort(lobes: &mut [Placed]) {
    let bright = |a: &[f64; 3]| 0.2126 * a[0] + 0.7152 * a[1] + 0.0722 * a[2];
    lobes.sort_by(|a, b| bright(&b.albedo).total_cmp(&bright(&a.albedo)));
}
