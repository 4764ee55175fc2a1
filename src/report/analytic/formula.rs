//! A formula as named steps: evaluated in f32 as the code computes it, counted, and written in a language.

use crate::encode::code::{C, Glsl, Hlsl, Python, Rust, Syntax, Wgsl};
use crate::grid::expression::Expression;
use crate::grid::scalar::Scalar;
use crate::math::rational::{Fitted, Term, Terms};
use std::fmt::Write;

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
    Python,
}

impl Lang {
    pub(super) fn syntax(self) -> &'static dyn Syntax {
        match self {
            Lang::Glsl => &Glsl,
            Lang::Wgsl => &Wgsl,
            Lang::Hlsl => &Hlsl,
            Lang::Rust => &Rust,
            Lang::C => &C,
            Lang::Python => &Python,
        }
    }

    /// Most numbers that a function of it returns.
    #[must_use]
    pub fn most_results(self) -> usize {
        self.syntax().most_channels()
    }
}

/// Steps from arguments to results.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Formula {
    pub(super) name: String,
    pub(super) arguments: Vec<&'static str>,
    /// Steps in order, each a name and what it is.
    pub(super) steps: Vec<(String, Expression)>,
    pub(super) results: Vec<Expression>,
    /// Steps that divide, and what they were divided by: times that they are 1 + ..., and must be positive.
    pub(super) denominators: Vec<(String, f64)>,
}

impl Formula {
    /// The results, then the least denominator (1 if there is none).
    pub(super) fn evaluate(&self, arguments: &[f32]) -> (Vec<f32>, f64) {
        let mut known: Vec<(&str, f32)> =
            self.arguments.iter().copied().zip(arguments.iter().copied()).collect();
        let value = |e: &Expression, known: &[(&str, f32)]| {
            e.evaluate(&|name| known.iter().rev().find(|k| k.0 == name).map(|k| k.1)).unwrap_or(f32::NAN)
        };
        let mut least = 1.0_f64;
        for (name, step) in &self.steps {
            let v = value(step, &known);
            if let Some((_, unit)) = self.denominators.iter().find(|d| d.0 == *name) {
                // a NaN is no positive number either
                let q = f64::from(v) * unit;
                least = if q < least || q.is_nan() { q } else { least };
            }
            known.push((name, v));
        }
        (self.results.iter().map(|r| value(r, &known)).collect(), least)
    }

    /// The same without arithmetic that changes nothing and without steps that nothing uses.
    pub(super) fn simplified(self) -> Formula {
        let Formula { name, arguments, steps, results, denominators } = self;
        let results: Vec<Expression> = results.into_iter().map(Expression::simplified).collect();
        let mut kept: Vec<(String, Expression)> = Vec::new();
        for (step, e) in steps.into_iter().rev() {
            let used = results.iter().chain(kept.iter().map(|k| &k.1)).any(|e| e.uses(&step));
            if used || denominators.iter().any(|d| d.0 == step) {
                kept.push((step, e.simplified()));
            }
        }
        kept.reverse();
        Formula { name, arguments, steps: kept, results, denominators }
    }

    pub(super) fn operations(&self) -> usize {
        self.steps.iter().map(|s| &s.1).chain(&self.results).map(Expression::operations).sum()
    }

    /// A function of the arguments that returns the results.
    pub(super) fn code(&self, lang: Lang) -> String {
        let syntax = lang.syntax();
        let name = &self.name;
        let mut body = String::new();
        for (step, e) in &self.steps {
            let _ = writeln!(body, "    {}", syntax.float(step, &e.write(syntax, false), false));
        }
        let results: Vec<String> = self.results.iter().map(|r| r.write(syntax, false)).collect();
        let arguments = |before: &str, behind: &str| -> String {
            let all: Vec<String> = self.arguments.iter().map(|a| format!("{before}{a}{behind}")).collect();
            all.join(", ")
        };
        let n = results.len().clamp(1, 4) - 1;
        let tuple = |kind: &str| format!("{kind}({})", results.join(", "));
        match lang {
            Lang::Glsl | Lang::Hlsl => {
                let kinds = match lang {
                    Lang::Glsl => ["float", "vec2", "vec3", "vec4"],
                    _ => ["float", "float2", "float3", "float4"],
                };
                let (kind, result) = (kinds[n], tuple(kinds[n]));
                format!("{kind} {name}({}) {{\n{body}    return {result};\n}}\n", arguments("float ", ""))
            }
            Lang::Wgsl => {
                let kind = ["f32", "vec2<f32>", "vec3<f32>", "vec4<f32>"][n];
                let result = tuple(kind);
                format!(
                    "fn {name}({}) -> {kind} {{\n{body}    return {result};\n}}\n",
                    arguments("", ": f32")
                )
            }
            Lang::Rust => {
                let (list, count) = (results.join(", "), results.len());
                let arguments = arguments("", ": f32");
                format!("pub fn {name}({arguments}) -> [f32; {count}] {{\n{body}    [{list}]\n}}\n")
            }
            Lang::C => {
                let out: String =
                    results.iter().enumerate().map(|(i, r)| format!("    out[{i}] = {r};\n")).collect();
                let (arguments, count) = (arguments("float ", ""), results.len());
                format!(
                    "#include <math.h>\n\nstatic inline void {name}({arguments}, float out[{count}]) {{\n{body}{out}}}\n"
                )
            }
            Lang::Python => {
                let (arguments, list) = (arguments("", ""), results.join(", "));
                format!(
                    "import numpy as np\n\n\ndef {name}({arguments}):\n{body}    \
                     return np.stack(np.broadcast_arrays({list}), axis=-1)\n"
                )
            }
        }
    }
}

/// A variable by name.
pub(super) fn name(name: &str) -> Expression {
    Expression::name(name)
}

/// A number.
pub(super) fn number(v: f64) -> Expression {
    Expression::Number(v)
}

/// P and Q, and what both were divided by.
pub(super) struct Ratio {
    pub(super) above: Expression,
    pub(super) below: Expression,
    pub(super) unit: f64,
}

/// P and Q by Horner's rule, in y inside, in x outside: two operations a term, as no term stands without its divisors. Both
/// are divided by the coefficient of Q with which Horner's rule begins, which saves its multiplication.
pub(super) fn ratio(terms: &Terms, fitted: &Fitted, x: &str, y: &str) -> Ratio {
    let largest = fitted.below.iter().fold(1.0_f64, |m, c| m.max(c.abs()));
    let unit = fitted.below.last().copied().filter(|c| c.abs() > 1e-4 * largest).unwrap_or(1.0);
    let above = terms.above.iter().copied().zip(fitted.above.iter().map(|c| c / unit));
    let below = terms.below.iter().copied().zip(fitted.below.iter().map(|c| c / unit));
    let one = std::iter::once(([0, 0], 1.0 / unit));
    Ratio { above: horner(above, x, y), below: horner(one.chain(below), x, y), unit }
}

#[allow(clippy::cast_possible_truncation, reason = "the code computes in f32")]
fn horner(terms: impl Iterator<Item = (Term, f64)>, x: &str, y: &str) -> Expression {
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for ([i, j], c) in terms {
        if rows.len() <= i {
            rows.resize(i + 1, Vec::new());
        }
        if rows[i].len() <= j {
            rows[i].resize(j + 1, 0.0);
        }
        rows[i][j] = f64::from(c as f32);
    }
    let by = |v: &str, parts: Vec<Expression>| {
        let sum = parts.into_iter().rev().reduce(|sum, part| sum.times(name(v)).plus(part));
        sum.unwrap_or(Expression::Number(0.0))
    };
    let rows: Vec<Expression> =
        rows.into_iter().map(|row| by(y, row.into_iter().map(Expression::Number).collect())).collect();
    by(x, rows)
}
