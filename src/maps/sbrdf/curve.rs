//! Lobes of every roughness: a metallic-roughness texel has few parameters, so the fit is made once along the roughness and read between.
//!
//! What such a texel reflects is linear in its colours: with s = (1 − v·h)⁵ and GGX's D V,
//! f = F0 · D V (1 − s) + D V s + c (1 − F0) (1 − s)/π, F0 and c (the diffuse colour) of glTF 2.0 Appendix B. Albedos are fitted to each of the
//! three terms; the shapes follow their mixture for the mean colour of the map. Nodes lie evenly along the roughness, each begun from
//! the one before, from the smoothest on. Between nodes ψ, ln n and the albedos are read linearly; what that costs is measured half way
//! between the nodes and is part of every residual. Of two widths the nodes are a grid: [`STRETCHED`] roughnesses, and as many strengths of the
//! anisotropy of glTF, each begun from the one before.

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

/// Nodes along the roughness and along the strength, of two widths.
pub const STRETCHED: [usize; 2] = [9, 5];

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
    terms(&Lobe::isotropic(DVec3::Z, alpha), Directions::new(alpha), mean, normalise)
}

/// The same of two widths, the larger one along x: α_max = α_min + (1 − α_min) strength².
#[must_use]
pub fn stretched(roughness: f64, strength: f64, mean: [f64; TERMS], normalise: Normalise) -> Problem {
    let alpha_min = (roughness * roughness).max(LEAST_ALPHA);
    let alpha_max = alpha_min + (1.0 - alpha_min) * strength * strength;
    let lobe = Lobe { normal: DVec3::Z, alpha_max, alpha_min, angle: 0.0 };
    terms(&lobe, Directions::stretched([alpha_max, alpha_min]), mean, normalise)
}

fn terms(lobe: &Lobe, directions: Directions, mean: [f64; TERMS], normalise: Normalise) -> Problem {
    let lobe = Prepared::new(lobe);
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

/// Nodes along a range.
#[derive(Debug, Clone, Copy)]
struct Along {
    range: [f64; 2],
    nodes: usize,
}

impl Along {
    fn at(self, place: f64) -> f64 {
        self.range[0] + (self.range[1] - self.range[0]) * place / (self.nodes.max(2) - 1) as f64
    }

    fn node(self, m: usize) -> f64 {
        self.at(m as f64)
    }

    /// Where the fit of a node of the roughness begins, and for how many steps: at the fit of the node before.
    fn begin(self, m: usize, before: Option<&Vec<Shape>>, lobes: usize) -> (Vec<Shape>, usize) {
        let alpha = |m: usize| (self.node(m) * self.node(m)).max(LEAST_ALPHA);
        match before {
            None => (start(alpha(m), lobes.clamp(1, MOST_LOBES)), STEPS[0]),
            Some(last) => {
                let sharper = 2.0 * libm::log(alpha(m - 1) / alpha(m));
                (last.iter().map(|s| Shape { log: s.log + sharper, ..*s }).collect(), STEPS[1])
            }
        }
    }
}

/// Fits along the roughness, and of two widths along the strength too.
#[derive(Debug, Clone)]
pub struct Curve {
    range: [f64; 2],
    /// Largest strength; 0 of one width.
    strength: f64,
    /// Nodes along the roughness.
    across: usize,
    /// `[strength][roughness]`.
    fits: Vec<Fit>,
    /// Most that reading between nodes adds to a residual.
    pub between: f64,
    /// What it adds behind each node, `[strength][roughness]`, of cells.
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
        let at = Along { range, nodes: if range[1] > range[0] { NODES } else { 1 } };
        let problems: Vec<Problem> =
            (0..at.nodes).into_par_iter().map(|m| problem(at.node(m), mean, normalise)).collect();
        let mut shapes: Vec<Vec<Shape>> = Vec::with_capacity(at.nodes);
        for (m, problem) in problems.iter().enumerate() {
            cancel.check()?;
            let (first, steps) = at.begin(m, shapes.last(), lobes);
            shapes.push(problem.descend(&first, steps));
        }
        let fits = problems.par_iter().zip(&shapes).map(|(p, s)| p.finish(s)).collect();
        let curve =
            Curve { range, strength: 0.0, across: at.nodes, fits, between: 0.0, lost: Vec::new(), mean };
        Ok(curve.judged(|r, _| problem(r, mean, normalise)))
    }

    /// The same of two widths, for strengths up to `strength`: see [`stretched`].
    ///
    /// # Errors
    /// [`Cancelled`].
    pub fn stretched(
        range: [f64; 2],
        strength: f64,
        mean: [f64; TERMS],
        lobes: usize,
        normalise: Normalise,
        cancel: &Cancel,
    ) -> Result<Curve, Cancelled> {
        let at = Along { range, nodes: if range[1] > range[0] { STRETCHED[0] } else { 1 } };
        let up = Along { range: [0.0, strength], nodes: if strength > 0.0 { STRETCHED[1] } else { 1 } };
        let make = |m: usize, k: usize| stretched(at.node(m), up.node(k), mean, normalise);
        let mut shapes: Vec<Vec<Shape>> = Vec::with_capacity(at.nodes);
        for m in 0..at.nodes {
            cancel.check()?;
            let (first, steps) = at.begin(m, shapes.last(), lobes);
            shapes.push(make(m, 0).descend(&first, steps));
        }
        // each roughness goes up along the strength by itself
        let column = |m: usize| -> Result<Vec<Fit>, Cancelled> {
            let mut own = shapes[m].clone();
            let mut fits = Vec::with_capacity(up.nodes);
            for k in 0..up.nodes {
                cancel.check()?;
                let problem = make(m, k);
                own = problem.descend(&own, STEPS[1]);
                fits.push(problem.finish(&own));
            }
            Ok(fits)
        };
        let columns: Vec<Vec<Fit>> = (0..at.nodes).into_par_iter().map(column).collect::<Result<_, _>>()?;
        let fits = (0..up.nodes).flat_map(|k| columns.iter().map(move |c| c[k].clone())).collect();
        let curve = Curve { range, strength, across: at.nodes, fits, between: 0.0, lost: Vec::new(), mean };
        Ok(curve.judged(|r, s| stretched(r, s, mean, normalise)))
    }

    /// With what reading between nodes costs, in the middle of every cell.
    fn judged(mut self, problem: impl Fn(f64, f64) -> Problem + Sync) -> Curve {
        let (across, up) = self.cells();
        let along = Along { range: self.range, nodes: self.across };
        let strengths = Along { range: [0.0, self.strength], nodes: self.fits.len() / self.across };
        let lost = |cell: usize| {
            let half = |count: usize, n: usize| if count > 0 { n as f64 + 0.5 } else { 0.0 };
            let (m, k) = (cell % across.max(1), cell / across.max(1));
            let (r, s) = (along.at(half(across, m)), strengths.at(half(up, k)));
            let (shapes, albedos, told) = self.read([r, s], &self.mean);
            problem(r, s).residual(&shapes, &albedos, &self.mean) - told
        };
        let count = if across + up > 0 { across.max(1) * up.max(1) } else { 0 };
        let lost: Vec<f64> = (0..count).into_par_iter().map(lost).map(|l| l.max(0.0)).collect();
        self.between = lost.iter().copied().fold(0.0, f64::max);
        self.lost = lost;
        self
    }

    /// Cells along the roughness and along the strength.
    fn cells(&self) -> (usize, usize) {
        (self.across - 1, self.fits.len() / self.across - 1)
    }

    /// How many lobes there are.
    #[must_use]
    pub fn lobes(&self) -> usize {
        self.fits.first().map_or(0, |f| f.shapes.len())
    }

    /// The node before a roughness and a strength, and how far it is to the next ones.
    fn place(&self, [roughness, strength]: [f64; 2]) -> ([usize; 2], [f64; 2]) {
        let (across, up) = self.cells();
        let part =
            |v: f64, [lo, hi]: [f64; 2]| if hi > lo { ((v - lo) / (hi - lo)).clamp(0.0, 1.0) } else { 0.0 };
        let places =
            [part(roughness, self.range) * across as f64, part(strength, [0.0, self.strength]) * up as f64];
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the nodes")]
        let node = |v: f64, last: usize| (v as usize).min(last.saturating_sub(1));
        let (m, k) = (node(places[0], across), node(places[1], up));
        ([m, k], [places[0] - m as f64, places[1] - k as f64])
    }

    /// The fits at the corners of a cell: those of one strength, then those of the next.
    fn corners(&self, [m, k]: [usize; 2]) -> [&Fit; 4] {
        let (across, up) = self.cells();
        let fit = |m: usize, k: usize| &self.fits[k.min(up) * self.across + m.min(across)];
        [fit(m, k), fit(m + 1, k), fit(m, k + 1), fit(m + 1, k + 1)]
    }

    /// Shapes, albedos and residual of a mixture of the terms.
    fn read(&self, place: [f64; 2], mixture: &[f64; TERMS]) -> (Vec<Shape>, Vec<f64>, f64) {
        let (cell, [t, u]) = self.place(place);
        let fits = self.corners(cell);
        let line = |x: f64, y: f64, t: f64| x + (y - x) * t;
        let mix = |v: [f64; 4]| line(line(v[0], v[1], t), line(v[2], v[3], t), u);
        let shape = |j: usize| {
            let of = |part: fn(&Shape) -> f64| mix(fits.map(|f| part(&f.shapes[j])));
            Shape { angle: of(|s| s.angle), log: of(|s| s.log), turn: of(|s| s.turn) }
        };
        let albedo =
            |fit: &Fit, j: usize| fit.albedos.iter().zip(mixture).map(|(w, m)| w[j] * m).sum::<f64>();
        let count = fits[0].shapes.len();
        let albedos = (0..=count).map(|j| mix(fits.map(|f| albedo(f, j)))).collect();
        let residual = mix(fits.map(|f| f.relative(mixture)));
        ((0..count).map(shape).collect(), albedos, residual)
    }

    /// The lobes of a texel of one width, by F0 and diffuse colour.
    #[must_use]
    pub fn texel(&self, roughness: f64, f0: [f64; 3], diffuse: [f64; 3]) -> Texel {
        self.texel_of([roughness, 0.0], f0, diffuse)
    }

    /// The lobes of a texel of a roughness and a strength.
    #[must_use]
    pub fn texel_of(&self, place: [f64; 2], f0: [f64; 3], diffuse: [f64; 3]) -> Texel {
        let channels = [0, 1, 2].map(|c| self.read(place, &mixture(f0[c], diffuse[c])));
        let ([m, k], [t, u]) = self.place(place);
        let fits = self.corners([m, k]);
        let lobe = |j: usize| {
            let [a, b, c, d] = fits.map(|f| f.constants[j]);
            let (first, second) = (a * libm::pow(b / a, t), c * libm::pow(d / c, t));
            Placed {
                lobe: channels[0].0[j].lobe(),
                albedo: [0, 1, 2].map(|c| channels[c].1[j + 1]),
                constant: first * libm::pow(second / first, u),
            }
        };
        let mut lobes: Vec<Placed> = (0..self.lobes()).map(lobe).collect();
        sort(&mut lobes);
        let cells = self.cells();
        let lost =
            if t + u > 0.0 { self.lost.get(k * cells.0.max(1) + m).copied().unwrap_or(0.0) } else { 0.0 };
        let residual = channels.iter().map(|c| c.2).fold(0.0, f64::max) + lost;
        Texel { diffuse: [0, 1, 2].map(|c| channels[c].1[0]), lobes, residual }
    }

    /// The largest residual over the nodes, for the mixture of the shapes.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.fits.iter().map(|f| f.relative(&self.mean)).fold(0.0, f64::max) + self.between
    }
}

/// The lobes of a fit of three targets, red, green and blue.
#[must_use]
pub fn placed(fit: &Fit) -> Texel {
    let lobe = |j: usize| Placed {
        lobe: fit.shapes[j].lobe(),
        albedo: [0, 1, 2].map(|c| fit.albedos[c][j + 1]),
        constant: fit.constants[j],
    };
    let mut lobes: Vec<Placed> = (0..fit.shapes.len()).map(lobe).collect();
    sort(&mut lobes);
    Texel { diffuse: [0, 1, 2].map(|c| fit.albedos[c][0]), lobes, residual: fit.all() }
}

/// Sorts lobes by falling albedo, that of green counting most as in luminance.
pub fn sort(lobes: &mut [Placed]) {
    let bright = |a: &[f64; 3]| 0.2126 * a[0] + 0.7152 * a[1] + 0.0722 * a[2];
    lobes.sort_by(|a, b| bright(&b.albedo).total_cmp(&bright(&a.albedo)));
}
