//! A small expression tree: what a warp computes, before a language writes it.

use super::{Call, Function, Syntax};

/// An expression in floating point.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Expression {
    Name(String),
    Number(f64),
    Infix(Box<Expression>, char, Box<Expression>),
    Call(Function, Vec<Expression>),
}

use Expression::{Infix, Name, Number};

impl Expression {
    pub(super) fn name(name: impl Into<String>) -> Expression {
        Name(name.into())
    }

    fn infix(self, operator: char, other: Expression) -> Expression {
        Infix(Box::new(self), operator, Box::new(other))
    }

    /// Sum; without a term that is 0.
    pub(super) fn plus(self, other: Expression) -> Expression {
        if other.is(0.0) { self } else { self.infix('+', other) }
    }

    pub(super) fn minus(self, other: Expression) -> Expression {
        if other.is(0.0) { self } else { self.infix('-', other) }
    }

    pub(super) fn times(self, other: Expression) -> Expression {
        match () {
            () if other.is(1.0) => self,
            () if self.is(1.0) => other,
            () => self.infix('*', other),
        }
    }

    pub(super) fn over(self, other: Expression) -> Expression {
        if other.is(1.0) { self } else { self.infix('/', other) }
    }

    pub(super) fn max(self, least: f64) -> Expression {
        Expression::Call(Function::Max, vec![self, Number(least)])
    }

    pub(super) fn clamp(self, least: f64, most: f64) -> Expression {
        Expression::Call(Function::Min, vec![self.max(least), Number(most)])
    }

    pub(super) fn cos(self) -> Expression {
        Expression::Call(Function::Cos, vec![self])
    }

    /// Power of a number that is not negative, by roots and products where they do, as the warps compute it.
    pub(super) fn pow(self, p: f64) -> Expression {
        let sqrt = |x| Expression::Call(Function::Sqrt, vec![x]);
        let is = |q: f64| (p - q).abs() == 0.0;
        match () {
            () if is(1.0) => self,
            () if is(0.5) => sqrt(self),
            () if is(0.25) => sqrt(sqrt(self)),
            () if is(2.0) => self.clone().times(self),
            () => Expression::Call(Function::Pow, vec![self, Number(p)]),
        }
    }

    fn is(&self, value: f64) -> bool {
        matches!(self, Number(v) if (v - value).abs() == 0.0)
    }

    /// Text in a language; parts of an infix expression that are infix themselves are in brackets.
    pub(super) fn write(&self, syntax: &dyn Syntax, double: bool) -> String {
        let part = |e: &Expression| match e {
            Infix(..) => format!("({})", e.write(syntax, double)),
            Number(v) if *v < 0.0 => format!("({})", e.write(syntax, double)),
            _ => e.write(syntax, double),
        };
        match self {
            Name(name) => name.clone(),
            Number(v) => format!("{}{}", number(*v, double), syntax.suffix(double)),
            Infix(a, operator, b) => format!("{} {operator} {}", part(a), part(b)),
            Expression::Call(function, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(|a| a.write(syntax, double)).collect();
                syntax.call(&Call { function: *function, arguments: &arguments, double })
            }
        }
    }
}

/// A number with a point or an exponent, the shortest that reads back to the same bits.
#[allow(clippy::cast_possible_truncation, reason = "the program computes in f32")]
pub(super) fn number(v: f64, double: bool) -> String {
    if double { format!("{v:?}") } else { format!("{:?}", v as f32) }
}
