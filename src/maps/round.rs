//! The fast way to one width about a given normal: a search along a line.
//!
//! With one width in the frame of the nodes the lobe depends on the height of a node alone, and on the logarithm of its width; the
//! slope of D along it is known. A first set of few nodes, spread over an octave to each side of a robust guess, is scanned at
//! [`SCAN`] widths, so that the wide and the narrow answer of a footprint of both are told apart; a second set about the better one
//! ends it. A footprint costs some thousands of products in place of some tens of thousands.

use super::Centre;
use super::fit::{Fitted, Fitter, robust};
use super::footprint::Footprint;
use super::lobe::{self, Facet, LEAST_ALPHA, Lobe};
use super::nodes::Nodes;
use glam::DVec3;

/// Logarithms of the widths that are tried first, against that of the guess.
const SCAN: [f64; 5] = [-1.0, -0.5, 0.0, 0.5, 1.0];

/// Charts of the first nodes, in widths of the guess.
const CHARTS: [f64; 2] = [1.8, 0.55];

/// Longest step.
const LONGEST: f64 = 0.4;

/// D along the logarithm of the width.
struct Line<'a> {
    nodes: &'a Nodes,
    normal: DVec3,
    mass: f64,
}

/// A point of the line: logarithm of the width, D, its slope, and how far it may be wrong.
#[derive(Debug, Clone, Copy)]
struct At {
    log: f64,
    value: f64,
    slope: f64,
    doubt: f64,
}

impl Line<'_> {
    fn at(&self, log: f64) -> At {
        let alpha = libm::exp(log);
        let (overlap, slope, doubt) = self.nodes.round(1.0 / alpha);
        let DVec3 { x, y, z } = self.normal;
        let sin2 = x * x + y * y;
        let square = alpha * alpha * sin2;
        let root = (square + z * z).sqrt();
        // the lobe's part above the mesh, and its slope
        let (mass, lost) = (0.5 * (1.0 + z / root), -0.5 * z * square / (root * root * root));
        At { log, value: 0.5 * (self.mass + mass) - overlap, slope: 0.5 * lost + slope, doubt }
    }
}

impl Fitter {
    /// The nearest lobe of one width about the mean normal.
    pub(super) fn round(&mut self, footprint: &Footprint, facets: &[Facet], least: f64) -> Fitted {
        let normal = footprint.normal();
        let base = lobe::frame(normal);
        let guess = robust(footprint, facets, Centre::Mean, ROUNDS);
        let guess = (guess.alpha_max * guess.alpha_min).sqrt().clamp(least, 1.0);
        let (low, high) = (libm::log(least), 0.0);
        let charts = CHARTS.map(|k| [k * guess; 2]);
        self.nodes.place(&base, &charts, &self.scan, facets);
        let line = Line { nodes: &self.nodes, normal, mass: footprint.mass };
        let (first, bend) = scan(&line, libm::log(guess), low, high);
        let start = libm::exp(first);
        // more nodes where narrow facets stand apart under a wide lobe
        let lattice = match self.level(start / least) {
            0 => &self.middle,
            level => &self.fine[level],
        };
        self.nodes.place(&base, &[[start; 2]], lattice, facets);
        let line = Line { nodes: &self.nodes, normal, mass: footprint.mass };
        let best = descend(&line, first, bend, low, high);
        let lobe = Lobe::isotropic(normal, libm::exp(best.log)).within(footprint.least.max(LEAST_ALPHA), 1.0);
        let at_limit = best.log >= high && best.slope < 0.0;
        let doubt = best.doubt + footprint.merge_error;
        Fitted { lobe, wide: None, distance: best.value, doubt, at_limit }
    }
}

/// Steps of the robust guess.
const ROUNDS: usize = 3;

/// The width where D is least, from the scan; and how fast the slope grows there.
fn scan(line: &Line, guess: f64, low: f64, high: f64) -> (f64, f64) {
    let points = SCAN.map(|s| line.at((guess + s).clamp(low, high)));
    let best = (0..points.len()).fold(0, |b, i| if points[i].value < points[b].value { i } else { b });
    let here = points[best];
    let up = here.slope < 0.0;
    let far = |p: &&At| if up { p.log > here.log + 1e-9 } else { p.log < here.log - 1e-9 };
    let next = if up { points.iter().find(far) } else { points.iter().rev().find(far) };
    match next {
        Some(next) if next.slope * here.slope < 0.0 => {
            let bend = (next.slope - here.slope) / (next.log - here.log);
            (if up { between(&here, next) } else { between(next, &here) }, bend.abs())
        }
        _ => (here.log, 1.0),
    }
}

/// Where the cubic through two points has its least, the slope falling at the first and rising at the second; held off the ends.
fn between(a: &At, b: &At) -> f64 {
    let width = b.log - a.log;
    let d = a.slope + b.slope - 3.0 * (b.value - a.value) / width;
    let root = (d * d - a.slope * b.slope).max(0.0).sqrt();
    let part = (root - a.slope + d) / (b.slope - a.slope + 2.0 * root).max(f64::MIN_POSITIVE);
    a.log + width * part.clamp(0.1, 0.9)
}

/// The least of D near `start`: steps down until the slope turns, then cubics between, until the tangents tell that less than
/// [`ENOUGH`] of D is left.
fn descend(line: &Line, start: f64, bend: f64, low: f64, high: f64) -> At {
    let mut best = line.at(start.clamp(low, high));
    let mut at = best;
    let mut ends: [Option<At>; 2] = [None, None];
    for _ in 0..STEPS {
        ends[usize::from(at.slope > 0.0)] = Some(at);
        let log = match ends {
            [Some(a), Some(b)] => {
                // where the tangents meet; a convex function is nowhere lower
                let meet = (a.value - b.value + b.slope * b.log - a.slope * a.log) / (b.slope - a.slope);
                let least = a.value + a.slope * (meet - a.log);
                if best.value - least < ENOUGH * best.value {
                    break;
                }
                between(&a, &b)
            }
            _ => {
                let step = (-1.2 * at.slope / bend.max(0.05)).clamp(-LONGEST, LONGEST);
                (at.log + step).clamp(low, high)
            }
        };
        if (log - at.log).abs() < SHORTEST {
            break;
        }
        at = line.at(log);
        if at.value < best.value {
            best = at;
        }
    }
    best
}

/// Most steps.
const STEPS: usize = 6;

/// Shortest step.
const SHORTEST: f64 = 1e-3;

/// Part of D that is not worth a step.
const ENOUGH: f64 = 5e-3;
