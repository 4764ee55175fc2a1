//! Frames, special functions, sums and root finding; f64 throughout, transcendental functions from `libm` only.

pub mod complex;
pub mod double;
pub mod exp;
pub mod figures;
pub mod frame;
pub mod lanes;
pub mod least_squares;
pub mod nearest;
pub mod rational;
pub mod root;
pub mod shown;
pub mod simplex;
pub mod special;
pub mod square;
pub mod sum;
