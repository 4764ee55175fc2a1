//! What the maps of axes are written in: each map is one generic function, and what it is asked for (a value, a slope, the lines of
//! a program, a formula) is the type that it is called with.

use super::expression::{Expression, Function};

/// A number, or what stands for one.
pub trait Scalar: Sized + Clone {
    /// The least divisor: where a quotient is 0 / 0 its value is 0.
    const LEAST: f64;
    /// A constant.
    fn number(v: f64) -> Self;
    /// Sum.
    #[must_use]
    fn plus(self, other: Self) -> Self;
    /// Difference.
    #[must_use]
    fn minus(self, other: Self) -> Self;
    /// Product.
    #[must_use]
    fn times(self, other: Self) -> Self;
    /// Quotient.
    #[must_use]
    fn over(self, other: Self) -> Self;
    /// The larger of this and a constant.
    #[must_use]
    fn at_least(self, least: f64) -> Self;
    /// The smaller of this and a constant.
    #[must_use]
    fn at_most(self, most: f64) -> Self;
    /// Square root of a number that is not negative.
    #[must_use]
    fn root(self) -> Self;
    /// Power of a number that is not negative, when roots and products do not give it.
    #[must_use]
    fn raised(self, p: f64) -> Self;
    /// Cosine.
    #[must_use]
    fn cosine(self) -> Self;

    /// Power of a number that is not negative, by roots and products where they are exact.
    #[must_use]
    fn power(self, p: f64) -> Self {
        let is = |q: f64| (p - q).abs() == 0.0;
        match () {
            () if is(1.0) => self,
            () if is(0.5) => self.root(),
            () if is(0.25) => self.root().root(),
            () if is(2.0) => self.clone().times(self),
            () => self.raised(p),
        }
    }
}

impl Scalar for f64 {
    const LEAST: f64 = 1e-300;

    fn number(v: f64) -> f64 {
        v
    }

    fn plus(self, other: f64) -> f64 {
        self + other
    }

    fn minus(self, other: f64) -> f64 {
        self - other
    }

    fn times(self, other: f64) -> f64 {
        self * other
    }

    fn over(self, other: f64) -> f64 {
        self / other
    }

    // a NaN stays one
    fn at_least(self, least: f64) -> f64 {
        if self < least { least } else { self }
    }

    fn at_most(self, most: f64) -> f64 {
        if self > most { most } else { self }
    }

    fn root(self) -> f64 {
        self.sqrt()
    }

    fn raised(self, p: f64) -> f64 {
        if (p - 4.0).abs() == 0.0 { (self * self) * (self * self) } else { libm::pow(self, p) }
    }

    fn cosine(self) -> f64 {
        libm::cos(self)
    }
}

/// As a shader computes.
#[allow(clippy::cast_possible_truncation, reason = "numbers of 32 bits are what is asked for")]
impl Scalar for f32 {
    // as in the programs that are written
    const LEAST: f64 = 1e-30;

    fn number(v: f64) -> f32 {
        v as f32
    }

    fn plus(self, other: f32) -> f32 {
        self + other
    }

    fn minus(self, other: f32) -> f32 {
        self - other
    }

    fn times(self, other: f32) -> f32 {
        self * other
    }

    fn over(self, other: f32) -> f32 {
        self / other
    }

    fn at_least(self, least: f64) -> f32 {
        if self < least as f32 { least as f32 } else { self }
    }

    fn at_most(self, most: f64) -> f32 {
        if self > most as f32 { most as f32 } else { self }
    }

    fn root(self) -> f32 {
        self.sqrt()
    }

    fn raised(self, p: f64) -> f32 {
        libm::powf(self, p as f32)
    }

    fn cosine(self) -> f32 {
        libm::cosf(self)
    }
}

/// A value with its derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope {
    /// Value.
    pub value: f64,
    /// Derivative with respect to whatever has slope 1.
    pub slope: f64,
}

impl Scalar for Slope {
    const LEAST: f64 = f64::LEAST;

    fn number(value: f64) -> Slope {
        Slope { value, slope: 0.0 }
    }

    fn plus(self, o: Slope) -> Slope {
        Slope { value: self.value + o.value, slope: self.slope + o.slope }
    }

    fn minus(self, o: Slope) -> Slope {
        Slope { value: self.value - o.value, slope: self.slope - o.slope }
    }

    fn times(self, o: Slope) -> Slope {
        Slope { value: self.value * o.value, slope: self.slope * o.value + self.value * o.slope }
    }

    fn over(self, o: Slope) -> Slope {
        let value = self.value / o.value;
        Slope { value, slope: (self.slope - value * o.slope) / o.value }
    }

    fn at_least(self, least: f64) -> Slope {
        if self.value < least { Slope::number(least) } else { self }
    }

    fn at_most(self, most: f64) -> Slope {
        if self.value > most { Slope::number(most) } else { self }
    }

    fn root(self) -> Slope {
        let value = self.value.sqrt();
        Slope { value, slope: 0.5 * self.slope / value }
    }

    fn raised(self, p: f64) -> Slope {
        Slope { value: self.value.raised(p), slope: p * libm::pow(self.value, p - 1.0) * self.slope }
    }

    fn cosine(self) -> Slope {
        Slope { value: libm::cos(self.value), slope: -libm::sin(self.value) * self.slope }
    }
}

/// Terms and factors that change nothing are left out.
impl Scalar for Expression {
    // the least that is a normal number of f32, with room
    const LEAST: f64 = 1e-30;

    fn number(v: f64) -> Expression {
        Expression::Number(v)
    }

    fn plus(self, other: Expression) -> Expression {
        if other.is(0.0) { self } else { self.infix('+', other) }
    }

    fn minus(self, other: Expression) -> Expression {
        if other.is(0.0) { self } else { self.infix('-', other) }
    }

    fn times(self, other: Expression) -> Expression {
        match () {
            () if other.is(1.0) => self,
            () if self.is(1.0) => other,
            () => self.infix('*', other),
        }
    }

    fn over(self, other: Expression) -> Expression {
        if other.is(1.0) { self } else { self.infix('/', other) }
    }

    fn at_least(self, least: f64) -> Expression {
        Expression::Call(Function::Max, vec![self, Expression::Number(least)])
    }

    fn at_most(self, most: f64) -> Expression {
        Expression::Call(Function::Min, vec![self, Expression::Number(most)])
    }

    fn root(self) -> Expression {
        Expression::Call(Function::Sqrt, vec![self])
    }

    fn raised(self, p: f64) -> Expression {
        Expression::Call(Function::Pow, vec![self, Expression::Number(p)])
    }

    fn cosine(self) -> Expression {
        Expression::Call(Function::Cos, vec![self])
    }
}
