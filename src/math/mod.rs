//! Frames, special functions and sums; f64 throughout, transcendental functions from `libm` only.

pub mod double;
pub mod frame;
pub mod root;
pub mod special;
pub mod sum;
