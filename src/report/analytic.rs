//! Split sums as a formula: rational functions of two variables, fitted to fresh integrals, written as shader code.
//!
//! Fitted are E and the rest r of the layout `factored`, both smooth where a mirror begins; then
//! `bias = E (1 - mu)^5 + r`, `scale = E - bias`. Each is P(u, a) / Q(u, a), P and Q of degree N in u and in a = alpha, Q(0, 0) = 1;
//! `u = sqrt(mu (1 + a) / (mu + a))` is the coupled variable, in which the corner mu, alpha -> 0 is smooth, or plainly `u = mu`.
//!
//! Linearised least squares, reweighted by 1 / Q of the step before (Sanathanan and Koerner) and by the error at each
//! point (Lawson), so that the largest error falls; practical points count three times. The best of all steps whose
//! Q stays positive is kept. Errors are measured in f32, as the code computes, at points between those of the fit, at those and on the edges.

use crate::integrate::Sums;
use crate::math::least_squares::least_squares;
use crate::tables::Bound;
use crate::verify::reconstruction::{PRACTICAL_ALPHA, PRACTICAL_MU};
use rayon::prelude::*;
use std::fmt::Write;

/// How much more an error counts in the practical domain.
const PRACTICAL_WEIGHT: f64 = 3.0;
/// Lines of points along each variable.
const LINES: usize = 65;
/// Steps of the fit.
const STEPS: usize = 100;
/// Steps before points are reweighted by their errors.
const SETTLING: usize = 8;
/// Least value of a denominator.
const LEAST_Q: f64 = 1e-3;
/// Integration error of the truth.
const TOLERANCE: f64 = 1e-6;
/// Degrees that can be asked for.
pub const DEGREES: [usize; 2] = [1, 5];

/// The variable beside alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Variables {
    /// `sqrt(mu (1 + alpha) / (mu + alpha))`.
    Coupled,
    /// `mu`.
    Plain,
}

/// Languages of the code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[allow(missing_docs, reason = "the names say it")]
pub enum Lang {
    Glsl,
    Wgsl,
    Hlsl,
    Rust,
    C,
}

/// Largest and mean error, and where the largest lies.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Off {
    /// The largest of scale, bias and E.
    pub largest: f64,
    /// Mean over points and these three.
    pub mean: f64,
    /// mu and alpha of the largest.
    pub at: [f64; 2],
}

/// A fit, with the numbers that the code holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Id of the model whose split sum it is.
    pub model: &'static str,
    /// Degree in each variable.
    pub degree: usize,
    /// The variable beside alpha.
    pub variables: Variables,
    /// P and Q of E and of the rest: coefficient of `u^i a^j` at `i (degree + 1) + j`.
    pub coefficients: [[Vec<f32>; 2]; 2],
    /// Over the whole domain.
    pub whole: Off,
    /// Over mu >= 0.05, roughness >= 0.09.
    pub practical: Off,
}

/// Why there is no fit.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// Not a table of E and rest over mu and alpha.
    #[error(
        "{got} is not fitted: a fit takes the layout `factored` of `dfg` on two axes, mu and alpha or roughness"
    )]
    Table {
        /// Kind and layout.
        got: String,
    },
    /// No denominator stays positive.
    #[error("degree {degree}: no denominator stays positive; take another degree, or coupled variables")]
    Pole {
        /// Degree.
        degree: usize,
    },
}

struct Sample {
    mu: f64,
    alpha: f64,
    /// E and rest.
    value: [f64; 2],
    practical: bool,
}

/// Fits a degree; `bound` is a table of the layout `factored` of `dfg` (its axes say only which variable comes first).
///
/// # Errors
/// [`FitError`].
pub fn fit(bound: &Bound, degree: usize, variables: Variables) -> Result<Fit, FitError> {
    let spec = &bound.spec;
    let ids: Vec<&str> = spec.layout.ids().collect();
    let axes = spec.axis("mu").zip(spec.axis("alpha"));
    let Some((mu, alpha)) = axes.filter(|_| ids == ["dfg.loss", "dfg.rest"] && spec.grid.axes().len() == 2)
    else {
        return Err(FitError::Table { got: format!("{} with {}", spec.kind.id, ids.join(", ")) });
    };
    let truth = |offset: f64| samples(bound, [mu, alpha], offset);
    let nodes = truth(0.0);
    let part = |i: usize| rational(&nodes, i, degree, variables).ok_or(FitError::Pole { degree });
    let mut fit = Fit {
        model: bound.spec.model.as_ref().map_or("", |(info, _)| info.id),
        degree,
        variables,
        coefficients: [part(0)?, part(1)?],
        whole: Off::default(),
        practical: Off::default(),
    };
    // nodes include the edges; the others lie between them
    let all: Vec<Sample> = nodes.into_iter().chain(truth(0.5)).collect();
    (fit.whole, fit.practical) = (fit.off(&all, false), fit.off(&all, true));
    Ok(fit)
}

/// E and rest on lines of the coupled variable and of roughness, and of mu and roughness, shifted by a part of their distance: the
/// former are dense where mu is near alpha, the latter where it is not.
fn samples(bound: &Bound, [mu_axis, alpha_axis]: [usize; 2], offset: f64) -> Vec<Sample> {
    let lines = if offset > 0.0 { LINES - 1 } else { LINES };
    let place = |i: usize| (i as f64 + offset) / (LINES - 1) as f64;
    let one = |n: usize| {
        let (x, roughness) = (place(n % lines), place(n / lines % lines));
        let alpha = roughness * roughness;
        let mu = if n < lines * lines && alpha > 0.0 { x * x * alpha / (1.0 + alpha - x * x) } else { x };
        let mut at = [0.0; 2];
        (at[mu_axis], at[alpha_axis]) = (mu, alpha);
        let value: Sums = bound.baker.texel(&at, TOLERANCE).ok()?.value;
        // mu = alpha = 0 is not one value
        (mu + alpha > 0.0).then_some(Sample {
            mu,
            alpha,
            value: [1.0 - value[0], value[1]],
            practical: mu >= PRACTICAL_MU && alpha >= PRACTICAL_ALPHA,
        })
    };
    (0..2 * lines * lines).into_par_iter().filter_map(one).collect()
}

fn variable(variables: Variables, mu: f64, alpha: f64) -> f64 {
    match variables {
        Variables::Coupled => (mu * (1.0 + alpha) / (mu + alpha)).sqrt(),
        Variables::Plain => mu,
    }
}

/// P and Q of one function, or none if no step has a positive Q.
fn rational(samples: &[Sample], which: usize, degree: usize, variables: Variables) -> Option<[Vec<f32>; 2]> {
    let n = (degree + 1) * (degree + 1);
    let table: Vec<Vec<f64>> =
        samples.iter().map(|s| powers(variable(variables, s.mu, s.alpha), s.alpha, degree)).collect();
    // P - f (Q - 1) = f
    let row = |(p, s): (&Vec<f64>, &Sample)| -> Vec<f64> {
        p.iter().copied().chain(p[1..].iter().map(|p| -s.value[which] * p)).collect()
    };
    let mut rows: Vec<Vec<f64>> = table.iter().zip(samples).map(row).collect();
    let mut right: Vec<f64> = samples.iter().map(|s| s.value[which]).collect();
    // a pull of the denominator towards 1, for as long as it has a zero
    for j in n..2 * n - 1 {
        rows.push((0..2 * n - 1).map(|k| f64::from(u8::from(k == j))).collect());
        right.push(0.0);
    }
    let mut pull = 0.0_f64;
    let importance = |s: &Sample| if s.practical { PRACTICAL_WEIGHT } else { 1.0 };
    let mut weights = vec![1.0 / samples.len() as f64; samples.len()];
    let mut below = vec![1.0; samples.len()];
    let mut best: Option<(f64, Vec<f64>)> = None;
    for step in 0..STEPS {
        let mut scaled: Vec<f64> = samples
            .iter()
            .zip(&weights)
            .zip(&below)
            .map(|((s, w), q)| w.sqrt() * importance(s) / q)
            .collect();
        scaled.resize(rows.len(), pull);
        let c = least_squares(&rows, &right, &scaled)?;
        below = table.iter().map(|p| 1.0 + dot(&p[1..], &c[n..])).collect();
        if below.iter().any(|q| *q <= LEAST_Q) {
            pull = (2.0 * pull).max(1e-5);
            below.fill(1.0);
            continue;
        }
        let errors: Vec<f64> = table
            .iter()
            .zip(&below)
            .zip(samples)
            .map(|((p, q), s)| importance(s) * (dot(p, &c[..n]) / q - s.value[which]).abs())
            .collect();
        let largest = errors.iter().copied().fold(0.0, f64::max);
        if best.as_ref().is_none_or(|b| largest < b.0) {
            best = Some((largest, c));
        }
        if step >= SETTLING && largest > 0.0 {
            weights.iter_mut().zip(&errors).for_each(|(w, e)| *w *= e / largest + 1e-3);
            let sum: f64 = weights.iter().sum();
            weights.iter_mut().for_each(|w| *w /= sum);
        }
    }
    let (_, c) = best?;
    #[allow(clippy::cast_possible_truncation, reason = "the code computes in f32")]
    let single = |v: &[f64]| v.iter().map(|c| *c as f32).collect::<Vec<f32>>();
    let below: Vec<f64> = std::iter::once(1.0).chain(c[n..].iter().copied()).collect();
    Some([single(&c[..n]), single(&below)])
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// `u^i a^j` at `i (degree + 1) + j`.
fn powers(u: f64, a: f64, degree: usize) -> Vec<f64> {
    let mut out = Vec::new();
    let mut ui = 1.0;
    for _ in 0..=degree {
        let mut term = ui;
        for _ in 0..=degree {
            out.push(term);
            term *= a;
        }
        ui *= u;
    }
    out
}

impl Fit {
    /// Scale, bias and E in f32, operation by operation as the code computes them.
    #[must_use]
    pub fn evaluate(&self, mu: f32, alpha: f32) -> [f32; 3] {
        let u = match self.variables {
            Variables::Coupled => (mu * (1.0 + alpha) / (mu + alpha).max(1e-30)).sqrt(),
            Variables::Plain => mu,
        };
        let [e, rest] = [0, 1].map(|f| self.polynomial(f, 0, u, alpha) / self.polynomial(f, 1, u, alpha));
        let e = e.clamp(0.0, 1.0);
        let k = 1.0 - mu;
        let bias = (e * (k * k * k * k * k) + rest).clamp(0.0, e);
        [e - bias, bias, e]
    }

    /// By Horner's rule in alpha, then in u.
    fn polynomial(&self, function: usize, part: usize, u: f32, a: f32) -> f32 {
        let rows = self.coefficients[function][part].chunks_exact(self.degree + 1);
        rows.map(|row| row.iter().rev().copied().reduce(|sum, c| sum * a + c).unwrap_or(0.0))
            .rev()
            .reduce(|sum, c| sum * u + c)
            .unwrap_or(0.0)
    }

    /// Multiplications, additions, divisions and roots of scale and bias; clamps not counted.
    #[must_use]
    pub fn operations(&self) -> usize {
        let horner = 2 * ((self.degree + 1) * (self.degree + 1) - 1);
        let variable = if self.variables == Variables::Coupled { 5 } else { 0 };
        4 * horner + 2 + variable + 8
    }

    #[allow(clippy::cast_possible_truncation, reason = "the code computes in f32")]
    fn off(&self, samples: &[Sample], practical: bool) -> Off {
        let mut off = Off::default();
        let mut n = 0.0;
        for s in samples.iter().filter(|s| s.practical || !practical) {
            let e = s.value[0];
            let bias = e * libm::pow(1.0 - s.mu, 5.0) + s.value[1];
            for (got, want) in self.evaluate(s.mu as f32, s.alpha as f32).iter().zip([e - bias, bias, e]) {
                let error = (f64::from(*got) - want).abs();
                off.mean += error;
                n += 1.0;
                if error > off.largest {
                    (off.largest, off.at) = (error, [s.mu, s.alpha]);
                }
            }
        }
        off.mean /= f64::max(n, 1.0);
        off
    }

    /// A function `split_sum(mu, alpha)` that returns scale, bias and E.
    #[must_use]
    pub fn code(&self, lang: Lang) -> String {
        let (float, suffix, bind, clamp, max, sqrt) = match lang {
            Lang::Glsl | Lang::Hlsl => ("float", "", "float", "clamp", "max", "sqrt"),
            Lang::Wgsl => ("f32", "", "let", "clamp", "max", "sqrt"),
            Lang::Rust => ("f32", "", "let", "f32::clamp", "f32::max", "f32::sqrt"),
            Lang::C => ("float", "f", "const float", "brdf_clamp", "fmaxf", "sqrtf"),
        };
        let mut body = String::new();
        let one = format!("1.0{suffix}");
        let u = match self.variables {
            Variables::Coupled => {
                format!("{sqrt}(mu * ({one} + alpha) / {max}(mu + alpha, 1e-30{suffix}))")
            }
            Variables::Plain => "mu".to_owned(),
        };
        let _ = writeln!(body, "    {bind} u = {u};");
        for (f, name) in ["e", "r"].iter().enumerate() {
            for (part, side) in ["p", "q"].iter().enumerate() {
                let text = self.horner(f, part, suffix);
                let _ = writeln!(body, "    {bind} {name}_{side} = {text};");
            }
        }
        let zero = format!("0.0{suffix}");
        let _ = writeln!(body, "    {bind} e = {clamp}(e_p / e_q, {zero}, {one});");
        let _ = writeln!(body, "    {bind} k = {one} - mu;");
        let _ = writeln!(body, "    {bind} bias = {clamp}(e * (k * k * k * k * k) + r_p / r_q, {zero}, e);");
        let open = match lang {
            Lang::Glsl => "vec3 split_sum(float mu, float alpha) {\n".to_owned(),
            Lang::Hlsl => "float3 split_sum(float mu, float alpha) {\n".to_owned(),
            Lang::Wgsl => "fn split_sum(mu: f32, alpha: f32) -> vec3<f32> {\n".to_owned(),
            Lang::Rust => format!("pub fn split_sum(mu: {float}, alpha: {float}) -> [{float}; 3] {{\n"),
            Lang::C => "#include <math.h>\n\nstatic float brdf_clamp(float x, float lo, float hi) {\n    \
                        return x < lo ? lo : (x > hi ? hi : x);\n}\n\n\
                        static void split_sum(float mu, float alpha, float out[3]) {\n"
                .to_owned(),
        };
        let close = match lang {
            Lang::Glsl => "    return vec3(e - bias, bias, e);\n}\n",
            Lang::Hlsl => "    return float3(e - bias, bias, e);\n}\n",
            Lang::Wgsl => "    return vec3<f32>(e - bias, bias, e);\n}\n",
            Lang::Rust => "    [e - bias, bias, e]\n}\n",
            Lang::C => "    out[0] = e - bias; out[1] = bias; out[2] = e;\n}\n",
        };
        format!("{}{open}{body}{close}", self.comment())
    }

    fn comment(&self) -> String {
        let line = |what: &str, o: &Off| {
            let [mu, alpha] = o.at;
            format!(
                "// {what}: largest {:.2e} at mu = {mu:.4}, alpha = {alpha:.4}, mean {:.2e}\n",
                o.largest, o.mean
            )
        };
        format!(
            "// Split sum of {}: scale, bias, E = scale + bias, each in [0, 1]; mu = n.v, alpha = roughness^2, both in [0, 1].\n\
             // Rational, degree {}; {} operations. Errors in f32, against integrals:\n{}{}",
            self.model,
            self.degree,
            self.operations(),
            line("whole domain", &self.whole),
            line("mu >= 0.05, roughness >= 0.09", &self.practical)
        )
    }

    fn horner(&self, function: usize, part: usize, suffix: &str) -> String {
        let rows = self.coefficients[function][part].chunks_exact(self.degree + 1);
        let number = |c: &f32| if *c < 0.0 { format!("({c:?}{suffix})") } else { format!("{c:?}{suffix}") };
        let inner = |row: &[f32]| {
            let terms = row.iter().rev().map(number);
            terms.reduce(|sum, c| format!("({sum}) * alpha + {c}")).unwrap_or_default()
        };
        rows.map(inner).rev().reduce(|sum, c| format!("({sum}) * u + ({c})")).unwrap_or_default()
    }
}
