//! Student's t: the default kernel, which calls the terms node by node.

use super::{Distribution, StudentT};
use crate::integrate::FacetLobe;

/// Finest scale of the chart at the horizon, in widths.
const FINEST: f64 = 1e-9;

impl Distribution for StudentT {
    fn widths(&self) -> [f64; 2] {
        [self.alpha_x(), self.alpha_y()]
    }

    fn facets(&self) -> FacetLobe {
        FacetLobe { steep: self.gamma() < 2.0, ..FacetLobe::smith(self.widths(), self.reach()) }
    }

    /// A view in the horizon sees facets of all slopes by what they hide: beyond the slope x the part `x^(3 - 2 gamma)`, which
    /// falls slowly as gamma nears 3/2. The chart sees slopes up to the inverse of its finest scale.
    fn left_out(&self, mu_o: f64) -> f64 {
        let decay = 2.0 * self.gamma() - 3.0;
        let width = self.alpha_x().max(self.alpha_y());
        if mu_o > FINEST * width || decay >= 1.0 { 0.0 } else { libm::pow(FINEST, decay) }
    }

    /// Where `(1 + X / (gamma - 1))^(-gamma)` is below 1e-19, X = tan^2 / alpha^2; infinite for a long tail.
    fn reach(&self) -> f64 {
        let b = self.gamma() - 1.0;
        let end = (b * libm::expm1(44.0 / self.gamma())).sqrt();
        if end < 30.0 { end } else { f64::INFINITY }
    }
}
