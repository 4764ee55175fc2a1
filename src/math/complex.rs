//! Complex numbers, as far as optics needs them.

use std::ops::{Add, Mul, Neg, Sub};

/// `re + i im`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Complex {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Complex {
    /// The real number `re`.
    #[must_use]
    pub const fn real(re: f64) -> Self {
        Self { re, im: 0.0 }
    }

    /// `re + i im`.
    #[must_use]
    pub const fn new(re: f64, im: f64) -> Self {
        Self { re, im }
    }

    /// |z|². Overflows where the square does; see [`Complex::modulus`].
    #[must_use]
    pub fn norm2(self) -> f64 {
        self.re * self.re + self.im * self.im
    }

    /// |z|.
    #[must_use]
    pub fn modulus(self) -> f64 {
        libm::hypot(self.re, self.im)
    }

    /// arg z in (−π, π]; 0 for z = 0.
    #[must_use]
    pub fn argument(self) -> f64 {
        libm::atan2(self.im, self.re)
    }

    /// `z · x` for a real x.
    #[must_use]
    pub fn scale(self, x: f64) -> Self {
        Self { re: self.re * x, im: self.im * x }
    }

    /// a/b by the conjugate of b; NaN for b = 0.
    #[must_use]
    pub fn over(self, b: Self) -> Self {
        // One exponent is taken out of b first, so that |b|² neither overflows nor underflows.
        let size = b.re.abs().max(b.im.abs());
        let unit = b.scale(1.0 / size);
        (self * Self::new(unit.re, -unit.im)).scale(1.0 / (unit.norm2() * size))
    }

    /// The square root with Im ≥ 0 (and Re ≥ 0 if that is 0): the wave that decays into the medium.
    ///
    /// The part with the larger modulus comes first; the other follows from 2 Re Im = im z without a difference.
    #[must_use]
    pub fn sqrt_upper(self) -> Self {
        let modulus = self.modulus();
        if modulus == 0.0 {
            return Self::real(0.0);
        }
        let (re, im) = if self.re >= 0.0 {
            let re = (0.5 * (modulus + self.re)).sqrt();
            (re, 0.5 * self.im / re)
        } else {
            let im = (0.5 * (modulus - self.re)).sqrt();
            (0.5 * self.im / im, im)
        };
        if im < 0.0 { Self::new(-re, -im) } else { Self::new(re, im) }
    }

    /// `exp(i z) − 1`, without cancellation for small z.
    #[must_use]
    pub fn expm1_i(self) -> Self {
        let shrink = libm::expm1(-self.im);
        let (sin, cos) = libm::sincos(self.re);
        let half = libm::sin(0.5 * self.re);
        // e^(−y) cos x − 1 = (e^(−y) − 1) cos x − 2 sin²(x/2)
        Self::new(shrink * cos - 2.0 * half * half, (1.0 + shrink) * sin)
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self::new(self.re + b.re, self.im + b.im)
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self::new(self.re - b.re, self.im - b.im)
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self::new(self.re * b.re - self.im * b.im, self.re * b.im + self.im * b.re)
    }
}

impl Neg for Complex {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.re, -self.im)
    }
}
