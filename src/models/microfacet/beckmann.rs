//! Beckmann: the default kernel, which calls the terms node by node (erfc does not vectorise).

use super::{Beckmann, Distribution};

impl Distribution for Beckmann {
    fn widths(&self) -> [f64; 2] {
        [self.alpha_x(), self.alpha_y()]
    }

    /// exp(-6.5^2) = 5e-19: below the rounding of any sum.
    fn reach(&self) -> f64 {
        6.5
    }
}
