//! Numbers that only one kind of table has: what the laws know of them is told in the file of the kind, beside the formula.

use super::Spec;

/// A quadrature that shares nothing with those of the bakers: the integral between the breaks to an absolute error; value and error.
pub type Quadrature<'a> = dyn Fn(&[f64], f64, &mut dyn FnMut(f64) -> f64) -> (f64, f64) + 'a;

/// What a rule that is independent of the baker's says of a number at a point: value and error, or nothing. It aims at the error that
/// is given, and integrates in coordinates of its own.
pub type OwnTruth = fn(&Spec, &[f64], f64, &Quadrature<'_>) -> Option<(f64, f64)>;

/// Such a number.
#[derive(Debug)]
pub struct OwnNumber {
    /// In words, as in files and reports.
    pub name: &'static str,
    /// Along which quantity it rises (1) or falls (-1) from texel to texel.
    pub trend: Option<(&'static str, f64)>,
    /// The rule that the law `honest` compares with.
    pub truth: OwnTruth,
}

impl PartialEq for OwnNumber {
    /// Each is one static.
    fn eq(&self, other: &OwnNumber) -> bool {
        std::ptr::eq(self, other)
    }
}
