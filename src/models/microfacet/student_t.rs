//! Student's t: the default kernel, which calls the terms node by node.

use super::{Distribution, StudentT};

impl Distribution for StudentT {
    fn widths(&self) -> [f64; 2] {
        [self.alpha_x(), self.alpha_y()]
    }

    /// Where `(1 + X / (gamma - 1))^(-gamma)` is below 1e-19, X = tan^2 / alpha^2; infinite for a long tail.
    fn reach(&self) -> f64 {
        let b = self.gamma() - 1.0;
        let end = (b * libm::expm1(44.0 / self.gamma())).sqrt();
        if end < 30.0 { end } else { f64::INFINITY }
    }
}
