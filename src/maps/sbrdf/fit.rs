//! Lobes of least squares: albedos linear, shapes by damped steps.
//!
//! Norm: ∫∫ |Δf (n·o)|²/(f (n·o) + E(i) (n·o)/π) do over the pairs of [`Directions`], E(i) the target's reflectance for light from i. It has
//! the unit of energy: peaks, tails and what is diffuse count as the light that they send. A residual is its root, over that of the target: 0
//! the same, 1 as far as no lobe at all. For given shapes the albedos are those of least
//! squares that are not negative; the shapes follow the method of Marquardt, on the residual that the albedos leave (variable
//! projection by differences). A shape has two variables: the angle ψ of (Cx, Cz) = (−sin ψ, cos ψ), made max |C| = 1, and ln n; where the
//! target has a direction a third one, χ: Cx and Cy times e^χ and e^−χ.
//!
//! Source: [Marquardt 1963](crate::cite::MARQUARDT_1963). Deterministic.

use super::nodes::Directions;
use super::{CosineLobe, Divided, EXPONENTS, MOST_LOBES, Normalise};
use crate::math::least_squares::{nonnegative, positive};
use std::f64::consts::{FRAC_1_PI, FRAC_PI_4};

/// Shape of a lobe, as the fit varies it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// ψ; π/4 is Phong's lobe.
    pub angle: f64,
    /// ln n.
    pub log: f64,
    /// χ, half of ln (Cx/Cy); 0 where Cx = Cy.
    pub turn: f64,
}

/// Largest exponent times α².
const MOST_EXPONENT: f64 = 6.0;

/// Largest |χ|.
const MOST_TURN: f64 = 2.0;

/// ψ stays between lobes along the surface, forth and back.
const ANGLES: [f64; 2] = [-1.45, 1.45];

impl Shape {
    /// The lobe.
    #[must_use]
    pub fn lobe(&self) -> CosineLobe {
        let (sin, cos) = libm::sincos(self.angle);
        let c = [-sin * libm::exp(self.turn), -sin * libm::exp(-self.turn), cos];
        let longest = c.iter().fold(0.0f64, |m, c| m.max(c.abs()));
        CosineLobe { c: c.map(|c| c / longest), n: libm::exp(self.log) }
    }

    /// The shape of a lobe whose Cx and Cy have one sign.
    #[must_use]
    pub fn of(lobe: &CosineLobe) -> Shape {
        let [x, y, z] = lobe.c;
        let across = (x * y).max(0.0).sqrt();
        let turn = if across > 0.0 { 0.5 * libm::log(x / y) } else { 0.0 };
        Shape { angle: libm::atan2(if x < 0.0 { across } else { -across }, z), log: libm::log(lobe.n), turn }
    }

    /// Held within what may be stored, and below the exponent `most`.
    fn held(self, most: f64) -> Shape {
        let [lo, hi] = EXPONENTS.map(libm::log);
        Shape {
            angle: self.angle.clamp(ANGLES[0], ANGLES[1]),
            log: self.log.clamp(lo, hi.min(libm::log(most).max(lo))),
            turn: self.turn.clamp(-MOST_TURN, MOST_TURN),
        }
    }

    fn moved(mut self, variable: usize, step: f64) -> Shape {
        match variable {
            0 => self.angle += step,
            1 => self.log += step,
            _ => self.turn += step,
        }
        self
    }
}

/// Lobes, and the albedos of each target.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Shapes of the lobes.
    pub shapes: Vec<Shape>,
    /// One over the largest integral of each lobe; 1 where lobes are divided by their own integral.
    pub constants: Vec<f64>,
    /// `[target][diffuse, lobe 1, ...]`.
    pub albedos: Vec<Vec<f64>>,
    /// Products of the residuals of the targets with each other.
    pub residuals: Vec<Vec<f64>>,
    /// Products of the targets.
    pub squares: Vec<Vec<f64>>,
}

/// Targets on a set of directions, times the cosine and the root of the weight.
#[derive(Debug, Clone)]
pub struct Problem {
    directions: Directions,
    /// (n·o) √weight of every pair.
    factors: Vec<f64>,
    targets: Vec<Vec<f64>>,
    /// The mixture of targets that the shapes are fitted to.
    mixture: Vec<f64>,
    normalise: Normalise,
    /// Largest exponent: a narrower lobe would slip between the directions.
    most: f64,
}

impl Problem {
    /// `targets` are values of f cos at the pairs of directions, or none where it is not known; `mixture` says how much of each the shapes follow.
    #[must_use]
    pub fn new(
        directions: Directions,
        targets: &[Vec<Option<f64>>],
        mixture: &[f64],
        normalise: Normalise,
    ) -> Problem {
        let mut weights = directions.weights();
        let known = |k: usize| targets.iter().all(|t| t[k].is_some());
        scale(&directions, &mut weights, |k| {
            targets.iter().zip(mixture).map(|(t, m)| t[k].unwrap_or(0.0) * m).sum()
        });
        let roots: Vec<f64> =
            weights.iter().enumerate().map(|(k, w)| if known(k) { w.sqrt() } else { 0.0 }).collect();
        let cosines = directions.sample(|_, o| o.z);
        let factors = cosines.iter().zip(&roots).map(|(c, w)| c * w).collect();
        let weighed =
            |t: &Vec<Option<f64>>| t.iter().zip(&roots).map(|(v, w)| v.unwrap_or(0.0) * w).collect();
        let targets: Vec<Vec<f64>> = targets.iter().map(weighed).collect();
        let mix = |k: usize| targets.iter().zip(mixture).map(|(t, m)| t[k] * m).sum();
        let mixture = (0..roots.len()).map(mix).collect();
        let most = MOST_EXPONENT / (directions.alpha * directions.alpha);
        Problem { directions, factors, targets, mixture, normalise, most }
    }

    /// Variables of a shape.
    fn variables(&self) -> usize {
        if self.directions.stretched { 3 } else { 2 }
    }

    /// The lobe at every pair, weighed; for the search without the constant, which changes no shape and takes long.
    fn column(&self, shape: &Shape, search: bool) -> Vec<f64> {
        let divided = match self.normalise {
            Normalise::Largest if search => Divided::plain(shape.lobe()),
            normalise => Divided::new(shape.lobe(), normalise),
        };
        let mut out = Vec::with_capacity(self.factors.len());
        for (i, views) in self.directions.lights.iter().zip(&self.directions.views) {
            let lobe = divided.from(*i);
            for (o, _) in views {
                out.push(lobe(*o) * self.factors[out.len()]);
            }
        }
        out
    }

    fn diffuse(&self) -> Vec<f64> {
        self.factors.iter().map(|f| f * FRAC_1_PI).collect()
    }

    /// Albedos of a target, and what is left of it.
    fn project(columns: &[Vec<f64>], target: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let gram: Vec<Vec<f64>> =
            columns.iter().map(|a| columns.iter().map(|b| dot(a, b)).collect()).collect();
        let right: Vec<f64> = columns.iter().map(|a| dot(a, target)).collect();
        let albedos = nonnegative(&gram, &right);
        let mut left = target.to_vec();
        for (column, w) in columns.iter().zip(&albedos).filter(|(_, w)| **w > 0.0) {
            left.iter_mut().zip(column).for_each(|(l, c)| *l -= w * c);
        }
        (albedos, left)
    }

    /// Shapes from a start, at most `steps` steps.
    #[must_use]
    pub fn descend(&self, start: &[Shape], steps: usize) -> Vec<Shape> {
        let (diffuse, variables) = (self.diffuse(), self.variables());
        let mut shapes: Vec<Shape> = start.iter().map(|s| s.held(self.most)).collect();
        let mut columns: Vec<Vec<f64>> =
            std::iter::once(diffuse).chain(shapes.iter().map(|s| self.column(s, true))).collect();
        let mut left = Problem::project(&columns, &self.mixture).1;
        let (mut value, mut damping) = (dot(&left, &left), 1e-2);
        let floor = 1e-14 * dot(&self.mixture, &self.mixture);
        for _ in 0..steps {
            let slopes = self.slopes(&shapes, &mut columns, &left);
            let gram: Vec<Vec<f64>> =
                slopes.iter().map(|a| slopes.iter().map(|b| dot(a, b)).collect()).collect();
            let right: Vec<f64> = slopes.iter().map(|a| -dot(a, &left)).collect();
            let mut gained = None;
            for _ in 0..8 {
                let mut damped = gram.clone();
                let least = gram.iter().enumerate().fold(0.0f64, |m, (i, row)| m.max(row[i])) * 1e-9;
                damped
                    .iter_mut()
                    .enumerate()
                    .for_each(|(i, row)| row[i] += damping * row[i] + least + f64::MIN_POSITIVE);
                let step = positive(&damped, &right);
                let Some(step) = step else {
                    damping *= 10.0;
                    continue;
                };
                let next: Vec<Shape> = shapes
                    .iter()
                    .enumerate()
                    .map(|(j, s)| {
                        let long = |v: f64| v.clamp(-1.0, 1.0);
                        let first = variables * j;
                        let turn = if variables > 2 { 0.5 * long(2.0 * step[first + 2]) } else { 0.0 };
                        s.moved(0, 0.5 * long(2.0 * step[first]))
                            .moved(1, long(step[first + 1]))
                            .moved(2, turn)
                            .held(self.most)
                    })
                    .collect();
                let tried: Vec<Vec<f64>> = std::iter::once(columns[0].clone())
                    .chain(next.iter().map(|s| self.column(s, true)))
                    .collect();
                let rest = Problem::project(&tried, &self.mixture).1;
                let lower = dot(&rest, &rest);
                if lower < value {
                    gained = Some(value - lower);
                    (shapes, columns, left, value) = (next, tried, rest, lower);
                    damping = (damping * 0.2).max(1e-9);
                    break;
                }
                damping *= 6.0;
            }
            match gained {
                Some(gain) if gain > 1e-5 * value && value > floor => {}
                _ => break,
            }
        }
        shapes
    }

    /// Derivatives of what is left to the variables of the shapes, by differences.
    fn slopes(&self, shapes: &[Shape], columns: &mut [Vec<f64>], left: &[f64]) -> Vec<Vec<f64>> {
        const STEP: f64 = 1e-4;
        let mut out = Vec::with_capacity(self.variables() * shapes.len());
        for (j, shape) in shapes.iter().enumerate() {
            for variable in 0..self.variables() {
                let moved = self.column(&shape.moved(variable, STEP), true);
                let kept = std::mem::replace(&mut columns[j + 1], moved);
                let rest = Problem::project(columns, &self.mixture).1;
                columns[j + 1] = kept;
                out.push(rest.iter().zip(left).map(|(a, b)| (a - b) / STEP).collect());
            }
        }
        out
    }

    /// Albedos of every target under given shapes.
    #[must_use]
    pub fn finish(&self, shapes: &[Shape]) -> Fit {
        let columns: Vec<Vec<f64>> =
            std::iter::once(self.diffuse()).chain(shapes.iter().map(|s| self.column(s, false))).collect();
        let (albedos, left): (Vec<_>, Vec<_>) =
            self.targets.iter().map(|t| Problem::project(&columns, t)).unzip();
        let products =
            |list: &[Vec<f64>]| list.iter().map(|a| list.iter().map(|b| dot(a, b)).collect()).collect();
        let constant = |s: &Shape| match self.normalise {
            Normalise::Incident => 1.0,
            Normalise::Largest => 1.0 / s.lobe().largest(),
        };
        let constants = shapes.iter().map(constant).collect();
        Fit {
            shapes: shapes.to_vec(),
            constants,
            albedos,
            residuals: products(&left),
            squares: products(&self.targets),
        }
    }

    /// Relative residual of given shapes and albedos against a mixture of the targets.
    #[must_use]
    pub fn residual(&self, shapes: &[Shape], albedos: &[f64], mixture: &[f64]) -> f64 {
        let lobes: Vec<CosineLobe> = shapes.iter().map(Shape::lobe).collect();
        let mix = |k: usize| self.targets.iter().zip(mixture).map(|(t, m)| t[k] * m).sum::<f64>();
        let target: Vec<f64> = (0..self.factors.len()).map(mix).collect();
        let mut left = target.clone();
        for (k, l) in left.iter_mut().enumerate() {
            *l -= albedos[0] * self.factors[k] * FRAC_1_PI;
        }
        let size = dot(&target, &target);
        self.subtract(&lobes, &albedos[1..], &mut left);
        (dot(&left, &left) / size.max(f64::MIN_POSITIVE)).sqrt()
    }

    /// Relative residual of lobes with their albedos, diffuse first, against a target.
    #[must_use]
    pub fn left(&self, lobes: &[CosineLobe], albedos: &[f64], target: usize) -> f64 {
        let Some(target) = self.targets.get(target) else { return 0.0 };
        let mut left: Vec<f64> =
            target.iter().zip(&self.factors).map(|(t, f)| t - albedos[0] * f * FRAC_1_PI).collect();
        self.subtract(lobes, &albedos[1..], &mut left);
        (dot(&left, &left) / dot(target, target).max(f64::MIN_POSITIVE)).sqrt()
    }

    /// Relative difference of two sets of lobes with their albedos, diffuse first.
    #[must_use]
    pub fn difference(&self, a: (&[CosineLobe], &[f64]), b: (&[CosineLobe], &[f64])) -> f64 {
        let of = |(lobes, albedos): (&[CosineLobe], &[f64])| {
            let mut out: Vec<f64> = self.factors.iter().map(|f| -albedos[0] * f * FRAC_1_PI).collect();
            self.subtract(lobes, &albedos[1..], &mut out);
            out
        };
        let (a, b) = (of(a), of(b));
        let square: f64 = a.iter().zip(&b).map(|(x, y)| (x - y) * (x - y)).sum();
        (square / dot(&a, &a).max(f64::MIN_POSITIVE)).sqrt()
    }

    fn subtract(&self, lobes: &[CosineLobe], albedos: &[f64], left: &mut [f64]) {
        for (lobe, albedo) in lobes.iter().zip(albedos) {
            let divided = Divided::new(*lobe, self.normalise);
            let mut k = 0;
            for (i, views) in self.directions.lights.iter().zip(&self.directions.views) {
                let value = divided.from(*i);
                for (o, _) in views {
                    left[k] -= albedo * value(*o) * self.factors[k];
                    k += 1;
                }
            }
        }
    }
}

impl Fit {
    /// Relative residual of all targets together.
    #[must_use]
    pub fn all(&self) -> f64 {
        let of = |m: &[Vec<f64>]| m.iter().enumerate().map(|(i, row)| row[i]).sum::<f64>();
        let size = of(&self.squares);
        if size > 0.0 { (of(&self.residuals).max(0.0) / size).sqrt() } else { 0.0 }
    }

    /// Relative residual of a mixture of the targets.
    #[must_use]
    pub fn relative(&self, mixture: &[f64]) -> f64 {
        let of = |m: &[Vec<f64>]| -> f64 {
            m.iter()
                .zip(mixture)
                .map(|(row, a)| a * row.iter().zip(mixture).map(|(v, b)| v * b).sum::<f64>())
                .sum()
        };
        let size = of(&self.squares);
        if size > 0.0 { (of(&self.residuals).max(0.0) / size).sqrt() } else { 0.0 }
    }
}

/// Where the search begins, for a surface that reflects as GGX of width α does: mirror lobes, the exponents spread about 1/(2 α²).
#[must_use]
pub fn start(alpha: f64, lobes: usize) -> Vec<Shape> {
    const SPREAD: [&[f64]; MOST_LOBES] = [&[1.0], &[2.0, 0.2], &[3.0, 0.6, 0.06]];
    let n = 0.5 / (alpha * alpha);
    let shape = |k: &f64| Shape { angle: FRAC_PI_4, log: libm::log(n * k), turn: 0.0 }.held(f64::MAX);
    SPREAD[lobes.clamp(1, MOST_LOBES) - 1].iter().map(shape).collect()
}

/// Divides the weights by f cos + E cos/π, f of the mixture.
fn scale(directions: &Directions, weights: &mut [f64], mixture: impl Fn(usize) -> f64) {
    let mut first = 0;
    for views in &directions.views {
        let own = first..first + views.len();
        let (mut energy, mut solid) = (0.0, 0.0);
        for k in own.clone() {
            energy += weights[k] * mixture(k);
            solid += weights[k] * views[k - first].0.z * FRAC_1_PI;
        }
        let energy = energy / solid;
        for k in own {
            let scale = mixture(k) + energy * views[k - first].0.z * FRAC_1_PI;
            weights[k] = if scale > 0.0 { weights[k] / scale } else { 0.0 };
        }
        first += views.len();
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
