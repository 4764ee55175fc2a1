//! Charlie and the velvets: reference values, norms, samplers, finiteness.

use crate::terms::lobes::{assert_sampler, hemisphere};
use crate::terms::values::{Row, assert_relative, cosines, rows};
use crate::tolerance::{DIGIT_LOST, DIGITS_LOST, FEW_ROUNDINGS, INTEGRAL_10, MANY_ROUNDINGS};
use brdfbake::math::frame;
use brdfbake::terms::{charlie, vcavity, velvet};
use glam::{DVec2, DVec3};

const TERMS: &str = "points_terms";
const SHEEN: &str = "points_sheen";

/// D V of a row, V from the two cosines.
fn shade(row: &Row, d: impl Fn(DVec3) -> f64, v: impl Fn(f64, f64) -> f64) -> f64 {
    let (wo, wi) = (row.wo(), row.wi());
    d(frame::half_vector(wo, wi).unwrap().wh) * v(wo.z, wi.z)
}

#[test]
fn charlie_matches_reference_values() {
    for row in rows(TERMS, "D_charlie") {
        row.check(charlie::d(row.num("r"), row.wi()), MANY_ROUNDINGS);
    }
    for row in rows(TERMS, "Lambda_charlie_fit") {
        row.check(charlie::lambda(row.num("r"), row.wi().z), DIGIT_LOST);
    }
    for row in rows("points_sampling", "sample_charlie_sintheta") {
        let m = charlie::sample_d(row.num("r"), DVec2::new(row.num("u"), 0.0));
        row.check(frame::sin_theta(m), FEW_ROUNDINGS);
    }
    for row in rows(SHEEN, "charlie_conty_kulla") {
        let r = row.num("r");
        // Near the mirror direction the sine of the half vector is a difference: 1e-16/sin raised to 1/r.
        row.check(shade(&row, |m| charlie::d(r, m), |o, i| charlie::visibility(r, o, i)), 1e-11);
    }
    for row in rows(SHEEN, "charlie_neubelt_visibility") {
        row.check(shade(&row, |m| charlie::d(row.num("r"), m), velvet::visibility_neubelt), 1e-11);
    }
}

#[test]
fn charlie_is_normalised_sampled_and_finite() {
    for r in [1e-3, 0.07, 0.25, 0.5, 1.0] {
        let what = format!("roughness {r}");
        // Steep at the horizon for small r: sin^(1/r) changes within √r of it; 128 nodes in one panel resolve r = 0.07.
        if r > 0.05 {
            assert_relative(&what, hemisphere(1.0, |m| charlie::d(r, m) * m.z), 1.0, INTEGRAL_10);
            assert_sampler(&what, 1.0, |m| charlie::d(r, m), |u| charlie::sample_d(r, u));
        }
        for mu in cosines().into_iter().chain([0.0]) {
            let (d, lambda) = (charlie::d(r, frame::from_mu(mu)), charlie::lambda(r, mu));
            assert!(d.is_finite() && d >= 0.0, "{what}, mu = {mu}: D = {d}");
            assert!(lambda.is_finite() && lambda > 0.0, "{what}, mu = {mu}: Lambda = {lambda}");
            let soft = charlie::lambda_softened(r, mu);
            assert!(soft.is_finite() && soft > 0.0, "{what}, mu = {mu}: softened Lambda = {soft}");
            for mu_i in cosines() {
                let v = charlie::visibility(r, mu, mu_i);
                assert!(v.is_finite() && v >= 0.0, "{what}, {mu}, {mu_i}: V = {v}");
                assert_eq!(v, charlie::visibility(r, mu_i, mu));
            }
        }
    }
    assert_eq!(charlie::d(0.5, DVec3::Z), 0.0);
    assert_eq!(charlie::d(0.5, DVec3::X), 0.0);
    assert!(charlie::d(0.0, frame::from_mu(0.1)).is_finite());
    assert_relative(
        "softening ends at the normal",
        charlie::lambda_softened(0.5, 1.0),
        charlie::lambda(0.5, 1.0),
        FEW_ROUNDINGS,
    );
    // Both branches of the fit meet at 1/2.
    assert_relative("joint", charlie::lambda(0.3, 0.5 - 1e-14), charlie::lambda(0.3, 0.5), DIGITS_LOST);
}

#[test]
fn velvet_matches_reference_values() {
    for row in rows(SHEEN, "velvet07_neubelt") {
        row.check(
            shade(&row, |m| velvet::d_2007(row.num("alpha"), m), velvet::visibility_neubelt),
            DIGITS_LOST,
        );
    }
    for row in rows(SHEEN, "velvet00_vcavity") {
        let (wo, wi) = (row.wo(), row.wi());
        let half = frame::half_vector(wo, wi).unwrap();
        let g = vcavity::g2(wo, wi, half.wh, half.cos_d);
        row.check(velvet::d_2000(row.num("sigma"), half.wh) * g / (4.0 * wo.z * wi.z), DIGITS_LOST);
    }
}

#[test]
fn velvets_are_normalised_and_finite() {
    for width in [0.2, 0.5, 1.0, 2.0] {
        assert_relative("2000", hemisphere(1.0, |m| velvet::d_2000(width, m) * m.z), 1.0, INTEGRAL_10);
        assert_relative("2007", hemisphere(1.0, |m| velvet::d_2007(width, m) * m.z), 1.0, INTEGRAL_10);
    }
    for width in [0.0, 1e-3, 0.5, 2.0] {
        for mu in cosines() {
            for d in [velvet::d_2000(width, frame::from_mu(mu)), velvet::d_2007(width, frame::from_mu(mu))] {
                assert!(d.is_finite() && d >= 0.0, "width {width}, mu = {mu}: {d}");
            }
        }
    }
    assert_eq!((velvet::d_2000(0.5, DVec3::X), velvet::d_2007(0.5, DVec3::X)), (0.0, 0.0));
    assert_eq!(velvet::d_2000(0.5, DVec3::Z), 0.0);
    assert_eq!(velvet::visibility_neubelt(0.0, 0.0), 0.0);
    assert_eq!(velvet::visibility_neubelt(1.0, 0.3), 0.25);
}
