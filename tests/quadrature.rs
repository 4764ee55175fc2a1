//! Quadrature rules and point sets: reference nodes, exactness, balance, honest error estimates.
#![allow(clippy::float_cmp, reason = "exact results are asserted exactly")]
#![allow(clippy::excessive_precision, reason = "reference values are quoted with all their digits")]
#![allow(clippy::unwrap_used, reason = "a test may fail by panicking")]
#![allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "cell numbers are small")]

use crate::tolerance::{
    ASYMPTOTIC, DOUBLE_DOUBLE, DRAWN_SIGMA_FEW, FEW_ROUNDINGS, LONG_SUM, NEAREST, assert_relative, near,
};
use brdfbake::integrate::gauss::{self, MAX_ORDER};
use brdfbake::integrate::hammersley;
use brdfbake::integrate::sobol::{Sobol, replicate_mean};
use brdfbake::math::double::Double;
use brdfbake::math::sum::compensated_sum;
use glam::DVec2;

/// Order, index, node, weight on [0, 1]: mpmath, 50 digits, Newton from cos(π (i + 3/4)/(n + 1/2)).
const GAUSS: &[(usize, usize, f64, f64)] = &[
    (1, 0, 0.5, 1.0),
    (2, 0, 0.21132486540518711775, 0.5),
    (3, 0, 0.11270166537925831148, 0.27777777777777777778),
    (3, 1, 0.5, 0.44444444444444444444),
    (5, 0, 0.046910077030668003601, 0.11846344252809454376),
    (5, 1, 0.23076534494715845448, 0.23931433524968323402),
    (5, 2, 0.5, 0.28444444444444444444),
    (16, 0, 0.0052995325041750337019, 0.013576229705877047426),
    (16, 3, 0.12229779582249848305, 0.062314485627766936026),
    (16, 7, 0.45249374508118127991, 0.094725305227534248143),
    (33, 0, 0.0012876528767723913669, 0.0033031139237936890293),
    (33, 10, 0.23330504760682617823, 0.039656182397443369182),
    (33, 16, 0.5, 0.046884223080104998284),
    (64, 0, 0.00034747913211393027155, 0.00089164036084821647365),
    (64, 1, 0.0018299416140223603265, 0.0020735166302812338176),
    (64, 31, 0.48782485366828778375, 0.024345478504569860192),
    (100, 0, 0.00014313661327938316089, 0.0003673172452528358652),
    (100, 49, 0.49218550778922845856, 0.015627711726931678474),
    (255, 0, 0.000022147341218124134904, 0.000056836809995711360578),
    (255, 60, 0.133126487795636842, 0.0041770268846127580359),
    (255, 127, 0.5, 0.0061479190568791572284),
    (256, 0, 0.000021974990503884632599, 0.000056394508911136087756),
    (256, 1, 0.00011578129536840694756, 0.00013126747214822295314),
    (256, 64, 0.1491640428256574203, 0.0043633079808494035702),
    (256, 127, 0.49693804381240523525, 0.006123835820144877952),
];

#[test]
fn gauss_nodes_and_weights_are_the_nearest_numbers() {
    for &(order, i, node, weight) in GAUSS {
        let rule = gauss::rule(order);
        assert_eq!(rule.nodes[i], node, "node {i} of order {order}");
        assert_eq!(rule.weights[i], weight, "weight {i} of order {order}");
    }
}

#[test]
fn gauss_rules_are_symmetric_rising_and_sum_to_one() {
    for order in 1..=MAX_ORDER {
        let rule = gauss::rule(order);
        assert_eq!((rule.nodes.len(), rule.weights.len()), (order, order));
        for i in 0..order / 2 {
            assert_eq!(rule.nodes[order - 1 - i], 1.0 - rule.nodes[i], "order {order}, node {i}");
            assert_eq!(rule.weights[order - 1 - i], rule.weights[i], "order {order}, weight {i}");
        }
        assert!(rule.nodes[0] > 0.0 && rule.nodes[order - 1] < 1.0, "order {order}");
        assert!(rule.nodes.windows(2).all(|pair| pair[0] < pair[1]), "order {order}: nodes rise");
        assert!(rule.weights.iter().all(|w| *w > 0.0), "order {order}: weights are positive");
        assert_relative(
            &format!("order {order}"),
            compensated_sum(rule.weights.iter().copied()),
            1.0,
            NEAREST,
        );
        if order % 2 == 1 {
            assert_eq!(rule.nodes[order / 2], 0.5, "order {order}: the middle");
        }
    }
}

#[test]
fn gauss_rules_are_exact_to_degree_2n_minus_1_and_no_further() {
    for order in [1, 2, 3, 4, 7, 12, 20, 31, 64, 128, 256] {
        let rule = gauss::rule(order);
        // Shifted Legendre polynomials: every monomial of degree ≥ 1 below 2n integrates to 1/(degree + 1).
        for degree in 0..2 * order {
            let degree = i32::try_from(degree).unwrap();
            let got = rule.integrate(0.0, 1.0, |x| libm::pow(x, f64::from(degree)));
            assert_relative(
                &format!("order {order}, x^{degree}"),
                got,
                1.0 / f64::from(degree + 1),
                LONG_SUM,
            );
        }
        if order <= 12 {
            // The error for x^2n is n!⁴/((2n + 1) (2n)!²) times its derivative (2n)!/(2n)!, on [0, 1].
            let n = f64::from(u32::try_from(order).unwrap());
            let (factorial, square) = (|m: f64| libm::tgamma(m + 1.0), |x: f64| x * x);
            let expected =
                square(square(factorial(n))) / ((2.0 * n + 1.0) * factorial(2.0 * n) * factorial(2.0 * n));
            let got = 1.0 / (2.0 * n + 1.0) - rule.integrate(0.0, 1.0, |x| libm::pow(x, 2.0 * n));
            near!(
                got,
                expected,
                FEW_ROUNDINGS + ASYMPTOTIC * expected,
                "order {order}: {got:e}, formula {expected:e}"
            );
        }
    }
}

#[test]
fn gauss_on_smooth_functions_and_intervals() {
    assert_relative(
        "∫ exp",
        gauss::rule(16).integrate(-1.0, 2.0, libm::exp),
        7.0211766577592084,
        FEW_ROUNDINGS,
    );
    assert_relative(
        "∫ cos",
        gauss::rule(20).integrate(0.0, 1.5, libm::cos),
        0.9974949866040544309,
        FEW_ROUNDINGS,
    );
    // A backward interval has the opposite sign.
    assert_relative("∫ backward", gauss::rule(8).integrate(1.0, 0.0, |x| x), -0.5, FEW_ROUNDINGS);
    // An algebraic end at 0: sqrt(x) in x = t² is exact; the relative accuracy of small nodes carries it.
    let got = gauss::rule(256).integrate(0.0, 1.0, |t| 2.0 * t * t);
    assert_relative("∫ sqrt", got, 2.0 / 3.0, FEW_ROUNDINGS);
}

#[test]
fn orders_outside_the_table_are_clamped_and_rules_are_shared() {
    assert!(std::ptr::eq(gauss::rule(0), gauss::rule(1)));
    assert!(std::ptr::eq(gauss::rule(1000), gauss::rule(MAX_ORDER)));
    let made: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| gauss::rule(77))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert!(made.iter().all(|rule| std::ptr::eq(*rule, gauss::rule(77))));
}

#[test]
fn double_double_keeps_106_bits() {
    let third = Double::from(1.0).over(3.0);
    let rest = third * Double::from(3.0) - Double::from(1.0);
    assert!(rest.to_f64().abs() < DOUBLE_DOUBLE, "{rest:?}");
    let seven = Double::sum(7.0, 1e-20);
    let rest = seven * seven.reciprocal() - Double::from(1.0);
    assert!(rest.to_f64().abs() < DOUBLE_DOUBLE, "{rest:?}");
    let product = Double::product(1.0 + f64::EPSILON, 1.0 - f64::EPSILON);
    assert_eq!((product.hi, product.lo), (1.0, -f64::EPSILON * f64::EPSILON));
    assert_eq!((Double::sum(1.0, 1e-20) - Double::from(1.0)).to_f64(), 1e-20);
}

#[test]
fn hammersley_points_are_those_of_the_definition() {
    let expected = [(0.0, 0.0), (0.125, 0.5), (0.25, 0.25), (0.375, 0.75), (0.5, 0.125), (0.625, 0.625)];
    for (i, ((x, y), point)) in expected.into_iter().zip(hammersley::points(8)).enumerate() {
        assert_eq!(point, DVec2::new(x, y), "point {i}");
    }
    assert_eq!(hammersley::points(8).count(), 8);
    assert_eq!(hammersley::radical_inverse(u32::MAX), 1.0 - libm::exp2(-32.0));
    assert_eq!(hammersley::point(0, 0), DVec2::ZERO);
}

/// Every dyadic box of area 1/n holds exactly one of the n = 2ᵏ points: a (0, k, 2)-net.
fn assert_net(points: &[DVec2], what: &str) {
    let log = points.len().ilog2();
    for split in 0..=log {
        let (columns, rows) = (1_usize << split, 1_usize << (log - split));
        let mut count = vec![0; points.len()];
        for p in points {
            let column = (p.x * columns as f64) as usize;
            let row = (p.y * rows as f64) as usize;
            count[row * columns + column] += 1;
        }
        assert!(count.iter().all(|c| *c == 1), "{what}: boxes {columns} x {rows} hold {count:?}");
    }
}

#[test]
fn scrambled_sobol_points_are_nets_for_every_power_of_two() {
    for seed in [0, 1, 42, u64::MAX] {
        let points: Vec<_> = Sobol::new(seed).points(4096).collect();
        for log in 0..=12 {
            assert_net(&points[..1 << log], &format!("seed {seed}, first 2^{log}"));
        }
        // Any aligned block is one as well.
        assert_net(&points[1024..2048], &format!("seed {seed}, second block"));
        assert!(points.iter().all(|p| p.x > 0.0 && p.x < 1.0 && p.y > 0.0 && p.y < 1.0));
    }
}

#[test]
fn sobol_seeds_are_reproducible_and_independent() {
    let point = Sobol::new(1).point(12345);
    assert_eq!(point, Sobol::new(1).point(12345));
    assert_ne!(point, Sobol::new(2).point(12345));
    // One given point over many seeds is uniform on the square: mean 1/2, variance 1/12, no correlation.
    let n = 20_000_u32;
    for index in [0, 1, 2, 777] {
        let all: Vec<_> =
            (0..n).map(|seed| Sobol::new(u64::from(seed)).point(index) - DVec2::splat(0.5)).collect();
        let mean = |f: &dyn Fn(&DVec2) -> f64| all.iter().map(f).sum::<f64>() / f64::from(n);
        let sigma = 1.0 / f64::from(n).sqrt();
        for (what, got, expected, spread) in [
            ("x", mean(&|p| p.x), 0.0, 0.289),
            ("y", mean(&|p| p.y), 0.0, 0.289),
            ("x²", mean(&|p| p.x * p.x), 1.0 / 12.0, 0.0745),
            ("y²", mean(&|p| p.y * p.y), 1.0 / 12.0, 0.0745),
            ("xy", mean(&|p| p.x * p.y), 0.0, 0.0833),
        ] {
            let bound = 4.5 * spread * sigma;
            near!(got, expected, bound, "index {index}: mean {what} = {got}, expected {expected} ± {bound}");
        }
    }
}

#[test]
fn standard_errors_of_replicates_are_honest() {
    // ∫∫ x exp(xy) = e − 2; a kink: ∫∫ |x + y − 1| = 1/3.
    let e2 = std::f64::consts::E - 2.0;
    let mut inside = 0;
    let trials = 200;
    for seed in 0..trials {
        let [smooth, kink] =
            replicate_mean(seed, 16, 256, |u| [u.x * libm::exp(u.x * u.y), (u.x + u.y - 1.0).abs()]);
        assert!(
            smooth.standard_error < DRAWN_SIGMA_FEW && kink.standard_error < DRAWN_SIGMA_FEW,
            "{smooth:?} {kink:?}"
        );
        for (estimate, exact) in [(smooth, e2), (kink, 1.0 / 3.0)] {
            let error = (estimate.mean - exact).abs();
            assert!(error < 6.0 * estimate.standard_error, "seed {seed}: {estimate:?}, exact {exact}");
            inside += u64::from(error < 2.0 * estimate.standard_error);
        }
    }
    // Student's t with 15 degrees of freedom: 93.6 % within two standard errors.
    let share = inside as f64 / (2.0 * trials as f64);
    assert!((0.88..0.98).contains(&share), "{share} of the estimates lie within two standard errors");
}

#[test]
fn replicates_converge_faster_than_random_points() {
    let error = |points| replicate_mean(3, 32, points, |u| [libm::exp(u.x + u.y)])[0].standard_error;
    let (coarse, fine) = (error(64), error(4096));
    // Random points would gain 8; nearly N^(−3/2) gains 500.
    assert!(coarse / fine > 200.0, "64 points {coarse:e}, 4096 points {fine:e}");
    assert_eq!(replicate_mean(3, 1, 8, |u| [u.x])[0].standard_error, f64::INFINITY);
    assert_eq!(replicate_mean(3, 0, 0, |_| [1.0])[0].mean, 1.0);
}
