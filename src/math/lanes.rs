//! Four numbers that go through the same operations, so that a compiler can put them into one register.
//!
//! Only + - * / and square roots, which IEEE 754 rounds the same way on every machine and at every register width; never a fused
//! multiply-add. [`wide`] runs a kernel with the widest registers that the processor has: the bits are those of the narrow ones.

use std::ops::{Add, Div, Mul, Sub};

/// How many numbers.
pub const LANES: usize = 4;

/// Four numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(32))]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    /// The same number in every lane.
    #[inline(always)]
    #[must_use]
    pub fn all(x: f64) -> Lanes {
        Lanes([x; LANES])
    }

    /// A function of each.
    #[inline(always)]
    #[must_use]
    pub fn map(self, f: impl Fn(f64) -> f64) -> Lanes {
        let [a, b, c, d] = self.0;
        Lanes([f(a), f(b), f(c), f(d)])
    }

    /// Square roots.
    #[inline(always)]
    #[must_use]
    pub fn sqrt(self) -> Lanes {
        let [a, b, c, d] = self.0;
        Lanes([a.sqrt(), b.sqrt(), c.sqrt(), d.sqrt()])
    }

    /// The smallest of them.
    #[inline(always)]
    #[must_use]
    pub fn least(self) -> f64 {
        self.0.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

macro_rules! operator {
    ($trait:ident, $function:ident, $sign:tt) => {
        impl $trait for Lanes {
            type Output = Lanes;
            #[inline(always)]
            fn $function(self, other: Lanes) -> Lanes {
                let [a, b, c, d] = self.0;
                let [e, f, g, h] = other.0;
                Lanes([a $sign e, b $sign f, c $sign g, d $sign h])
            }
        }
        impl $trait<f64> for Lanes {
            type Output = Lanes;
            #[inline(always)]
            fn $function(self, other: f64) -> Lanes {
                let [a, b, c, d] = self.0;
                Lanes([a $sign other, b $sign other, c $sign other, d $sign other])
            }
        }
        impl $trait<Lanes> for f64 {
            type Output = Lanes;
            #[inline(always)]
            fn $function(self, other: Lanes) -> Lanes {
                let [a, b, c, d] = other.0;
                Lanes([self $sign a, self $sign b, self $sign c, self $sign d])
            }
        }
    };
}
operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

/// A kernel: everything that it calls is to be inlined, else it is compiled for the narrow registers.
pub trait Kernel {
    /// What it computes.
    type Output;

    /// Computes it.
    fn run(self) -> Self::Output;
}

struct Job<K>(K);

impl<K: Kernel> pulp::NullaryFnOnce for Job<K> {
    type Output = K::Output;
    #[inline(always)]
    fn call(self) -> K::Output {
        self.0.run()
    }
}

/// Runs a kernel with the widest registers that this processor has.
#[inline]
pub fn wide<K: Kernel>(kernel: K) -> K::Output {
    pulp::Arch::new().dispatch(Job(kernel))
}
