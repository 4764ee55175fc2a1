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
