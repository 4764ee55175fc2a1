//! Compensated summation: the order is the caller's, the rounding error is not.

/// Neumaier's compensated sum.
///
/// Each addition keeps its exact rounding error in a second variable, whichever operand is larger.
/// Source: [Neumaier1974](crate::cite::NEUMAIER_1974), algorithm IV.
/// Accuracy: |error| ≤ 2u·|Σx| + O(n u²)·Σ|x| with u = 2⁻⁵³ (`tests/math.rs`), against n u·Σ|x| of a plain loop.
/// The result depends on the order of the terms by that much only, but it does depend: keep a fixed order
/// where bytes must not change.
///
/// ```
/// use brdfbake::math::sum::Sum;
/// let mut sum = Sum::default();
/// for x in [1.0, 1e100, 1.0, -1e100] {
///     sum.add(x);
/// }
/// assert_eq!(sum.total(), 2.0);
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    /// Adds one term.
    pub fn add(&mut self, x: f64) {
        let t = self.sum + x;
        self.lost += if self.sum.abs() >= x.abs() { (self.sum - t) + x } else { (x - t) + self.sum };
        self.sum = t;
    }

    /// Adds another sum with its own compensation.
    pub fn merge(&mut self, other: Self) {
        self.add(other.sum);
        self.lost += other.lost;
    }

    /// The sum, rounded once.
    ///
    /// Guard: an infinite sum makes the compensation NaN (∞ − ∞); the plain sum is returned then.
    #[must_use]
    pub fn total(self) -> f64 {
        let total = self.sum + self.lost;
        if total.is_nan() { self.sum } else { total }
    }
}

impl FromIterator<f64> for Sum {
    fn from_iter<I: IntoIterator<Item = f64>>(terms: I) -> Self {
        let mut sum = Self::default();
        for x in terms {
            sum.add(x);
        }
        sum
    }
}

/// The compensated sum of `terms`, in their order; see [`Sum`].
#[must_use]
pub fn compensated_sum<I: IntoIterator<Item = f64>>(terms: I) -> f64 {
    terms.into_iter().collect::<Sum>().total()
}
