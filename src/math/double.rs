//! Double-double arithmetic: an unevaluated sum of two f64, about 106 bits.
//!
//! Slow, and used once a process: where tables of constants (quadrature nodes) are made to the last bit. Only + − · /,
//! so the bits are the same on every machine; no fused operations.

use std::ops::{Add, Mul, Sub};

/// hi + lo with |lo| ≤ ulp(hi)/2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Double {
    /// The value rounded to f64.
    pub hi: f64,
    /// What rounding lost.
    pub lo: f64,
}

impl Double {
    /// a + b exactly, for |a| ≥ |b| or a = 0.
    fn ordered_sum(a: f64, b: f64) -> Self {
        let hi = a + b;
        Self { hi, lo: b - (hi - a) }
    }

    /// a + b exactly. Source: [Knuth 1969](crate::cite::KNUTH_1969) §4.2.2 theorem B.
    #[must_use]
    pub fn sum(a: f64, b: f64) -> Self {
        let hi = a + b;
        let virtual_b = hi - a;
        Self { hi, lo: (a - (hi - virtual_b)) + (b - virtual_b) }
    }

    /// a·b exactly, unless it over- or underflows. Source: [Dekker1971](crate::cite::DEKKER_1971) §5.
    #[must_use]
    pub fn product(a: f64, b: f64) -> Self {
        let (a_hi, a_lo) = split(a);
        let (b_hi, b_lo) = split(b);
        let hi = a * b;
        Self { hi, lo: ((a_hi * b_hi - hi) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo }
    }

    /// The quotient by a plain number, to about 1e-31 relative.
    #[must_use]
    pub fn over(self, b: f64) -> Self {
        let first = self.hi / b;
        let rest = self - Self::product(first, b);
        Self::ordered_sum(first, (rest.hi + rest.lo) / b)
    }

    /// 1/self, to about 1e-31 relative.
    #[must_use]
    pub fn reciprocal(self) -> Self {
        let first = 1.0 / self.hi;
        // One Newton step: x + x (1 − self x).
        let rest = Self::from(1.0) - self * Self::from(first);
        Self::from(first) + rest * Self::from(first)
    }

    /// Rounded to f64.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        self.hi + self.lo
    }
}

/// Two halves of the significand, 26 bits each.
fn split(a: f64) -> (f64, f64) {
    let c = 134_217_729.0 * a;
    let hi = c - (c - a);
    (hi, a - hi)
}

impl From<f64> for Double {
    fn from(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }
}

impl Add for Double {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let high = Self::sum(self.hi, other.hi);
        let low = Self::sum(self.lo, other.lo);
        let mid = Self::ordered_sum(high.hi, high.lo + low.hi);
        Self::ordered_sum(mid.hi, mid.lo + low.lo)
    }
}

impl Sub for Double {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + Self { hi: -other.hi, lo: -other.lo }
    }
}

impl Mul for Double {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = Self::product(self.hi, other.hi);
        Self::ordered_sum(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}
