//! Numbers as text, for every message and report: with an exponent where there would be a row of zeros, and never with
//! digits that say nothing. Files and shaders have forms of their own, which machines read.

use std::borrow::Borrow;

/// Significant digits of [`short`].
const SHORT: usize = 6;

/// The fewest digits that read back to the same number: `0.1`, `1e-300`, `-2.5`, `inf`, `NaN`. For what somebody gave or may
/// want to give again.
#[must_use]
pub fn exact(x: impl Borrow<f64>) -> String {
    let x = *x.borrow();
    match x {
        _ if x.abs() == 0.0 => "0".to_owned(),
        _ if !x.is_finite() || is_plain(x) => format!("{x}"),
        _ => format!("{x:e}"),
    }
}

/// At most six significant digits, without trailing zeros: `0.0312`, `1.5e-7`. For what was measured.
#[must_use]
pub fn short(x: impl Borrow<f64>) -> String {
    significant(x, SHORT)
}

/// At most so many significant digits; digits in front of the point all the same.
#[must_use]
pub fn significant(x: impl Borrow<f64>, digits: usize) -> String {
    let x = *x.borrow();
    if !x.is_finite() {
        return exact(x);
    }
    if is_plain(x) && x.abs() >= 1e6 {
        return format!("{x:.0}");
    }
    // the text of a rounded number reads back to a number whose shortest text is that one
    format!("{x:.*e}", digits.max(1) - 1).parse().map_or_else(|_| exact(x), |rounded: f64| exact(rounded))
}

/// The number that was meant by one that is written with all digits of a f32, as programs do that compute in f32:
/// 0.4399999976158142 is the f32 nearest 0.44, and becomes 0.44. It moves by less than half a step of f32; others stay.
#[must_use]
pub fn meant(x: f64) -> f64 {
    #[allow(clippy::cast_possible_truncation, reason = "is it a f32?")]
    let single = x as f32;
    if f64::from(single).to_bits() == x.to_bits() { single.to_string().parse().unwrap_or(x) } else { x }
}

/// Is it readable without an exponent?
fn is_plain(x: f64) -> bool {
    (1e-4..1e7).contains(&x.abs())
}

#[cfg(test)]
mod tests {
    use super::{exact, meant, short};

    #[test]
    fn a_f32_with_all_its_digits_is_the_number_that_was_meant() {
        // literals as Blender writes them, and numbers that are no f32 or are the same in both
        let cases = [
            (0.4399999976158142, 0.44),
            (0.800000011920929, 0.8),
            (1.4500000476837158, 1.45),
            (400.29998779296875, 400.3),
            (-0.30000001192092896, -0.3),
            (0.44, 0.44),
            (0.5, 0.5),
            (1.0 / 3.0, 1.0 / 3.0),
            (0.439999997615814, 0.439999997615814),
            (16_777_216.0, 16_777_216.0),
            (f64::MAX, f64::MAX),
        ];
        for (x, expected) in cases {
            assert_eq!(meant(x).to_bits(), f64::to_bits(expected), "{x}");
        }
    }

    #[test]
    fn what_is_given_is_told_as_it_was_given() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-2.5, "-2.5"),
            (0.1, "0.1"),
            (1.0 / 3.0, "0.3333333333333333"),
            (1e-4, "0.0001"),
            (9.99e-5, "9.99e-5"),
            (9_999_999.0, "9999999"),
            (1e7, "1e7"),
            (1e-300, "1e-300"),
            (-1e300, "-1e300"),
            (5e-324, "5e-324"),
            (f64::MAX, "1.7976931348623157e308"),
            (f64::INFINITY, "inf"),
            (f64::NEG_INFINITY, "-inf"),
            (f64::NAN, "NaN"),
        ];
        for (v, expected) in cases {
            assert_eq!(exact(v), expected);
        }
    }

    #[test]
    fn what_is_measured_is_short_and_true() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (100.0, "100"),
            (1_234_567.0, "1234567"),
            (12_345_678.0, "1.23457e7"),
            (0.03125, "0.03125"),
            (0.999_999_9, "1"),
            (1.5e-7, "1.5e-7"),
            (3.3e-31, "3.3e-31"),
            (2.0 / 3.0, "0.666667"),
            (f64::MAX, "1.79769e308"),
            (f64::NEG_INFINITY, "-inf"),
            (f64::NAN, "NaN"),
        ];
        for (v, expected) in cases {
            assert_eq!(short(v), expected);
        }
    }
}
