//! The adaptive rule: exactness, honesty, kinks.

use crate::tolerance::{DIGIT_LOST, DIGITS_LOST, INTEGRAL_10, MANY_ROUNDINGS, TWO_ULPS, near};
use brdfbake::integrate::line;

#[test]
fn one_panel_is_exact_to_degree_22_and_its_gauss_part_is_the_rule_of_7() {
    for degree in 0..=22_u32 {
        let mut calls = 0;
        let e = line::integrate(&[0.0, 1.0], 1, f64::INFINITY, &mut |x, out| {
            calls += 1;
            out[0] = libm::pow(x, f64::from(degree));
        });
        let expected = 1.0 / (f64::from(degree) + 1.0);
        near!(e.value[0], expected, TWO_ULPS, "degree {degree}: {:e}", e.value[0] - expected);
        assert_eq!(calls, 15);
        // the pair agrees, so the estimate is rounding, as long as both are exact
        if degree <= 13 {
            assert!(e.error[0] < DIGIT_LOST, "degree {degree}: {:e}", e.error[0]);
        }
    }
}

#[test]
fn errors_stay_below_tolerance_and_estimate() {
    type Case = (&'static str, fn(f64) -> f64, [f64; 2], f64);
    let pi = std::f64::consts::PI;
    let cases: [Case; 6] = [
        ("exp", libm::exp, [0.0, 2.0], libm::exp(2.0) - 1.0),
        ("peak", |x| 1.0 / (1e-6 + x * x), [0.0, 1.0], 1e3 * libm::atan(1e3)),
        ("root", f64::sqrt, [0.0, 1.0], 2.0 / 3.0),
        ("log", libm::log, [0.0, 1.0], -1.0),
        ("waves", |x| libm::sin(100.0 * x), [0.0, 1.0], (1.0 - libm::cos(100.0)) / 100.0),
        ("kink inside", |x| (x - 1.0 / 3.0).abs(), [0.0, 1.0], 5.0 / 18.0),
    ];
    for (name, f, ends, expected) in cases {
        for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
            let e = line::integrate(&ends, 1, tolerance, &mut |x, out| out[0] = f(x));
            let error = (e.value[0] - expected).abs();
            assert!(error <= e.error[0], "{name} {tolerance:e}: {error:e} above {:e}", e.error[0]);
            assert!(error <= tolerance.max(DIGITS_LOST * expected.abs()), "{name} {tolerance:e}: {error:e}");
        }
    }
    // channels are independent of each other
    let both = line::integrate(&[0.0, pi], 2, 1e-10, &mut |x, out| {
        out[0] = libm::sin(x);
        out[1] = libm::sqrt(x);
    });
    near!(both.value[0], 2.0, MANY_ROUNDINGS);
    near!(both.value[1], 2.0 / 3.0 * pi * pi.sqrt(), INTEGRAL_10);
}

#[test]
fn nan_ends_the_work_and_is_told() {
    let e = line::integrate(&[0.0, 1.0], 1, 1e-9, &mut |x, out| out[0] = (x - 0.5).sqrt());
    assert!(e.value[0].is_nan() && e.evaluations <= 15);
}
