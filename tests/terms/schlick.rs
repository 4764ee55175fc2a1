//! Schlick's approximation and its generalisations.

use crate::terms::values::{assert_relative, cosines, rows};
use crate::tolerance::{FEW_ROUNDINGS, NEAREST, QUOTED_DIGITS, ULP, near};
use brdfbake::terms::schlick;

const FILE: &str = "points_fresnel";

#[test]
fn schlick_matches_reference_values() {
    for row in rows(FILE, "fresnel_schlick") {
        row.check(schlick::schlick(row.num("F0"), 1.0, libm::cos(row.wi_theta())), FEW_ROUNDINGS);
    }
    for row in rows(FILE, "fresnel_schlick_generalised") {
        let cos = libm::cos(row.wi_theta());
        row.check(
            schlick::schlick_generalised(row.num("F0"), row.num("F90"), row.num("exponent"), cos),
            FEW_ROUNDINGS,
        );
    }
    for row in rows(FILE, "fresnel_f82_tint_unclamped") {
        row.check(
            schlick::f82_tint_unclamped(row.num("F0"), row.num("tint"), libm::cos(row.wi_theta())),
            FEW_ROUNDINGS,
        );
    }
}

#[test]
fn schlick_ends_and_range() {
    for (f0, f90) in [(0.0, 1.0), (0.04, 1.0), (0.9375, 0.5), (1.0, 1.0)] {
        assert_eq!(schlick::schlick(f0, f90, 1.0), f0);
        assert_relative("grazing", schlick::schlick(f0, f90, 0.0), f90, ULP);
        for c in cosines() {
            let f = schlick::schlick(f0, f90, c);
            assert!(f >= f0.min(f90) && f <= f0.max(f90), "f0 = {f0}, f90 = {f90}, c = {c}: {f}");
            assert_eq!(f, schlick::schlick_generalised(f0, f90, 5.0, c));
        }
    }
    assert_eq!(schlick::weight(1.0 + f64::EPSILON), 0.0, "a rounded cosine above 1 is normal incidence");
    assert_eq!(schlick::schlick_generalised(0.25, 1.0, 3.5, 1.0 + f64::EPSILON), 0.25);
}

#[test]
fn f82_is_schlick_times_the_tint_at_its_angle_and_dips_below_zero() {
    let mu = 1.0 / 7.0;
    for (f0, tint) in [(0.9, 0.5), (0.5, 0.0), (0.04, 1.0), (0.0, 0.25)] {
        let expected = tint * schlick::schlick(f0, 1.0, mu);
        near!(schlick::f82_tint_unclamped(f0, tint, mu), expected, FEW_ROUNDINGS, "f0 = {f0}, tint = {tint}");
        assert_eq!(schlick::f82_tint_unclamped(f0, tint, 1.0), f0);
    }
    // The worst dip: -0.1268 at c = 0.261.
    let dip = schlick::f82_tint_unclamped(0.0, 0.0, 0.261);
    assert!((dip + 0.1268).abs() < QUOTED_DIGITS, "{dip}");
    for c in cosines() {
        assert!((0.0..=1.0).contains(&schlick::f82_tint(0.0, 0.0, c)));
    }
}

/// `f0`, `tint`, average of the unclamped curve; by quadrature, 16 digits verified by a second route.
const F82_AVERAGE: &[(f64, f64, f64)] = &[
    (0.9375, 0.5, 8.7278337408244333e-01),
    (0.5, 0.875, 5.1100295075949333e-01),
    (0.75, 0.0, 6.4063329271180351e-01),
    (0.0625, 0.5, 7.2383089136360420e-02),
    (0.25, 1.0, 2.8571428571428571e-01),
    (0.875, 0.25, 7.8294169726039421e-01),
    (0.046875, 0.75, 7.5176065833542565e-02),
];

#[test]
fn averages_match_reference_values_and_each_other() {
    for &(f0, tint, expected) in F82_AVERAGE {
        assert_relative(
            &format!("{f0} {tint}"),
            schlick::f82_tint_average(f0, tint),
            expected,
            FEW_ROUNDINGS,
        );
    }
    // 2 ∫ F c dc is linear in F: the average of (1 − c)⁵ alone is 1/21.
    assert_relative("1/21", schlick::schlick_average(0.0, 1.0), 1.0 / 21.0, NEAREST);
    assert_relative("p = 5", schlick::schlick_generalised_average(0.0, 1.0, 5.0), 1.0 / 21.0, ULP);
    // p = 1: 2 ∫ (1 − c) c dc = 1/3.
    assert_relative("p = 1", schlick::schlick_generalised_average(0.0, 1.0, 1.0), 1.0 / 3.0, ULP);
    assert_relative(
        "tint 1",
        schlick::f82_tint_average(0.3, 1.0),
        schlick::schlick_average(0.3, 1.0),
        NEAREST,
    );
}
