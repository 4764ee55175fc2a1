//! The tolerances of tests and checks, in one table with their reasons.

/// A tolerance: what is compared, how far it may be off, and why.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// What is compared.
    pub quantity: &'static str,
    /// Absolute part.
    pub absolute: f64,
    /// Relative part.
    pub relative: f64,
    /// Why it is not zero.
    pub why: &'static str,
}

/// Every tolerance.
pub static TOLERANCES: &[Tolerance] = &[
    Tolerance {
        quantity: "closed form value",
        absolute: 0.0,
        relative: 1e-12,
        why: "a few dozen roundings in f64",
    },
    Tolerance {
        quantity: "near-mirror value",
        absolute: 0.0,
        relative: 1e-9,
        why: "angles are given to half an ulp; a lobe of width alpha amplifies that by 1 / alpha",
    },
    Tolerance {
        quantity: "integral",
        absolute: 1e-10,
        relative: 1e-10,
        why: "asked for at 1e-11; the references hold 12 digits or more",
    },
];

/// Looks a tolerance up; zero if there is none of that name.
#[must_use]
pub fn of_quantity(quantity: &str) -> Tolerance {
    let none = Tolerance { quantity: "exact", absolute: 0.0, relative: 0.0, why: "bits must be equal" };
    TOLERANCES.iter().copied().find(|t| t.quantity == quantity).unwrap_or(none)
}

impl Tolerance {
    /// Is `got` near enough to `expected`? NaN never is.
    #[must_use]
    pub fn accepts(&self, got: f64, expected: f64) -> bool {
        (got - expected).abs() <= self.absolute + self.relative * expected.abs()
    }
}
