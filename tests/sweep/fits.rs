//! Fitted kinds: the estimate is that of the stated residual, which is integrated here for the parameters that the product found.

use crate::sweep::check::Outcome;
use crate::sweep::closed::Profile;
use crate::sweep::facets::Pair;
use crate::sweep::kinds;
use crate::sweep::lobe;
use crate::sweep::quad::{self, Setting, mark, sharp, sorted};
use crate::sweep::texel::{Pick, Texel};
use crate::sweep::truth;
use rayon::prelude::*;
use serde_json::json;
use std::f64::consts::{FRAC_PI_2, PI};

/// Tolerances that matrices are asked for: entries of broad lobes are loose.
const MATRICES: [f64; 2] = [1e-2, 1e-3];

/// Residuals of fits to Gaussians and of matrices, against those of this file.
pub(crate) fn run(seed: u64, count: u64) -> (Vec<String>, Vec<Outcome>) {
    let gaussians = (0..count).into_par_iter().map(|n| gaussians(seed, n, 0));
    let mut all: Vec<(String, Vec<Outcome>)> = gaussians.collect();
    let matrices = (0..count).into_par_iter().map(|n| matrix(seed, n, 0));
    all.extend(matrices.collect::<Vec<_>>());
    let mut labels = Vec::new();
    let mut outcomes = Vec::new();
    for (row, (label, of_row)) in all.into_iter().enumerate() {
        labels.push(label);
        outcomes.extend(of_row.into_iter().map(|o| Outcome { row, ..o }));
    }
    (labels, outcomes)
}

fn outcome(
    row: usize,
    tolerance: f64,
    value: f64,
    estimate: f64,
    truth: f64,
    own: f64,
    evaluations: u32,
) -> Outcome {
    let floor = own.max(1e-13);
    Outcome { row, tolerance, error: value - truth, floor, estimate, evaluations, refused: false }
}

/// `sqrt(int (p - q)^2 dr / int p^2 dr)` of a fit, p = 2 pi r R.
fn gaussians(seed: u64, number: u64, row: usize) -> (String, Vec<Outcome>) {
    let mut pick = Pick::new("gaussian-fit", seed, number);
    let mut texel = crate::sweep::closed::attempt("diffusion-profile", "ring", &mut pick);
    let count = 2 + pick.0.index(5);
    texel.params.remove("scale");
    texel.kind = "gaussian-fit".to_owned();
    texel.layout = "weights-residual".to_owned();
    texel.axes = vec!["gaussian".to_owned()];
    let bound = texel.bind_with(count);
    let fitted: Vec<_> = (0..count).map(|i| bound.baker.texel(&[i as f64], 1e-6).unwrap()).collect();
    let profile = Profile::new(&texel.resolved());
    let outcomes = (0..3)
        .map(|c| {
            let square = |s: &Setting, of: &dyn Fn(f64) -> f64| {
                let lengths = profile.lengths(c).into_iter().chain(fitted.iter().map(|e| e.value[0].sqrt()));
                // variances are shared: a narrow channel may hold the Gaussian of a wide one
                let widths = fitted.iter().map(|e| 12.0 * e.value[0].sqrt());
                let end = (0..3).map(|c| profile.end(c)).chain(widths).fold(0.0, f64::max);
                let edges = sorted(sharp(0.0), mark(end), lengths.map(mark).collect());
                let unit = s.pieces(&edges, 1e-3, &mut |at, _, _| profile.ring(c, at.x).powi(2)).value;
                s.pieces(&edges, 1e-13 * unit, &mut |at, _, _| of(at.x).powi(2)).value
            };
            let lobes = |r: f64| -> f64 {
                fitted
                    .iter()
                    .map(|e| e.value[1 + c] * r / e.value[0] * (-0.5 * r * r / e.value[0]).exp())
                    .sum()
            };
            let of = |s: &Setting| {
                (square(s, &|r| profile.ring(c, r) - lobes(r)) / square(s, &|r| profile.ring(c, r))).sqrt()
            };
            let (a, b) = (of(&quad::FIRST), of(&quad::SECOND));
            let e = &fitted[0];
            outcome(row, 1e-6, e.value[4 + c], e.error[4 + c], b, (a - b).abs() + 1e-12, e.evaluations)
        })
        .collect();
    (format!("gaussian-fit {}", texel.resolved().choice("profile").unwrap()), outcomes)
}

/// Relative L3 error and half the total variation of the lobe of a matrix.
fn matrix(seed: u64, number: u64, row: usize) -> (String, Vec<Outcome>) {
    let mut pick = Pick::new("ltc-matrix", seed, number);
    let id = pick.one(&["ggx", "beckmann", "kelemen"]);
    let mut params = serde_json::Map::new();
    params.insert("alpha".to_owned(), json!(pick.log(0.01, 1.0)));
    let texel = Texel::new("ltc-matrix", "over-m22-residual", id, params, &[("mu", pick.between(0.02, 1.0))]);
    let mut outcomes = Vec::new();
    for tolerance in MATRICES {
        let e = texel.bind().unwrap().baker.texel(&texel.at, tolerance).unwrap();
        let m = [e.value[0], e.value[1], e.value[2], e.value[3]];
        let (l3, variation) = judge(&texel, m);
        for (c, (truth, own)) in [(4, l3), (5, variation)] {
            outcomes.push(outcome(row, tolerance, e.value[c], e.error[c], truth, own, e.evaluations));
        }
    }
    (format!("ltc-matrix {id}"), outcomes)
}

/// The lobe of an inverse matrix over its middle entry.
struct Cosine {
    m11: f64,
    m31: f64,
    m13: f64,
    m33: f64,
}

impl Cosine {
    fn det(&self) -> f64 {
        (self.m11 * self.m33 - self.m13 * self.m31).abs()
    }

    /// Density of a direction.
    fn at(&self, w: glam::DVec3) -> f64 {
        let v = glam::DVec3::new(self.m11 * w.x + self.m13 * w.z, w.y, self.m31 * w.x + self.m33 * w.z);
        let square = v.length_squared();
        v.z.max(0.0) * self.det() / (PI * square * square)
    }

    /// `int D^k dw` below the horizon, in the space of the cosine: w ~ M v, `D dw = cos / pi dv`.
    fn below(&self, k: i32, setting: &Setting) -> f64 {
        // M of the inverse: w.z = (-m31 v.x + m11 v.z) / (m11 m33 - m13 m31)
        let sign = (self.m11 * self.m33 - self.m13 * self.m31).signum();
        let (a, b) = (-self.m31 * sign, self.m11 * sign);
        let edges = sorted(mark(0.0), mark(FRAC_PI_2), vec![mark((b / a.abs()).atan())]);
        setting
            .pieces(&edges, setting.tolerance, &mut |at, tolerance, _| {
                let (sin, cos) = at.x.sin_cos();
                // a sin cos(phi) + b cos < 0
                let bound = -b * cos / (a * sin);
                let (from, to) = match () {
                    () if a > 0.0 && bound > -1.0 => (bound.min(1.0).acos(), PI),
                    () if a < 0.0 && bound < 1.0 => (0.0, bound.max(-1.0).acos()),
                    () if b < 0.0 && a == 0.0 => (0.0, PI),
                    () => return 0.0,
                };
                let inner = setting.pieces(&[mark(from), mark(to)], tolerance, &mut |phi, _, _| {
                    let v = glam::DVec3::new(sin * phi.x.cos(), sin * phi.x.sin(), cos);
                    let det = self.m11 * self.m33 - self.m13 * self.m31;
                    let w = glam::DVec3::new(
                        (self.m33 * v.x - self.m13 * v.z) / det,
                        v.y,
                        (self.m11 * v.z - self.m31 * v.x) / det,
                    );
                    self.at(w / w.length()).powi(k - 1)
                });
                2.0 * inner.value * sin * cos / PI
            })
            .value
    }
}

fn judge(texel: &Texel, [m11, m31, m13, m33]: [f64; 4]) -> ((f64, f64), (f64, f64)) {
    let draw = texel.draw(true);
    let cosine = Cosine { m11, m31, m13, m33 };
    let (albedo, _) = truth::albedo(&draw).unwrap_or(kinds::NONE);
    let run = |setting: &Setting| {
        let over = |of: &(dyn Fn(f64, f64) -> f64 + Sync), scale: f64| {
            let (lobe, _) = truth::half_vector(&draw).unwrap();
            // the part of the lobe over `mu_i (wo.wh)` and its measure is f
            let density = |p: &Pair, flux: f64| {
                let f = flux / (p.cosines() * p.facets());
                of(f * p.mu_i / albedo, cosine.at(p.wi)) * p.cos_d * p.facets()
            };
            let all = lobe::over(lobe, density);
            all.integrate(draw.mu, 0.0, setting, setting.tolerance * scale).value
        };
        let cube = over(&|p, _| p * p * p, 1.0);
        let apart = over(&|p, d| (p - d).abs().powi(3), cube) + cosine.below(3, setting);
        let variation = 0.5 * (over(&|p, d| (p - d).abs(), 1.0) + cosine.below(1, setting));
        ((apart / cube).cbrt(), variation)
    };
    let (a, b) = (run(&quad::ROUGH), run(&quad::LOOSE));
    ((b.0, (a.0 - b.0).abs() + 1e-8), (b.1, (a.1 - b.1).abs() + 1e-8))
}
