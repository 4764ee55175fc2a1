//! A small expression tree: what a warp computes, before a language writes it.

use super::{Call, Function, Syntax};

/// An expression in floating point.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Expression {
    Name(String),
    Number(f64),
    Infix(Box<Expression>, char, Box<Expression>),
    Call(Function, Vec<Expression>),
}

use Expression::{Infix, Name, Number};

impl Expression {
    pub(crate) fn name(name: impl Into<String>) -> Expression {
        Name(name.into())
    }

    fn infix(self, operator: char, other: Expression) -> Expression {
        Infix(Box::new(self), operator, Box::new(other))
    }

    /// Sum; without a term that is 0.
    pub(crate) fn plus(self, other: Expression) -> Expression {
        if other.is(0.0) { self } else { self.infix('+', other) }
    }

    pub(crate) fn minus(self, other: Expression) -> Expression {
        if other.is(0.0) { self } else { self.infix('-', other) }
    }

    pub(crate) fn times(self, other: Expression) -> Expression {
        match () {
            () if other.is(1.0) => self,
            () if self.is(1.0) => other,
            () => self.infix('*', other),
        }
    }

    pub(crate) fn over(self, other: Expression) -> Expression {
        if other.is(1.0) { self } else { self.infix('/', other) }
    }

    pub(crate) fn max(self, least: f64) -> Expression {
        Expression::Call(Function::Max, vec![self, Number(least)])
    }

    pub(crate) fn clamp(self, least: f64, most: f64) -> Expression {
        Expression::Call(Function::Min, vec![self.max(least), Number(most)])
    }

    pub(crate) fn cos(self) -> Expression {
        Expression::Call(Function::Cos, vec![self])
    }

    /// Power of a number that is not negative, by roots and products where they do, as the warps compute it.
    pub(crate) fn pow(self, p: f64) -> Expression {
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

    pub(crate) fn min(self, other: Expression) -> Expression {
        Expression::Call(Function::Min, vec![self, other])
    }

    /// The value in f32, operation by operation as the code computes it; `None` for a name without a value.
    #[allow(clippy::cast_possible_truncation, reason = "the program computes in f32")]
    pub(crate) fn evaluate(&self, of: &impl Fn(&str) -> Option<f32>) -> Option<f32> {
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
    pub(crate) fn operations(&self) -> usize {
        match self {
            Name(_) | Number(_) => 0,
            Infix(a, _, b) => 1 + a.operations() + b.operations(),
            Expression::Call(function, arguments) => {
                let own = usize::from(!matches!(function, Function::Min | Function::Max));
                own + arguments.iter().map(Expression::operations).sum::<usize>()
            }
        }
    }

    fn is(&self, value: f64) -> bool {
        matches!(self, Number(v) if (v - value).abs() == 0.0)
    }

    /// Text in a language; parts of an infix expression that are infix themselves are in brackets.
    pub(crate) fn write(&self, syntax: &dyn Syntax, double: bool) -> String {
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
