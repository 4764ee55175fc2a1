//! The solver on functions whose best fits are known.

use crate::tolerance::{EXCHANGE, EXCHANGE_SAMPLED, EXCHANGE_SAMPLED_TWICE, near};
use brdfbake::cancel::Cancel;
use brdfbake::math::rational::{Point, Terms, fit};

fn points(n: usize, f: impl Fn(f64) -> f64) -> Vec<Point> {
    let x = |i: usize| i as f64 / (n - 1) as f64;
    let point = |i| Point { at: [x(i), 0.0], base: 0.0, factor: 1.0, want: f(x(i)), weight: 1.0, slack: 0.0 };
    (0..n).map(point).collect()
}

#[test]
fn a_parabola_by_a_line() {
    // Chebyshev: the best line for x^2 on [0, 1] is x - 1/8, off by 1/8 thrice
    let best = fit(&points(401, |x| x * x), &Terms::of_degree(1, 1, false), 1, 400, &Cancel::new()).unwrap();
    near!(best.largest, 0.125, EXCHANGE_SAMPLED, "{best:?}");
    assert!(
        (best.above[0] + 0.125).abs() < EXCHANGE_SAMPLED_TWICE
            && (best.above[1] - 1.0).abs() < EXCHANGE_SAMPLED_TWICE,
        "{best:?}"
    );
}

#[test]
fn the_exponential_by_one_over_one() {
    // e^x on [0, 1]: Remez's exchange in 40 digits alternates at 0, 0.31703591, 0.80643612, 1 with 4.29546529631998e-3
    let best = fit(&points(401, libm::exp), &Terms::of_degree(1, 1, true), 1, 400, &Cancel::new()).unwrap();
    let least = 4.29546529631998e-3;
    assert!(best.largest < 1.02 * least && best.largest > 0.999 * least, "{best:?}");
}

#[test]
fn a_rational_function_of_two_variables_is_found_again() {
    let f = |[x, y]: [f64; 2]| (0.3 + x - 0.2 * y) / (1.0 + 2.0 * x * y + 0.5 * y * y);
    let at = (0..33 * 33).map(|n| [n % 33, n / 33].map(|i| i as f64 / 32.0));
    let points: Vec<Point> = at
        .map(|at| Point { at, base: 1.0, factor: -2.0, want: 1.0 - 2.0 * f(at), weight: 1.0, slack: 0.0 })
        .collect();
    let best = fit(&points, &Terms::of_degree(2, 2, true), 1, 60, &Cancel::new()).unwrap();
    assert!(best.largest < EXCHANGE, "{best:?}");
}

#[test]
fn a_power_of_a_line_is_found_again() {
    let mut points = points(101, |x| (1.0 - 0.5 * x).powi(4));
    let best = fit(&points, &Terms::of_degree(1, 1, false), 4, 60, &Cancel::new()).unwrap();
    assert!(best.largest < EXCHANGE, "{best:?}");
    // what no choice can remove is counted, not fitted
    points.iter_mut().for_each(|p| p.slack = 0.25);
    let slack = fit(&points, &Terms::of_degree(1, 1, false), 4, 60, &Cancel::new()).unwrap();
    near!(slack.largest, 0.25, EXCHANGE, "{slack:?}");
}

#[test]
fn too_few_points_have_no_fit() {
    assert!(fit(&points(2, |x| x), &Terms::of_degree(3, 1, true), 1, 10, &Cancel::new()).is_none());
    assert!(fit(&[], &Terms::of_degree(1, 1, false), 1, 10, &Cancel::new()).is_none());
}
