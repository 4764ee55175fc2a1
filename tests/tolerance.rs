//! How far off a number may be: the bounds of the tests in one table, each with its reason, and the comparisons that use them.
//!
//! Relative to what is expected in [`assert_relative`], absolute in [`near!`]. A bound is never moved to make a test pass: if the
//! reason no longer holds, the number is wrong or the reason is. Estimates of the code under test are no bounds of this table: a value
//! is compared with its own estimate, plus the error of what it is compared with.
#![allow(dead_code, unused_macros, unused_imports, reason = "each binary uses a part")]

// Rounding of closed forms. An operation is off by half of 2.2e-16, a function of libm by one unit in the last place at most; errors of
// n of them in a row grow like n at worst.

/// The nearest double: nothing but the rounding of the result.
pub(crate) const NEAREST: f64 = 1e-16;
/// One unit in the last place.
pub(crate) const ULP: f64 = 2e-16;
/// Two units in the last place: a function of libm and an operation or two.
pub(crate) const TWO_ULPS: f64 = 4e-16;
/// Three squares and two sums of a unit vector.
pub(crate) const UNIT_SQUARED: f64 = 5e-16;
/// A closed form of fewer than ten operations.
pub(crate) const FEW_ROUNDINGS: f64 = 1e-15;
/// A closed form of ten to twenty operations.
pub(crate) const TEN_ROUNDINGS: f64 = 2e-15;
/// A sum of tens of terms of one sign, or two quantities of [`FEW_ROUNDINGS`] that make one.
pub(crate) const LONG_SUM: f64 = 3e-15;
/// exp(x²) times erfc(x): the relative error of x² becomes x² times that in the exponential.
pub(crate) const LIBRARY_PRODUCT: f64 = 5e-15;
/// A closed form of dozens of operations and functions of libm, or one where a digit cancels.
pub(crate) const MANY_ROUNDINGS: f64 = 1e-14;
/// D of a lobe that is fitted to thousands of texels and measured at a few hundred directions: what the directions leave open.
pub(crate) const MEASURED_MISS: f64 = 0.02;
/// What storing both lobes in 16 bits may move the mean of D by.
pub(crate) const STORED_MEAN: f64 = 1e-3;
/// As [`MANY_ROUNDINGS`] after a subtraction of like numbers or a steep function, which take one digit more.
pub(crate) const DIGIT_LOST: f64 = 1e-13;
/// The same twice over, at angles next to the peak of a phase function.
pub(crate) const DIGIT_LOST_TWICE: f64 = 2e-13;
/// As [`DIGIT_LOST`], two digits more: inverses, sums of both signs, points next to a branch of a formula.
pub(crate) const DIGITS_LOST: f64 = 1e-12;
/// An inverse that is steep at an end of its domain: a digit more than [`DIGITS_LOST`].
pub(crate) const INVERSE_AT_A_POLE: f64 = 1e-11;
/// The length of a direction that was drawn at an end of the unit square for an extreme parameter: finite, and a direction.
pub(crate) const LENGTH_AT_THE_ENDS: f64 = 1e-9;
/// The square of an amplitude that is zero but for rounding.
pub(crate) const SQUARED_ROUNDING: f64 = 1e-30;
/// The last digits of a double-double, 2^-106, and the square of a rounding.
pub(crate) const DOUBLE_DOUBLE: f64 = 1e-31;
/// Values that go both ways through one formula in other order.
pub(crate) const RECIPROCITY: f64 = 1e-11;
/// A difference quotient: the square root of a rounding.
pub(crate) const DIFFERENCE_QUOTIENT: f64 = 1e-8;

// Numbers in single precision: 24 bits, half of 1.2e-7.

/// The nearest single.
pub(crate) const SINGLE_NEAREST: f64 = 6.1e-8;
/// One unit in the last place of a single.
pub(crate) const SINGLE: f64 = 1e-7;
/// Angles out of cosines that another program holds as singles.
pub(crate) const SINGLE_ANGLES: f64 = 1e-6;
/// A formula that a shader evaluates in singles: dozens of roundings.
pub(crate) const SHADER_SINGLE: f64 = 1e-5;

// Integrals and sums that a test makes itself. The number is the error of the test's rule, which converges to it: refining the rule
// moves its sum by less.

/// A smooth integrand on a sphere.
pub(crate) const INTEGRAL_13: f64 = 1e-13;
/// A smooth integrand on a line or disk.
pub(crate) const INTEGRAL_12: f64 = 1e-12;
/// Peaks that the rule is told of; the product is asked for 1e-11 or better.
pub(crate) const INTEGRAL_11: f64 = 1e-11;
/// Two of these.
pub(crate) const INTEGRAL_11_TWICE: f64 = 2e-11;
/// A chain of five of these.
pub(crate) const INTEGRAL_11_FIVE: f64 = 5e-11;
/// Peaks in two dimensions; the product is asked for 1e-10 or better.
pub(crate) const INTEGRAL_10: f64 = 1e-10;
/// Two of these.
pub(crate) const INTEGRAL_10_TWICE: f64 = 2e-10;
/// Narrow peaks and kinks; the product is asked for 1e-9 or better.
pub(crate) const INTEGRAL_9: f64 = 1e-9;
/// Two of these.
pub(crate) const INTEGRAL_9_TWICE: f64 = 2e-9;
/// Two albedos that are each asked for 1e-9, and the rounding of what is added to them.
pub(crate) const INTEGRAL_9_THRICE: f64 = 3e-9;
/// Integrands with a root at an end.
pub(crate) const INTEGRAL_8: f64 = 1e-8;
/// Quotients over the little that white lacks: errors of 1e-10 over 1e-3.
pub(crate) const INTEGRAL_7: f64 = 1e-7;
/// Marginals, each asked for 1e-7.
pub(crate) const INTEGRAL_7_TWICE: f64 = 2e-7;
/// Albedos that are asked for 1e-6 on either side.
pub(crate) const INTEGRAL_6: f64 = 1e-6;
/// The rule is converged to 1e-6, and so is the product.
pub(crate) const INTEGRAL_6_TWICE: f64 = 2e-6;
/// Integrals over two directions that are asked for 1e-5, or sums of those of 1e-7.
pub(crate) const INTEGRAL_5: f64 = 1e-5;
/// Two of these.
pub(crate) const INTEGRAL_5_TWICE: f64 = 2e-5;
/// A cumulative distribution that is read at its own inverse.
pub(crate) const INVERTED_9: f64 = 1e-9;
/// An angle out of a cosine next to 1 or -1: the root of 1e-12.
pub(crate) const ANGLE_AT_THE_END: f64 = 1e-6;
/// A sum over the spectrum, which the test ends where less than this is left.
pub(crate) const CUT_SPECTRUM: f64 = 1e-6;
/// Quotients of two sums over the visible spectrum that the test makes with fewer breaks.
pub(crate) const SPECTRUM_SUM: f64 = 1e-5;
/// What is left of the fringes of a film of 50 µm after the average over the sensitivities of the eye.
pub(crate) const FRINGES_LEFT: f64 = 1e-6;
/// A series of 4000 terms for one that has no end.
pub(crate) const SERIES_CUT: f64 = 1e-11;
/// A square of 1e9 times its distance for a plane.
pub(crate) const PLANE_CUT: f64 = 1e-8;
/// A rule over the sphere that does not know the great circle at which its integrand has a kink.
pub(crate) const KINK_IN_A_SUM: f64 = 2e-4;
/// The formula of the remainder is exact; its value is a difference of like numbers.
pub(crate) const ASYMPTOTIC: f64 = 1e-3;

// What a product was asked for.

/// A table that was asked for 1e-6, and the rounding of its storage.
pub(crate) const ASKED_6: f64 = 1.1e-6;
/// A table that was asked for 1e-3.
pub(crate) const ASKED_3: f64 = 1e-3;

// Limits that a parameter approaches and does not reach.

/// Two models that become one at infinity, at 1e8 or an exponent of thousands.
pub(crate) const LIMIT_FAR: f64 = 1e-4;
/// At a width of 0.05, or at a sphere of a millimetre into which light spreads all over.
pub(crate) const LIMIT_NEAR: f64 = 1e-2;
/// A lobe so narrow that the cosine changes by this over it.
pub(crate) const NARROW_LOBE: f64 = 1e-6;
/// Along the normal of a rough surface a matrix does not lean: what the search for its fit leaves.
pub(crate) const NOTHING_LEANS: f64 = 1e-2;
/// A mirror along the normal reflects all: what a width of a texel leaves.
pub(crate) const NARROW_LIGHT_WEIGHT: f64 = 1e-3;

// Draws and lattices with fixed seeds, whose error is that of their number of points.

/// Standard error of the scrambled replicates that a moment must reach before it is judged.
pub(crate) const DRAWN_SIGMA: f64 = 2e-4;
/// The same of 16 replicates of 256 points.
pub(crate) const DRAWN_SIGMA_FEW: f64 = 3e-4;
/// A midpoint sum of a density over 400 x 400 cells of the sphere.
pub(crate) const MIDPOINT_SUM: f64 = 1e-4;
/// A mean of 16 384 Sobol points of a smooth integrand.
pub(crate) const SOBOL_16K: f64 = 1e-3;
/// A mean of 65 536 Sobol points, or of 400 000 random ones (standard error 5e-4), or what another program samples so.
pub(crate) const DRAWN: f64 = 2e-3;
/// A mean over a lattice of 512 x 512 through a sampler with an edge (a line of cells is 2e-3), or what another program samples with fewer points.
pub(crate) const DRAWN_FEW: f64 = 3e-3;
/// Split sums of 4096 Hammersley points, as bakers make them, away from grazing and mirrors.
pub(crate) const HAMMERSLEY: f64 = 2e-3;

// Fits: what their optimum leaves.

/// The optimum is the function itself.
pub(crate) const FIT_EXACT: f64 = 1e-6;
/// A midpoint sum over a cap, whose edge at the horizon is a kink.
pub(crate) const MIDPOINT_CAP: f64 = 2e-6;
/// The search for a fit ends where the residual no longer falls by this; its cube root is what is compared.
pub(crate) const FIT_FOUND: f64 = 1e-5;
/// What another table holds as singles, of a rule of its own.
pub(crate) const HELD_AS_SINGLE: f64 = 5e-6;
/// A sum of two Gaussians that is fitted to samples of itself: the search ends here.
pub(crate) const FIT_SAMPLED_PROFILE: f64 = 1e-4;
/// Neighbouring texels of a fitted table.
pub(crate) const FIT_SMOOTH: f64 = 2e-3;
/// A residual that is judged anew, at halves of its inputs.
pub(crate) const FIT_READ: f64 = 3e-3;
/// An exchange that ended: the extremes are level.
pub(crate) const EXCHANGE: f64 = 1e-9;
/// The largest value of a parabola on the samples of a test.
pub(crate) const EXCHANGE_SAMPLED: f64 = 1e-3;
/// Twice that, in a coefficient.
pub(crate) const EXCHANGE_SAMPLED_TWICE: f64 = 2e-3;
/// A table is read between its texels, bilinearly: an eighth of the curvature over a step.
pub(crate) const LOOKED_UP: f64 = 2e-3;
/// An index on an axis whose map is steep, in texels.
pub(crate) const AXIS_STEEP: f64 = 1e-4;
/// An index on any axis, in lengths of the axis.
pub(crate) const AXIS_STEP: f64 = 1e-6;

// Lobes of parameter maps, against sums over the hemisphere that other programs made.

/// What a lobe reflects, by a sum over a grid of directions in a test.
pub(crate) const LOBE_OVER_DIRECTIONS: f64 = 1e-3;
/// A number that a picture shows with four digits.
pub(crate) const SHOWN: f64 = 2e-4;
/// Four printed digits, and what the grid of that program leaves of a minimum.
pub(crate) const LOBE_DIGITS: f64 = 1e-4;
/// Six printed digits.
pub(crate) const LOBE_DIGITS_SIX: f64 = 2e-6;
/// F0 of a material whose colours are codes of 8 bits, by that of the colours themselves: half a code of sRGB and a little.
pub(crate) const F0_OF_CODES: f64 = 3e-3;
/// Five printed digits, of which the last is not rounded.
pub(crate) const FIVE_DIGITS: f64 = 6e-6;
/// Nine printed digits.
pub(crate) const LOBE_DIGITS_NINE: f64 = 1e-8;
/// A reflectance by the 72 rings and 64 sectors of a conversion, at grazing too.
pub(crate) const LOBE_ENERGY: f64 = 3e-3;
/// Shapes and albedos of a fit: it ends where a step gains a hundred thousandth of the square.
pub(crate) const LOBE_FIT: f64 = 5e-3;
/// A sum of rings and sectors that the horizon cuts: an edge of a part in a few hundred rings.
pub(crate) const LOBE_HORIZON: f64 = 1e-3;
/// A minimum that golden sections find: the root of the last digit, and what the value has of it.
pub(crate) const LOBE_MINIMUM: f64 = 1e-6;
/// A midpoint sum of 1500 x 1500 slopes of an integrand with a kink.
pub(crate) const LOBE_SUM: f64 = 2e-5;

// Published numbers: the digits that are printed, or the error that the author states.

/// Four digits after the point.
pub(crate) const QUOTED_DIGITS: f64 = 5e-5;
/// Three digits, read off a texture of halves.
pub(crate) const QUOTED_DIGITS_THREE: f64 = 3e-3;
/// The same of the lesser channel.
pub(crate) const QUOTED_DIGITS_FOUR: f64 = 4e-3;
/// The polynomial of the internal reflectance of a dipole against the integral that it fits.
pub(crate) const PUBLISHED_FIT_DIPOLE: f64 = 5e-3;
/// The fit of an albedo against the exact one.
pub(crate) const PUBLISHED_FIT_ALBEDO: f64 = 1e-4;
/// The same there and back.
pub(crate) const PUBLISHED_FIT_INVERSE: f64 = 1e-7;
/// Colours of metals as renderers publish them, of other measurements and spaces.
pub(crate) const COLOUR: f64 = 0.1;
/// Areas below the colour-matching functions of the CIE, which are equal but for the digits of their rows.
pub(crate) const CIE_AREAS: f64 = 4e-4;
/// The white of a colour space whose matrix has seven digits.
pub(crate) const COLOUR_WHITE: f64 = 1e-5;
/// Tables of Cycles: floats in print, made by sampling.
pub(crate) const CYCLES_FLOAT_TABLE: f64 = 1e-4;
/// Mean of a table of Cycles, made by sampling, against the sum that is known of it.
pub(crate) const CYCLES_SUM: f64 = 1e-3;
/// Their print: six digits.
pub(crate) const CYCLES_PRINTED: f64 = 6e-6;

/// Fails unless `got` is within `bound` of `expected`; says all three, and the inputs.
macro_rules! near {
    ($got:expr, $expected:expr, $bound:expr $(,)?) => {
        $crate::tolerance::near!($got, $expected, $bound, "{}", stringify!($got))
    };
    ($got:expr, $expected:expr, $bound:expr, $($inputs:tt)+) => {{
        let (got, expected, bound): (f64, f64, f64) = ($got, $expected, $bound);
        let off = (got - expected).abs();
        assert!(
            off <= bound,
            "{}: got {got:e}, expected {expected:e}, off by {off:e}, bound {bound:e}",
            format_args!($($inputs)+)
        );
    }};
}
pub(crate) use near;

/// Fails unless `got` is `expected` but for `bound` of it.
#[track_caller]
pub(crate) fn assert_relative(what: &str, got: f64, expected: f64, bound: f64) {
    let error = (got - expected).abs();
    assert!(
        error <= bound * expected.abs(),
        "{what}: got {got:e}, expected {expected:e}, relative error {:e}, bound {bound:e}",
        error / expected.abs()
    );
}

/// As [`near!`], for what has its words at hand.
#[track_caller]
pub(crate) fn close(what: &str, got: f64, expected: f64, bound: f64) {
    near!(got, expected, bound, "{what}");
}
