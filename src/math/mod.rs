//! Frames, special functions and sums; f64 throughout, transcendental functions from `libm` only.
