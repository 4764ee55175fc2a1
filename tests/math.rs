//! Frames, special functions and sums against high-precision reference values (mpmath, 50 digits) and identities.
#![allow(clippy::float_cmp, reason = "exact results are asserted exactly")]
#![allow(clippy::excessive_precision, reason = "reference values are quoted with all their digits")]

use crate::tolerance::{
    DIFFERENCE_QUOTIENT, DIGIT_LOST, FEW_ROUNDINGS, LIBRARY_PRODUCT, MANY_ROUNDINGS, NEAREST, TEN_ROUNDINGS,
    TWO_ULPS, ULP, UNIT_SQUARED, assert_relative, near,
};
use brdfbake::math::{frame, root, special, sum};
use glam::DVec3;

/// x, erfcx(x), K(x) = 1/(√π erfcx(x)) − x: mpmath, 50 digits; above x = 8 by 400 terms of the continued fraction.
const ERFCX: &[(f64, f64, f64)] = &[
    (0.0, 1.0, 0.5641895835477562869),
    (1e-300, 1.0, 0.5641895835477562869),
    (1e-8, 0.999999988716208429, 0.564189579913954026),
    (0.01, 0.9888154610463425106, 0.5605711589003103047),
    (0.1, 0.8964569799691266419, 0.5293548894752167425),
    (0.3, 0.7345993345676551423, 0.4680235429015291939),
    (0.5, 0.6156903441929258749, 0.4163528206493492081),
    (0.75, 0.5069376502931448058, 0.3629368339903430627),
    (1.0, 0.4275835761558070044, 0.3194837571173956302),
    (1.5, 0.3215854164543175024, 0.2544004008897638526),
    (2.0, 0.2553956763105057439, 0.209080402997207099),
    (2.75, 0.1936620962790686786, 0.1632679775125145916),
    (3.0, 0.1790011511813899504, 0.1518768445016172125),
    (4.0, 0.1369994576250613899, 0.1181884463500880361),
    (5.0, 0.1107046377330686264, 0.09635002743184075331),
    (7.0, 0.07980005432915293349, 0.07004009321386988505),
    (9.5, 0.05906467835256389085, 0.05206392863165126513),
    (13.0, 0.04327192186460969266, 0.03823725031227490653),
    (20.0, 0.02817434874105131932, 0.02493788705419718932),
    (30.0, 0.0187958888614167515, 0.01664819937811420284),
    (100.0, 0.005641613782989432904, 0.00499950012495377205),
    (1e4, 0.00005641895807268084115, 0.0000499999995000000125),
    (1e10, 5.641895835477562869e-11, 5.0e-11),
    (1e150, 5.641895835477562869e-151, 5.0e-151),
];

#[test]
fn erfcx_and_its_tail_match_reference_values() {
    for &(x, value, tail) in ERFCX {
        assert_relative(&format!("erfcx({x:e})"), special::erfcx(x), value, FEW_ROUNDINGS);
        assert_relative(&format!("erfcx_tail({x:e})"), special::erfcx_tail(x), tail, FEW_ROUNDINGS);
    }
}

#[test]
fn erfcx_agrees_with_exp_times_erfc_where_that_is_good() {
    for i in 0..400 {
        let x = f64::from(i) * 0.01;
        // exp(x²) carries the rounding of x², up to 16 · 2⁻⁵³ here.
        assert_relative("erfcx", special::erfcx(x), libm::exp(x * x) * special::erfc(x), LIBRARY_PRODUCT);
        assert_relative(
            "erfcx(-x)",
            special::erfcx(-x),
            libm::exp(x * x) * special::erfc(-x),
            LIBRARY_PRODUCT,
        );
    }
}

#[test]
fn erfcx_satisfies_its_differential_equation_at_the_tail() {
    // K' = 2K² + 2xK − 1 (a Riccati equation), checked with central differences.
    for x in [0.1, 0.7, 2.0, 5.0, 11.0] {
        let h = 1e-4;
        let slope = (special::erfcx_tail(x + h) - special::erfcx_tail(x - h)) / (2.0 * h);
        let k = special::erfcx_tail(x);
        let expected = 2.0 * k * (x + k) - 1.0;
        near!(slope, expected, DIFFERENCE_QUOTIENT, "x = {x}: K' = {slope}, from the equation {expected}");
    }
}

#[test]
fn tail_is_finite_positive_and_falls_over_all_magnitudes() {
    let mut last = f64::INFINITY;
    for e in -320..=308 {
        let x = libm::pow(10.0, f64::from(e));
        let k = special::erfcx_tail(x);
        assert!(
            k.is_finite() && k > 0.0 && k <= last * (1.0 + FEW_ROUNDINGS),
            "K({x:e}) = {k:e} after {last:e}"
        );
        last = k;
    }
    assert_eq!(special::erfcx_tail(-1.0), special::erfcx_tail(0.0));
}

#[test]
fn constants_and_small_helpers() {
    assert_relative("√π", special::SQRT_PI, std::f64::consts::PI.sqrt(), ULP);
    assert_relative("1/√π", special::FRAC_1_SQRT_PI, 0.5641895835477562869, ULP);
    assert_eq!(special::exprel(0.0), 1.0);
    assert_relative("exprel(1e-9)", special::exprel(1e-9), 1.000000000500000000167, TWO_ULPS);
    assert_relative("exprel(-2)", special::exprel(-2.0), 0.4323323583816936540530, TWO_ULPS);
    assert_eq!(special::circle(0.25), (0.0, 1.0));
    assert_eq!(special::circle(0.5), (-1.0, 0.0));
    assert_eq!(special::circle(0.75), (0.0, -1.0));
    assert_eq!(special::circle(1.0), (1.0, 0.0));
    for i in 0..1000 {
        let u = f64::from(i) / 1000.0;
        let (cos, sin) = special::circle(u);
        let (s, c) = libm::sincos(2.0 * std::f64::consts::PI * u);
        assert!((cos - c).abs() < TEN_ROUNDINGS && (sin - s).abs() < TEN_ROUNDINGS, "u = {u}");
        assert_relative("cos² + sin²", cos * cos + sin * sin, 1.0, TWO_ULPS);
    }
}

const COS_POW: [(f64, f64, f64); 7] = [
    (1.5, 3.0, 0.000353951393082256071),
    (1.25, 64.0, 8.323488518460171517e-33),
    (0.75, 1.5, 0.6258779801004992159),
    (0.125, 1000.0, 0.0003964620526476816555),
    (0.0009765625, 1000000.0, 0.6207435570205716251),
    (0.0009765625, 10000000.0, 0.008494194575538281551),
    (1e-09, 10000000.0, 0.999999999995),
];

/// z, Γ(z + 1/2)/Γ(z): mpmath, 40 digits.
const GAMMA_HALF: [(f64, f64); 10] = [
    (0.5, 0.5641895835477562869),
    (0.625, 0.6564868081748983472),
    (1.0, 0.8862269254527580136),
    (3.75, 1.873187169616183714),
    (20.0, 4.444275161239915145),
    (31.9, 5.625921011108650938),
    (32.0, 5.634801160177469862),
    (100.0, 9.987507861262518211),
    (1e4, 99.99875000781298827),
    (1e8, 9999.999987500000008),
];

#[test]
fn ratios_of_gamma_functions_match_reference_values() {
    for (z, expected) in GAMMA_HALF {
        assert_relative(&format!("z = {z}"), special::gamma_half_ratio(z), expected, MANY_ROUNDINGS);
    }
    assert_eq!(special::gamma_half_ratio(0.0), 0.0);
}

#[test]
fn roots_of_rising_functions() {
    let cube = |x: f64| (x * x * x - 2.0, 3.0 * x * x);
    assert_relative("cube root", root::solve(0.0, 2.0, cube), 1.2599210498948731648, ULP);
    // A flat start sends Newton out of the bracket; bisection brings it back.
    let steep = |x: f64| {
        (libm::tanh(50.0 * (x - 0.9)), 50.0 / libm::cosh(50.0 * (x - 0.9)) / libm::cosh(50.0 * (x - 0.9)))
    };
    assert_relative("tanh", root::solve(-1.0, 1.0, steep), 0.9, MANY_ROUNDINGS);
    assert_relative("one sign", root::solve(0.0, 1.0, |x| (x - 5.0, 1.0)), 1.0, MANY_ROUNDINGS);
}

#[test]
fn cosine_powers_keep_their_digits() {
    // θ, n, cosⁿθ: mpmath, 50 digits.
    for (theta, n, expected) in COS_POW {
        let (sin, cos) = libm::sincos(theta);
        let bound = 4e-16 * (1.0 - n * libm::log(cos));
        assert_relative(&format!("cos^{n} {theta}"), special::cos_pow(cos, sin * sin, n), expected, bound);
    }
    assert_eq!(special::cos_pow(0.0, 1.0, 0.0), 1.0);
    assert_eq!(special::cos_pow(0.0, 1.0, 2.5), 0.0);
    assert_eq!(special::cos_pow(-0.5, 0.75, 3.0), 0.0);
}

#[test]
fn neumaier_sum_keeps_what_a_plain_loop_loses() {
    assert_eq!(sum::compensated_sum([1.0, 1e100, 1.0, -1e100]), 2.0);
    // 0.1 in binary is 0.1 + 5.551e-18; ten million of it is 1e6 + 5.55e-11, which rounds to 1e6 (half an ulp: 5.8e-11).
    let got = sum::compensated_sum(std::iter::repeat_n(0.1, 10_000_000));
    assert_eq!(got, 1_000_000.0);
    let mut left: sum::Sum = [1e16, 1.0].into_iter().collect();
    let right: sum::Sum = [1.0, -1e16].into_iter().collect();
    left.merge(right);
    assert_eq!(left.total(), 2.0);
    assert_eq!(sum::compensated_sum([f64::INFINITY, 1.0]), f64::INFINITY);
    assert_eq!(sum::compensated_sum(std::iter::empty()), 0.0);
}

#[test]
fn directions_and_angles_are_inverse_to_each_other() {
    for theta in [1e-9, 1e-3, 0.5, 1.25, 1.5625, 2.0, 3.125] {
        for phi in [-3.0, -0.5, 0.25, 1.5, 3.0] {
            let w = frame::spherical(theta, phi);
            assert_relative("length", w.length_squared(), 1.0, UNIT_SQUARED);
            assert_relative("theta", frame::theta(w), theta, DIGIT_LOST);
            assert_relative("phi", frame::phi(w), phi, FEW_ROUNDINGS);
            assert_relative("sin", frame::sin_theta(w), libm::sin(theta), TWO_ULPS);
            assert_relative(
                "tan²",
                frame::tan2_theta(w),
                libm::tan(theta) * libm::tan(theta),
                MANY_ROUNDINGS,
            );
            assert_eq!(frame::mu(w), frame::cos_theta(w).abs());
            assert_eq!(frame::cos2_theta(w), w.z * w.z);
            assert_eq!(frame::sin2_theta(w), w.x * w.x + w.y * w.y);
        }
    }
    assert_eq!(frame::tan2_theta(DVec3::X), f64::INFINITY);
    assert_eq!(frame::from_mu(1.0), DVec3::Z);
    assert_eq!(frame::from_mu(0.0), DVec3::X);
    assert_eq!(frame::from_mu(0.6), DVec3::new(0.8, 0.0, 0.6));
}

#[test]
fn reflection_about_the_half_vector_gives_the_other_direction() {
    for (a, b) in [((0.5, 0.0), (1.25, 3.0)), ((1.5, 0.25), (1.46875, 3.375)), ((0.875, 1.0), (0.875, 1.0))] {
        let (wo, wi) = (frame::spherical(a.0, a.1), frame::spherical(b.0, b.1));
        let half = frame::half_vector(wo, wi).unwrap();
        assert!((frame::reflect(wo, half.wh) - wi).length() < MANY_ROUNDINGS);
        assert_relative("wo.wh", half.cos_d, wo.dot(half.wh), MANY_ROUNDINGS);
        assert_relative("wi.wh", half.cos_d, wi.dot(half.wh), MANY_ROUNDINGS);
        assert_relative("|H|²", half.length_squared, 2.0 + 2.0 * wo.dot(wi), DIGIT_LOST);
        assert_eq!(Some(half), frame::half_vector(wi, wo), "symmetric to the bit");
        assert!(frame::both_above(wo, wi) && !frame::both_above(wo, -wi));
    }
    assert_eq!(frame::half_vector(DVec3::X, -DVec3::X), None);
}

#[test]
fn reflect_matches_reference_values() {
    // points_basics.csv, rows reflect_x, reflect_y, reflect_z.
    let (w, n) = (frame::spherical(0.5, 0.0), frame::spherical(0.125, 3.140625));
    let r = frame::reflect(w, n);
    assert_relative("x", r.x, -0.68163867232960183, MANY_ROUNDINGS);
    near!(r.y, 0.00019567232582554657, NEAREST);
    assert_relative("z", r.z, 0.73168892440509076, MANY_ROUNDINGS);
}
