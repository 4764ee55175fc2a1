//! The minimum of a function of one to five variables with known slope, by the method of Broyden, Fletcher, Goldfarb and Shanno.

/// Most variables.
pub(super) const MOST: usize = 5;

/// A point or a slope; those beyond the number of variables are 0.
pub(super) type Point = [f64; MOST];

/// What is to be made small.
pub(super) trait Cost {
    /// Number of variables.
    fn variables(&self) -> usize;
    /// Value and slope.
    fn value(&self, at: &Point) -> (f64, Point);
    /// The nearest point that is allowed.
    fn hold(&self, at: Point) -> Point;
}

/// Longest step of a variable.
const LONGEST: f64 = 0.4;

/// Shorter steps are not worth it.
const SHORTEST: f64 = 2e-4;

/// Goes down from `start`, at most `steps` steps, and until a step gains less than the part `enough` of the value; returns where it
/// came to, and the value there.
///
/// Source: [Nocedal and Wright 2006](crate::cite::NOCEDAL_WRIGHT_2006) Alg. 6.1, with Armijo's rule alone: an update without curvature is left out.
/// Deterministic.
pub(super) fn descend(cost: &impl Cost, start: Point, steps: usize, enough: f64) -> (Point, f64) {
    let n = cost.variables();
    let mut at = cost.hold(start);
    let (mut value, mut slope) = cost.value(&at);
    let mut inverse = [[0.0; MOST]; MOST];
    (0..n).for_each(|i| inverse[i][i] = 2.0);
    let mut fresh = true;
    for _ in 0..steps {
        let mut step = [0.0; MOST];
        for i in 0..n {
            step[i] = -dot(&inverse[i], &slope);
        }
        let fall = dot(&step, &slope);
        let length = step.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        if length < SHORTEST || fall > -1e-8 {
            break;
        }
        let Some((next, lower, steeper)) = search(cost, &at, value, &step, fall, (LONGEST / length).min(1.0))
        else {
            break;
        };
        let moved = difference(&next, &at);
        let turned = difference(&steeper, &slope);
        let along = dot(&moved, &turned);
        let square = dot(&turned, &turned);
        if along > 1e-10 * square.max(1e-12) {
            if fresh {
                (0..n).for_each(|i| inverse[i][i] = along / square);
                fresh = false;
            }
            update(&mut inverse, n, &moved, &turned, along);
        }
        let gain = value - lower;
        (at, value, slope) = (next, lower, steeper);
        if gain < 1e-6_f64.max(enough * value) {
            break;
        }
    }
    (at, value)
}

/// A shorter and shorter step, until it goes down.
fn search(
    cost: &impl Cost,
    at: &Point,
    value: f64,
    step: &Point,
    fall: f64,
    longest: f64,
) -> Option<(Point, f64, Point)> {
    let mut t = longest;
    for _ in 0..6 {
        let mut next = *at;
        next.iter_mut().zip(step).for_each(|(x, s)| *x += t * s);
        let next = cost.hold(next);
        let (v, slope) = cost.value(&next);
        if v < value + 1e-4 * t * fall {
            return Some((next, v, slope));
        }
        t *= 0.35;
    }
    None
}

fn update(inverse: &mut [Point; MOST], n: usize, moved: &Point, turned: &Point, along: f64) {
    let mut product = [0.0; MOST];
    for i in 0..n {
        product[i] = dot(&inverse[i], turned);
    }
    let twice = 1.0 + dot(&product, turned) / along;
    for i in 0..n {
        for j in 0..n {
            inverse[i][j] +=
                (twice * moved[i] * moved[j] - product[i] * moved[j] - moved[i] * product[j]) / along;
        }
    }
}

fn dot(a: &Point, b: &Point) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn difference(a: &Point, b: &Point) -> Point {
    let mut out = [0.0; MOST];
    out.iter_mut().zip(a.iter().zip(b)).for_each(|(o, (a, b))| *o = a - b);
    out
}
