//! A small expression tree: what a map of an axis computes, before a language writes it.

use crate::math::figures::exact;
use std::fmt::Debug;

/// Functions that an expression calls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Function {
    /// Square root.
    Sqrt,
    /// Power.
    Pow,
    /// Cosine.
    Cos,
    /// The smaller of two.
    Min,
    /// The larger of two.
    Max,
}

/// A call of a function.
#[derive(Debug)]
pub struct Call<'a> {
    /// Which.
    pub function: Function,
    /// Its arguments, written.
    pub arguments: &'a [String],
    /// In 64 bits?
    pub double: bool,
}

impl Call<'_> {
    /// `sqrt(x)`: as GLSL, HLSL, WGSL, Python and formulas have it; behind something where the names stand in a `namespace`.
    #[must_use]
    pub fn common(&self, namespace: &str) -> String {
        let name = match self.function {
            Function::Sqrt => "sqrt",
            Function::Pow => "pow",
            Function::Cos => "cos",
            Function::Min => "min",
            Function::Max => "max",
        };
        format!("{namespace}{name}({})", self.arguments.join(", "))
    }
}

/// How numbers and calls are written. Infix operators are the same everywhere.
pub trait Notation: Debug {
    /// A number.
    fn number(&self, v: f64, double: bool) -> String;
    /// A call.
    fn call(&self, call: &Call<'_>) -> String;
}

/// Formulas in reports and metadata, in the common words of C, shaders and Python: `sqrt(x)`, `pow(x, y)`, `cos`, `min`, `max`.
#[derive(Debug, Clone, Copy)]
pub struct PlainText;

impl Notation for PlainText {
    fn number(&self, v: f64, _: bool) -> String {
        exact(v)
    }

    fn call(&self, call: &Call<'_>) -> String {
        call.common("")
    }
}

/// An expression in floating point; the trait `Scalar` builds it.
#[derive(Debug, Clone, PartialEq)]
pub enum Expression {
    /// A variable.
    Name(String),
    /// A constant.
    Number(f64),
    /// Two expressions and one of `+ - * /`.
    Infix(Box<Expression>, char, Box<Expression>),
    /// A function of expressions.
    Call(Function, Vec<Expression>),
}

use Expression::{Infix, Name, Number};

impl Expression {
    /// A variable.
    #[must_use]
    pub fn name(name: impl Into<String>) -> Expression {
        Name(name.into())
    }

    pub(super) fn infix(self, operator: char, other: Expression) -> Expression {
        Infix(Box::new(self), operator, Box::new(other))
    }

    /// The smaller of two.
    #[must_use]
    pub fn min(self, other: Expression) -> Expression {
        Expression::Call(Function::Min, vec![self, other])
    }

    /// The value in f32, operation by operation as the code computes it; `None` for a name without a value.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "the program computes in f32")]
    pub fn evaluate(&self, of: &impl Fn(&str) -> Option<f32>) -> Option<f32> {
        match self {
            Name(name) => of(name),
            Number(v) => Some(*v as f32),
            Infix(a, operator, b) => {
                let (a, b) = (a.evaluate(of)?, b.evaluate(of)?);
                Some(match operator {
                    '+' => a + b,
                    '-' => a - b,
                    '*' => a * b,
                    _ => a / b,
                })
            }
            Expression::Call(function, arguments) => {
                let first = arguments.first()?.evaluate(of)?;
                let second = || arguments.get(1)?.evaluate(of);
                Some(match function {
                    Function::Sqrt => first.sqrt(),
                    Function::Cos => libm::cosf(first),
                    Function::Pow => libm::powf(first, second()?),
                    Function::Min => first.min(second()?),
                    Function::Max => first.max(second()?),
                })
            }
        }
    }

    /// Sums, differences, products, quotients, roots and other functions; minima and maxima are not counted.
    #[must_use]
    pub fn operations(&self) -> usize {
        match self {
            Name(_) | Number(_) => 0,
            Infix(a, _, b) => 1 + a.operations() + b.operations(),
            Expression::Call(function, arguments) => {
                let own = usize::from(!matches!(function, Function::Min | Function::Max));
                own + arguments.iter().map(Expression::operations).sum::<usize>()
            }
        }
    }

    /// Is the name in it?
    #[must_use]
    pub fn uses(&self, name: &str) -> bool {
        match self {
            Name(own) => own == name,
            Number(_) => false,
            Infix(a, _, b) => a.uses(name) || b.uses(name),
            Expression::Call(_, arguments) => arguments.iter().any(|a| a.uses(name)),
        }
    }

    /// The same without arithmetic that changes nothing: sums with 0, products with 0 and 1, quotients by 1, `c - (c - x)`. Numbers that
    /// are 0 in 32 bits are 0.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "the program computes in f32")]
    pub fn simplified(self) -> Expression {
        match self {
            Number(v) if (v as f32).abs() <= 0.0 => Number(0.0),
            Infix(a, operator, b) => plain(a.simplified(), operator, b.simplified()),
            Expression::Call(function, arguments) => {
                Expression::Call(function, arguments.into_iter().map(Expression::simplified).collect())
            }
            other => other,
        }
    }

    pub(super) fn is(&self, value: f64) -> bool {
        matches!(self, Number(v) if (v - value).abs() == 0.0)
    }

    /// Text in a notation; parts of an infix expression that are infix themselves are in brackets.
    #[must_use]
    pub fn write(&self, notation: &(impl Notation + ?Sized), double: bool) -> String {
        let part = |e: &Expression| match e {
            Infix(..) => format!("({})", e.write(notation, double)),
            Number(v) if *v < 0.0 => format!("({})", e.write(notation, double)),
            _ => e.write(notation, double),
        };
        match self {
            Name(name) => name.clone(),
            Number(v) => notation.number(*v, double),
            Infix(a, operator, b) => format!("{} {operator} {}", part(a), part(b)),
            Expression::Call(function, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(|a| a.write(notation, double)).collect();
                notation.call(&Call { function: *function, arguments: &arguments, double })
            }
        }
    }
}

/// A sum, difference, product or quotient of simplified parts.
fn plain(a: Expression, operator: char, b: Expression) -> Expression {
    match (operator, a, b) {
        ('+', zero, other) | ('+' | '-', other, zero) if zero.is(0.0) => other,
        ('*', one, other) | ('*' | '/', other, one) if one.is(1.0) => other,
        ('*', zero, _) | ('*', _, zero) | ('/', zero, _) if zero.is(0.0) => Number(0.0),
        ('-', Number(c), Infix(d, '-', x)) if d.is(c) => *x,
        (operator, a, b) => a.infix(operator, b),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arithmetic_that_changes_nothing_is_left_out() {
        let (x, n) = (|| Expression::name("x"), Number);
        let sum = |a: Expression, b| a.infix('+', b);
        let dead = sum(n(1e-60).infix('*', x()), sum(x(), n(0.0)).infix('*', n(1.0)));
        assert_eq!(dead.simplified(), x());
        assert_eq!(n(1.0).infix('-', n(1.0).infix('-', x())).simplified(), x());
        assert_eq!(x().infix('/', n(1.0)).infix('-', n(0.0)).simplified(), x());
        let kept = n(2.0).infix('-', n(1.0).infix('-', x()));
        assert_eq!(kept.clone().simplified(), kept);
        assert_eq!(n(0.0).infix('-', x()).simplified(), n(0.0).infix('-', x()));
    }
}
