//! The one lobe that is nearest to a footprint.
//!
//! Nearest means least D, half the integral of the absolute difference of the two densities over the upper hemisphere
//! (0 the same, 1 disjoint). GGX has no variance, so that rules which add variances miss it: on a twentieth of scratches
//! they are three times worse than doing nothing. The integral is that of `nodes`.
//!
//! The search begins at two places: a robust mean of the slopes (facets count less the farther they lie, as in the likelihood of
//! Student's t, of which GGX is a case), and the densest facet; it goes down from the better one, or both. It ends on
//! finer nodes about what was found.

use super::descent::{self, Cost, Point};
use super::footprint::Footprint;
use super::lobe::{self, Facet, LEAST_ALPHA, Lobe};
use super::nodes::{Lattice, Local, Nodes};
use super::two::Wide;
use glam::{DMat2, DVec2, DVec3};

/// Where the normal of the lobe comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Centre {
    /// The normalised mean of the unit normals, which existing mips of a normal map hold.
    Mean,
    /// Fitted, and to be written with the lobe.
    Free,
}

/// How many widths the lobe has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// One.
    Isotropic,
    /// Two, and a direction.
    Anisotropic,
    /// One of each of two lobes: see [`two`](super::two).
    Two,
}

/// How much work is spent on a texel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Some tens of microseconds.
    Fast,
    /// The reference: every facet, 16384 nodes, every start.
    Exact,
}

/// A lobe with what is known of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitted {
    /// The lobe; of two the narrow one.
    pub lobe: Lobe,
    /// The wide one beside it, where two were asked for.
    pub wide: Option<Wide>,
    /// D between it and the footprint, as the nodes tell.
    pub distance: f64,
    /// How far the nodes may be wrong about D.
    pub doubt: f64,
    /// True if a wider lobe than α = 1 would be nearer.
    pub at_limit: bool,
}

/// Buffers and lattices of the fit: one a thread.
#[derive(Debug, Clone)]
pub struct Fitter {
    pub(super) nodes: Nodes,
    coarse: Lattice,
    /// Of the scan of `round`, and of its end.
    pub(super) scan: Lattice,
    pub(super) middle: Lattice,
    /// Of 256 nodes and more, each twice as many as the one before.
    pub(super) fine: Vec<Lattice>,
    pub(super) effort: Effort,
}

/// The variables of a descent: logarithms of the widths against those of the start, shear, slopes of the normal.
struct Problem<'a> {
    nodes: &'a Nodes,
    base: [DVec3; 3],
    /// Widths at the start.
    start: [f64; 2],
    centre: Centre,
    shape: Shape,
    mass: f64,
    least: f64,
}

impl Problem<'_> {
    /// Variables of the shape.
    const fn widths(&self) -> usize {
        match self.shape {
            Shape::Isotropic | Shape::Two => 1,
            Shape::Anisotropic => 3,
        }
    }

    fn local(&self, p: &Point) -> Local {
        let [a, b] = self.start;
        let shape = match self.shape {
            Shape::Isotropic | Shape::Two => {
                let l = libm::exp(p[0]) / a;
                [l, 0.0, l]
            }
            Shape::Anisotropic => [libm::exp(p[0]) / a, p[2] / b, libm::exp(p[1]) / b],
        };
        let axes = match self.centre {
            Centre::Mean => [DVec3::X, DVec3::Y, DVec3::Z],
            Centre::Free => {
                let k = self.widths();
                lobe::about(DVec3::new(a * p[k], b * p[k + 1], 1.0).normalize(), DVec3::X)
            }
        };
        Local { axes, shape }
    }

    fn lobe(&self, p: &Point) -> Lobe {
        let Local { axes, shape: [l1, l2, l3] } = self.local(p);
        let out = axes.map(|v| self.base[0] * v.x + self.base[1] * v.y + self.base[2] * v.z);
        // the inverse of LᵀL holds the squared widths in the axes of the fit; turn it into the frame of shaders
        let inverse = DMat2::from_cols(DVec2::new(1.0 / l1, 0.0), DVec2::new(-l2 / (l1 * l3), 1.0 / l3));
        let square = inverse * inverse.transpose();
        let frame = lobe::frame(out[2]);
        let turn = DMat2::from_cols(
            DVec2::new(frame[0].dot(out[0]), frame[1].dot(out[0])),
            DVec2::new(frame[0].dot(out[1]), frame[1].dot(out[1])),
        );
        Lobe::from_square(out[2], turn * square * turn.transpose())
    }

    fn turns(&self, local: &Local) -> super::nodes::Overlap {
        match self.centre {
            Centre::Mean => self.nodes.overlap::<false>(local),
            Centre::Free => self.nodes.overlap::<true>(local),
        }
    }

    /// D with its doubt.
    fn distance(&self, p: &Point) -> (f64, f64) {
        let overlap = self.turns(&self.local(p));
        (0.5 * (self.mass + self.lobe(p).mass()) - overlap.value, overlap.doubt)
    }
}

/// Step of a difference in place of a derivative, where only scalars depend on it.
const STEP: f64 = 1e-4;

impl Cost for Problem<'_> {
    fn variables(&self) -> usize {
        self.widths() + if self.centre == Centre::Free { 2 } else { 0 }
    }

    fn value(&self, at: &Point) -> (f64, Point) {
        let local = self.local(at);
        let overlap = self.turns(&local);
        let (d, [l1, _, l3]) = (overlap.shape, local.shape);
        let mut slope = [0.0; descent::MOST];
        match self.shape {
            Shape::Isotropic | Shape::Two => slope[0] = -(d[0] + d[2]) * l1,
            Shape::Anisotropic => {
                (slope[0], slope[1], slope[2]) = (-d[0] * l1, -d[2] * l3, -d[1] / self.start[1]);
            }
        }
        let n = self.variables();
        for k in self.widths()..n {
            let mut near = *at;
            near[k] += STEP;
            let [t, b, n] = self.local(&near).axes;
            let old = local.axes;
            // the turn of the axes; what stands still turns the other way against them
            let turn = [b.dot(old[2]), n.dot(old[0]), t.dot(old[1])].map(|w| w / STEP);
            slope[k] = turn.iter().zip(overlap.turn).map(|(w, r)| w * r).sum();
        }
        let mass = self.lobe(at).mass();
        if mass < 1.0 - 1e-6 {
            for (k, s) in slope.iter_mut().enumerate().take(n) {
                let mut near = *at;
                near[k] += STEP;
                *s += 0.5 * (self.lobe(&near).mass() - mass) / STEP;
            }
        }
        (0.5 * (self.mass + mass) - overlap.value, slope)
    }

    fn hold(&self, mut at: Point) -> Point {
        if self.shape != Shape::Anisotropic {
            let a = self.start[0];
            at[0] = at[0].min(libm::log(a / self.least)).max(libm::log(a));
        }
        at
    }
}

/// A place to begin: a lobe, whose axes are those of the nodes.
type Start = Lobe;

impl Fitter {
    /// Lattices for this effort.
    #[must_use]
    pub fn new(effort: Effort) -> Fitter {
        let (coarse, fine) = match effort {
            Effort::Fast => (64, vec![256, 512, 1024, 2048]),
            Effort::Exact => (1024, vec![16384]),
        };
        let fine = fine.into_iter().map(Lattice::new).collect();
        let (scan, middle) = (Lattice::new(48), Lattice::new(192));
        Fitter { nodes: Nodes::default(), coarse: Lattice::new(coarse), scan, middle, fine, effort }
    }

    /// The nearest lobe. A constant footprint is its own answer, to the bit.
    #[must_use]
    pub fn fit(&mut self, footprint: &Footprint, centre: Centre, shape: Shape) -> Fitted {
        let round = |f: &&Facet| shape == Shape::Anisotropic || f.is_round();
        if footprint.is_constant()
            && let Some(f) = footprint.facets.first().filter(round)
        {
            let lobe = match shape {
                Shape::Anisotropic => f.lobe(),
                Shape::Isotropic | Shape::Two => Lobe::isotropic(f.normal, f.alpha),
            };
            let wide = (shape == Shape::Two).then_some(Wide { alpha: f.alpha, share: 0.0 });
            return Fitted { lobe, wide, distance: 0.0, doubt: 0.0, at_limit: false };
        }
        let wide: Vec<Facet> = footprint.facets.iter().map(|f| f.wide(LEAST_ALPHA)).collect();
        let least = footprint.least.max(LEAST_ALPHA);
        if shape == Shape::Two {
            let single = self.fit(footprint, centre, Shape::Isotropic);
            return self.two(footprint, &wide, single, centre);
        }
        if self.effort == Effort::Fast && (centre, shape) == (Centre::Mean, Shape::Isotropic) {
            return self.round(footprint, &wide, least);
        }
        let starts = self.starts(footprint, &wide, least, centre, shape);
        let mut best: Option<(Lobe, f64)> = None;
        for start in starts {
            let charts = [1.6, 0.7].map(|k| [k * start.alpha_max, k * start.alpha_min]);
            let (lobe, distance, ..) =
                self.descend(&start, &charts, footprint, &wide, (centre, shape), 0, 10);
            if best.is_none_or(|(_, d)| distance < d) {
                best = Some((lobe, distance));
            }
        }
        let mut lobe = best.map_or(Lobe::isotropic(footprint.normal(), least), |b| b.0);
        let rounds = if self.effort == Effort::Exact { 3 } else { 1 };
        let mut fitted = None;
        for _ in 0..rounds {
            let start = lobe.within(least, 1.0);
            let chart = [[start.alpha_max, start.alpha_min]];
            let lattice = 1 + self.level((start.alpha_max * start.alpha_min).sqrt() / least);
            let found = self.descend(&start, &chart, footprint, &wide, (centre, shape), lattice, 12);
            lobe = found.0;
            fitted = Some(found);
        }
        let (lobe, distance, doubt, at_limit) = fitted.unwrap_or((lobe, 1.0, 1.0, true));
        Fitted { lobe, wide: None, distance, doubt: doubt + footprint.merge_error, at_limit }
    }

    /// Which lattice: more nodes where narrow facets stand apart under a wide lobe.
    pub(super) fn level(&self, ratio: f64) -> usize {
        let wanted = [4.0, 6.0, 9.0].iter().filter(|limit| ratio > **limit).count();
        wanted.min(self.fine.len() - 1)
    }

    /// Goes down from a start on the nodes of these charts; `lattice` 0 is the coarse one.
    #[allow(clippy::too_many_arguments, reason = "one step of `fit`, which holds them all")]
    fn descend(
        &mut self,
        start: &Start,
        charts: &[[f64; 2]],
        footprint: &Footprint,
        facets: &[Facet],
        (centre, shape): (Centre, Shape),
        lattice: usize,
        steps: usize,
    ) -> (Lobe, f64, f64, bool) {
        let base = start.axes();
        let coarse = lattice == 0;
        let lattice = lattice.checked_sub(1).map_or(&self.coarse, |i| &self.fine[i]);
        self.nodes.place(&base, charts, lattice, facets);
        let least = footprint.least.max(LEAST_ALPHA);
        let widths = [start.alpha_max, start.alpha_min];
        let problem =
            Problem { nodes: &self.nodes, base, start: widths, centre, shape, mass: footprint.mass, least };
        let enough = match (self.effort, coarse) {
            (Effort::Exact, _) => 0.0,
            (Effort::Fast, true) => 1e-2,
            (Effort::Fast, false) => 2e-3,
        };
        let (at, mut distance) = descent::descend(&problem, [0.0; descent::MOST], steps, enough);
        let free = problem.lobe(&at);
        let mut doubt = problem.distance(&at).1;
        let lobe = free.within(least, 1.0);
        let edge = 1.0 - 1e-9;
        let at_limit = free.alpha_max >= edge;
        if lobe != free {
            (distance, doubt) = self.judge(&lobe, footprint, facets, steps);
        }
        (lobe, distance, doubt, at_limit)
    }

    /// D of a given lobe, with its doubt, on nodes of its own.
    fn judge(&mut self, lobe: &Lobe, footprint: &Footprint, facets: &[Facet], steps: usize) -> (f64, f64) {
        let lattice = if steps == 0 { &self.coarse } else { &self.fine[0] };
        let base = lobe.axes();
        let widths = [lobe.alpha_max, lobe.alpha_min];
        self.nodes.place(&base, &[widths], lattice, facets);
        let shape = [1.0 / widths[0], 0.0, 1.0 / widths[1]];
        let overlap = self.nodes.overlap::<false>(&Local { axes: [DVec3::X, DVec3::Y, DVec3::Z], shape });
        (0.5 * (footprint.mass + lobe.mass()) - overlap.value, overlap.doubt)
    }

    /// D between a lobe and a footprint, with its doubt.
    #[must_use]
    pub fn distance(&mut self, lobe: &Lobe, footprint: &Footprint) -> (f64, f64) {
        let wide: Vec<Facet> = footprint.facets.iter().map(|f| f.wide(LEAST_ALPHA)).collect();
        let (distance, doubt) = self.judge(&lobe.within(LEAST_ALPHA, f64::MAX), footprint, &wide, 1);
        (distance, doubt + footprint.merge_error)
    }

    /// Where to begin: the better start, and the other one if it is not much worse.
    fn starts(
        &mut self,
        footprint: &Footprint,
        facets: &[Facet],
        least: f64,
        centre: Centre,
        shape: Shape,
    ) -> Vec<Start> {
        let round = |lobe: Lobe| match shape {
            Shape::Anisotropic => lobe.within(least, 1.0),
            Shape::Isotropic | Shape::Two => {
                Lobe::isotropic(lobe.normal, (lobe.alpha_max * lobe.alpha_min).sqrt()).within(least, 1.0)
            }
        };
        let mut all =
            vec![round(robust(footprint, facets, centre, 8)), round(densest(footprint, facets, centre))];
        let told: Vec<f64> = all.iter().map(|lobe| self.judge(lobe, footprint, facets, 0).0).collect();
        if told[1] < told[0] {
            all.swap(0, 1);
        }
        let [better, worse] = [told[0].min(told[1]), told[0].max(told[1])];
        // few facets have more answers that are far apart, and cost less
        let near = if facets.len() > 8 { 1.3 } else { 1.6 };
        if worse > near * better && self.effort == Effort::Fast {
            all.truncate(1);
        }
        all
    }
}

/// A robust mean and scatter of the slopes about the mean normal, by so many steps of reweighting.
pub(super) fn robust(footprint: &Footprint, facets: &[Facet], centre: Centre, steps: usize) -> Lobe {
    let normal = footprint.normal();
    let [t, b, n] = lobe::frame(normal);
    let slopes: Vec<(DVec2, DMat2, f64)> =
        facets.iter().map(|f| (Footprint::slope(normal, f.normal), f.square(), f.weight)).collect();
    let mut mean = DVec2::ZERO;
    let mut scatter = DMat2::IDENTITY * footprint.square.max(LEAST_ALPHA * LEAST_ALPHA);
    for _ in 0..steps {
        let inverse = scatter.inverse();
        let (mut sum, mut first, mut second) = (0.0, DVec2::ZERO, DMat2::ZERO);
        for (slope, square, weight) in &slopes {
            let d = *slope - mean;
            let own = inverse * *square;
            let own = 0.25 * (own.x_axis.x + own.y_axis.y);
            let u = 2.0 * weight / (1.0 + d.dot(inverse * d) + own);
            sum += u;
            first += *slope * u;
            second += (DMat2::from_cols(d * d.x, d * d.y) + *square * 0.5) * u;
        }
        if centre == Centre::Free {
            mean = first / sum;
        }
        scatter = second;
    }
    let middle = (t * mean.x + b * mean.y + n).normalize();
    Lobe::from_square(middle, scatter)
}

/// The facet where the footprint is densest, of at most sixteen, and as wide as that density tells.
fn densest(footprint: &Footprint, facets: &[Facet], centre: Centre) -> Lobe {
    let step = facets.len().div_ceil(16).max(1);
    let density = |h: DVec3| facets.iter().map(|f| f.weight * f.density(h)).sum::<f64>();
    let mut best = (0.0, footprint.normal());
    for f in facets.iter().step_by(step) {
        let d = density(f.normal);
        if d > best.0 {
            best = (d, f.normal);
        }
    }
    let alpha = if best.0 > 0.0 { 1.0 / (std::f64::consts::PI * best.0).sqrt() } else { 1.0 };
    let normal = if centre == Centre::Free { best.1 } else { footprint.normal() };
    Lobe::isotropic(normal, alpha)
}
